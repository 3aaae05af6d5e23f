"""study.toml and the files of texts: typed, and errors that name the key."""

from __future__ import annotations

import tomllib
from dataclasses import fields
from pathlib import Path

import pytest

from game.forms.reading import FormsError, paper_forms, read_forms
from game.study.study_settings import SettingsError, read_settings
from game.study.texts import LATER_TEXTS, TextsError, read_texts, shipped_texts
from game.tables.session_tables import LIKERT_ITEMS, MENTAL_STATES
from game.world.settings import MissionSettings

TEMPLATE = Path(__file__).parents[2] / "game" / "study" / "template"
EARLIER = Path(__file__).parents[1] / "data" / "earlier_study"
NAMES = {
    "seed": 1,
    "blocks": 5,
    "first": "one",
    "second": "two",
    "practice": "three",
    "coach": "ana",
    "preset": "calibrated",
}


@pytest.fixture
def study_toml(tmp_path: Path) -> Path:
    path = tmp_path / "study.toml"
    path.write_text((TEMPLATE / "study.toml").read_text().format(**NAMES))
    return path


def test_the_template_is_valid_and_hides_score_and_pause(study_toml: Path) -> None:
    settings, digest = read_settings(study_toml)
    assert settings.buildings == ("one", "two")
    assert not settings.mission.show_score
    assert not settings.mission.allow_pause
    assert settings.memorise_ms(1) == 180_000
    assert len(digest) == 64


@pytest.mark.parametrize(
    ("was", "becomes", "told"),
    [
        ("blocks = 5", "block = 5", "Did you mean blocks?"),
        ("columns = 120", "colums = 120", "study.toml, screen: .*Did you mean columns?"),
        ("columns = 120", "columns = 20", "screen.columns must be between 80 and 400, not 20"),
        ("duration_ms = 240000", "duration_ms = 5", "study.toml, mission: duration_ms must be"),
        ("duration_ms = 240000", "duration = 5", "Did you mean duration_ms?"),
        ('controls = "compass"', 'controls = "mouse"', "study.toml, mission.controls: .*'mouse'"),
        ("show_score = false", "", "show_score must be false"),
        ('"one", "two"', '"one", "one"', "two buildings must differ"),
        ("[60, 180]", "[180, 60]", "memorise_seconds"),
        ('coach = "ana"', 'coach = "yoked"', "coach must be one of .*, not yoked"),
        ('return_url = ""', 'return_url = "panel.example"', "web.return_url must be an address"),
        ('return_url = ""', 'return_url = "https://x.example/{kode}"', "web.return_url .*{code}"),
        ('panel_id = "PROLIFIC_PID"', 'panel_id = "a b"', "web.panel_id must be a name"),
        ("hash_ids", "hash_id", "Did you mean hash_ids?"),
        ("seed = 1", "seed = ", "not TOML"),
    ],
)
def test_a_bad_setting_is_named_with_its_hint(
    study_toml: Path, was: str, becomes: str, told: str
) -> None:
    study_toml.write_text(study_toml.read_text().replace(was, becomes))
    with pytest.raises(SettingsError, match=told):
        read_settings(study_toml)


def test_the_guide_has_every_key_of_a_mission_and_what_it_is_if_not_given() -> None:
    guide = (TEMPLATE.parents[2] / "docs" / "lab.md").read_text(encoding="utf-8")
    table = guide[guide.index("These are the keys of `[mission]`") :].split("\n\n")[1]
    listed: dict[str, str] = {}
    for line in table.splitlines()[2:]:
        names, _, value = (cell.strip() for cell in line.strip("|").split(" | "))
        keys, values = (text.replace("`", "").split(", ") for text in (names, value))
        listed |= dict(zip(keys, values * len(keys) if len(values) == 1 else values, strict=True))
    rules = MissionSettings(show_score=False, allow_pause=False)
    usual = {field.name: getattr(rules, field.name) for field in fields(rules)}
    assert listed.keys() == usual.keys()
    assert listed.pop("red_expiry_ms") == "half of the mission"
    for name, value in listed.items():
        given = usual[name]
        shown = f"{given:g}" if isinstance(given, float) else str(given).lower()
        assert value == shown, name


def test_a_missing_file_says_how_to_make_one(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match="ana study new"):
        read_settings(tmp_path / "study.toml")


def test_the_texts_are_valid_and_ask_what_the_paper_asked() -> None:
    texts, forms = read_texts(TEMPLATE / "texts.toml"), paper_forms()
    assert "18" in texts.consent.agree
    _check, sliders, likert = forms.forms
    assert tuple(slider.id for slider in sliders.questions) == MENTAL_STATES
    assert tuple(statement.id for statement in likert.questions) == LIKERT_ITEMS
    shown = (TEMPLATE / "texts.toml").read_text().split("[debrief]")[0].casefold()
    assert not any(word in shown for word in ("static", "adaptive", "level"))


def test_texts_of_an_earlier_study_lack_nothing(tmp_path: Path) -> None:
    written = tomllib.loads((TEMPLATE / "texts.toml").read_text())
    assert set(LATER_TEXTS) < written.keys()
    lines, kept = [], True
    for line in (TEMPLATE / "texts.toml").read_text().splitlines():
        if line.startswith("["):
            kept = line.strip("[]").partition(".")[0] not in LATER_TEXTS
        lines += [line] * kept
    path = tmp_path / "texts.toml"
    path.write_text("\n".join(lines).replace('title = "Welcome"', 'title = "Willkommen"'))
    assert not set(LATER_TEXTS) & tomllib.loads(path.read_text()).keys()
    texts = read_texts(path)
    assert texts.consent.title == "Willkommen"
    assert (texts.no_place, texts.cut_off) == (shipped_texts().no_place, shipped_texts().cut_off)
    path.write_text(path.read_text().replace("[declined]", "[refused]"))
    with pytest.raises(TextsError):
        read_texts(path)


@pytest.mark.parametrize(
    ("was", "becomes", "told"),
    [
        ('id = "pref2"', 'id = "pref1"', "two items have the id pref1"),
        ("right = 3", "right = 4", "right must be between 1 and 3"),
        ('"neither", ', "", "5 answers, not 4"),
        ("[scale]", "[scales]", "scales"),
    ],
)
def test_bad_items_of_an_earlier_study_are_named(
    tmp_path: Path, was: str, becomes: str, told: str
) -> None:
    path = tmp_path / "items.toml"
    path.write_text((EARLIER / "items.toml").read_text().replace(was, becomes))
    pages = read_texts(EARLIER / "texts.toml").form_pages
    with pytest.raises(FormsError, match=told) as refused:
        read_forms(tmp_path, pages)
    assert "items.toml" in str(refused.value)

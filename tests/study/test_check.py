"""`ana study check`: every page opened, the folder and the disk tried, before anybody comes."""

from __future__ import annotations

import fcntl
import re
import shutil
from pathlib import Path

import pytest
from PIL import Image

from game.cli import main
from game.errors import AnaError
from game.screens.study import pictures, rehearsal
from game.screens.study.base import Frame
from game.screens.study.pages import PageScreen
from game.screens.study.pictures import write_pictures
from game.screens.widgets.theme import LOOK
from game.study.folder import Study, StudyError, new_study, open_study
from game.study.lab.readiness import shortfalls
from game.study.lab.stated_design import outdated
from game.study.lab.stated_times import contradicted, stated
from game.study.languages import languages
from game.study.study_settings import ScreenSize
from game.study.texts import Page, shipped_texts


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("check") / "study"
    new_study(folder, seed=3, blocks=1)
    return folder


@pytest.fixture
def folder(made: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(made, tmp_path / "study"))


FEW_PAGES = """rounds = 1
phases = ["consent", "rounds", "debrief"]
round_phases = ["mission"]
"""


@pytest.fixture
def short(folder: Path) -> Path:
    """A study with few pages."""
    edit(folder, "study.toml", "label_seconds", f"{FEW_PAGES}label_seconds")
    edit(folder, "study.toml", "duration_ms = 240000", "duration_ms = 8000")
    return folder


def edit(folder: Path, name: str, before: str, after: str) -> Study:
    path = folder / name
    text = path.read_text(encoding="utf-8")
    assert before in text
    path.write_text(text.replace(before, after, 1), encoding="utf-8")
    return open_study(folder)


@pytest.mark.long
def test_a_new_study_is_well(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "check", str(folder)]) == 0
    assert "all is well" in capsys.readouterr().out
    assert not (folder / "sessions").exists()


@pytest.mark.slow
def test_every_page_of_a_new_study_is_pictured(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "pictures"
    assert main(["study", "check", str(folder), "--pictures", str(out)]) == 0
    assert "pages" in capsys.readouterr().out
    pictures = sorted(out.glob("*.svg"))
    index = (out / "index.html").read_text(encoding="utf-8")
    assert len(pictures) >= 36
    assert all(picture.name in index for picture in pictures)
    assert "Map of" in index
    assert not [it for it in (*pictures, out / "index.html") if 'url("' in it.read_text("utf-8")]
    for picture in pictures:
        with Image.open(picture.with_suffix(".png")) as drawn:
            assert drawn.width > 1_000
            assert len(drawn.getcolors(1 << 24) or ()) > 2
    assert not (folder / "sessions").exists()


def test_the_servers_configuration_comes_with_what_is_wrong(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(rehearsal, "found_wrong", lambda _study, **_: (["the page is cut"], []))
    assert main(["study", "sshd", str(folder)]) == 0
    told = capsys.readouterr()
    assert "ForceCommand" in told.out
    assert "the page is cut" in told.err


def test_words_that_cannot_be_seen_fail_it(short: Path, capsys: pytest.CaptureFixture[str]) -> None:
    endless = "Donaudampfschifffahrtsgesellschaftskapitaen" * 4
    edit(short, "forms.toml", 'low = "', f'low = "{endless} ')
    assert main(["study", "check", str(short)]) == 2
    assert "these words are cut off or hidden" in capsys.readouterr().err


async def test_a_page_longer_than_the_screen_is_looked_at_to_its_end(tmp_path: Path) -> None:
    body = "\n\n".join(f"Paragraph {number} of many." for number in range(30))
    long, frame = Page("Thanks", body), Frame(ScreenSize(), shipped_texts().words)
    async with rehearsal.Showing(LOOK).run_test(size=(120, 40)) as pilot:
        last = await rehearsal.shown(pilot, "", lambda: PageScreen(frame, long), body)
    assert len(last.pictures) > 1
    index = write_pictures([last], "Study", tmp_path / "pictures").read_text("utf-8")
    for part in range(1, len(last.pictures) + 1):
        assert f'src="01-{part}.svg"' in index
        with Image.open(tmp_path / "pictures" / f"01-{part}.png") as drawn:
            assert len(drawn.getcolors(1 << 24) or ()) > 2
    assert last.missing == ()


def test_texts_must_say_when_reds_expire(folder: Path) -> None:
    study = edit(folder, "texts.toml", "in the first {red_time}", "soon")
    assert any("red victims expire" in one for one in shortfalls(study))


def test_rights_and_locks_are_tried(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study = open_study(folder)
    assert list(shortfalls(study)) == []
    (folder / "texts.toml").chmod(0o666)
    assert any("chmod go-w" in one for one in shortfalls(study))
    (folder / "texts.toml").chmod(0o600)

    def refuse(_file: object, _operation: int) -> None:
        raise OSError(37, "No locks available")

    monkeypatch.setattr(fcntl, "flock", refuse)
    assert any("local disk" in one for one in shortfalls(study))
    monkeypatch.setattr("shutil.disk_usage", lambda _: shutil._ntuple_diskusage(1, 1, 5_000_000))
    assert any("nearly full: 5 MB" in one for one in shortfalls(study))


def test_a_locale_without_utf8_is_told(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study = open_study(folder)
    monkeypatch.setattr("locale.getpreferredencoding", lambda do_setlocale: "ISO-8859-1")
    assert any("set LANG=C.UTF-8" in one for one in shortfalls(study))


def test_a_primary_outcome_that_nothing_measures_is_told(folder: Path) -> None:
    assert list(shortfalls(open_study(folder))) == []
    study = edit(folder, "study.toml", '["engagement", "victims"]', '["engagements", "joy"]')
    told = [one for one in shortfalls(study) if "primary.outcomes" in one]
    assert len(told) == 2
    assert "Did you mean engagement?" in told[0]
    assert "forms.toml asks no such item" in told[1]


@pytest.mark.parametrize("language", languages())
def test_a_new_study_says_the_times_that_it_has(language: str, tmp_path: Path) -> None:
    new_study(tmp_path / "study", seed=3, blocks=1, language=language)
    study = open_study(tmp_path / "study")
    assert [*contradicted(study), *outdated(study)] == []


@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("rounds = 1", [("consent", "rounds is 1:"), ("debrief", "met one instructor:")]),
        ('instructors = ["ana", "yoked"]', [("debrief", "the instructors are ana and yoked:")]),
        ('instructors = ["static:1", "static:3"]', [("debrief", "static:1 and static:3:")]),
        ('round_phases = ["mission"]', [("consent", "no memorise and no label:")]),
        ('instructors = ["knowledge", "static"]', []),
    ],
)
def test_what_the_texts_still_say_of_the_papers_design_is_told(
    line: str, told: list[tuple[str, str]], language: str, tmp_path: Path
) -> None:
    new_study(tmp_path / "study", seed=3, blocks=1, language=language)
    study = edit(tmp_path / "study", "study.toml", "label_seconds", f"{line}\nlabel_seconds")
    notes = list(outdated(study))
    for (page_name, why), note in zip(told, notes, strict=True):
        assert note.startswith(f'texts.toml, {page_name}.body says "')
        assert note.partition('"')[2].partition('"')[0] in getattr(study.texts, page_name).body
        assert note.endswith(f"{why} change the text")


@pytest.mark.parametrize(("language", "said"), [("en", "four-minute"), ("de", "vierminütigen")])
def test_a_text_that_names_the_time_of_a_longer_mission_is_told(
    language: str, said: str, tmp_path: Path
) -> None:
    new_study(tmp_path / "study", seed=3, blocks=1, language=language)
    edit(
        tmp_path / "study", "study.toml", "memorise_seconds = [60, 180]", "memorise_seconds = [20]"
    )
    edit(tmp_path / "study", "study.toml", "label_seconds = 240", "label_seconds = 30")
    study = edit(tmp_path / "study", "study.toml", "duration_ms = 240000", "duration_ms = 20000")
    mission, session = contradicted(study)
    assert mission.startswith(
        f'texts.toml, consent.body says "{said}", but label_seconds is 30 s; '
    )
    assert mission.endswith("duration_ms is 20 s: change the text or the setting")
    assert '"25 minut' in session.lower()
    assert "a session takes between 1 and 15 minutes" in session


@pytest.mark.parametrize(
    ("text", "ms"),
    [
        ("a 20-second mission", 20_000),
        ("It takes about 1.5 minutes.", 90_000),
        ("in one minute", 60_000),
        ("about twenty-five minutes", 1_500_000),
        ("thirty-five minutes", []),
        ("2-3 minutes", 180_000),
        ("Sie haben zwanzig Sekunden", []),
        ("take the second door; someone minute", []),
        ("{time} minutes", []),
    ],
)
def test_times_are_found_in_a_text(text: str, ms: int | list[int]) -> None:
    found = [it for _, it in stated(text, shipped_texts().units)]
    assert found == ([ms] if isinstance(ms, int) else ms)


@pytest.mark.parametrize(
    ("name", "before", "after", "told"),
    [
        (
            "study.toml", "memorise_seconds = [60, 180]", "memorise_seconds = 20",
            "study.toml, memorise_seconds: this must be a list in brackets, not a whole number. "
            "Write [20]",
        ),
        (
            "study.toml", "duration_ms = 240000", 'duration_ms = "4 min"',
            "study.toml, mission.duration_ms: this must be a whole number, not text in quotes",
        ),
        (
            "study.toml", '"foundry"', '"foundryy.txt"',
            "study.toml, buildings: there is no building 'foundryy.txt', neither in this folder "
            "nor among those that are shipped. Did you mean foundry?",
        ),
        (
            "study.toml", "label_seconds", 'phases = ["consent", "practise"]\nlabel_seconds',
            "study.toml, phases[1]: 'practise' is none of the values that are allowed. Did you "
            "mean practice? Choose from",
        ),
        (
            "study.toml", 'memorise = "continue"', 'memorise = "go on"',
            "study.toml, interruption.memorise: 'go on' is none of the values that are allowed. "
            "Choose from continue, void",
        ),
        (
            "texts.toml", 'go_on = "continue"', "go_on = 3",
            "texts.toml, words.go_on: this must be text in quotes, not a whole number",
        ),
        (
            "forms.toml", 'id = "likert"', 'id = "sliders"',
            "two forms have the id sliders; delete one of them, or give it another id",
        ),
    ],
)  # fmt: skip
def test_a_mistake_in_a_file_is_told_in_plain_words(
    folder: Path, name: str, before: str, after: str, told: str
) -> None:
    with pytest.raises(AnaError, match=re.escape(told)):
        edit(folder, name, before, after)


@pytest.mark.parametrize("name", ["study.toml", "texts.toml", "forms.toml", "instructions.toml"])
def test_a_file_that_is_no_utf_8_is_told_as_such(folder: Path, name: str) -> None:
    path = folder / name
    path.write_bytes(path.read_text("utf-8").encode("utf-16"))
    told = f"{name}: the file is not UTF-8 text. Save it again as UTF-8"
    with pytest.raises(AnaError, match=re.escape(told)):
        open_study(folder)


def test_a_doubled_id_is_told_with_its_lines(folder: Path) -> None:
    text = (folder / "forms.toml").read_text("utf-8").splitlines()
    first, second = (text.index(f'id = "{name}"') + 1 for name in ("sliders", "likert"))
    with pytest.raises(AnaError, match=f"forms.toml, lines {first} and {second}: two forms"):
        edit(folder, "forms.toml", 'id = "likert"', 'id = "sliders"')


def test_a_machine_without_the_font_is_told_which(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pictures, "_FONT", "No Such Mono")
    with pytest.raises(StudyError, match="No Such Mono is not on this machine"):
        write_pictures([], "Study", tmp_path / "pictures")
    assert not (tmp_path / "pictures").exists()

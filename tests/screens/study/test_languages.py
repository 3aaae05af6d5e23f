"""A study in another language: everything is drawn whole, in its own words."""

from __future__ import annotations

import re
import shutil
import tomllib
from pathlib import Path

import msgspec
import pytest
from rich.cells import cell_len

from game.cli import main
from game.coach.acts import InstructionIssued
from game.coach.instructions.phrasebook_file import english, parse_phrasebook
from game.journal.reader import read_journal
from game.journal.records import MissionStarted, PhaseEnded
from game.screens.study.rehearsal import rehearsed
from game.screens.widgets.canvas import width
from game.screens.widgets.instruction_bar import bar_rows, lines_needed, longest_guidance
from game.session.verification import verify
from game.study.folder import Study, new_study, open_study
from game.study.lab.readiness import shortfalls
from game.study.languages import Translation, languages
from game.study.ready import ready_forms, ready_names, ready_text
from game.world import load_building

ROOT = Path(__file__).parents[3]
GERMAN, JAPANESE = ROOT / "game/study/languages/de", ROOT / "tests/data/japanese"
ROOMS = (
    *("図書室", "会議室", "受付", "食堂", "倉庫", "書庫", "作業場", "休憩室", "研究室", "応接室"),
    *("放送室", "暗室", "中庭", "給湯室", "医務室", "事務室", "電算室", "資料室", "印刷室", "台所"),
)
BUILDINGS = ("foundry", "harbour", "practice")


def japanese_study(folder: Path) -> Study:
    new_study(folder, seed=3, blocks=1)
    (folder / "forms.toml").unlink(missing_ok=True)
    for path in JAPANESE.glob("*.toml"):
        shutil.copy(path, folder / path.name)
    settings = (folder / "study.toml").read_text()
    for name in BUILDINGS:
        text = load_building(name).text
        for room, japanese in zip(re.findall(r"(?m)^\S = room .*$", text), ROOMS, strict=False):
            text = text.replace(f"{room}\n", f"{room.partition(' room ')[0]} room {japanese}\n")
        (folder / f"{name}.txt").write_text(text)
        settings = settings.replace(f'"{name}"', f'"{name}.txt"')
    (folder / "study.toml").write_text(settings)
    return open_study(folder)


@pytest.mark.long
def test_a_study_in_wide_characters_is_drawn_whole_on_every_page(tmp_path: Path) -> None:
    pages = rehearsed(japanese_study(tmp_path / "study"), pictures=False)
    assert len(pages) > 40
    assert not {page.name: page.missing for page in pages if page.missing}


@pytest.mark.long
def test_nobody_in_a_german_study_reads_english(tmp_path: Path) -> None:
    new_study(tmp_path / "study", seed=3, blocks=1, language="de")
    study = open_study(tmp_path / "study")
    assert not list(shortfalls(study))
    assert study.settings.name == "Adaptive Navigationshilfe", "the pages in a browser show it"
    pages = rehearsed(study)
    assert [page.name for page in pages[:2]] == ["01 Bevor es losgeht", "02 Willkommen"]
    assert not {page.name: page.missing for page in pages if page.missing}
    english_words = re.compile(
        r">[^<]*\b(the|you|your|and|is|of|press|y|enter|space)\b[^<]*<", re.IGNORECASE
    )
    for page in pages:
        for picture in page.pictures:
            found = english_words.search(picture.partition("<g ")[2].replace("&#160;", " "))
            assert found is None or "study.toml changed" in found[0], (page.name, found[0])


@pytest.mark.parametrize("columns", [80, 100, 120, 200])
@pytest.mark.parametrize("language", ["en", "de", "ja"])
def test_the_bar_keeps_its_height_and_cuts_nothing(language: str, columns: int) -> None:
    source = {"de": GERMAN, "ja": JAPANESE}.get(language)
    phrases = english()
    if source:
        text = (source / "instructions.toml").read_text(encoding="utf-8")
        phrases = parse_phrasebook(text, language)
    lines = lines_needed(phrases, ROOMS, columns)
    assert 3 <= lines <= 4
    for guidance in longest_guidance(phrases, ROOMS):
        rows = bar_rows(guidance, columns, lines=lines)
        assert len(rows) == lines
        shown = ["".join(text for text, _ in row).rstrip() for row in rows]
        assert all(cell_len(one) <= columns for one in shown)
        joined = "".join("".join(one.split()) for one in shown)
        assert joined == "".join((guidance.notice + guidance.text).split())
        assert all(width(row) >= columns for row in rows)


def test_a_german_study_is_simulated_verified_and_says_the_english_tuples(tmp_path: Path) -> None:
    """The same people in the same study but for the words: the same instructions, as long as
    nobody goes astray."""
    told = {}
    for language in languages():
        folder = tmp_path / language
        new_study(folder, seed=5, blocks=1, language=language)
        assert main(["simulate", str(folder), "--participants", "1", "--seed", "5"]) == 0
        (path,) = folder.glob("sessions/simulated/*/journal.jsonl")
        assert verify(path).reproduced
        records = [entry.record for entry in read_journal(path).entries]
        assert sum(isinstance(it, PhaseEnded) for it in records) > 12
        texts = {it.instructions_text for it in records if isinstance(it, MissionStarted)}
        expected = None if language == "en" else open_study(folder).phrases.text
        assert texts == {expected}
        issued = [it for it in records if isinstance(it, InstructionIssued)]
        told[language] = issued
    rooms = Translation("de").rooms
    first = [
        [(action, rooms.get(thing, thing)) for action, thing in it.tuples] for it in told["en"][:3]
    ]
    assert first == [list(it.tuples) for it in told["de"][:3]]
    assert not {it.text for it in told["en"]} & {it.text for it in told["de"]}


def without_words(name: str, language: str) -> object:
    """A ready form without what is written in a language."""

    def bare(tree: object) -> object:
        if isinstance(tree, list | tuple):
            return [bare(it) for it in tree]
        if isinstance(tree, dict):
            words = ("title", "body", "text", "low", "high", "unit", "other", "source", "answers")
            kept = {key: bare(it) for key, it in tree.items() if key not in words}
            return kept | {f"{key} of": len(tree[key]) for key in ("answers",) if key in tree}
        return tree

    return bare(msgspec.to_builtins(ready_forms(name, language)))


@pytest.mark.parametrize("name", ready_names())
def test_german_forms_ask_the_same_items(name: str) -> None:
    assert without_words(name, "de") == without_words(name, "en")
    assert ready_text(name, "de") != ready_text(name)


def keys(tree: object) -> set[str]:
    """The keys of a tree of texts."""
    below = tree.items() if isinstance(tree, dict) else ()
    return {path for key, it in below for path in (key, *(f"{key}.{one}" for one in keys(it)))}


@pytest.mark.parametrize("folder", [GERMAN, JAPANESE], ids=lambda it: it.name)
def test_a_translation_has_every_text(folder: Path) -> None:
    """Older study folders may lack some; a translation that comes with the game may not."""
    english_texts = (ROOT / "game/study/template/texts.toml").read_text(encoding="utf-8")
    translated = (folder / "texts.toml").read_text(encoding="utf-8")
    assert keys(tomllib.loads(translated)) >= keys(tomllib.loads(english_texts))


@pytest.mark.parametrize("name", BUILDINGS)
def test_a_translated_building_differs_in_its_room_names_alone(name: str) -> None:
    translation = Translation("de")
    text = translation.buildings([name])[f"{name}.txt"]
    back = {german: room for room, german in translation.rooms.items()}
    there = re.sub(r"(?m)^(\S = room )(.*)$", lambda it: it[1] + back[it[2]], text)
    assert there == load_building(name).text


def test_every_german_room_has_a_sentence_of_its_own() -> None:
    translation = Translation("de")
    text = translation.texts["instructions.toml"]
    assert {f'"Goto {room}" = ' in text for room in translation.rooms.values()} == {True}


def test_a_language_that_there_is_not_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["study", "new", str(tmp_path / "study"), "--language", "dee"]) == 2
    assert "Did you mean de?" in capsys.readouterr().err
    assert not (tmp_path / "study").exists()


def test_a_sentence_for_a_misspelt_room_is_found(tmp_path: Path) -> None:
    new_study(tmp_path / "study", seed=3, blocks=1, language="de")
    path = tmp_path / "study" / "instructions.toml"
    path.write_text(path.read_text().replace('"Goto Empfang"', '"Goto Empfnag"'))
    (found,) = shortfalls(open_study(tmp_path / "study"))
    assert "has a room 'Empfnag'. Did you mean Empfang?" in found
    assert re.match(r"instructions.toml, line \d+: ", found)


def test_study_check_names_the_line_of_a_sentence_that_is_wrong(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    new_study(tmp_path / "study", seed=3, blocks=1, language="de")
    path = tmp_path / "study" / "instructions.toml"
    text = path.read_text()
    path.write_text(text.replace("{nten} Tür links", "{nteen} Tür links"))
    assert main(["study", "check", str(tmp_path / "study")]) == 2
    told = capsys.readouterr().err
    line = next(n for n, it in enumerate(path.read_text().splitlines(), 1) if "{nteen}" in it)
    assert f"instructions.toml, line {line}: there is no {{nteen}}" in told
    assert "Did you mean {nten}?" in told

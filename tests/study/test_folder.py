"""The study's folder: creating, opening, protection against changes, withdrawal."""

from __future__ import annotations

import stat
from pathlib import Path

import pytest

from game.errors import AnaError
from game.study.folder import (
    Identity,
    Study,
    StudyError,
    amend,
    identify,
    new_study,
    open_study,
)
from game.study.lab.leaving import withdraw
from game.study.ledger import LedgerError, SettingsAmended, agreed_inputs, ending_of, slot_of
from game.study.lock import SessionBusy, SessionLock
from game.study.study_settings import SettingsError
from tests.study.people import P01, journal_of, small_study, take_part


@pytest.fixture
def study(tmp_path: Path) -> Study:
    return small_study(tmp_path / "study")


def edit(study: Study, before: str, after: str) -> None:
    path = study.folder / "study.toml"
    text = path.read_text()
    assert before in text
    path.write_text(text.replace(before, after))


def test_a_new_study_is_valid_and_private(tmp_path: Path) -> None:
    folder = tmp_path / "deep" / "study"
    new_study(folder, seed=3, blocks=2)
    study = open_study(folder)
    assert (study.settings.seed, study.settings.blocks) == (3, 2)
    assert study.settings.memorise_seconds == (60, 180)
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    for file in folder.iterdir():
        assert stat.S_IMODE(file.stat().st_mode) == 0o600


def test_without_a_seed_a_random_one_is_chosen(tmp_path: Path) -> None:
    seeds = set()
    for name in "abc":
        new_study(tmp_path / name)
        seeds.add(open_study(tmp_path / name).settings.seed)
    assert len(seeds) == 3


def test_a_study_is_not_made_over_another(study: Study) -> None:
    with pytest.raises(StudyError, match="not empty"):
        new_study(study.folder)


@pytest.mark.parametrize("name", ["P01", "a", "x" * 32, "A-b_9"])
def test_pseudonyms(name: str) -> None:
    assert identify(name) == Identity("live", name)
    assert identify(name, pilot=True).mode == "pilot"


@pytest.mark.parametrize(
    "name", ["", "x" * 33, "a@b.org", "Ann Lee", "../x", "a/b", ".", "é", "-rf", "--help", "_a"]
)
def test_not_pseudonyms(name: str) -> None:
    with pytest.raises(StudyError, match="pseudonym"):
        identify(name)


@pytest.mark.parametrize(
    ("before", "after"), [("seed = 7", "seed = 8"), ("blocks = 1", "blocks = 2")]
)
def test_what_decides_the_allocation_never_changes(study: Study, before: str, after: str) -> None:
    edit(study, before, after)
    with pytest.raises(SettingsError, match="the study was created with"):
        open_study(study.folder)


def test_settings_change_freely_until_the_first_allocation(study: Study) -> None:
    edit(study, "label_seconds = 6", "label_seconds = 7")
    changed = open_study(study.folder)
    changed.ledger.agree(changed.inputs)
    (amended,) = (e for e in changed.ledger.entries() if isinstance(e, SettingsAmended))
    assert amended.settings_hash == changed.copy.sha256
    changed.ledger.agree(changed.inputs)
    assert sum(isinstance(e, SettingsAmended) for e in changed.ledger.entries()) == 1


def test_afterwards_a_change_needs_an_amendment(study: Study) -> None:
    study.ledger.agree(study.inputs)
    study.ledger.allocate("P02", "live")
    edit(study, "label_seconds = 6", "label_seconds = 7")
    changed = open_study(study.folder)
    with pytest.raises(LedgerError, match="ana study amend"):
        changed.ledger.agree(changed.inputs)
    amend(study.folder, "a mistake")
    changed.ledger.agree(changed.inputs)
    with pytest.raises(LedgerError, match=r"study\.toml changed"):
        study.ledger.agree(study.inputs)


@pytest.mark.parametrize("name", ["texts.toml", "forms.toml", "instructions.toml", "mine.txt"])
def test_texts_items_and_buildings_are_frozen_too(study: Study, name: str) -> None:
    text = study.buildings[0].text.replace("Foundry Court", "My Own House")
    (study.folder / "mine.txt").write_text(text)
    edit(study, '"foundry"', '"mine.txt"')
    study = open_study(study.folder)
    study.freeze()
    study.ledger.allocate("P02", "live")
    kept = {path.name for path in (study.folder / "versions").iterdir()}
    assert len(kept) == len(study.inputs) == 7
    path = study.folder / name
    changed = path.read_text()
    before, after = {
        "texts.toml": ("Thank you", "Thanks"),
        "forms.toml": ("engagement", "engagement_2"),
        "instructions.toml": ("Stop.", "Stand still."),
        "mine.txt": ("facing north", "facing south"),
    }[name]
    path.write_text(changed.replace(before, after, 1))
    later = open_study(study.folder)
    assert later.version != study.version
    named = name if name != "mine.txt" else "building My Own House"
    with pytest.raises(LedgerError, match=f"{named} changed after"):
        later.freeze()
    assert amend(study.folder, "a slip") == (named,)
    later.freeze()
    now = {path.name for path in (study.folder / "versions").iterdir()}
    assert kept < now
    assert len(now) == len(kept) + 1


def test_a_ledger_of_the_first_release_is_agreed_with(tmp_path: Path) -> None:
    new_study(tmp_path / "plain")
    study = open_study(tmp_path / "plain")
    study.ledger.allocate("P02", "live")
    assert set(agreed_inputs(study.ledger.entries())) == {"study.toml"}
    study.ledger.agree(study.inputs)
    assert agreed_inputs(study.ledger.entries()) == dict(study.inputs)


def test_nothing_is_amended_that_was_not_changed(study: Study) -> None:
    study.ledger.agree(study.inputs)
    with pytest.raises(StudyError, match="nothing has changed"):
        amend(study.folder, "no reason")


def test_a_building_must_fit_the_study_screen(study: Study) -> None:
    edit(study, "columns = 120", "columns = 90")
    with pytest.raises(StudyError, match="more than the map"):
        open_study(study.folder)


def test_a_building_file_of_the_folder_is_used(study: Study) -> None:
    text = study.buildings[0].text.replace("Foundry Court", "My Own House")
    (study.folder / "mine.txt").write_text(text)
    edit(study, '"foundry"', '"mine.txt"')
    assert open_study(study.folder).buildings[0].name == "My Own House"


def test_a_folder_without_a_study_is_told_how_to_get_one(tmp_path: Path) -> None:
    with pytest.raises(AnaError, match="ana study new"):
        open_study(tmp_path)


def test_journals_and_their_folders_are_private(finished: Study) -> None:
    home = finished.home(P01)
    assert stat.S_IMODE((home / "journal.jsonl").stat().st_mode) == 0o600
    for folder in (home, home.parent, home.parent.parent):
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700


def test_withdrawal_deletes_what_was_recorded_and_leaves_a_tombstone(copy: Study) -> None:
    take_part(copy, Identity("pilot", "P02"))
    assert withdraw(copy, P01)
    assert not copy.home(P01).exists()
    assert journal_of(copy, Identity("pilot", "P02")).entries
    entries = copy.ledger.entries()
    assert ending_of(entries, "P01", "pilot") == "withdrawn"
    assert slot_of(entries, "P01", "pilot") is not None
    assert not withdraw(copy, P01)
    with pytest.raises(StudyError, match="has withdrawn"):
        take_part(copy)


def test_nobody_is_withdrawn_while_taking_part(copy: Study) -> None:
    lock = SessionLock(copy.home(P01))
    with pytest.raises(SessionBusy):
        withdraw(copy, P01)
    assert journal_of(copy).entries
    lock.release()

"""People who find no place because the study is closed or full, and what is kept about them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from game.journal.records import PhaseEnded, PracticeChecked, SessionEnded
from game.study.design import BLOCK
from game.study.folder import Identity, Study
from game.study.lab.leaving import drop_out
from game.study.lab.study_status import StatusReader
from game.study.ledger import ending_of, slot_of
from tests.study.people import cut_off, journal_of, small_study, take_part

P05 = Identity("live", "P05")


def fill(study: Study) -> None:
    """Let others take all places."""
    study.ledger.agree(study.inputs)
    for number in range(study.settings.blocks * BLOCK):
        study.ledger.allocate(f"Q{number}", "live")


CLOSE_OR_FILL = pytest.mark.parametrize(
    "end", [lambda study: study.ledger.close(), fill], ids=["closed", "full"]
)


@CLOSE_OR_FILL
def test_a_newcomer_without_a_place_is_told_at_login_and_nothing_is_recorded(
    tmp_path: Path, end: Callable[[Study], None]
) -> None:
    study = small_study(tmp_path / "study")
    study.ledger.agree(study.inputs)
    end(study)
    before = study.ledger.path.read_bytes()
    asked: list[str] = []
    outcome, person = take_part(study, P05, moment=asked.append)
    assert (outcome, asked) == ("over", ["read"])
    assert person.read_pages == [study.texts.no_place]
    assert not study.home(P05).exists()
    assert study.ledger.path.read_bytes() == before


@CLOSE_OR_FILL
@pytest.mark.parametrize("here", ["agree", "look"])
def test_people_in_consent_or_practice_when_places_run_out_are_told_after_practice(
    tmp_path: Path, end: Callable[[Study], None], here: str
) -> None:
    study = small_study(tmp_path / "study")
    done: list[str] = []

    def moment(what: str) -> None:
        if what == here and here not in done:
            end(study)
        done.append(what)

    outcome, person = take_part(study, P05, moment=moment)
    assert outcome == "over"
    assert person.read_pages[-1] == study.texts.no_place
    assert "memorise" not in done
    kept = [entry.record for entry in journal_of(study, P05).entries]
    assert isinstance(kept[-2], PhaseEnded)
    assert kept[-1] == SessionEnded("turned_away")
    assert any(isinstance(record, PracticeChecked) for record in kept)
    assert ending_of(study.ledger.entries(), "P05", "live") == "turned_away"
    assert slot_of(study.ledger.entries(), "P05", "live") is None
    assert StatusReader(study.folder).look().totals.turned_away == 1


def test_people_who_come_back_to_a_closed_study_in_mid_practice_are_told_at_login(
    tmp_path: Path,
) -> None:
    study = small_study(tmp_path / "study")
    cut_off(study, P05, at="play")
    study.ledger.close()
    for _ in range(2):
        outcome, person = take_part(study, P05)
        assert (outcome, person.read_pages) == ("over", [study.texts.no_place])
        assert journal_of(study, P05).entries[-1].record == SessionEnded("turned_away")


def test_people_with_a_place_finish_after_the_study_is_closed(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study")
    cut_off(study, P05, at="memorise")
    study.ledger.close()
    assert take_part(study, P05)[0] == "over"
    assert ending_of(study.ledger.entries(), "P05", "live") == "finished"


def test_people_who_were_turned_away_continue_once_a_place_is_free(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study", refill_dropouts="true")
    cut_off(study, P05, at="look")
    fill(study)
    take_part(study, P05)
    drop_out(study, Identity("live", "Q3"))
    assert take_part(study, P05)[0] == "over"
    slot = slot_of(study.ledger.entries(), "P05", "live")
    assert slot is not None
    assert (slot.slot, slot.refill) == (3, True)
    assert ending_of(study.ledger.entries(), "P05", "live") == "finished"


def test_a_closed_or_full_study_can_be_tried_as_a_pilot(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study")
    fill(study)
    study.ledger.close()
    take_part(study)
    assert ending_of(study.ledger.entries(), "P01", "pilot") == "finished"

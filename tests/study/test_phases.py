"""Phases in any sensible order, as data: what is refused, and that sessions follow the order."""

from __future__ import annotations

import shutil
from itertools import permutations
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.forms.reading import paper_forms
from game.journal.history import Step, history_of, read_history
from game.journal.records import PhaseEnded, PhaseStarted, SessionEnded
from game.study.course import course
from game.study.folder import open_study
from game.study.protocol.timeline import next_point
from game.study.study_settings import RoundPhase, StudyPhase, StudySettings
from tests.study.people import P01, journal_of, take_part
from tests.study.test_designs import with_settings
from tests.study.test_timeline import passed

PHASES: tuple[StudyPhase, ...] = (
    "preflight", "consent", "practice", "rounds", "preference", "debrief",
)  # fmt: skip
PARTS: tuple[RoundPhase, ...] = ("memorise", "label", "mission", "forms")
FORMS = ("sliders", "likert")


def settings(
    phases: tuple[StudyPhase, ...] = PHASES, parts: tuple[RoundPhase, ...] = PARTS, rounds: int = 2
) -> StudySettings:
    return StudySettings(
        name="test",
        seed=1,
        buildings=("one", "two", "three")[: max(rounds, 1)],
        practice_building="four",
        phases=phases,
        round_phases=parts,
        rounds=rounds,
    )


def chosen(of: tuple[str, ...]) -> st.SearchStrategy[tuple[str, ...]]:
    """Some of them, in any order."""
    every = [some for count in range(1, len(of) + 1) for some in permutations(of, count)]
    return st.sampled_from(every)


@given(chosen(PARTS), st.integers(1, 3))
def test_a_round_has_any_order_in_which_a_mission_makes_sense(
    parts: tuple[RoundPhase, ...], rounds: int
) -> None:
    at = {part: place for place, part in enumerate(parts)}
    sensible = (
        "mission" in at
        and at.get("memorise", -1) < at["mission"]
        and at.get("forms", len(parts)) > at["mission"]
    )
    if not sensible:
        with pytest.raises(ValueError, match="round_phases must have"):
            settings(parts=parts, rounds=rounds)
        return
    steps = course(paper_forms(), settings(parts=parts, rounds=rounds))
    expected = [
        phase
        for part in (*parts, *(() if "forms" in parts else ("forms",)))
        for phase in (FORMS if part == "forms" else (part,))
    ]
    for round_ in range(1, rounds + 1):
        assert [step.phase for step in steps if step.round == round_] == expected
    assert len(set(steps)) == len(steps)


@given(chosen(PHASES))
def test_phases_come_in_their_order_or_are_refused(phases: tuple[StudyPhase, ...]) -> None:
    needed = {"consent", "rounds", "debrief"} <= set(phases)
    if needed and list(phases) == [phase for phase in PHASES if phase in phases]:
        steps = course(paper_forms(), settings(phases))
        kept = [step.phase for step in steps if step.phase in phases]
        assert kept == [phase for phase in phases if phase != "rounds"]
    else:
        with pytest.raises(ValueError, match="phases must have"):
            settings(phases)


@given(
    st.sampled_from([("mission", "label"), ("label", "memorise", "mission", "forms"),
                     ("memorise", "mission", "forms", "label"), ("mission",)]),
    st.floats(0, 1, exclude_max=True),
)  # fmt: skip
def test_a_session_continues_at_the_next_step_of_any_order(
    parts: tuple[RoundPhase, ...], share: float
) -> None:
    now = settings(parts=parts)
    steps = course(paper_forms(), now)
    done = int(share * len(steps))
    point = next_point(history_of(passed(steps[:done])), now, steps)
    assert (point.step, point.settle) == (steps[done], ())


@pytest.mark.parametrize(
    "parts", [("memorise", "mission", "forms", "label"), ("label", "memorise", "mission")]
)
def test_a_session_in_another_order_is_conducted_and_resumed(
    parts: tuple[str, ...], tmp_path: Path
) -> None:
    listed = ", ".join(f'"{part}"' for part in parts)
    study = with_settings(
        tmp_path / "study", round_phases=f"[{listed}]", phases='["consent", "rounds", "debrief"]'
    )
    assert take_part(study)[0] == "over"
    entries = journal_of(study).entries
    whole = [
        Step(it.envelope.phase, it.envelope.round)
        for it in entries
        if isinstance(it.record, PhaseEnded)
    ]
    assert whole == list(study.course)
    lines = (study.home(P01) / "journal.jsonl").read_bytes().splitlines(keepends=True)
    cut = Step("mission", 2)
    at = next(
        number
        for number, it in enumerate(entries)
        if isinstance(it.record, PhaseStarted) and Step(it.envelope.phase, it.envelope.round) == cut
    )
    again = Path(shutil.copytree(study.folder, tmp_path / "again"))
    ledger = again / "ledger.jsonl"
    ledger.write_bytes(ledger.read_bytes().rpartition(b'{"type":"session_ended"')[0])
    resumed = open_study(again)
    (resumed.home(P01) / "journal.jsonl").write_bytes(b"".join(lines[: at + 1]))
    assert take_part(resumed)[0] == "over"
    assert journal_of(resumed).entries[-1].record == SessionEnded("finished")
    assert read_history(journal_of(resumed)).endings[cut] == "interrupted"
    assert set(read_history(journal_of(resumed)).endings) == set(study.course)

"""Verification: every journal reproduces, and no change to one goes unnoticed."""

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.journal.reader import Difference
from game.journal.writer import Journal
from game.session.verification import Verification, verify_files, verify_transcript
from game.world.events import Action
from game.world.settings import MissionSettings
from tests.session.toy import COMPASS, SETTINGS, TURN, played, toy, transcript, write

MISSION = played()
LINES = MISSION.splitlines(keepends=True)
TYPES = [json.loads(line)["type"] for line in LINES]


def verified(data: bytes) -> Verification:
    return verify_transcript(transcript(data), build=toy)


def edited(line: int, **fields: Any) -> bytes:
    lines = list(LINES)
    lines[line - 1] = json.dumps(json.loads(lines[line - 1]) | fields).encode() + b"\n"
    return b"".join(lines)


def renumbered(lines: list[bytes]) -> bytes:
    """Lines whose `seq` a forger has patched."""
    return b"".join(
        json.dumps(json.loads(line) | {"seq": seq}).encode() + b"\n"
        for seq, line in enumerate(lines)
    )


def line_of(kind: str) -> int:
    return TYPES.index(kind) + 1


def test_the_mission_of_these_tests_has_every_kind_of_event() -> None:
    assert {
        "acted",
        "treatment_started",
        "treatment_broken",
        "rescued",
        "expired",
        "mission_ended",
        "goal_set",
        "instruction_issued",
        "posterior_evaluated",
        "level_changed",
    } <= set(TYPES)


def keys(actions: tuple[Action, ...]) -> st.SearchStrategy[list[tuple[int, Action]]]:
    return st.lists(st.tuples(st.integers(0, 1_500), st.sampled_from(actions)), max_size=40)


@given(pressed=keys(COMPASS), until_ms=st.none() | st.integers(0, 20_000))
def test_what_was_played_is_reproduced(
    pressed: list[tuple[int, Action]], until_ms: int | None
) -> None:
    outcome = verified(played(pressed, until_ms=until_ms))
    assert outcome.difference is None
    assert outcome.missions == 1


@given(pressed=keys(TURN))
def test_play_under_turn_controls_is_reproduced(pressed: list[tuple[int, Action]]) -> None:
    settings = MissionSettings(duration_ms=15_000, red_expiry_ms=9_000, controls="turn")
    assert verified(played(pressed, settings)).reproduced


@pytest.mark.parametrize("lines", range(2, len(LINES)))
def test_a_mission_cut_at_any_line_still_verifies(lines: int) -> None:
    assert verified(b"".join(LINES[:lines])).reproduced


@pytest.mark.parametrize(
    ("kind", "fields", "field"),
    [
        ("acted", {"outcome": "bumped"}, "acted.outcome"),
        ("acted", {"position": [1, 1]}, "acted.position.0"),
        ("rescued", {"victim": "v03"}, "rescued.victim"),
        ("rescued", {"at_ms": 3_301}, "rescued.at_ms"),
        ("treatment_started", {"due_ms": 1}, "treatment_started.due_ms"),
        ("mission_ended", {"rescued": 9}, "mission_ended.rescued"),
        ("goal_set", {"route": ["v02"]}, "goal_set.route"),
        ("instruction_issued", {"text": "Fly."}, "instruction_issued.text"),
        ("posterior_evaluated", {"posterior": {"v01": 0.4}}, "posterior_evaluated.posterior.v01"),
        ("posterior_evaluated", {"posterior": {"v02": 0.4}}, "posterior_evaluated.posterior.v02"),
        ("posterior_evaluated", {"comprehension": 0.34}, "posterior_evaluated.comprehension"),
        ("level_changed", {"after": 1}, "level_changed.after"),
        ("mission_started", {"rules_version": 0}, "rules_version"),
        ("mission_started", {"building_sha256": "0" * 64}, "building_sha256"),
    ],
)
def test_a_changed_field_is_named(kind: str, fields: dict[str, Any], field: str) -> None:
    difference = verified(edited(line_of(kind), **fields)).difference
    assert difference is not None
    assert (difference.line, difference.field) == (line_of(kind), field)


def test_reals_may_differ_in_their_last_bits() -> None:
    line = line_of("posterior_evaluated")
    share = json.loads(LINES[line - 1])["comprehension"]
    assert verified(edited(line, comprehension=share + 1e-12)).reproduced
    assert not verified(edited(line, comprehension=share + 1e-8)).reproduced


@pytest.mark.parametrize("line", range(3, len(LINES)))
def test_a_removed_line_is_noticed_even_if_the_rest_is_renumbered(line: int) -> None:
    rest = LINES[: line - 1] + LINES[line:]
    assert verified(b"".join(rest)).difference == Difference(line, "seq", line, line - 1)
    assert TYPES[line - 1] == "acted" or not verified(renumbered(rest)).reproduced


def test_an_added_line_is_noticed() -> None:
    ended = line_of("mission_ended")
    late = verified(renumbered([*LINES[:ended], LINES[ended - 2], *LINES[ended:]])).difference
    assert late == Difference(ended + 1, "type", TYPES[ended - 2], "nothing")
    early = verified(renumbered([LINES[0], LINES[4], *LINES[1:]])).difference
    assert early is not None
    assert (early.line, early.expected) == (2, "nothing")


def test_a_record_of_another_kind_is_named_by_its_kind() -> None:
    rescued, expired = line_of("rescued"), line_of("expired")
    lines = list(LINES)
    lines[rescued - 1] = LINES[expired - 1]
    difference = verified(renumbered(lines)).difference
    assert difference == Difference(rescued, "type", "expired", "rescued")


def test_an_impossible_action_is_named() -> None:
    line = line_of("acted")
    forward = verified(edited(line, action="forward")).difference
    assert forward is not None
    assert (forward.line, forward.field) == (line, "acted")
    second = TYPES.index("acted", line) + 1
    back_in_time = verified(edited(second, at_ms=1)).difference
    assert back_in_time is not None
    assert back_in_time.line <= second


def test_a_spoilt_building_is_named() -> None:
    text = json.loads(LINES[1])["building_text"].replace(">", ".")
    difference = verified(edited(2, building_text=text)).difference
    assert difference is not None
    assert difference.line == 2


def test_an_abandoned_mission_must_be_complete_up_to_its_end() -> None:
    left = played(until_ms=9_000).splitlines(keepends=True)
    kinds = [json.loads(line)["type"] for line in left]
    place = kinds.index("mission_abandoned")
    assert verified(renumbered(left)).reproduced
    missing = renumbered(left[: place - 1] + left[place:])
    difference = verified(missing).difference
    assert difference is not None
    assert difference.recorded == "nothing"


def test_a_cut_mission_is_verified_though_the_session_went_on(tmp_path: Path) -> None:
    path = write(tmp_path, b"".join(LINES[:9]) + LINES[9][:30])
    journal = Journal.resume(path, None)
    journal.close()
    outcome = verify_transcript(transcript(path.read_bytes()), build=toy)
    assert (outcome.reproduced, outcome.missions, outcome.records) == (True, 1, 7)


def test_the_command_reports_on_each_file(tmp_path: Path) -> None:
    folders = [tmp_path / name for name in ("good", "torn", "bad", "none")]
    for folder in folders:
        folder.mkdir()
    good = write(folders[0], MISSION)
    torn = write(folders[1], MISSION[:-10])
    bad = write(folders[2], edited(line_of("rescued"), victim="v03"))
    none = write(folders[3], b"# Notes\n")
    said: list[str] = []

    def status(*paths: Path) -> int:
        said.clear()
        return verify_files(paths, said.append, build=toy)

    assert status(good) == 0
    assert said == [f"{good}: 1 mission, {len(LINES) - 3} records reproduced"]
    assert status(good, torn) == 0
    torn_bytes = len(LINES[-1]) - 10
    assert said[1].endswith(f"(an unfinished last line of {torn_bytes} bytes is ignored)")
    assert status(bad, good) == 1
    line = line_of("rescued")
    assert said[0] == f"{bad}: differs: line {line}: rescued.victim is v03, but should be v02"
    assert status(none) == 2
    assert status(bad, none, good) == 2
    assert len(said) == 3
    assert status(tmp_path / "missing.jsonl") == 2


def test_settings_are_the_missions_and_not_todays() -> None:
    slow = MissionSettings(duration_ms=30_000, red_expiry_ms=29_000, treat_blue_ms=9_000)
    assert slow != SETTINGS
    assert verified(played(settings=slow)).reproduced


@pytest.mark.parametrize(("rules", "release"), [(1, "before 0.1.0"), (2, "0.1.0"), (99, "another")])
def test_the_release_that_verifies_other_rules_is_named(rules: int, release: str) -> None:
    line = line_of("mission_started")
    verification = verified(edited(line, rules_version=rules))
    difference = verification.difference
    assert difference is not None
    assert (difference.line, difference.field) == (line, "rules_version")
    assert release in str(difference)

"""`yoked` repeats the levels of somebody else's mission."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from game.cli import main
from game.coach.acts import InstructionIssued, Level
from game.coach.spec import CoachSpec, parse_coach
from game.coach.yoke import LevelFrom, Yoke
from game.commands.ana_play import options_of
from game.errors import AnaError
from game.journal.reader import read_journal
from game.rescuers.catalogue import character
from game.rescuers.driver import drive
from game.session.playing import end_free_play, start_in_memory
from game.session.verification import verify
from game.session.yoking import yoke_of
from game.world import load_building
from game.world.settings import MissionSettings

HARBOUR, RULES = load_building("harbour"), MissionSettings(duration_ms=90_000)


def journal_of(path: Path, spec: CoachSpec, who: str, *, ended: bool = True) -> Path:
    run, journal = start_in_memory(HARBOUR, RULES, spec, 4, rescuer=who, path=path)
    drive(run, character(who).make(HARBOUR, RULES, 4), done=lambda: not ended)
    end_free_play(run, journal, run.mission.time_ms)
    return path


def test_the_levels_are_repeated_at_their_times_whoever_walks(tmp_path: Path) -> None:
    source = journal_of(tmp_path / "source.jsonl", parse_coach("ana", preset="literal"), "stranger")
    yoke = yoke_of(source, HARBOUR)
    assert len(yoke.levels) > 1
    spec = parse_coach("yoked", yoke=yoke)
    assert msgspec.json.decode(msgspec.json.encode(spec), type=CoachSpec) == spec
    path = journal_of(tmp_path / "yoked.jsonl", spec, "literal")
    issued = [e.record for e in read_journal(path).entries]
    told = [record for record in issued if isinstance(record, InstructionIssued)]
    assert [record.level for record in told] == [yoke.level_at(record.at_ms) for record in told]
    assert len({record.level for record in told}) > 1
    assert verify(path).reproduced


def test_the_level_at_a_time_is_the_last_that_began() -> None:
    yoke = Yoke("s", "h", None, (LevelFrom(0, Level.C3), LevelFrom(500, Level.C1)))
    assert [yoke.level_at(ms) for ms in (0, 499, 500, 9_000)] == [3, 3, 1, 1]


def test_another_building_is_refused(tmp_path: Path) -> None:
    source = journal_of(tmp_path / "source.jsonl", parse_coach("static", 1), "literal")
    with pytest.raises(AnaError, match="Give --building for Harbour House"):
        yoke_of(source, load_building("foundry"))
    spec = parse_coach("yoked", yoke=yoke_of(source, HARBOUR))
    with pytest.raises(AnaError, match="another building"):
        start_in_memory(load_building("foundry"), RULES, spec, 1, rescuer="literal")


def test_a_mission_that_was_left_has_no_levels_to_repeat(tmp_path: Path) -> None:
    source = journal_of(tmp_path / "source.jsonl", parse_coach("static", 1), "literal", ended=False)
    with pytest.raises(AnaError, match="no mission in Harbour House was finished"):
        yoke_of(source, HARBOUR)


def test_the_command_line_takes_a_journal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = journal_of(tmp_path / "source.jsonl", parse_coach("static", 1), "literal")
    given = {"building": "harbour", "coach": "yoked", "preset": None, "level": None}
    rest = {"seed": 1, "log": tmp_path, "minutes": None, "assignments": ()}
    options = options_of(**given, levels_of=source, **rest)  # type: ignore[arg-type]
    assert options.spec.yoke == yoke_of(source, HARBOUR)
    assert main(["play", "--coach", "yoked"]) == 2
    assert "--levels-of" in capsys.readouterr().err
    assert main(["play", "--coach", "knowledge+quiz"]) == 2
    assert "plays in studies alone" in capsys.readouterr().err

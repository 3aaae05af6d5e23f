"""The options of `ana play` and `ana watch`: each mistake is reported with a hint."""

from __future__ import annotations

import os
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path

import pytest

from game.cli import main
from game.coach.spec import parse_coach
from game.commands.ana_play import assigned, last_journal, only_journal, options_of
from game.errors import AnaError
from game.journal.folders import JOURNAL
from game.session.playing import end_free_play, start_in_memory
from game.world import load_building
from game.world.placing import placed_anew
from game.world.settings import MissionSettings
from game.world.variant import Variant, day_seed

GIVEN = {
    "building": "harbour",
    "coach": "ana",
    "preset": None,
    "level": None,
    "seed": 7,
    "log": None,
    "minutes": None,
    "assignments": (),
}


def test_the_options_define_the_mission() -> None:
    given = {**GIVEN, "coach": "static", "level": 3, "minutes": 1.5, "log": Path("here")}
    options = options_of(**given)  # type: ignore[arg-type]
    assert options.building.name == "Harbour House"
    assert options.spec.level == 3
    assert options.settings.duration_ms == 90_000
    assert (options.seed, options.log_dir) == (7, Path("here"))


def test_the_controls_are_an_option() -> None:
    for controls in ("compass", "turn"):
        options = options_of(**{**GIVEN, "controls": controls})  # type: ignore[arg-type]
        assert options.settings.controls == controls
    usual = options_of(**{**GIVEN, "assignments": ("controls=turn",)})  # type: ignore[arg-type]
    assert usual.settings.controls == "turn"


def test_a_difficulty_is_a_set_of_settings_that_others_override() -> None:
    options = options_of(**{**GIVEN, "difficulty": "hard", "minutes": 1})  # type: ignore[arg-type]
    assert (options.settings.sight_radius, options.settings.duration_ms) == (4, 60_000)
    assert len(options.building.victims) == 25
    assert options.variant == Variant(difficulty="hard")


def test_seeded_victims_move_with_the_seed() -> None:
    options = options_of(**{**GIVEN, "victims": "seeded"})  # type: ignore[arg-type]
    assert options.building == placed_anew(load_building("harbour"), 7)
    following = options.again()
    assert (following.seed, following.variant) == (8, options.variant)
    assert following.building == placed_anew(load_building("harbour"), 8)


def test_the_mission_of_the_day_comes_from_the_date() -> None:
    now = datetime(2026, 11, 26, 1, 30, tzinfo=timezone(timedelta(hours=5)))
    assert day_seed(now) == 20261125, "by Greenwich, so that it is one day for everybody"
    day = {**GIVEN, "building": None, "seed": None, "today": True}
    options = options_of(**day)  # type: ignore[arg-type]
    assert options.seed == day_seed(datetime.now(UTC))
    assert options.building == load_building(f"generated:{options.seed}")
    drawn = options_of(**{**day, "building": "foundry"})  # type: ignore[arg-type]
    assert drawn.variant.victims == "seeded"
    assert drawn.building == placed_anew(load_building("foundry"), options.seed)


def test_any_setting_can_be_set() -> None:
    wanted = ["moves_per_second=20", "controls=turn", "show_score=false", "treat_red_ms=4000"]
    settings = assigned(MissionSettings(), wanted)
    assert settings == MissionSettings(
        moves_per_second=20, controls="turn", show_score=False, treat_red_ms=4000
    )


@pytest.mark.parametrize(
    ("assignment", "told"),
    [
        ("moves_per_second", "not KEY=VALUE"),
        ("move_per_second=3", "Did you mean moves_per_second"),
        ("speed=3", "Choose from duration_ms"),
        ("moves_per_second=fast", "must be a number from 0.5 to 100, not 'fast'"),
        ("moves_per_second=0", "from 0.5 to 100, not '0'"),
        ("controls=mouse", "compass or turn"),
    ],
)
def test_a_bad_setting_is_named(assignment: str, told: str) -> None:
    with pytest.raises(AnaError, match=told):
        assigned(MissionSettings(), [assignment])


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--building", "harbor"], "Did you mean harbour?"),
        (["--coach", "anna"], "Did you mean ana?"),
        (["--coach", "static", "--level", "4"], "Give 1, 2 or 3"),
        (["--preset", "litteral"], "Did you mean literal?"),
        (["--level", "1"], "--coach static"),
        (["--today", "--seed", "3"], "--today: the seed of the mission of the day is the date"),
        (["--difficulty", "harsh"], "easy"),
        (["--minutes", "0"], "--minutes: a mission lasts from a second to 60 minutes, not 0"),
        (["--minutes", "nan"], "--minutes: a mission lasts"),
        (["--set", "duration_ms=1.5"], "must be a whole number from 1000 to 3600000, not '1.5'"),
        (["--set", "show_score=maybe"], "must be true or false, not 'maybe'"),
        (["--minuts", "1"], "--minutes"),
        ([], "not a terminal"),
    ],
)
def test_a_mistake_ends_with_status_2(
    arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["play", *arguments]) == 2
    assert told in capsys.readouterr().err


def test_a_rescuer_is_chosen_by_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["watch", "--rescuer", "newcommer"]) == 2
    assert "Did you mean newcomer?" in capsys.readouterr().err


class TestReplayOfAFolder:
    def session(self, folder: Path) -> Path:
        run, journal = start_in_memory(
            load_building("practice"), MissionSettings(), parse_coach("static", 1), 1,
            rescuer="literal", path=folder / JOURNAL,
        )  # fmt: skip
        end_free_play(run, journal, 0)
        return folder / JOURNAL

    def test_is_that_of_its_session(self, tmp_path: Path) -> None:
        journal = self.session(tmp_path / "only")
        assert only_journal(tmp_path / "only") == only_journal(tmp_path) == journal

    def test_with_several_sessions_is_refused(self, tmp_path: Path) -> None:
        self.session(tmp_path / "one")
        self.session(tmp_path / "two")
        with pytest.raises(AnaError, match=r"2 sessions in this folder.*the newest is"):
            only_journal(tmp_path)

    def test_without_a_session_is_refused(
        self, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        assert main(["replay", str(tmp_path)]) == 2
        assert "there is no journal in this folder" in capsys.readouterr().err


def test_replay_alone_takes_the_last_mission(tmp_path: Path) -> None:
    with pytest.raises(AnaError, match="no mission to replay yet"):
        last_journal(tmp_path)
    for number in (2, 1):
        journal = tmp_path / f"mission-{number}" / "journal.jsonl"
        journal.parent.mkdir()
        journal.touch()
        os.utime(journal, (number, number))
    assert last_journal(tmp_path).parent.name == "mission-2"

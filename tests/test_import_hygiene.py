"""Nothing heavy is imported on the way to the game, and the house lists only what it can open."""

import json
import subprocess
import sys

import click
import pytest

from game.cli import ana
from game.lazy import LazyCommand

HEAVY = ("matplotlib", "numpy", "pandas", "pingouin", "scipy", "statsmodels", "tcod")
ON_THE_WAY_TO_PLAY = ("game.cli", "game.commands.ana_play", "game.screens.play.mission_screen")
LATER = ("game.rescuers", "game.study", "game.screens.play.result", "game.session.replay")
"""What a mission does not need for its first picture."""
BEHIND_THE_OPENING = (
    "game.coach.kinds.ana",
    "game.screens.play.mission_screen",
    "game.journal.writer",
)
"""What the line that opens the game does not wait for."""
LAZY = [command for command in ana.commands.values() if isinstance(command, LazyCommand)]


def modules_after(*imports: str) -> set[str]:
    program = f"import json, sys, {', '.join(imports)}; print(json.dumps(list(sys.modules)))"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, check=True)
    return set(json.loads(run.stdout))


def test_the_way_to_play_imports_nothing_heavy() -> None:
    loaded = modules_after(*ON_THE_WAY_TO_PLAY)
    assert set(ON_THE_WAY_TO_PLAY) <= loaded
    assert not loaded.intersection(HEAVY)
    assert not loaded.intersection(LATER)


def test_the_first_paint_waits_for_no_mission() -> None:
    opening, mission = modules_after("game.commands.ana_play"), modules_after(*ON_THE_WAY_TO_PLAY)
    assert not opening.intersection(BEHIND_THE_OPENING)
    assert not mission.isdisjoint(BEHIND_THE_OPENING)


def test_the_frame_imports_no_room() -> None:
    assert {name for name in modules_after("game.cli") if name.startswith("game.")} == {
        "game.cli",
        "game.errors",
        "game.lazy",
    }


def test_every_heavy_name_would_be_noticed() -> None:
    assert "numpy" in modules_after("game.cli", "numpy")


@pytest.mark.parametrize("stub", LAZY, ids=lambda stub: str(stub.name))
def test_every_listed_command_can_be_loaded(stub: LazyCommand) -> None:
    command = stub.load()
    assert isinstance(command, click.Command)
    assert command.name == stub.name
    assert command.help

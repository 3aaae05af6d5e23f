"""The `ana` command: where each subcommand lives, and how every run ends."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

from game import __version__
from game.errors import AnaError
from game.lazy import LazyCommand, LazyGroup

if TYPE_CHECKING:
    from game.journal.records import StudyMode

OBJECTS_BETWEEN_COLLECTIONS = 10_000
"""Importing makes many objects and no garbage; looking for it after every 700 of them would take a
fifteenth of the start-up time."""

STATUS_BAD_INPUT = 2
STATUS_INTERRUPTED = 130


_PLAY, _STUDY, _MACHINE = "Play", "Study", "This computer"


@click.group(
    cls=LazyGroup,
    commands=[
        LazyCommand("play", "game.commands.ana_play:play", "Play a mission now.", _PLAY),
        LazyCommand("serve", "game.commands.ana_serve:serve_play", "Play in a browser.", _PLAY),
        LazyCommand(
            "watch", "game.commands.ana_watch:watch", "Watch a simulated rescuer play.", _PLAY
        ),
        LazyCommand(
            "replay",
            "game.commands.ana_play:replay_journal",
            "Replay a mission with the coach's reasoning.",
            _PLAY,
        ),
        LazyCommand(
            "building",
            "game.commands.ana_building:building_group",
            "Check a building file, or show one.",
            _PLAY,
        ),
        LazyCommand(
            "study",
            "game.commands.ana_study:study_group",
            "Set up and run the experiment.",
            _STUDY,
        ),
        LazyCommand(
            "simulate",
            "game.commands.ana_simulate:simulate_command",
            "Simulate a whole study.",
            _STUDY,
        ),
        LazyCommand(
            "analyse",
            "analysis.command:command",
            "Compute every statistic of a study.",
            _STUDY,
        ),
        LazyCommand(
            "compare",
            "analysis.compare:command",
            "Compare coaches on the same simulated people.",
            _STUDY,
        ),
        LazyCommand(
            "verify",
            "game.commands.ana_verify:verify_command",
            "Check that journals replay exactly.",
            _STUDY,
        ),
        LazyCommand(
            "doctor",
            "game.commands.ana_doctor:doctor_command",
            "Check that this terminal can play.",
            _MACHINE,
        ),
        LazyCommand(
            "completion",
            "game.commands.ana_completion:completion_command",
            "Print a shell's completion script.",
            _MACHINE,
        ),
    ],
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)
@click.version_option(__version__, prog_name="ana", message="%(prog)s %(version)s")
@click.pass_context
def ana(ctx: click.Context) -> int | None:
    """A guided rescue mission with a coach that adapts to you, and the experiment around it.

    Without a command the game opens.
    """
    if ctx.invoked_subcommand is not None:
        return None
    from game.screens.play.app import run_home

    return run_home()


def main(args: Sequence[str] | None = None) -> int:
    """Run `ana` with `args` (default: the process's own) and return the exit status.

    Anything the user can fix is reported in one form on the error stream, with status 2; an
    interrupt gives 130; a reader that closes the pipe ends the process quietly with 1.
    """
    gc.set_threshold(OBJECTS_BETWEEN_COLLECTIONS)
    try:
        status = cast(
            "int | None",
            ana.main(args, prog_name="ana", standalone_mode=False, obj=_GameSide()),
        )
    except click.UsageError as error:
        return _refuse(error.format_message(), hint=_help_hint(error.ctx))
    except click.ClickException as error:
        return _refuse(error.format_message())
    except AnaError as error:
        return _refuse(str(error))
    except (click.Abort, KeyboardInterrupt):
        return STATUS_INTERRUPTED
    return status or 0


class _GameSide:
    """What the analysis, which knows neither studies nor simulated people, asks of the game."""

    def refuse_unlike_ledger(self, folder: Path, mode: StudyMode) -> None:
        """Raise JournalError where the sessions of a study folder are not those of its ledger."""
        from game.study.lab.sessions import refuse_unlike_ledger

        refuse_unlike_ledger(folder, mode)

    def unblind(self, folder: Path) -> str:
        """Record in a study folder that its allocation was looked at; what to tell of that."""
        from game.commands.ana_study import record_analysis

        return record_analysis(folder)

    def trials(self, tick: Callable[[int, int], None], **asked: Any) -> Iterator[dict[str, Any]]:
        """Play a comparison, as `game.simulation.comparison.trials` does."""
        from game.simulation.comparison import asked_trials

        return asked_trials(tick, **asked)


def _refuse(problem: str, hint: str = "") -> int:
    click.echo(f"ana: {problem}{hint}", err=True)
    return STATUS_BAD_INPUT


def _help_hint(ctx: click.Context | None) -> str:
    return f"\nTry '{ctx.command_path} --help'." if ctx else ""

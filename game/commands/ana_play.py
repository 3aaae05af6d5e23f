"""`ana play` and `ana replay`."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Literal, TypeVar, get_args, get_origin, get_type_hints

import click
import msgspec

from game.coach.presets import PRESETS
from game.coach.spec import DEFAULT_PRESET, parse_coach
from game.commands.offered import buildings, coaches, levels, offering, presets
from game.commands.offered import settings as settings_offered
from game.errors import AnaError, choose_from
from game.journal.folders import JOURNAL, all_journals, newest_journals
from game.places import sessions_folder
from game.screens.play.app import run_play, run_replay
from game.screens.play.options import PlayOptions
from game.session.yoking import yoke_of
from game.world import load_building
from game.world.library import GENERATED, shipped_buildings
from game.world.settings import FREE_PLAY, RANGES, Controls, MissionSettings
from game.world.variant import Difficulty, Variant, Victims, day_seed, varied, with_demands

DEFAULT_BUILDING = "harbour"
MINUTE_MS = 60_000
SHORTEST_MINUTES, LONGEST_MINUTES = 1 / 60, 60

_Command = TypeVar("_Command", bound=Callable[..., Any])


def mission_options(command: _Command) -> _Command:
    """The options that define the mission."""
    options = (
        click.option(
            "--building",
            shell_complete=offering(buildings, files=True),
            metavar="NAME|PATH",
            help=f"{', '.join(shipped_buildings())}, {GENERATED}:SEED for one made from a seed, or "
            f"the path of your own file.  [default: {DEFAULT_BUILDING}]",
        ),
        click.option(
            "--victims",
            type=click.Choice(get_args(Victims)),
            help="Where the victims are: in their usual places, as drawn in the building's file, "
            "or where the seed puts them.  [default: drawn]",
        ),
        click.option(
            "--difficulty",
            type=click.Choice(get_args(Difficulty)),
            default="standard",
            show_default=True,
            help="How many victims there are, how long the mission lasts (unless --minutes says "
            "so), and how far you see.",
        ),
        click.option(
            "--today",
            is_flag=True,
            help="The mission of the day, the same for everybody: today's office or, with "
            "--building, that building with today's places for the victims.",
        ),
        click.option(
            "--coach",
            shell_complete=offering(coaches, files=True),
            default="ana",
            show_default=True,
            metavar="KIND|FILE.py:CLASS",
            help="ana and knowledge choose how simple their words are; static and pace do not; "
            "yoked speaks as the coach did in the mission of --levels-of; FILE.py:CLASS is "
            "one of your own.",
        ),
        click.option(
            "--preset",
            shell_complete=offering(presets),
            metavar="NAME",
            help=f"The rule by which ana adapts: {', '.join(PRESETS)}. docs/coaches.md tells them "
            f"apart.  [default: {DEFAULT_PRESET}]",
        ),
        click.option(
            "--level",
            type=int,
            shell_complete=offering(levels),
            metavar="1|2|3",
            help="How a static coach speaks: step by step (1), by doors and hallways (2), or by "
            "room names (3).",
        ),
        click.option(
            "--levels-of",
            type=click.Path(path_type=Path, dir_okay=False),
            metavar="JOURNAL",
            help="The mission whose levels a yoked coach repeats, at the same times.",
        ),
        click.option(
            "--seed",
            type=int,
            help="Seed for random choices; recorded in the journal.  [default: random]",
        ),
        click.option(
            "--log",
            type=click.Path(path_type=Path, file_okay=False),
            metavar="DIR",
            help="The folder for journals, one a mission.  [default: data/sessions in ana's own "
            "folder, or your data folder where ana is installed]",
        ),
        click.option(
            "--controls",
            type=click.Choice(get_args(Controls)),
            help="What the arrows do: go in four directions (compass), or turn left and right and "
            "go ahead (turn).  [default: compass]",
        ),
        click.option(
            "--minutes", type=float, help="How long the mission lasts.  [default: by --difficulty]"
        ),
        click.option(
            "--set",
            "assignments",
            shell_complete=offering(settings_offered),
            multiple=True,
            metavar="KEY=VALUE",
            help="A mission setting, for example moves_per_second=20; repeatable. A KEY that "
            "there is not is answered with all that there are.",
        ),
    )
    for option in reversed(options):
        command = option(command)
    return command


@click.command(name="play")
@mission_options
@click.option(
    "--now", is_flag=True, help="Start the clock at once, without the page before the mission."
)
@click.option(
    "--memorise",
    type=click.IntRange(0, 3600),
    default=0,
    metavar="SECONDS",
    help="First show the map, with the rooms' names, for so many seconds.",
)
@click.option(
    "--text",
    is_flag=True,
    help="Play by typing lines and reading sentences, as with a screen reader; needs no screen.",
)
def play(now: bool, text: bool, memorise: int, **given: Any) -> int:
    """Play a mission now."""
    options = replace(options_of(**given), now=now, memorise_ms=1000 * memorise)
    return play_in_text(options) if text else run_play(options)


@click.command(name="replay")
@click.argument("journal", type=click.Path(path_type=Path), required=False)
def replay_journal(journal: Path | None) -> int:
    """Replay the mission in JOURNAL, showing what the coach believed at each moment.

    Instead of a journal you can give the folder of its session. Without either, your last mission
    is replayed.
    """
    if journal is None:
        return run_replay(last_journal(sessions_folder()))
    return run_replay(only_journal(journal) if journal.is_dir() else journal)


def last_journal(folder: Path) -> Path:
    """The newest journal of free play in a folder. Raises AnaError where there is none."""
    found = newest_journals(folder)
    if not found:
        raise AnaError(
            "there is no mission to replay yet",
            place=str(folder),
            hint="Play one with `ana play`, or give the journal of another.",
        )
    return found[0]


def only_journal(folder: Path) -> Path:
    """The journal of the session in a folder. Raises AnaError where there is none, or several."""
    found = (*folder.glob(JOURNAL), *folder.glob(f"*/{JOURNAL}")) or all_journals(folder)
    if len(found) == 1:
        return found[0]
    newest = max(found, key=lambda path: path.stat().st_mtime)
    raise AnaError(
        f"there are {len(found)} sessions in this folder",
        place=str(folder),
        hint=f"Give one of them; the newest is {newest.parent}",
    )


def play_in_text(options: PlayOptions) -> int:
    """Play a mission by the lines of the standard input."""
    from game.screens.text.text_play import play_text, typed_lines

    return play_text(
        options.building,
        options.settings,
        options.spec,
        options.seed,
        options.log_dir,
        typed_lines(),
        sys.stdout,
        memorise_ms=options.memorise_ms,
        variant=options.variant,
        about=options.about,
    )


def options_of(
    building: str | None,
    coach: str,
    preset: str | None,
    level: int | None,
    seed: int | None,
    log: Path | None,
    minutes: float | None,
    assignments: tuple[str, ...],
    levels_of: Path | None = None,
    victims: Victims | None = None,
    difficulty: Difficulty = "standard",
    today: bool = False,
    controls: Controls | None = None,
) -> PlayOptions:
    """The mission defined by `mission_options`. Raises AnaError, naming the option."""
    settings = assigned(with_demands(FREE_PLAY, difficulty), assignments)
    if controls is not None:
        settings = replace(settings, controls=controls)
    if minutes is not None:
        if not SHORTEST_MINUTES <= minutes <= LONGEST_MINUTES:
            raise AnaError(
                f"a mission lasts from a second to {LONGEST_MINUTES} minutes, not {minutes:g}",
                place="--minutes",
                hint="Give minutes, as in --minutes 2.5",
            )
        settings = replace(settings, duration_ms=round(minutes * MINUTE_MS))
    if today and seed is not None:
        raise AnaError(
            "the seed of the mission of the day is the date",
            place="--today",
            hint="Leave out --seed, or leave out --today.",
        )
    if today:
        seed = day_seed(datetime.now(UTC))
        victims = victims or ("drawn" if building is None else "seeded")
        building = building or f"{GENERATED}:{seed}"
    elif seed is None:
        seed = int.from_bytes(os.urandom(4))
    drawn = load_building(building or DEFAULT_BUILDING, seed)
    variant = Variant(victims or "drawn", difficulty)
    plan = varied(drawn, variant, seed)
    yoke = None if levels_of is None else yoke_of(levels_of, plan)
    return PlayOptions(
        building=plan,
        spec=parse_coach(coach, level, preset, yoke=yoke),
        settings=settings,
        seed=seed,
        log_dir=log or sessions_folder(),
        variant=variant,
        drawn=drawn,
        onward="same" if today else "seed",
    )


def assigned(settings: MissionSettings, assignments: Iterable[str]) -> MissionSettings:
    """The settings with each KEY=VALUE set. Raises AnaError, naming the wrong assignment."""
    kinds = get_type_hints(MissionSettings)
    for assignment in assignments:
        name, equals, value = assignment.partition("=")
        place = f"--set {assignment}"
        if not equals:
            raise AnaError("this is not KEY=VALUE", place=place)
        if name not in kinds:
            raise AnaError(
                f"there is no setting '{name}'", place=place, hint=choose_from(name, kinds)
            )
        try:
            kind = str if get_origin(kinds[name]) is Literal else kinds[name]
            change: dict[str, Any] = {name: msgspec.convert(value, kind, strict=False)}
            settings = replace(settings, **change)
        except ValueError as error:
            raise AnaError(
                f"{name} must be {_what_fits(name, kinds[name])}, not '{value}'", place=place
            ) from error
    return settings


def _what_fits(name: str, kind: Any) -> str:
    """The values that a setting can have, in words."""
    if kind is bool:
        return "true or false"
    if get_origin(kind) is Literal:
        return " or ".join(get_args(kind))
    number = "a number" if kind is float else "a whole number"
    bounds = next(((low, high) for it, low, high in RANGES if it == name), None)
    return number if bounds is None else f"{number} from {bounds[0]} to {bounds[1]}"

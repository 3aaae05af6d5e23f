"""What a mission of free play is made from, and how that is chosen at home."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from random import randrange
from typing import TYPE_CHECKING, Literal

from game.screens.widgets.preferences import Preferences
from game.world import load_building
from game.world.building import Building
from game.world.library import GENERATED
from game.world.settings import FREE_PLAY, MissionSettings
from game.world.variant import USUAL, Difficulty, Variant, day_seed, varied, with_demands

if TYPE_CHECKING:
    from game.coach.spec import CoachSpec

NEW_SEEDS = 100_000
"""Seeds chosen at home are below this, so that they can be typed again."""


@dataclass(frozen=True)
class PlayOptions:
    """A mission of free play: where, by which rules, with which coach, kept in which folder; and
    who plays it where it is watched, by the name in `game.rescuers.catalogue`."""

    building: Building
    spec: CoachSpec
    settings: MissionSettings
    seed: int
    log_dir: Path
    rescuer: str = "literal"
    variant: Variant = USUAL
    drawn: Building | None = None
    """The building before the variant; None where they are the same."""
    memorise_ms: int = 0
    """For how long the map is shown first, to a person."""
    now: bool = False
    """Whether the clock starts at once, without the page before the mission."""
    onward: Literal["seed", "office", "same"] = "seed"
    """What changes from one mission to the next: the seed, with it the whole office, or nothing,
    as in the mission of the day."""

    @property
    def about(self) -> str:
        """What sets this mission apart, in a few words."""
        told = self.variant.of_seed(self.seed)
        if self.onward == "same":
            return ", ".join(filter(None, (f"Mission of the day {self.seed}", told)))
        if self.onward == "office" and self.variant.victims == "drawn":
            return ", ".join(filter(None, (f"Seed {self.seed}", told)))
        return told

    def again(self) -> PlayOptions:
        """The next mission: the next seed, and what follows from it; the map is known by now."""
        if self.onward == "same":
            return replace(self, memorise_ms=0, now=False)
        seed, drawn = self.seed + 1, self.drawn
        if self.onward == "office":
            drawn = load_building(f"{GENERATED}:{seed}")
        building = self.building if drawn is None else varied(drawn, self.variant, seed)
        return replace(self, seed=seed, building=building, drawn=drawn, memorise_ms=0, now=False)


def rules_of(
    difficulty: Difficulty, preferences: Preferences, given: PlayOptions | None
) -> MissionSettings:
    """The rules of a difficulty, those of the command line (`given`) where it is theirs, with the
    controls preferred."""
    if given is not None and given.variant.difficulty == difficulty:
        rules = given.settings
    else:
        rules = with_demands(FREE_PLAY, difficulty)
    return replace(rules, controls=preferences.controls)


def chosen_mission(
    chosen: Preferences, rules: MissionSettings, log_dir: Path, typed: str
) -> PlayOptions:
    """The mission chosen at home, by the seed that was typed or a new one."""
    seed = int(typed) if typed else randrange(1, NEW_SEEDS)
    name = f"{GENERATED}:{seed}" if chosen.building == GENERATED else chosen.building
    drawn = load_building(name, seed)
    variant = Variant(chosen.victims, chosen.difficulty)
    return PlayOptions(
        varied(drawn, variant, seed),
        _coach(chosen),
        rules,
        seed,
        log_dir,
        variant=variant,
        drawn=drawn,
        memorise_ms=1000 * chosen.memorise,
        onward="office" if chosen.building == GENERATED else "seed",
    )


def todays_mission(chosen: Preferences, rules: MissionSettings, log_dir: Path) -> PlayOptions:
    """The mission of the day, with the coach chosen at home."""
    seed = day_seed(datetime.now(UTC))
    building = load_building(f"{GENERATED}:{seed}")
    return PlayOptions(building, _coach(chosen), rules, seed, log_dir, onward="same")


def _coach(chosen: Preferences) -> CoachSpec:
    from game.screens.play.home import spec_of

    return spec_of(chosen.coach)

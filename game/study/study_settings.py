"""study.toml: every setting of a study, typed and checked when it is read."""

from __future__ import annotations

import re
import tomllib
from dataclasses import fields
from hashlib import sha256
from pathlib import Path
from typing import Literal, get_args

import msgspec

from game.coach.acts import Level
from game.coach.own import SEPARATOR
from game.coach.presets import PRESETS
from game.coach.registry import KINDS
from game.coach.spec import DEFAULT_PRESET
from game.errors import AnaError, choose_from, did_you_mean, disk_hint
from game.study.design import Design
from game.study.files import LEDGER, NEW_STUDY, NO_STUDY
from game.study.instructors import Instructor, instructor_named
from game.tables.designs import PRIMARY_CORRECTION, PRIMARY_OUTCOMES, Correction
from game.toml_words import (
    NOT_UTF8,
    SAVE_AS_UTF8,
    allowed,
    in_plain_words,
    listed,
    parted,
    refused,
)
from game.world.settings import MissionSettings

ADAPTIVE = "ana"
"""The usual adaptive instructor."""
_COACHES = tuple(name for name, kind in KINDS.items() if "yoke" not in kind.choices)
"""The coaches that a session can be led by; one that repeats levels would need a mission for each.
"""


class SettingsError(AnaError):
    """study.toml cannot be used as it is."""


def _within(name: str, value: int, low: int, high: int) -> None:
    if not low <= value <= high:
        raise ValueError(f"{name} must be between {low} and {high}, not {value}")


class _Section(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    pass


class ScreenSize(_Section, frozen=True):
    """The fixed size, in terminal cells, of the game view and the memorise map, and the look of the
    mission; a study made before there were looks has the first. Large `cells` of the office take
    4 x 2 of the terminal's, normal ones 2 x 1."""

    columns: int = 120
    rows: int = 40
    cells: Literal["normal", "large"] = "normal"
    look: Literal[1, 2] = 1

    def __post_init__(self) -> None:
        _within("screen.columns", self.columns, 80, 400)
        _within("screen.rows", self.rows, 24, 200)


class InterruptionRules(_Section, frozen=True):
    """What happens to a timed phase that was interrupted: continue with the remaining time, end it,
    or void the whole round."""

    memorise: Literal["continue", "void"] = "continue"
    label: Literal["continue", "void"] = "continue"
    mission: Literal["end", "void"] = "end"


class Primary(_Section, frozen=True):
    """The outcomes and the multiple-test correction chosen before any data are collected: victims,
    and whatever forms.toml asks after each mission."""

    outcomes: tuple[str, ...] = PRIMARY_OUTCOMES
    correction: Correction = PRIMARY_CORRECTION


class WebSettings(_Section, frozen=True):
    """Taking part in a browser: the address to go to at the end, in which `{code}` stands for the
    completion code (empty: none); the name under which a panel's links carry its ID (empty: no
    such links); and whether a pseudonym made from that ID is recorded in its place."""

    return_url: str = ""
    panel_id: str = "PROLIFIC_PID"
    hash_ids: bool = True

    def __post_init__(self) -> None:
        address = self.return_url.replace("{code}", "")
        if address and not re.fullmatch(r"https?://[^/\s{}][^\s{}]*", address):
            raise ValueError(
                "web.return_url must be an address that begins with https://, in which {code} "
                "stands for the completion code"
            )
        if self.panel_id and not re.fullmatch(r"[A-Za-z][A-Za-z0-9_-]*", self.panel_id):
            raise ValueError("web.panel_id must be a name of letters, digits, _ and -")


StudyPhase = Literal["preflight", "consent", "practice", "rounds", "preference", "debrief"]
RoundPhase = Literal["memorise", "label", "mission", "forms"]
PAPER_ROUND: tuple[RoundPhase, ...] = ("memorise", "label", "mission")
"""The parts of a round of the paper's; the forms after each mission follow."""
MOST_ROUNDS = 6


class StudySettings(_Section, frozen=True):
    """All settings of a study. Raises ValueError, naming the setting, if one is out of range.

    `instructors` are the two whose missions are compared, `coach` and `preset` the second of them
    where it is not given. `places` are all that there are to give, `blocks` how often each design
    cell is to be filled where `places` is not given.
    """

    name: str
    seed: int
    buildings: tuple[str, ...]
    practice_building: str
    blocks: int = 1
    places: int | None = None
    coach: str = ADAPTIVE
    preset: str = DEFAULT_PRESET
    instructors: tuple[str, str] | None = None
    static_levels: tuple[int, ...] = (1, 2, 3)
    rounds: int = 2
    phases: tuple[StudyPhase, ...] = get_args(StudyPhase)
    round_phases: tuple[RoundPhase, ...] = PAPER_ROUND
    memorise_seconds: tuple[int, ...] = (60, 180)
    label_seconds: int = 240
    refill_dropouts: bool = False
    least_free_mb: int = 1_000
    screen: ScreenSize = ScreenSize()
    mission: MissionSettings = msgspec.field(
        default_factory=lambda: MissionSettings(show_score=False, allow_pause=False)
    )
    interruption: InterruptionRules = InterruptionRules()
    primary: Primary = Primary()
    web: WebSettings = WebSettings()

    def __post_init__(self) -> None:
        if not self.name.strip():
            raise ValueError("name must not be empty")
        _within("blocks", self.blocks, 1, 1_000)
        if self.places is not None:
            _within("places", self.places, 1, 100_000)
        _check_rising("memorise_seconds", self.memorise_seconds, 1, 3_600)
        _check_rising("static_levels", self.static_levels, 1, 3)
        _within("label_seconds", self.label_seconds, 1, 3_600)
        _within("least_free_mb", self.least_free_mb, 0, 1_000_000)
        if self.preset not in PRESETS:
            raise ValueError(f"preset must be one of {', '.join(PRESETS)}, not {self.preset}")
        if SEPARATOR not in self.coach and self.coach not in _COACHES:
            raise ValueError(f"coach must be one of {', '.join(_COACHES)}, not {self.coach}")
        self._check_instructors()
        self._check_phases()
        self._check_buildings()
        if self.mission.show_score:
            raise ValueError("mission.show_score must be false in a study")
        if self.mission.allow_pause:
            raise ValueError("mission.allow_pause must be false in a study")

    def _check_instructors(self) -> None:
        if self.instructors is None:
            return
        if self.coach != ADAPTIVE:
            raise ValueError("coach and instructors both name an instructor; keep instructors")
        first, second = self.instructors
        if first == second:
            raise ValueError("the two instructors must differ")
        for one, other in ((self.pair[0], self.pair[1]), (self.pair[1], self.pair[0])):
            if one.takes("yoke") and not other.takes("preset"):
                raise ValueError("instructors: yoked repeats the levels of ana, so it goes with it")
            if one.takes("quiz") and not self._comes_before("label", "mission"):
                raise ValueError(
                    f"instructors: {one.kind} needs the round phase label before mission"
                )

    def _check_phases(self) -> None:
        for name, phases in (("phases", self.phases), ("round_phases", self.round_phases)):
            for phase in phases:
                if phases.count(phase) > 1:
                    raise ValueError(f"{name} has {phase} twice")
        for needed in ("consent", "rounds", "debrief"):
            if needed not in self.phases:
                raise ValueError(f"phases must have {needed}")
        if "mission" not in self.round_phases:
            raise ValueError("round_phases must have mission")
        _check_order("phases", self.phases, _ORDER)
        _check_order("round_phases", self.round_phases, _ROUND_ORDER)

    def _comes_before(self, one: RoundPhase, other: RoundPhase) -> bool:
        places = self.round_phases
        return one in places and other in places and places.index(one) < places.index(other)

    def _check_buildings(self) -> None:
        _within("rounds", self.rounds, 1, MOST_ROUNDS)
        if len(self.buildings) < self.rounds:
            raise ValueError(
                f"there are {self.rounds} rounds and {len(self.buildings)} buildings; name one for "
                "each round"
            )
        if len(set(self.buildings)) < len(self.buildings):
            two = len(self.buildings) == 2
            raise ValueError(f"the {'two ' if two else ''}buildings must differ")

    @property
    def pair(self) -> tuple[Instructor, Instructor]:
        """The two instructors."""
        names = self.instructors or ("static", self.coach)
        first, second = (instructor_named(name) for name in names)
        return first, second

    @property
    def yoked_to(self) -> Instructor | None:
        """The instructor whose levels the other one repeats, where one does that."""
        first, second = self.pair
        if first.takes("yoke"):
            return second
        return first if second.takes("yoke") else None

    @property
    def design(self) -> Design:
        """What is crossed. A factor that changes nothing has one value: the static level where no
        instructor takes it, the memorise time where nothing is memorised."""
        levels = [Level(level) for level in self.static_levels]
        if not any(instructor.by_design for instructor in self.pair):
            levels = levels if len(levels) == 1 else [Level.C2]
        memorise = len(self.memorise_seconds) if "memorise" in self.round_phases else 1
        return Design(memorise, tuple(levels), len(self.buildings))

    @property
    def all_places(self) -> int:
        """How many live places there are."""
        return self.places or self.blocks * self.design.block

    def memorise_ms(self, which: int) -> int:
        """How long the map is shown, by the place of the time in `memorise_seconds`; 0 where
        nothing is memorised."""
        return self.memorise_seconds[which] * 1000 if "memorise" in self.round_phases else 0


_ORDER: tuple[tuple[StudyPhase, StudyPhase], ...] = (
    ("preflight", "consent"),
    ("consent", "practice"),
    ("practice", "rounds"),
    ("rounds", "preference"),
    ("preference", "debrief"),
    ("consent", "rounds"),
    ("rounds", "debrief"),
)
"""Which phase makes sense only before which other."""
_ROUND_ORDER: tuple[tuple[RoundPhase, RoundPhase], ...] = (
    ("memorise", "mission"),
    ("mission", "forms"),
)


def _check_order(name: str, phases: tuple[str, ...], order: tuple[tuple[str, str], ...]) -> None:
    for before, later in order:
        if before in phases and later in phases and phases.index(before) > phases.index(later):
            raise ValueError(f"{name} must have {before} before {later}")


def _check_rising(name: str, values: tuple[int, ...], low: int, high: int) -> None:
    if not values:
        raise ValueError(f"{name} must not be empty")
    for value in values:
        _within(name, value, low, high)
    if list(values) != sorted(set(values)):
        raise ValueError(f"{name} must rise from each to the next: {list(values)}")


def read_settings(path: Path) -> tuple[StudySettings, str]:
    """The settings in `path` and the SHA-256 of the file. Raises SettingsError, naming the key."""
    try:
        data = path.read_bytes()
        text = data.decode("utf-8-sig")
        tree = tomllib.loads(text)
    except FileNotFoundError as error:
        if not (path.parent / LEDGER).exists():
            raise SettingsError(NO_STUDY, place=str(path.parent), hint=NEW_STUDY) from error
        raise SettingsError(
            "the settings are missing", place=str(path), hint="Restore the file from a backup"
        ) from error
    except OSError as error:
        raise SettingsError(
            f"the settings cannot be read ({error.strerror})",
            place=str(path),
            hint=disk_hint(error),
        ) from error
    except UnicodeDecodeError as error:
        raise SettingsError(NOT_UTF8, place=str(path), hint=SAVE_AS_UTF8) from error
    except tomllib.TOMLDecodeError as error:
        raise SettingsError(f"this is not TOML: {error}", place=str(path)) from error
    try:
        _no_unknown_rules(tree.get("mission"))
        settings = msgspec.convert(tree, StudySettings)
    except msgspec.ValidationError as error:
        found, key = parted(str(error))
        message = in_plain_words(found, "setting")
        place = f"{path}, {key.removeprefix('$.')}" if key.strip("$") else str(path)
        choices = allowed(StudySettings, key) if refused(found) else ()
        hint = choose_from(refused(found), choices) if choices else ""
        hint = hint or listed(found, key, tree) or _suggestion(message)
        raise SettingsError(message, place=place, hint=hint) from error
    return settings, sha256(data).hexdigest()


def _no_unknown_rules(mission: object) -> None:
    """Raise what msgspec would raise if it checked dataclasses for unknown fields."""
    rules = {field.name for field in fields(MissionSettings)}
    for name in mission if isinstance(mission, dict) else ():
        if name not in rules:
            raise msgspec.ValidationError(
                f"Object contains unknown field `{name}` - at `$.mission`"
            )


def _suggestion(message: str) -> str:
    unknown = re.search(r"no setting `(\w+)`", message)
    if unknown is None:
        return ""
    sections = (StudySettings, ScreenSize, InterruptionRules, Primary, WebSettings)
    names = {field for section in sections for field in section.__struct_fields__}
    names |= {field.name for field in fields(MissionSettings)}
    return did_you_mean(unknown[1], sorted(names)) or "Remove it"

"""study.toml: every setting of a study, typed and checked when it is read."""

from __future__ import annotations

import re
import tomllib
from dataclasses import fields
from hashlib import sha256
from pathlib import Path
from typing import Literal

import msgspec

from game.coach.own import SEPARATOR
from game.coach.presets import PRESETS
from game.coach.registry import KINDS
from game.coach.spec import DEFAULT_PRESET
from game.errors import AnaError, did_you_mean
from game.world.settings import MissionSettings

PrimaryOutcome = Literal[
    "victims", "engagement", "confidence", "frustration", "confusion", "preference"
]


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
    """The outcomes and the multiple-test correction chosen before any data are collected."""

    outcomes: tuple[PrimaryOutcome, ...] = ("engagement", "victims")
    correction: Literal["none", "bonferroni", "sidak", "holm"] = "holm"


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


class StudySettings(_Section, frozen=True):
    """All settings of a study. Raises ValueError, naming the setting, if one is out of range."""

    name: str
    seed: int
    blocks: int
    buildings: tuple[str, str]
    practice_building: str
    coach: str = ADAPTIVE
    preset: str = DEFAULT_PRESET
    memorise_seconds: tuple[int, int] = (60, 180)
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
        short, long = self.memorise_seconds
        _within("memorise_seconds", short, 1, 3_600)
        _within("memorise_seconds", long, short, 3_600)
        _within("label_seconds", self.label_seconds, 1, 3_600)
        _within("least_free_mb", self.least_free_mb, 0, 1_000_000)
        if self.preset not in PRESETS:
            raise ValueError(f"preset must be one of {', '.join(PRESETS)}, not {self.preset}")
        if SEPARATOR not in self.coach and self.coach not in _COACHES:
            raise ValueError(f"coach must be one of {', '.join(_COACHES)}, not {self.coach}")
        if self.buildings[0] == self.buildings[1]:
            raise ValueError("the two buildings must differ")
        if self.mission.show_score:
            raise ValueError("mission.show_score must be false in a study")
        if self.mission.allow_pause:
            raise ValueError("mission.allow_pause must be false in a study")

    def memorise_ms(self, long: bool) -> int:
        return self.memorise_seconds[long] * 1000


def read_settings(path: Path) -> tuple[StudySettings, str]:
    """The settings in `path` and the SHA-256 of the file. Raises SettingsError, naming the key."""
    try:
        data = path.read_bytes()
        text = data.decode("utf-8-sig")
        tree = tomllib.loads(text)
    except OSError as error:
        raise SettingsError(
            f"the settings cannot be read ({error.strerror})",
            place=str(path),
            hint="`ana study new` makes a study folder with a study.toml",
        ) from error
    except UnicodeDecodeError as error:
        raise SettingsError("the file is not UTF-8 text", place=str(path)) from error
    except tomllib.TOMLDecodeError as error:
        raise SettingsError(f"this is not TOML: {error}", place=str(path)) from error
    try:
        _no_unknown_rules(tree.get("mission"))
        settings = msgspec.convert(tree, StudySettings)
    except msgspec.ValidationError as error:
        message, key = _parted(str(error))
        place = f"{path}, {key}" if key else str(path)
        raise SettingsError(message, place=place, hint=_suggestion(message)) from error
    return settings, sha256(data).hexdigest()


def _no_unknown_rules(mission: object) -> None:
    """Raise what msgspec would raise if it checked dataclasses for unknown fields."""
    rules = {field.name for field in fields(MissionSettings)}
    for name in mission if isinstance(mission, dict) else ():
        if name not in rules:
            raise msgspec.ValidationError(
                f"Object contains unknown field `{name}` - at `$.mission`"
            )


def _parted(error: str) -> tuple[str, str]:
    """msgspec's message without its path, and the path as a person would write it."""
    message, _, path = error.partition(" - at `")
    message = message.replace("Object contains unknown field", "there is no setting")
    return message, path.rstrip("`").removeprefix("$").lstrip(".")


def _suggestion(message: str) -> str:
    unknown = re.search(r"no setting `(\w+)`", message)
    if unknown is None:
        return ""
    sections = (StudySettings, ScreenSize, InterruptionRules, Primary, WebSettings)
    names = {field for section in sections for field in section.__struct_fields__}
    names |= {field.name for field in fields(MissionSettings)}
    return did_you_mean(unknown[1], sorted(names)) or "Remove it"

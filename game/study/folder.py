"""A study's folder: its settings, texts, buildings and ledger, and where its sessions are kept.

DIR/study.toml, texts.toml, items.toml      what a lab edits
DIR/ledger.jsonl                            who was allocated what
DIR/sessions/MODE/PARTICIPANT/journal.jsonl and lock
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from secrets import randbelow
from typing import NamedTuple

from game.coach.spec import DEFAULT_PRESET
from game.errors import AnaError
from game.journal.folders import SESSIONS
from game.journal.records import StudyCopy
from game.journal.sink import make_folders
from game.study.ledger import (
    Ledger,
    LedgerEntry,
    Mode,
    SettingsAmended,
    StudyCreated,
    agreed_hash,
    agreement,
    utc_now,
)
from game.study.study_settings import (
    ADAPTIVE,
    ScreenSize,
    SettingsError,
    StudySettings,
    read_settings,
)
from game.study.texts import Items, Texts, read_items, read_texts
from game.world import load_building
from game.world.building import Building
from game.world.labels import HALF_BLOCKS, fit_label

SETTINGS, TEXTS, ITEMS, LEDGER = "study.toml", "texts.toml", "items.toml", "ledger.jsonl"
MODES: tuple[Mode, ...] = ("live", "pilot", "simulated")
MAP_MARGIN = (22, 4)
"""Columns and rows of the fixed screen that a building's map leaves to names, clock and keys."""

_BUILDINGS = {"first": "foundry", "second": "harbour", "practice": "practice"}
_PSEUDONYM = re.compile(r"[A-Za-z0-9_-]{1,32}")
_MOST_SEED = 2**31


class StudyError(AnaError):
    """A study cannot be opened, or does not allow what was asked."""


class Identity(NamedTuple):
    """Whose session it is, and which kind."""

    mode: Mode
    participant: str


@dataclass(frozen=True)
class Study:
    """A study as its folder has it now."""

    folder: Path
    settings: StudySettings
    copy: StudyCopy
    texts: Texts
    items: Items
    buildings: tuple[Building, Building]
    practice: Building

    @property
    def ledger(self) -> Ledger:
        return Ledger(self.folder / LEDGER)

    def home(self, identity: Identity) -> Path:
        """The folder of one participant's session."""
        return self.folder / SESSIONS / identity.mode / identity.participant

    def building(self, name: str) -> Building:
        """The building that the settings call `name`."""
        return self.buildings[self.settings.buildings.index(name)]


def identify(participant: str, *, pilot: bool = False) -> Identity:
    """The identity behind a participant's ID. Raises StudyError if it is not a pseudonym."""
    if _PSEUDONYM.fullmatch(participant) is None:
        raise StudyError(
            f"'{participant}' cannot be a participant's ID",
            place="--participant",
            mend="An ID is a pseudonym of 1 to 32 letters, digits, - and _, such as P01: "
            "no name, no address",
        )
    return Identity("pilot" if pilot else "live", participant)


def new_study(
    folder: Path,
    seed: int | None = None,
    blocks: int = 5,
    preset: str = DEFAULT_PRESET,
    coach: str = ADAPTIVE,
    now: Callable[[], str] = utc_now,
) -> None:
    """Make a study folder with the default settings and texts, to be edited.

    `coach` is the adaptive instructor, and `preset` how it adapts; `now` gives the time of the
    creation.

    Raises StudyError for a folder that holds something already, or cannot be made.
    """
    seed = randbelow(_MOST_SEED) if seed is None else seed
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise StudyError(
            "there is something in it already", place=str(folder), mend="Choose a new folder"
        )
    template = resources.files("game.study") / "template"
    try:
        make_folders(folder)
        for name in (SETTINGS, TEXTS, ITEMS):
            text = template.joinpath(name).read_text(encoding="utf-8")
            if name == SETTINGS:
                chosen = {"preset": preset, "coach": coach}
                text = text.format(seed=seed, blocks=blocks, **chosen, **_BUILDINGS)
            path = folder / name
            path.touch(mode=0o600)
            path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise StudyError(
            f"the folder cannot be made ({error.strerror})", place=str(folder)
        ) from error
    _, digest = read_settings(folder / SETTINGS)
    Ledger(folder / LEDGER, now).create(seed, blocks, digest)


def open_study(folder: Path) -> Study:
    """The study in `folder`, whole and sound.

    Raises StudyError or one of its relatives, naming the file and what to mend.
    """
    path = folder / SETTINGS
    settings, digest = read_settings(path)
    entries = Ledger(folder / LEDGER).entries()
    _same_as_created(settings, entries, path)
    study = Study(
        folder=folder,
        settings=settings,
        copy=StudyCopy(path.read_text(encoding="utf-8"), digest),
        texts=read_texts(folder / TEXTS),
        items=read_items(folder / ITEMS),
        buildings=(
            _building(folder, settings.buildings[0]),
            _building(folder, settings.buildings[1]),
        ),
        practice=_building(folder, settings.practice_building),
    )
    for building in (*study.buildings, study.practice):
        _check_map(building, settings.screen)
    return study


def amend(folder: Path, why: str) -> None:
    """Record that study.toml was changed, knowingly. Raises StudyError when it was not."""
    study = open_study(folder)
    if agreed_hash(study.ledger.entries()) == study.copy.sha256:
        raise StudyError("study.toml was not changed", place=str(folder))
    study.ledger.amend(study.copy.sha256, why)


def amendment(study: Study) -> str:
    """Why the settings were changed last; empty where they were not."""
    last = agreement(study.ledger.entries())
    return last.why if isinstance(last, SettingsAmended) else ""


def _same_as_created(settings: StudySettings, entries: tuple[LedgerEntry, ...], path: Path) -> None:
    """The seed and the number of places decide the allocation, and never change."""
    created = entries[0] if entries else None
    if not isinstance(created, StudyCreated):
        raise StudyError(
            "the ledger does not begin with the study's creation",
            place=str(path.with_name(LEDGER)),
            mend="Restore it from a copy",
        )
    for name in ("seed", "blocks"):
        asked, fixed = getattr(settings, name), getattr(created, name)
        if asked != fixed:
            raise SettingsError(
                f"{name} is {asked}, but the study was created with {fixed}",
                place=f"{path}, {name}",
                mend=f"Put {fixed} back, or create another study",
            )


def _building(folder: Path, name: str) -> Building:
    """A building file of the study folder, or a shipped building."""
    beside = folder / name
    return load_building(beside if beside.is_file() else name)


def _check_map(building: Building, screen: ScreenSize) -> None:
    """The memorise map shows the whole building at once, with every name. Raises StudyError."""
    columns = building.plan.width + MAP_MARGIN[0]
    rows = -(-building.plan.height // HALF_BLOCKS.cells) + MAP_MARGIN[1]
    if columns > screen.columns or rows > screen.rows:
        raise StudyError(
            f"{building.name} with its names is too large: it takes {columns} x {rows}",
            place=f"{SETTINGS}, screen",
            mend="Enlarge [screen], or choose a smaller building",
        )
    for room in building.rooms:
        if not fit_label(room):
            raise StudyError(
                f"the name '{room.name}' does not fit its room on the map",
                place=building.name,
                mend="Shorten the name; `ana building check FILE` shows all that do not fit",
            )

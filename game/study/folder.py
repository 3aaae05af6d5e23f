"""A study's folder: its settings, texts, buildings, ledger and sessions.

DIR/study.toml, texts.toml, items.toml      edited by the lab
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
from game.journal.records import StudyCopy, StudyMode
from game.journal.sink import make_folders
from game.study.ledger import (
    Ledger,
    LedgerEntry,
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
from game.world.fitness import shortcomings

SETTINGS, TEXTS, ITEMS, LEDGER = "study.toml", "texts.toml", "items.toml", "ledger.jsonl"

_BUILDINGS = {"first": "foundry", "second": "harbour", "practice": "practice"}
_PSEUDONYM = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,31}")
_MOST_SEED = 2**31


class StudyError(AnaError):
    """A study cannot be opened, or does not allow the request."""


class Identity(NamedTuple):
    """Whose session it is, and in which mode."""

    mode: StudyMode
    participant: str


@dataclass(frozen=True)
class Study:
    """A study as its folder holds it now."""

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
        """The mission building that the settings call `name`."""
        return self.buildings[self.settings.buildings.index(name)]


def identify(participant: str, *, pilot: bool = False) -> Identity:
    """The identity for a participant's ID. Raises StudyError if it is not a pseudonym."""
    if _PSEUDONYM.fullmatch(participant) is None:
        raise StudyError(
            f"'{participant}' is not a participant ID",
            hint="Use a pseudonym of 1 to 32 letters, digits, - and _ that begins with a letter or "
            "digit, such as P01; not a name or an address",
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
    """Create a study folder with the default settings and texts, for the lab to edit.

    `coach` is the adaptive instructor and `preset` how it adapts; `now` gives the time of creation.
    Raises StudyError if the folder is not empty or cannot be created.
    """
    seed = randbelow(_MOST_SEED) if seed is None else seed
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise StudyError("the folder is not empty", place=str(folder), hint="Choose a new folder")
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
            f"the folder cannot be created ({error.strerror})", place=str(folder)
        ) from error
    _, digest = read_settings(folder / SETTINGS)
    Ledger(folder / LEDGER, now).create(seed, blocks, digest)


def open_study(folder: Path) -> Study:
    """The study in `folder`, checked.

    Raises AnaError, naming the file and what to fix.
    """
    path = folder / SETTINGS
    settings, digest = read_settings(path)
    entries = Ledger(folder / LEDGER).entries()
    _same_as_created(settings, entries, path)
    study = Study(
        folder=folder,
        settings=settings,
        copy=StudyCopy(path.read_text(encoding="utf-8-sig"), digest),
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
    """Record that study.toml was changed on purpose. Raises StudyError if it was not changed."""
    study = open_study(folder)
    if agreed_hash(study.ledger.entries()) == study.copy.sha256:
        raise StudyError(
            "study.toml has not changed, so there is nothing to record", place=str(folder)
        )
    study.ledger.amend(study.copy.sha256, why)


def amendment(study: Study) -> str:
    """Why the settings were last changed; empty if they never were."""
    last = agreement(study.ledger.entries())
    return last.why if isinstance(last, SettingsAmended) else ""


def _same_as_created(settings: StudySettings, entries: tuple[LedgerEntry, ...], path: Path) -> None:
    """The seed and the number of places decide the allocation, so they never change."""
    created = entries[0] if entries else None
    if not isinstance(created, StudyCreated):
        raise StudyError(
            "the ledger does not begin with the creation of the study",
            place=str(path.with_name(LEDGER)),
            hint="Restore the ledger from a backup",
        )
    for name in ("seed", "blocks"):
        asked, fixed = getattr(settings, name), getattr(created, name)
        if asked != fixed:
            raise SettingsError(
                f"{name} is {asked}, but the study was created with {fixed}",
                place=f"{path}, {name}",
                hint=f"Change it back to {fixed}, or create a new study",
            )


def _building(folder: Path, name: str) -> Building:
    """A building file of the study folder, or a shipped building."""
    beside = folder / name
    return load_building(beside if beside.is_file() else name)


def _check_map(building: Building, screen: ScreenSize) -> None:
    """The memorise map shows the whole building at once, with every name. Raises StudyError."""
    problems = shortcomings(building, building.name, 1, (screen.columns, screen.rows))
    if problems:
        first = problems[0]
        raise StudyError(first.message, place=building.name, hint=f"{first.hint}.")

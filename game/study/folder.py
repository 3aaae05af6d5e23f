"""A study's folder: its settings, texts, buildings, ledger and sessions.

DIR/study.toml, texts.toml, forms.toml, instructions.toml      edited by the lab
DIR/ledger.jsonl                            who was allocated what
DIR/versions/                               every version of what sessions were made from
DIR/sessions/MODE/PARTICIPANT/journal.jsonl and lock
"""

from __future__ import annotations

import csv
import os
import pwd
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from importlib import resources
from pathlib import Path
from secrets import randbelow
from typing import NamedTuple

from game.coach.instructions.phrasebook import Phrasebook
from game.coach.instructions.phrasebook_file import english, parse_phrasebook
from game.coach.spec import DEFAULT_PRESET
from game.coach.yoke import Yoke
from game.errors import AnaError, choose_from, did_you_mean
from game.forms.form import Forms
from game.forms.reading import FORMS, paper_text, read_forms
from game.journal.folders import SESSIONS
from game.journal.records import StudyCopy, StudyMode
from game.journal.sink import make_folders
from game.study.course import Course, course
from game.study.donors import donated
from game.study.files import LEDGER as LEDGER
from game.study.files import SETTINGS as SETTINGS
from game.study.languages import ENGLISH, Translation
from game.study.ledger import (
    Ledger,
    LedgerEntry,
    SettingsAmended,
    StudyCreated,
    agreement,
    utc_now,
)
from game.study.links import pseudonyms
from game.study.study_settings import (
    ADAPTIVE,
    ScreenSize,
    SettingsError,
    StudySettings,
    read_settings,
)
from game.study.texts import Texts, read_texts
from game.tables.asked import asked_columns
from game.toml_words import NOT_UTF8, SAVE_AS_UTF8
from game.world.building import Building
from game.world.fitness import shortcomings
from game.world.library import GENERATED, load_building, shipped_buildings

TEXTS = "texts.toml"
INSTRUCTIONS = "instructions.toml"
"""What the instructors say; older folders lack it, and mean the shipped English."""
VERSIONS = "versions"
"""Copies of everything that sessions were made from."""
ROSTER = "roster.csv"
"""Who may take part; optional."""

_BUILDINGS = {"first": "foundry", "second": "harbour", "practice": "practice"}
_PSEUDONYM = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,31}")
_PSEUDONYMS = (
    "Use a pseudonym of 1 to 32 letters, digits, - and _ that begins with a letter or digit, such "
    "as P01; not a name or an address"
)
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
    forms: Forms
    phrases: Phrasebook
    buildings: tuple[Building, ...]
    practice: Building
    inputs: Mapping[str, str]
    """The SHA-256 of everything that a session is made from, by name."""
    notes: tuple[str, ...] = ()
    """What the experimenter should know of the files."""

    @cached_property
    def course(self) -> Course:
        """The steps of every session."""
        return course(self.forms, self.settings)

    @property
    def version(self) -> str:
        """A short name of the inputs, for each answer: the beginning of their joint SHA-256."""
        lines = "".join(f"{name} {digest}\n" for name, digest in sorted(self.inputs.items()))
        return sha256(lines.encode()).hexdigest()[:12]

    def freeze(self) -> None:
        """Make sure that the inputs are those that were agreed on, and keep a copy of each.

        Raises LedgerError for a change that was not recorded, StudyError where no copy can be kept.
        """
        self.ledger.agree(self.inputs)
        self.keep_copies()

    def keep_copies(self) -> None:
        """Keep the inputs as they are now in the folder `versions`, each version once."""
        buildings = {name_of(it): it.text.encode() for it in (*self.buildings, self.practice)}
        try:
            for name, digest in self.inputs.items():
                path = kept_copy(self.folder, name, digest)
                if not path.exists():
                    make_folders(path.parent)
                    data = buildings.get(name) or (self.folder / name).read_bytes()
                    path.touch(mode=0o600)
                    path.write_bytes(data)
        except OSError as error:
            raise StudyError(
                f"no copy of the study's texts can be kept ({error.strerror})",
                place=str(self.folder / VERSIONS),
                hint="Free some space, and let the study's account write there",
            ) from error

    @property
    def ledger(self) -> Ledger:
        return Ledger(self.folder / LEDGER)

    def home(self, identity: Identity) -> Path:
        """The folder of one participant's session."""
        return self.folder / SESSIONS / identity.mode / identity.participant

    def yoke_for(self, identity: Identity, building: Building, memorise_ms: int) -> Yoke:
        """The levels that a yoked instructor repeats for a participant in a building that they
        memorised for so long."""
        other = self.settings.yoked_to
        assert other is not None
        modes = tuple(dict.fromkeys((identity.mode, "pilot")))
        seed = self.settings.seed
        return donated(self.folder, modes, identity.participant, building, other, memorise_ms, seed)

    def building(self, name: str) -> Building:
        """The mission building that the settings call `name`."""
        return self.buildings[self.settings.buildings.index(name)]


def roster_of(folder: Path) -> tuple[str, ...] | None:
    """The IDs in roster.csv, in its order; None where there is none.

    The IDs stand in the first column, or in the one headed `id` or `participant`; commas,
    semicolons or tabs part the columns. Raises StudyError for a file that cannot be read, and for
    an ID that is not one or stands there twice.
    """
    path = folder / ROSTER
    try:
        text = path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        return None
    except (OSError, UnicodeDecodeError) as error:
        raise StudyError(
            f"the roster cannot be read ({error})",
            place=str(path),
            hint="Save it as CSV in UTF-8, and let the study's account read it",
        ) from error
    lines = text.splitlines()
    apart = next((mark for mark in ";\t" if lines and mark in lines[0]), ",")
    reader = csv.reader(lines, delimiter=apart)
    rows = [(reader.line_num, row) for row in reader if any(it.strip() for it in row)]
    heads = [it.strip().casefold() for it in rows[0][1]] if rows else []
    column = next((heads.index(name) for name in ("id", "participant") if name in heads), None)
    found: list[str] = []
    for line, row in rows if column is None else rows[1:]:
        name = row[column or 0].strip() if len(row) > (column or 0) else ""
        place = f"{path}, line {line}"
        if name in found:
            raise StudyError(f"{name} stands there twice", place=place, hint="Remove one")
        if not is_pseudonym(name):
            raise StudyError(f"'{name}' is not a participant ID", place=place, hint=_PSEUDONYMS)
        found.append(name)
    return tuple(found)


def admit_by_roster(folder: Path, identity: Identity) -> None:
    """Raise StudyError unless the participant is on the roster, where there is one; pilots need not
    be."""
    roster = roster_of(folder) if identity.mode == "live" else None
    if roster is None or identity.participant in roster:
        return
    if identity.participant not in pseudonyms(folder, roster):
        raise StudyError(
            f"{identity.participant} is not on the roster of this study",
            place=str(folder / ROSTER),
            hint=did_you_mean(identity.participant, roster) or "Add the ID to the roster",
        )


def refuse_other_accounts(folder: Path, command: str) -> None:
    """Raise StudyError where another account than the folder's owner runs a command, root included:
    files that it made could not be read by the owner afterwards."""
    try:
        owner = folder.stat().st_uid
    except OSError:
        return
    if owner == os.geteuid():
        return
    try:
        name = pwd.getpwuid(owner).pw_name
    except KeyError:
        name = f"'#{owner}'"
    raise StudyError(
        f"this study belongs to the account {name}",
        place=str(folder),
        hint=f"Run it as that account: sudo -u {name} {command}",
    )


def is_pseudonym(name: str) -> bool:
    """Whether something can be a participant's ID."""
    return _PSEUDONYM.fullmatch(name) is not None


def identify(participant: str, *, pilot: bool = False) -> Identity:
    """The identity for a participant's ID. Raises StudyError if it is not a pseudonym."""
    if not is_pseudonym(participant):
        raise StudyError(f"'{participant}' is not a participant ID", hint=_PSEUDONYMS)
    return Identity("pilot" if pilot else "live", participant)


def new_study(
    folder: Path,
    seed: int | None = None,
    blocks: int = 5,
    preset: str = DEFAULT_PRESET,
    coach: str = ADAPTIVE,
    now: Callable[[], str] = utc_now,
    language: str = ENGLISH,
) -> None:
    """Create a study folder with the default settings and texts, for the lab to edit.

    `language` is that of everything participants read; `coach` is the adaptive instructor and
    `preset` how it adapts; `now` gives the time of creation. Raises StudyError if the folder is not
    empty or cannot be created, AnaError for a language that there is not.
    """
    translation = None if language == ENGLISH else Translation(language)
    seed = randbelow(_MOST_SEED) if seed is None else seed
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise StudyError("the folder is not empty", place=str(folder), hint="Choose a new folder")
    template = resources.files("game.study") / "template"
    try:
        make_folders(folder)
        for name in (SETTINGS, TEXTS, FORMS):
            text = paper_text() if name == FORMS else (template / name).read_text("utf-8")
            if name == SETTINGS:
                chosen = {"preset": preset, "coach": coach}
                ending = ".txt" if translation else ""
                names = {role: name + ending for role, name in _BUILDINGS.items()}
                text = text.format(seed=seed, blocks=blocks, **chosen, **names)
                text = translation.named(text) if translation else text
            _write_new(folder / name, text)
        _write_new(folder / INSTRUCTIONS, english().text)
        if translation is not None:
            for name, text in translation.texts.items():
                if (folder / name).exists():
                    _write_new(folder / name, text)
            for name, text in translation.buildings(_BUILDINGS.values()).items():
                _write_new(folder / name, text)
    except OSError as error:
        raise StudyError(
            f"the folder cannot be created ({error.strerror})", place=str(folder)
        ) from error
    _, digest = read_settings(folder / SETTINGS)
    Ledger(folder / LEDGER, now).create(seed, blocks, digest)


def _write_new(path: Path, text: str) -> None:
    path.touch(mode=0o600)
    path.write_text(text, encoding="utf-8")


def open_study(folder: Path) -> Study:
    """The study in `folder`, checked.

    Raises AnaError, naming the file and what to fix.
    """
    path = folder / SETTINGS
    settings, digest = read_settings(path)
    entries = Ledger(folder / LEDGER).entries()
    _same_as_created(settings, entries, path)
    texts = read_texts(folder / TEXTS)
    forms, asked, note = read_forms(folder, texts.form_pages)
    asked_columns(forms)
    phrases = read_phrasebook(folder / INSTRUCTIONS)
    buildings = tuple(_building(folder, name, "buildings") for name in settings.buildings)
    practice = _building(folder, settings.practice_building, "practice_building")
    study = Study(
        folder=folder,
        settings=settings,
        copy=StudyCopy(path.read_text(encoding="utf-8-sig"), digest),
        texts=texts,
        forms=forms,
        phrases=phrases,
        buildings=buildings,
        practice=practice,
        inputs={
            SETTINGS: digest,
            TEXTS: _digest(folder / TEXTS),
            asked: _digest(folder / asked),
            **_digest_if_there(folder / INSTRUCTIONS),
            **{name_of(building): building.hash for building in (*buildings, practice)},
        },
        notes=(note,) if note else (),
    )
    for building in (*study.buildings, study.practice):
        _check_map(building, settings.screen)
    return study


def amend(folder: Path, why: str) -> tuple[str, ...]:
    """Record that settings, texts, forms or buildings were changed on purpose; returns which.

    Raises StudyError if none has changed.
    """
    study = open_study(folder)
    changed = study.ledger.amend(study.inputs, why)
    if not changed:
        raise StudyError(
            "nothing has changed that a session is made from, so there is nothing to record",
            place=str(folder),
        )
    study.keep_copies()
    return changed


def name_of(building: Building) -> str:
    """The name of a building among the inputs."""
    return f"building {building.name}"


def kept_copy(folder: Path, name: str, digest: str) -> Path:
    """Where the copy of an input with this SHA-256 lies in a study's folder, once it was kept."""
    return folder / VERSIONS / f"{Path(name).stem}-{digest[:12]}{Path(name).suffix or '.txt'}"


def read_phrasebook(path: Path) -> Phrasebook:
    """The sentences in `path`; the shipped English where there is no such file. Raises
    PhrasebookError, naming the line, or StudyError where the file cannot be read."""
    try:
        return parse_phrasebook(path.read_text(encoding="utf-8-sig"), str(path))
    except FileNotFoundError:
        return english()
    except OSError as error:
        message = f"the instructions cannot be read ({error.strerror})"
        raise StudyError(message, place=str(path)) from error
    except UnicodeDecodeError as error:
        raise StudyError(NOT_UTF8, place=str(path), hint=SAVE_AS_UTF8) from error


def _digest_if_there(path: Path) -> dict[str, str]:
    return {path.name: _digest(path)} if path.exists() else {}


def _digest(path: Path) -> str:
    return sha256(path.read_bytes()).hexdigest()


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
    for name in ("seed",) if settings.places else ("seed", "blocks"):
        asked, fixed = getattr(settings, name), getattr(created, name)
        if asked != fixed:
            raise SettingsError(
                f"{name} is {asked}, but the study was created with {fixed}",
                place=f"{path}, {name}",
                hint=f"Change it back to {fixed}, or create a new study",
            )


def _building(folder: Path, name: str, key: str) -> Building:
    """A building file of the study folder, or a shipped building. Raises AnaError, which names the
    `key` of study.toml where there is no such building."""
    beside = folder / name
    if beside.is_file():
        return load_building(beside)
    if name in shipped_buildings() or name.startswith(f"{GENERATED}:") or Path(name).is_file():
        return load_building(name)
    files = sorted(path.name for path in folder.glob("*.txt"))
    raise StudyError(
        f"there is no building '{name}', neither in this folder nor among those that are shipped",
        place=f"{folder / SETTINGS}, {key}",
        hint=choose_from(name, (*files, *shipped_buildings())),
    )


def _check_map(building: Building, screen: ScreenSize) -> None:
    """The memorise map shows the whole building at once, with every name. Raises StudyError."""
    problems = shortcomings(building, building.name, 1, (screen.columns, screen.rows))
    if problems:
        first = problems[0]
        raise StudyError(first.message, place=building.name, hint=f"{first.hint}.")

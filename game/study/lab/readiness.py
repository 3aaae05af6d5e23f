"""Whether this machine and this folder can carry a study: tried before the first participant."""

from __future__ import annotations

import fcntl
import locale
import os
import stat
from collections.abc import Iterator
from pathlib import Path

from game.errors import AnaError, did_you_mean
from game.forms.reading import FORMS
from game.journal.folders import SESSIONS
from game.study.folder import INSTRUCTIONS, LEDGER, SETTINGS, TEXTS, Study
from game.study.lab.hindrances import Hindrances
from game.study.ledger import lock_whole
from game.tables.asked import outcomes_of
from game.toml_lines import at_line, line_of

_TRIAL = ".check"


def shortfalls(study: Study) -> Iterator[str]:
    """Everything that would keep sessions from being run or kept here, in words."""
    yield from Hindrances(study.folder).look(study.ledger.entries())
    yield from _files(study.folder)
    yield from _writing(study.folder)
    yield from _locale()
    yield from _half_time(study)
    yield from _rooms(study)
    yield from _outcomes(study)


def _files(folder: Path) -> Iterator[str]:
    owner = folder.stat().st_uid
    for path in _everything(folder):
        found = path.lstat()
        if found.st_uid != owner:
            yield f"{path} belongs to another account; give it to {folder.owner()} with chown"
        elif not os.access(path, os.R_OK):
            yield f"{path} cannot be read by this account; allow it with chmod u+r"
        elif _written(folder, path) and not os.access(path, os.W_OK):
            yield f"{path} cannot be written by this account; allow it with chmod u+w"
        if found.st_mode & (stat.S_IWGRP | stat.S_IWOTH) and not path.is_symlink():
            yield f"{path} can be written by other accounts; take that away with chmod go-w"


def _everything(folder: Path) -> Iterator[Path]:
    """The folder and all that lies in it, as far as it can be looked into."""
    for parent, folders, files in os.walk(folder):
        folders.sort()
        yield Path(parent)
        yield from (Path(parent) / name for name in sorted(files))
        yield from (
            Path(parent) / name for name in folders if not os.access(Path(parent) / name, os.X_OK)
        )


def _written(folder: Path, path: Path) -> bool:
    """Whether sessions write to it: the ledger, the folders, and what is in `sessions`."""
    return path.is_dir() or path == folder / LEDGER or path.is_relative_to(folder / SESSIONS)


def _writing(folder: Path) -> Iterator[str]:
    """Write, sync and lock a file where sessions will lie."""
    path = folder / _TRIAL
    try:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o600)
    except OSError as error:
        yield f"nothing can be written in {folder} ({error.strerror})"
        return
    try:
        os.write(descriptor, b"check\n")
        os.fsync(descriptor)
        lock_whole(descriptor, path, wait=False)
        fcntl.flock(descriptor, fcntl.LOCK_UN)
    except (OSError, AnaError) as error:
        yield str(error)
    finally:
        os.close(descriptor)
        path.unlink(missing_ok=True)


def _locale() -> Iterator[str]:
    encoding = locale.getpreferredencoding(do_setlocale=False)
    if encoding.replace("-", "").casefold() != "utf8":
        yield f"the locale's encoding is {encoding}, not UTF-8: set LANG=C.UTF-8 for the account"


def _rooms(study: Study) -> Iterator[str]:
    """A sentence for a room that no building has, and that is nearly the name of one."""
    rooms = {
        room.name for building in (*study.buildings, study.practice) for room in building.rooms
    }
    said = study.phrases.own_sentences
    for name in said:
        hint = did_you_mean(name, rooms - set(said)) if name not in rooms else ""
        if hint:
            line = line_of(study.phrases.text, "C3", f"Goto {name}")
            place = at_line(INSTRUCTIONS, line)
            yield f"{place}: no building of this study has a room '{name}'. {hint}"


def _half_time(study: Study) -> Iterator[str]:
    """The texts must say when red victims expire, unless that is when the mission ends."""
    mission, rules = study.texts.mission, study.settings.mission
    early = rules.reds_expire_ms < rules.duration_ms
    told = "{red_time}" in mission.body or "{red_time}" in mission.title
    if early and not told:
        yield f"{TEXTS}, mission: nothing says that red victims expire; add {{red_time}}"


def _outcomes(study: Study) -> Iterator[str]:
    """Primary outcomes must be measured."""
    asked = outcomes_of(study.forms)
    known = ("victims", *asked.composites, *asked.ranges)
    for name in study.settings.primary.outcomes:
        if name not in known:
            hint = did_you_mean(name, known) or f"{FORMS} asks no such item after each mission"
            yield f"{SETTINGS}, primary.outcomes: nothing measures {name}. {hint}"

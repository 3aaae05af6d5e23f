"""Where every participant is, read from the study's folder while sessions write to it.

Nothing here writes or waits. Only what was added to a journal since the last look is read.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal, get_args

import msgspec

from game.journal.folders import JOURNAL, folders_of
from game.journal.history import History
from game.journal.journal_error import JournalError
from game.journal.records import (
    STUDY_MODES,
    Allocated,
    Declined,
    Envelope,
    Exposed,
    Phase,
    PhaseEnded,
    PhaseStarted,
    Resumed,
    SessionEnded,
    Withdrawn,
)
from game.study.folder import Identity
from game.study.lock import is_held
from game.study.study_settings import StudySettings

SessionState = Literal["taking part", "left", "cut off", "finished", "declined", "turned away"]
"""`left` stopped on purpose and may come back; `cut off` lost its process. `turned away` found no
place, because the study was closed or full."""

SILENCE_S = 10.0
"""A timed phase writes every second; one that is silent for longer hangs."""

_Telling = (
    PhaseStarted | Exposed | PhaseEnded | Allocated | Declined | Withdrawn | Resumed | SessionEnded
)
"""The records that move a session on; of all others only the envelope is looked at."""


class _Line(Envelope, frozen=True):
    type: str


_line = msgspec.json.Decoder(_Line)
_telling = msgspec.json.Decoder(_Telling)
_TAGS = frozenset(kind.__struct_config__.tag for kind in get_args(_Telling))


class SessionStatus(msgspec.Struct, frozen=True, kw_only=True):
    """Where one session is. Nothing in it reveals how the participant was allocated.

    `clock_s` is how long a timed phase has been on the screen and `limit_s` its whole length;
    both are None in untimed phases and while memorising, whose length is allocated.
    `silent_s` is the age of the last record. `interruptions` counts how often the session broke
    off, on purpose or not, the last time included where nobody has come back yet; `resumed` how
    often it was continued.
    """

    participant: str
    mode: str
    state: SessionState
    phase: Phase
    round: int
    clock_s: float | None
    limit_s: float | None
    silent_s: float | None
    interruptions: int
    resumed: int
    problems: tuple[str, ...]


@dataclass
class SessionWatch:
    """One session's journal, followed."""

    identity: Identity
    home: Path
    history: History = field(default_factory=History)
    offset: int = 0
    torn: int = 0
    trouble: str = ""
    _tail: bytes = b""

    def look(self) -> None:
        """Take in what was written since the last look."""
        self.trouble = ""
        try:
            with (self.home / JOURNAL).open("rb") as file:
                file.seek(self.offset)
                added = file.read()
        except FileNotFoundError:
            return
        except OSError as error:
            self.trouble = f"the journal cannot be read ({error.strerror})"
            return
        self.offset += len(added)
        *lines, self._tail = (self._tail + added).split(b"\n")
        for line in lines:
            try:
                envelope = _line.decode(line)
                record = _telling.decode(line) if envelope.type in _TAGS else None
                self.history.note(envelope, record)
            except (msgspec.DecodeError, UnicodeDecodeError):
                self.torn += 1

    def replaced(self) -> bool:
        """Whether the journal is shorter than what was read of it: it is another one."""
        try:
            return (self.home / JOURNAL).stat().st_size < self.offset
        except OSError:
            return self.offset > 0

    def status(self, settings: StudySettings, now: datetime) -> SessionStatus:
        """Where the session is at the moment `now`."""
        state = self._state()
        told = self._timed and self.history.step.phase != "memorise"
        silent_s = self._silent_s(now)
        return SessionStatus(
            participant=self.identity.participant,
            mode=self.identity.mode,
            state=state,
            phase=self.history.step.phase if self.history.ended_utc else "consent",
            round=self.history.step.round,
            clock_s=self.history.exposure_ms / 1000 if told else None,
            limit_s=_limit_s(self.history.step.phase, settings) if told else None,
            silent_s=silent_s,
            interruptions=self.history.resumed + (state in ("left", "cut off")),
            resumed=self.history.resumed,
            problems=tuple(self._problems(state, silent_s)),
        )

    @property
    def _timed(self) -> bool:
        """Whether a timed phase is under way."""
        return self.history.begun is not None and self.history.limit_ms is not None

    def _state(self) -> SessionState:
        if self.history.declined:
            return "declined"
        if self.history.over:
            return "finished"
        if is_held(self.home):
            return "taking part"
        if self.history.left is None:
            return "cut off"
        return "turned away" if self.history.left.reason == "turned_away" else "left"

    def _silent_s(self, now: datetime) -> float | None:
        if not self.history.ended_utc:
            return None
        return max(0.0, (now - datetime.fromisoformat(self.history.ended_utc)).total_seconds())

    def _problems(self, state: SessionState, silent_s: float | None) -> list[str]:
        found = [self.trouble] if self.trouble else []
        if self.torn > self.history.resumed:
            found.append(f"{self.torn} lines of the journal cannot be read")
        if self._tail and state != "taking part":
            found.append(
                f"the journal ends in an unfinished line ({len(self._tail)} bytes, ignored)"
            )
        person = self.identity.mode != "simulated"
        if state == "cut off" and person and not self.trouble:
            found.append("the program ended unexpectedly; the participant can log in again")
        silent = silent_s is not None and silent_s > SILENCE_S
        if state == "taking part" and self._timed and silent:
            found.append(
                f"no activity for {silent_s:.0f} s in a timed phase; the connection may be frozen"
            )
        return found


def _limit_s(phase: str, settings: StudySettings) -> float | None:
    match phase:
        case "label":
            return float(settings.label_seconds)
        case "mission":
            return settings.mission.duration_ms / 1000
        case _:
            return None


class Attendance:
    """All sessions of a study, followed over time."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._watched: dict[Identity, SessionWatch] = {}

    def look(self, settings: StudySettings, now: datetime | None = None) -> list[SessionStatus]:
        """Where everyone is now, by mode and participant.

        People who left before consent are missing: nothing was recorded about them. So are those
        whose mode's folder cannot be read, which `Hindrances` names.
        """
        moment = now or datetime.now(UTC)
        watched = (self._watch(identity, home) for identity, home in self._homes())
        self._watched = {watch.identity: watch for watch in watched}
        for watch in self._watched.values():
            watch.look()
        found = [(watch, watch.status(settings, moment)) for watch in self._watched.values()]
        return [
            one
            for watch, one in found
            if one.silent_s is not None or one.state == "taking part" or watch.trouble
        ]

    def _homes(self) -> Iterator[tuple[Identity, Path]]:
        for mode in STUDY_MODES:
            with suppress(JournalError):
                for home in folders_of(self.folder, mode):
                    yield Identity(mode, home.name), home

    def _watch(self, identity: Identity, home: Path) -> SessionWatch:
        """The watch kept so far, unless the journal is another one now."""
        known = self._watched.get(identity)
        if known is None or known.replaced():
            return SessionWatch(identity, home)
        return known

"""The roll of a study: who is where, read from the folder while sessions write to it.

Nothing here writes or waits. Of a journal only what was added since the last look is read.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal, get_args

import msgspec

from game.journal.folders import JOURNAL, SESSIONS
from game.journal.records import (
    Allocated,
    Declined,
    Envelope,
    Exposed,
    Interruption,
    Phase,
    PhaseEnded,
    PhaseStarted,
    Resumed,
    SessionEnded,
    Withdrawn,
)
from game.study.folder import MODES, Identity
from game.study.lock import is_held
from game.study.protocol import Progress, Step
from game.study.study_settings import StudySettings

State = Literal["taking part", "left", "cut off", "finished", "declined", "turned away"]
"""`left` went on purpose and may come back, `cut off` did not: its process is gone. `turned away`
found no place, because the study was closed or full."""

SILENCE_S = 10.0
"""A timed phase writes every second; one silent for longer hangs."""

_Telling = (
    PhaseStarted
    | Exposed
    | PhaseEnded
    | Allocated
    | Declined
    | Withdrawn
    | Interruption
    | Resumed
    | SessionEnded
)
"""The records that move a session on; of all others only the envelope is looked at."""


class _Line(Envelope, frozen=True):
    type: str


_line = msgspec.json.Decoder(_Line)
_telling = msgspec.json.Decoder(_Telling)
_TAGS = frozenset(kind.__struct_config__.tag for kind in get_args(_Telling))


class SessionStatus(msgspec.Struct, frozen=True, kw_only=True):
    """Where one session is. Nothing in it tells how the participant was allocated.

    `clock_s` is how long a timed phase has been on the screen and `limit_s` its whole length;
    both are None in untimed phases and while memorising, whose length is allocated.
    `silent_s` is the age of the last record.
    """

    participant: str
    mode: str
    state: State
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
    progress: Progress = field(default_factory=Progress)
    step: Step = field(default_factory=lambda: Step("session"))
    interruptions: int = 0
    resumed: int = 0
    ended: SessionEnded | None = None
    limit_ms: int | None = None
    last_utc: str = ""
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
                self._note(envelope, record)
            except (msgspec.DecodeError, UnicodeDecodeError):
                self.torn += 1

    def replaced(self) -> bool:
        """Whether the journal is shorter than what was read of it: it is another one."""
        try:
            return (self.home / JOURNAL).stat().st_size < self.offset
        except FileNotFoundError:
            return self.offset > 0

    def status(self, settings: StudySettings, now: datetime) -> SessionStatus:
        """Where the session is at the moment `now`."""
        state = self._state()
        told = self._timed and self.step.phase != "memorise"
        silent_s = self._silent_s(now)
        return SessionStatus(
            participant=self.identity.participant,
            mode=self.identity.mode,
            state=state,
            phase=self.step.phase if self.last_utc else "consent",
            round=self.step.round,
            clock_s=self.progress.exposure_ms / 1000 if told else None,
            limit_s=_limit_s(self.step.phase, settings) if told else None,
            silent_s=silent_s,
            interruptions=self.interruptions,
            resumed=self.resumed,
            problems=tuple(self._problems(state, silent_s)),
        )

    def _note(self, envelope: Envelope, record: _Telling | None) -> None:
        if record is not None:
            self.progress = self.progress.after(envelope, record)
        self.last_utc = envelope.utc
        if envelope.phase != "session":
            self.step = Step(envelope.phase, envelope.round)
        self.ended = record if isinstance(record, SessionEnded) else None
        match record:
            case PhaseStarted(left_ms=left_ms):
                self.limit_ms = left_ms
            case Interruption():
                self.interruptions += 1
            case Resumed():
                self.resumed += 1
            case _:
                pass

    @property
    def _timed(self) -> bool:
        """Whether a timed phase is under way."""
        return self.progress.begun is not None and self.limit_ms is not None

    def _state(self) -> State:
        if self.progress.declined:
            return "declined"
        if self.progress.over:
            return "finished"
        if is_held(self.home):
            return "taking part"
        if self.ended is None:
            return "cut off"
        return "turned away" if self.ended.reason == "turned_away" else "left"

    def _silent_s(self, now: datetime) -> float | None:
        if not self.last_utc:
            return None
        return max(0.0, (now - datetime.fromisoformat(self.last_utc)).total_seconds())

    def _problems(self, state: State, silent_s: float | None) -> list[str]:
        found = [self.trouble] if self.trouble else []
        if self.torn > self.resumed:
            found.append(f"{self.torn} lines of the journal cannot be read")
        if self._tail and state != "taking part":
            found.append(f"the journal ends in {len(self._tail)} torn bytes; they do not count")
        if state == "cut off":
            found.append("its process is gone; the participant may log in again")
        silent = silent_s is not None and silent_s > SILENCE_S
        if state == "taking part" and self._timed and silent:
            found.append(f"silent for {silent_s:.0f} s in a timed phase: a frozen link?")
        return found


def _limit_s(phase: Phase, settings: StudySettings) -> float | None:
    match phase:
        case "label":
            return float(settings.label_seconds)
        case "mission":
            return settings.mission.duration_ms / 1000
        case _:
            return None


class Roll:
    """All sessions of a study, followed."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._watched: dict[Identity, SessionWatch] = {}

    def look(self, settings: StudySettings, now: datetime | None = None) -> list[SessionStatus]:
        """Where everybody is now, in the order of mode and participant.

        Who left before consent is not there: nothing was recorded.
        """
        moment = now or datetime.now(UTC)
        watched = (self._watch(identity, home) for identity, home in self._homes())
        self._watched = {watch.identity: watch for watch in watched}
        for watch in self._watched.values():
            watch.look()
        statuses = [watch.status(settings, moment) for watch in self._watched.values()]
        return [one for one in statuses if one.silent_s is not None or one.state == "taking part"]

    def _homes(self) -> Iterator[tuple[Identity, Path]]:
        for mode in MODES:
            for home in sorted((self.folder / SESSIONS / mode).glob("*/")):
                yield Identity(mode, home.name), home

    def _watch(self, identity: Identity, home: Path) -> SessionWatch:
        """The watch kept so far, unless the journal is another one now."""
        known = self._watched.get(identity)
        if known is None or known.replaced():
            return SessionWatch(identity, home)
        return known

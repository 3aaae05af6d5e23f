"""Replay: a recorded mission at any moment, forwards and backwards.

The mission is played again from its recorded actions; what the coach did comes from its records.
So a journal can be replayed without the coach that made it; verification shows that the coach
would do the same again.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from copy import deepcopy
from typing import NamedTuple

from game.coach.acts import LevelChanged
from game.journal.history import Happening, MissionHistory, building_of, read_history
from game.journal.journal_error import JournalError
from game.journal.reader import Transcript
from game.journal.records import RunRecord
from game.journal.thoughts import Thoughts
from game.world.events import Acted, Expired, Rescued
from game.world.mission import Mission
from game.world.observation import Observation

CHECKPOINT_MS = 10_000


class _Moment(NamedTuple):
    """The state of a replay after `done` records."""

    done: int
    mission: Mission
    thoughts: Thoughts


class Replay:
    """One mission of a journal, seen at `time_ms` of its time: 0 at first.

    Raises JournalError if the journal has no such mission (`number` counts from 0); so does `seek`
    if an action in it cannot be carried out.
    """

    def __init__(self, transcript: Transcript, number: int = 0) -> None:
        recorded = read_history(transcript).missions
        if not 0 <= number < len(recorded):
            raise JournalError(
                f"there is no mission {number + 1}: the journal holds {len(recorded)}",
                place=transcript.source,
                hint="Give a journal that has a mission.",
            )
        self.transcript = transcript
        self.number, self.count = number, len(recorded)
        self.recorded = recorded[number]
        self.started = self.recorded.started
        self.building = building_of(self.started)
        self.duration_ms = self.recorded.until_ms
        self._happened: Sequence[Happening] = self.recorded.happened
        self._due = [happening.record.at_ms for happening in self._happened]
        self._records = tuple(happening.record for happening in self._happened)
        self._now = _Moment(0, Mission(self.building, self.started.settings), Thoughts())
        self._checkpoints = [self._copy(self._now)]
        self.time_ms = 0
        self.seek(0)

    @property
    def thoughts(self) -> Thoughts:
        """What the coach thinks at this moment."""
        return self._now.thoughts

    @property
    def records(self) -> tuple[RunRecord, ...]:
        """Everything that has happened up to and including this moment."""
        return self._records[: self._now.done]

    def so_far(self) -> MissionHistory:
        """The history of the mission up to and including this moment."""
        recorded = self.recorded
        past = MissionHistory(recorded.line, recorded.step, self.started)
        for record in self.records:
            past.note(recorded.line, record)
        return past

    @property
    def highlights(self) -> tuple[Rescued | Expired | LevelChanged, ...]:
        """The rescues, expiries and changes of level of the whole mission, for a timeline."""
        wanted = Rescued | Expired | LevelChanged
        return tuple(record for record in self._records if isinstance(record, wanted))

    def observation(self) -> Observation:
        """What the rescuer saw at this moment, with the instruction on the bar."""
        return self._now.mission.observation(self._now.thoughts.guidance)

    def seek(self, to_ms: int) -> None:
        """Go to `to_ms`, or to the nearer end if that lies outside the recording."""
        to_ms = min(max(0, to_ms), self.duration_ms)
        if to_ms < self.time_ms:
            self._go_back(to_ms)
        end = bisect_right(self._due, to_ms)
        while (next_ms := len(self._checkpoints) * CHECKPOINT_MS) <= to_ms:
            self._play(bisect_right(self._due, next_ms), next_ms)
            self._checkpoints.append(self._copy(self._now))
        self._play(end, to_ms)
        self.time_ms = to_ms

    def _go_back(self, to_ms: int) -> None:
        place = min(to_ms // CHECKPOINT_MS, len(self._checkpoints) - 1)
        self._now = self._copy(self._checkpoints[place])

    def _play(self, end: int, to_ms: int) -> None:
        done, mission, thoughts = self._now
        line = self.recorded.line
        try:
            for happening in self._happened[done:end]:
                line, record = happening
                thoughts = thoughts.after(record)
                if isinstance(record, Acted):
                    mission.step(record.action, record.at_ms, record.pressed_ms)
            mission.step(None, to_ms)
        except ValueError as error:
            raise JournalError(
                f"this action cannot be carried out ({error})",
                place=f"{self.transcript.source}, line {line}",
                hint="Use the original file; `ana verify` says where this one differs.",
            ) from error
        self._now = _Moment(end, mission, thoughts)

    def _copy(self, moment: _Moment) -> _Moment:
        """An independent copy, except for the parts that never change."""
        building = self.building
        shared = {id(building): building, id(building.plan): building.plan}
        return moment._replace(mission=deepcopy(moment.mission, shared))

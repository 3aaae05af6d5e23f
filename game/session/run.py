"""Playing a mission with a coach: pacing, the order of events, and what is recorded.

Times are mission milliseconds and come from the caller: a screen passes its clock, a simulation a
virtual one, a replay the recorded times.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from game.coach.api import Coach
from game.journal.records import RunRecord
from game.world.events import Action, LevelAsked, LevelWish, MissionEvent
from game.world.mission import Due, Mission, Order
from game.world.observation import Observation

Recorder = Callable[[Sequence[RunRecord]], None]


HELD_MS = 80
"""Presses less than this apart come from a key that is held, or from one that corrects another."""
MOST_WAITING = 3


class _Waiting(NamedTuple):
    action: Action
    pressed_ms: int


def waiting_after(
    waiting: tuple[_Waiting, ...], pressed: _Waiting, *, held: bool
) -> tuple[_Waiting, ...]:
    """What waits after another press.

    Single taps queue, so that each is a step. With `held` (the press before was less than `HELD_MS`
    ago) the same move adds nothing to what waits, so that letting go of a key stops the rescuer
    within one move, and another move replaces all of it.
    """
    if held and all(it.action is pressed.action for it in waiting):
        return (*waiting[:-1], pressed)
    return (pressed,) if held else (*waiting[: MOST_WAITING - 1], pressed)


class MissionRun:
    """One mission with its coach.

    `record` receives everything that happens, in order, once per call that makes something happen.
    It must have handed it to the operating system before it returns, because the caller paints
    only after that. Whatever it raises, the call raises.
    """

    def __init__(self, mission: Mission, coach: Coach, record: Recorder) -> None:
        self.mission = mission
        self.coach = coach
        self._record = record
        self._happened: list[RunRecord] = []
        self._next_move_ms = 0
        self._due: Due | None = None
        """What is next due, until something happens."""
        self._waiting: tuple[_Waiting, ...] = ()
        self._pressed_ms: int | None = None

    @property
    def ended(self) -> bool:
        return self.mission.ended

    @property
    def next_due_ms(self) -> int | None:
        """When something happens next without a key press; None once the mission has ended."""
        if self.ended:
            return None
        due_ms = self._next_due().at_ms
        return min(due_ms, self._next_move_ms) if self._waiting else due_ms

    def begin(self) -> None:
        """Let the coach give its first instruction. Call once, at 0 ms."""
        try:
            self._happened += self.coach.begin(self.mission.observation())
            self._due = None
        finally:
            self._hand_over()

    def observation(self) -> Observation:
        return self.mission.observation(self.coach.guidance)

    def press(self, action: Action, now_ms: int) -> None:
        """A key was pressed. A move that comes before the pace allows waits for its time (see
        `waiting_after`); triage acts at once, and what waits is forgotten."""
        try:
            self._advance(now_ms)
            if action is Action.TRIAGE:
                self._waiting = ()
                self._act(action, now_ms, now_ms)
                return
            held = self._pressed_ms is not None and now_ms - self._pressed_ms < HELD_MS
            self._pressed_ms = now_ms
            if now_ms >= self._next_move_ms:
                self._act(action, now_ms, now_ms)
            else:
                self._waiting = waiting_after(self._waiting, _Waiting(action, now_ms), held=held)
        finally:
            self._hand_over()

    def advance(self, now_ms: int) -> None:
        """Make everything happen that is due by `now_ms`, each at its own time."""
        try:
            self._advance(now_ms)
        finally:
            self._hand_over()

    def act(self, action: Action, at_ms: int, pressed_ms: int) -> None:
        """Carry out an action at its recorded time, as a replay does: it was paced already."""
        try:
            self._advance(at_ms)
            self._act(action, at_ms, pressed_ms)
        finally:
            self._hand_over()

    def ask_level(self, want: LevelWish, at_ms: int) -> bool:
        """The rescuer asks the coach for simpler or shorter words: whether others stand on the bar
        then. Raises ValueError where the rules do not allow it."""
        if not self.mission.settings.level_key:
            raise ValueError("the level key is not allowed in this mission")
        try:
            self._advance(at_ms)
            before = self.coach.guidance
            if not self.ended:
                self._tell([LevelAsked(at_ms, want)])
            return self.coach.guidance != before
        finally:
            self._hand_over()

    def _hand_over(self) -> None:
        if self._happened:
            happened, self._happened = self._happened, []
            self._record(happened)

    def _advance(self, now_ms: int) -> None:
        while not self.ended:
            due_ms = self._next_move_ms
            if self._waiting and due_ms <= now_ms:
                self._fire_until(due_ms)
                (action, pressed_ms), *rest = self._waiting
                self._waiting = tuple(rest)
                self._act(action, due_ms, pressed_ms)
            else:
                self._fire_until(now_ms)
                break
        if not self.ended:
            self.mission.pass_time(now_ms)

    def _act(self, action: Action, at_ms: int, pressed_ms: int) -> None:
        if self.ended:
            return
        if action is not Action.TRIAGE:
            self._next_move_ms = at_ms + self.mission.settings.pace_ms
        self._tell(self.mission.step(action, at_ms, pressed_ms))

    def _next_due(self) -> Due:
        if self._due is None:
            due = self.mission.next_due
            assert due is not None
            evaluation_ms = self.coach.next_evaluation_ms
            if evaluation_ms is not None:
                due = min(due, Due(evaluation_ms, Order.EVALUATION))
            self._due = due
        return self._due

    def _fire_until(self, now_ms: int) -> None:
        while not self.ended and (due := self._next_due()).at_ms <= now_ms:
            if due.order is Order.EVALUATION:
                self.mission.pass_time(due.at_ms)
                self._due = None
                self._happened += self.coach.evaluate(due.at_ms, self.mission.observation())
            else:
                self._tell(self.mission.fire_next())

    def _tell(self, events: Iterable[MissionEvent]) -> None:
        self._due = None
        for event in events:
            self._happened.append(event)
            self._happened += self.coach.on_event(event, self.mission.observation())

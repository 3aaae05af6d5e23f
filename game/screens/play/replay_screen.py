"""A recorded mission on the screen, at any moment, with what the coach believed then."""

from __future__ import annotations

import time
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.screen import Screen
from textual.timer import Timer

from game.coach.acts import LevelChanged
from game.errors import AnaError
from game.journal.reader import Transcript
from game.screens.play.coachpanel import CoachPanel, coach_pins
from game.screens.play.mission_screen import Failed
from game.screens.play.mission_story import coach_name
from game.screens.play.missionview import MissionView
from game.screens.widgets.canvas import Canvas, Row
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.statuspanel import clock_text
from game.session.replay import Replay
from game.world.events import Expired, Rescued

SPEEDS = (1, 2, 4, 8, 16)
JUMP_MS = 5_000
FRAME_S = 0.1
"""While playing, the screen follows ten times a second: a replay has no keys to answer."""

MARKS = {LevelChanged: ("◆", "level"), Rescued: ("✓", "rescued"), Expired: ("✗", "expired")}
"""What stands on the time line; of two in one column the later here."""


def mission_title(replay: Replay) -> str:
    """Where the mission was played and with which coach; in a study, in which part of it."""
    recorded = replay.recorded
    entries = replay.transcript.entries
    place = next(entry.envelope for entry in entries if entry.line == recorded.line)
    practice = place.phase == "practice"
    parts = [
        f"round {place.round}" if place.round else "practice" if practice else "",
        replay.building.name,
        f"coach {coach_name(replay.started.coach)}",
        "left early" if recorded.end == "abandoned" and not practice else "",
    ]
    return " · ".join(part for part in parts if part)


def timeline_rows(replay: Replay, columns: int, *, playing: bool, speed: int) -> list[Row]:
    """Where the replay stands, and a line of the whole mission with its events."""
    wide = columns - 2
    full = max(1, replay.duration_ms)

    def column(at_ms: int) -> int:
        return min(wide - 1, (wide - 1) * at_ms // full)

    here = column(replay.time_ms)
    line = [("━", "done") if at <= here else ("─", "faint") for at in range(wide)]
    kinds: list[type] = list(MARKS)
    for record in sorted(replay.highlights, key=lambda record: kinds.index(type(record))):
        line[column(record.at_ms)] = MARKS[type(record)]
    line[here] = line[here][0] if line[here][0] not in "━─" else "┃", "moment"
    state = "▶ playing" if playing else "‖ stopped"
    where = f"  {_at(replay.time_ms)} of {_at(replay.duration_ms)}"
    legend: Row = (
        ("    ✓", "rescued"), (" rescue ", "quiet"), ("✗", "expired"), (" death ", "quiet"),
        ("◆", "level"), (" new level", "quiet"),
    )  # fmt: skip
    return [
        ((f" {mission_title(replay)}", "quiet"),),
        ((f" {state}", "strong"), (where, "quiet"),
         (f"  {speed}x", "strong"), *legend),
        ((" ", ""), *line),
    ]  # fmt: skip


def _at(time_ms: int) -> str:
    """A time since the start, in whole seconds gone."""
    return clock_text(time_ms // 1000 * 1000)


class Timeline(Canvas):
    """The rows under a replay."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "done", "faint", "quiet", "strong", "moment", "rescued", "expired", "level",
    }  # fmt: skip

    def __init__(self) -> None:
        super().__init__([(), (), ()], id="timeline")


class ReplayScreen(Screen[None]):
    """Plays a journal's mission."""

    class Left(Message):
        """The viewer is done."""

    class MissionWanted(Message):
        """Mission `number` of the same journal, counted from 0."""

        def __init__(self, transcript: Transcript, number: int) -> None:
            super().__init__()
            self.transcript = transcript
            self.number = number

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("space,p,P", "play", "Play or stop", id="replay.play"),
        Binding("right,l", "jump(1)", "5 s on", id="replay.on"),
        Binding("left,h", "jump(-1)", "5 s back", id="replay.back"),
        Binding("home,0", "seek(0)", "Start", id="replay.start"),
        Binding("end,G", "seek(1)", "End", id="replay.end"),
        Binding("up,plus,equals_sign,k", "speed(1)", "Faster", id="replay.faster"),
        Binding("down,minus,j", "speed(-1)", "Slower", id="replay.slower"),
        Binding("n,N,full_stop", "event(1)", "Next event", id="replay.next"),
        Binding("b,B,comma", "event(-1)", "Previous event", id="replay.before"),
        Binding("right_square_bracket", "mission(1)", "Next mission", id="replay.mission.next"),
        Binding(
            "left_square_bracket", "mission(-1)", "Previous mission", id="replay.mission.before"
        ),
        Binding("escape,q,Q,ctrl+q,ctrl+c", "leave", "Leave", id="replay.leave"),
    ]

    def __init__(self, replay: Replay) -> None:
        super().__init__()
        self.replay = replay
        self._panel = CoachPanel(replay.building, replay.started.coach)
        self._view = MissionView(replay.started.settings, self._panel)
        self._view.status.deaths = True
        self._timeline = Timeline()
        self._keys = KeyLine(id="keys")
        self._number, self._count = replay.number, replay.count
        self._playing: Timer | None = None
        self._speed = 0
        self._exact_ms = 0.0
        self._since = 0.0

    def compose(self) -> ComposeResult:
        yield self._view
        yield self._timeline
        yield self._keys

    def on_mount(self) -> None:
        self.action_play()

    def on_resize(self) -> None:
        self.call_after_refresh(self._show)

    def on_screen_suspend(self) -> None:
        if self._playing is not None:
            self.action_play()

    def _show(self) -> None:
        replay, playing = self.replay, self._playing is not None
        self._view.show(replay.observation(), coach_pins(replay.thoughts, replay.building))
        self._panel.show(replay.thoughts)
        self._timeline.draw(
            timeline_rows(
                replay,
                self.size.width,
                playing=playing,
                speed=SPEEDS[self._speed],
            )
        )
        several = (("[ ]", f"{self._number + 1}/{self._count}"),) * (self._count > 1)
        self._keys.set_keys(
            ("Space", "stop" if playing else "play"), ("← →", "5 s"), ("N B", "events"),
            ("↑ ↓", "speed"), *several, ("Q", "leave"),
        )  # fmt: skip

    def _go(self, to_ms: float) -> None:
        try:
            self.replay.seek(round(to_ms))
        except AnaError as error:
            self.app.post_message(Failed(error))
            return
        self._exact_ms = self.replay.time_ms
        self._show()

    def _step(self) -> None:
        now = time.monotonic()
        on_ms = (now - self._since) * 1000 * SPEEDS[self._speed]
        self._since = now
        exact_ms = self._exact_ms + on_ms
        self._go(exact_ms)
        self._exact_ms = min(exact_ms, self.replay.duration_ms)
        if self.replay.time_ms >= self.replay.duration_ms:
            self.action_play()

    def action_play(self) -> None:
        if self._playing is not None:
            self._playing.stop()
            self._playing = None
        else:
            if self.replay.time_ms >= self.replay.duration_ms:
                self._go(0)
            self._since = time.monotonic()
            self._playing = self.set_interval(FRAME_S, self._step)
        self._show()

    def action_jump(self, ways: int) -> None:
        self._go(self.replay.time_ms + ways * JUMP_MS)

    def action_seek(self, end: int) -> None:
        self._go(end * self.replay.duration_ms)

    def action_event(self, way: int) -> None:
        """Go to the next highlight, or to the one before."""
        here = self.replay.time_ms
        times = [record.at_ms for record in self.replay.highlights]
        if way > 0:
            self._go(min((at for at in times if at > here), default=self.replay.duration_ms))
        else:
            self._go(max((at for at in times if at < here), default=0))

    def action_speed(self, way: int) -> None:
        self._speed = max(0, min(self._speed + way, len(SPEEDS) - 1))
        self._show()

    def action_mission(self, way: int) -> None:
        """Go to the next mission of the journal, or to the one before, where there is one."""
        number = self._number + way
        if 0 <= number < self._count:
            self.app.post_message(self.MissionWanted(self.replay.transcript, number))

    def action_leave(self) -> None:
        self.app.post_message(self.Left())

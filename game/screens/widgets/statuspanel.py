"""The panel beside the office: clock, rescued, score, heading, treatment, and what to press."""

from __future__ import annotations

from typing import ClassVar

from game.mission_words import ENGLISH, MissionWords, Panel
from game.screens.widgets.canvas import BLANK, Canvas, Row
from game.screens.widgets.glyphs import HEADING_GLYPHS, HEADING_NAMES, SOLID, victim_kind
from game.screens.widgets.office import in_reach
from game.world.building import Severity
from game.world.observation import Observation, VictimState
from game.world.settings import MissionSettings

HURRY_MS = 30_000
"""The last part of a mission, and of the red victims' time, that stands out."""


def clock_text(left_ms: int) -> str:
    """Minutes and seconds left, the second that has begun included."""
    minutes, seconds = divmod(-(-left_ms // 1000), 60)
    return f"{minutes}:{seconds:02}"


def status_rows(
    observation: Observation,
    settings: MissionSettings,
    columns: int,
    *,
    timed: bool = True,
    deaths: bool = False,
    words: MissionWords = ENGLISH,
) -> list[Row]:
    """The panel's lines, `columns` wide; the clock is blank where time does not matter. `deaths`
    says how many red victims died, in English, rather than that their time is over."""
    panel = words.panel
    return [
        _clock(observation, panel) if timed else BLANK,
        _time_bar(observation, settings, columns) if timed else BLANK,
        _counts(observation, panel),
        _reds(observation, settings, panel, deaths=deaths) if timed else BLANK,
        _facing(observation, words),
        _doing(observation, columns, words),
    ]


def _clock(observation: Observation, panel: Panel) -> Row:
    left = observation.time_left_ms
    text = f" {clock_text(left)} "
    if left <= HURRY_MS:
        return (text, "hurry"), (f" {panel.left}", "strong")
    return (text, "clock"), (f" {panel.left}", "quiet")


def _time_bar(observation: Observation, settings: MissionSettings, columns: int) -> Row:
    spent = columns * observation.time_ms // settings.duration_ms
    reds_end = columns * min(settings.reds_expire_ms, settings.duration_ms) // settings.duration_ms
    red = max(0, reds_end - spent)
    return (
        ("─" * spent, "faint"),
        ("━" * red, "red-time"),
        ("━" * (columns - spent - red), "time"),
    )


def _counts(observation: Observation, panel: Panel) -> Row:
    count = panel.rescued.replace("{count}", str(observation.rescued))
    rescued: Row = (("✓ ", "rescued"), (count, "strong"))
    if observation.score is None:
        return rescued
    points = panel.points.replace("{count}", str(observation.score))
    return (*rescued, (f"  {points}", "quiet"))


def _reds(
    observation: Observation, settings: MissionSettings, panel: Panel, *, deaths: bool
) -> Row:
    left = min(settings.reds_expire_ms, settings.duration_ms) - observation.time_ms
    red = SOLID[victim_kind(Severity.RED, VictimState.WAITING)].text
    if left <= 0 and deaths:
        lost = observation.lost
        return (red, "seen-red"), (f" {lost or 'none'} died", "strong" if lost else "quiet")
    if left <= 0:
        return (red, "seen-red"), (f" {panel.out_of_time}", "faint")
    style = "hurry" if left <= HURRY_MS else "quiet"
    time = panel.for_reds.replace("{time}", clock_text(left))
    return (red, "red"), (" ", "quiet"), (time, style)


def _facing(observation: Observation, words: MissionWords) -> Row:
    heading = observation.heading
    direction: str = getattr(words.directions, HEADING_NAMES[heading])
    facing = words.panel.facing.replace("{direction}", direction)
    return (HEADING_GLYPHS[heading], "player"), (f" {facing}", "quiet")


def _doing(observation: Observation, columns: int, words: MissionWords) -> Row:
    treatment = observation.treatment
    if treatment is not None:
        mark = SOLID[victim_kind(treatment.severity, VictimState.WAITING)]
        wide = columns - 6
        done = wide * treatment.done_ms // max(1, treatment.total_ms)
        return (
            (mark.text, mark.style),
            (" ", "quiet"),
            ("█" * done, "progress"),
            ("░" * (wide - done), "faint"),
        )
    if in_reach(observation) is not None:
        return (f" {words.keys.space} ", "key"), (f" {words.panel.treats}", "strong")
    if _nearly_in_reach(observation):
        return ((words.panel.stand_beside, "quiet"),)
    return ()


def _nearly_in_reach(observation: Observation) -> bool:
    """Whether a waiting victim in view is two steps away, as one at a corner is."""
    x, y = observation.position
    return any(
        victim.state is VictimState.WAITING
        and abs(victim.cell[0] - x) + abs(victim.cell[1] - y) <= 2
        for victim in observation.victims
    )


def next_change_ms(observation: Observation, columns: int) -> int:
    """The mission time at which the panel next looks different, if nothing else happens."""
    second = observation.time_left_ms % 1000 or 1000
    changes = [observation.time_ms + second]
    treatment = observation.treatment
    if treatment is not None:
        wide = columns - 6
        done = wide * treatment.done_ms // max(1, treatment.total_ms) + 1
        due = -(-done * treatment.total_ms // wide)
        changes.append(observation.time_ms - treatment.done_ms + due)
    return min(changes)


class StatusPanel(Canvas):
    """Shows the numbers of an Observation."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "clock", "hurry", "quiet", "strong", "faint", "red-time", "time", "rescued", "red", "blue",
        "seen-red", "player", "progress", "key",
    }  # fmt: skip

    def __init__(self, settings: MissionSettings, words: MissionWords = ENGLISH) -> None:
        super().__init__(id="status")
        self.timed = True
        self.deaths = False
        self._settings = settings
        self._words = words
        self._observation: Observation | None = None

    def show(self, observation: Observation) -> None:
        """Draw the numbers of now."""
        self._observation = observation
        rows = status_rows(
            observation,
            self._settings,
            self.size.width,
            timed=self.timed,
            deaths=self.deaths,
            words=self._words,
        )
        if self.size.height == 1:
            rows = [(*rows[0], ("   ", "quiet"), *rows[2])]
        self.draw(rows)

    def on_resize(self) -> None:
        if self._observation is not None:
            self.show(self._observation)

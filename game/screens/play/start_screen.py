"""Before a mission of free play: what it is about, with the clock still stopped."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.message import Message
from textual.screen import Screen

from game.coach.spec import CoachSpec
from game.screens.play.mission_story import coach_name
from game.screens.widgets.canvas import BLANK, Canvas, Row, wrapped
from game.screens.widgets.dialogs import Help
from game.screens.widgets.glyphs import PLAIN, SOLID, STYLES, GlyphSet, Kind
from game.screens.widgets.howto import HasKeys, example_of, red_time, walking_rows
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.keymap import USUAL_KEYS, KeyMap
from game.screens.widgets.statuspanel import clock_text
from game.world.building import Building, Severity
from game.world.settings import MissionSettings

WIDEST = 76
"""Columns of the card where the window has more."""
_COACHES = {
    "ana": "ana says more or less, as you seem lost or seem to know your way.",
    "knowledge": "knowledge names a room to find out whether you know it, and leads you step by "
    "step where you do not.",
    "pace": "pace plans the way for how fast you walk.",
    "static C1": "This coach tells you every step.",
    "static C2": "This coach tells you which doors and hallways you pass.",
    "static C3": "This coach only names rooms: it helps to know the map.",
}
_FIRST = {"ana": 2, "knowledge": 3}
"""The level at which coaches that adapt usually begin."""


def card_rows(
    building: Building,
    rules: MissionSettings,
    spec: CoachSpec,
    about: str,
    glyphs: GlyphSet,
    columns: int,
    keys: KeyMap = USUAL_KEYS,
) -> list[Row]:
    """The card, `columns` wide: who is to be found, what the bar is, the keys."""
    reds = sum(site.severity is Severity.RED for site in building.victims)
    blues = len(building.victims) - reds
    time = clock_text(rules.duration_ms)
    coach = _COACHES.get(coach_name(spec), "")
    bar = f"The yellow bar at the top tells you where to go. {coach}".strip()
    example = example_of(spec.level or _FIRST.get(spec.kind, 1))
    return [
        ((building.name, "title"), (f"   {about}", "quiet")),
        ((f"{reds + blues} people are hurt. You have {time} to find and treat them.", "strong"),),
        BLANK,
        (glyphs[Kind.RED], (f"  {reds} red: dies unless treated {red_time(rules)}", "")),
        (glyphs[Kind.BLUE], (f"  {blues} blue: can wait until the end", "")),
        BLANK,
        *(((line, ""),) for line in wrapped(bar, columns)),
        (("It may say, for example:  ", "quiet"), (f" {example} ", "example")),
        BLANK,
        *walking_rows(turning=rules.controls == "turn", keys=keys),
        (("  ", ""), (f" {keys.label('help'):^7} ", "key"), ("  help", "")),
        BLANK,
        (("The clock has not started. ", "quiet"), ("Press any key to start.", "strong")),
    ]


class StartCard(Canvas):
    """The card as a widget."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {*STYLES, "title", "key", "quiet", "strong", "example"}

    def __init__(
        self, building: Building, rules: MissionSettings, spec: CoachSpec, about: str
    ) -> None:
        super().__init__()
        self._mission = building, rules, spec, about

    def on_resize(self, event: events.Resize) -> None:
        glyphs = PLAIN if self.app.native_ansi_color else SOLID
        keys = self.app.keys if isinstance(self.app, HasKeys) else USUAL_KEYS
        self.draw(card_rows(*self._mission, glyphs, min(WIDEST, event.size.width), keys))


class StartScreen(Screen[None]):
    """The card as a screen: any key that has no other meaning starts the mission."""

    class Wanted(Message):
        """`start` the mission, or back `home`."""

        def __init__(self, what: str, begin: Callable[[], None]) -> None:
            super().__init__()
            self.what = what
            self.begin = begin

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("question_mark,f1", "help", "Help", id="start.help"),
        Binding("escape,q,Q,ctrl+q,ctrl+c", "want('home')", "Back", id="start.back"),
    ]

    def __init__(
        self,
        building: Building,
        rules: MissionSettings,
        spec: CoachSpec,
        begin: Callable[[], None],
        about: str = "",
    ) -> None:
        super().__init__()
        self._rules = rules
        self._begin = begin
        self._card = StartCard(building, rules, spec, about)

    def compose(self) -> ComposeResult:
        with VerticalScroll(classes="card", can_focus=False):
            yield self._card
        yield KeyLine(("any key", "start"), ("?", "help"), ("Q", "back"), id="keys")

    def on_key(self, event: events.Key) -> None:
        if event.key not in self.active_bindings:
            event.stop()
            self.action_want("start")

    def action_want(self, what: str) -> None:
        self.app.post_message(self.Wanted(what, self._begin))

    def action_help(self) -> None:
        self.app.push_screen(Help(self._rules, key="Back"))

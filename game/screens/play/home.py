"""The home screen: a title, and what there is to do. Enter starts a mission."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any, ClassVar, get_args

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.message import Message
from textual.screen import Screen
from textual.timer import Timer

from game.coach.spec import CoachSpec, parse_coach
from game.journal.folders import newest_journals
from game.screens.play.menu import Item, after, menu_rows
from game.screens.play.mission_story import coach_name
from game.screens.play.past_missions import (
    MissionKind,
    PastMission,
    best,
    difficulty,
    of_kind,
    past_missions,
)
from game.screens.widgets.aside import aside
from game.screens.widgets.canvas import BLANK, Canvas, Row, centred, width
from game.screens.widgets.glyphs import PLAIN, SOLID, STYLES, GlyphSet, Kind
from game.screens.widgets.pointing import ClickCanvas, Pointed, RowClicked
from game.screens.widgets.preferences import Preferences
from game.world import load_building
from game.world.library import GENERATED
from game.world.settings import MissionSettings
from game.world.variant import Difficulty

_LETTERS = (
    "▄▀▀▀▄  █▄  █  ▄▀▀▀▄",
    "█▄▄▄█  █ █ █  █▄▄▄█",
    "█   █  █  ▀█  █   █",
)
_BELOW_ROWS = 1
_SUBTITLE = "Find the people who lie hurt in this office. A coach tells you where to go."
_SCENE = (
    "#################+#################",
    "#...............................R.#",
    "+..@..............B...............+",
    "#.................................#",
    "#############+#####################",
)
_SCENE_KINDS = {
    "#": Kind.WALL,
    "+": Kind.DOOR,
    ".": Kind.FLOOR,
    "R": Kind.RED,
    "B": Kind.BLUE,
    "@": Kind.PLAYER_EAST,
}
BUILDINGS = ("harbour", "foundry", "practice", GENERATED)
VICTIMS = {"drawn": "in their usual places", "seeded": "in new places each time"}
CONTROLS = {"compass": "arrows walk up, down, left, right", "turn": "← → turn, ↑ walks ahead"}
DWELL_S = 1.0
"""How long a choice has stood before it is looked at what a literal reader reaches."""
MOST_DIGITS = 9
"""Of a seed that is typed."""
COACHES = (
    ("ana", "ana: words as simple as you need"),
    ("knowledge", "knowledge: learns what you know"),
    ("static-1", "always step by step (C1)"),
    ("static-2", "always doors and hallways (C2)"),
    ("static-3", "always room names (C3)"),
)
MEMORISING = ((0, "no"), (60, "first, for one minute"), (180, "first, for three minutes"))


def scene_rows(glyphs: GlyphSet) -> list[Row]:
    """A little office under the title, drawn as the mission draws it."""
    return [tuple(glyphs[_SCENE_KINDS[mark]] for mark in line) for line in _SCENE]


@cache
def _building_name(name: str) -> str:
    return "another office each time" if name == GENERATED else load_building(name).name


def menu_items(preferences: Preferences, reached: str = "", seed: str = "") -> tuple[Item, ...]:
    """The lines of the menu, in order; `reached` is what was reached before in such a mission, and
    `seed` what was typed."""
    return (
        Item("play", "Play", note=reached),
        Item("building", "  in building", _building_name(preferences.building)),
        Item("coach", "  with coach", dict(COACHES)[preferences.coach]),
        Item("victims", "  people are", VICTIMS[preferences.victims]),
        Item("difficulty", "  difficulty", preferences.difficulty),
        Item("controls", "  controls", CONTROLS[preferences.controls]),
        Item("memorise", "  study the map", dict(MEMORISING)[preferences.memorise]),
        Item("seed", "  seed", note=f"{seed}▏" if seed else "a new one; type one to play it again"),
        Item("today", "Mission of the day"),
        Item("tutorial", "Tutorial, three minutes"),
        Item("howto", "How to play"),
        Item("watch", "Watch a simulated rescuer"),
        Item("replay", "Your missions"),
        Item("settings", "Settings"),
        Item("quit", "Quit"),
    )


def spec_of(coach: str) -> CoachSpec:
    """The coach that a preference names."""
    kind, _, level = coach.partition("-")
    return parse_coach(kind, int(level) if level else None)


def _reader_of(chosen: Preferences, rules: MissionSettings) -> int | None:
    """What a literal reader reaches in the mission that is chosen."""
    from game.screens.play.benchmark import literal_rescues

    return literal_rescues(load_building(chosen.building), rules, spec_of(chosen.coach), 1)


class HomePage(ClickCanvas):
    """Title, scene and menu."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {*STYLES, "letters", "subtitle", "item", "selected"}

    def __init__(self) -> None:
        super().__init__(id="home")
        self._items: Sequence[Item] = ()
        self._selected = 0

    def show(self, items: Sequence[Item], selected: int) -> None:
        """Draw the menu with one line selected."""
        self._items, self._selected = items, selected
        glyphs = PLAIN if self.app.native_ansi_color else SOLID
        columns = self.size.width
        title: list[Row] = [
            *(((line, "letters"),) for line in _LETTERS),
            ((_SUBTITLE, "subtitle"),),
        ]
        scene, menu = [BLANK, *scene_rows(glyphs)], [BLANK, *menu_rows(items, selected)]
        room = self.app.size.height - _BELOW_ROWS
        fits = len(title) + len(scene) + len(menu) <= room
        block = [*title, *(scene if fits else ()), *menu]
        self.draw([centred(row, columns) if width(row) else row for row in block])

    def item_at(self, row: int) -> int | None:
        """The menu's item in a row of the page."""
        number = row - (len(self.rows) - len(self._items))
        return number if number >= 0 else None

    def on_resize(self) -> None:
        self.show(self._items, self._selected)


class HomeScreen(Pointed, Screen[None]):
    """Lets one choose what to do; the app does it."""

    class Wanted(Message):
        """`what` is the action of a menu item, chosen on `sender`."""

        def __init__(self, what: str, sender: HomeScreen) -> None:
            super().__init__()
            self.what = what
            self.sender = sender

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,k,w,shift+tab", "move(-1)", id="home.up"),
        Binding("down,j,s,tab", "move(1)", id="home.down"),
        Binding("left,h,a", "change(-1)", id="home.left"),
        Binding("right,l,d", "change(1)", id="home.right"),
        Binding("enter,space", "choose", id="home.choose"),
        *(
            Binding(str(digit), f"digit('{digit}')", id=f"home.digit.{digit}")
            for digit in range(10)
        ),
        Binding("backspace,delete", "rub_out", id="home.rub_out"),
        Binding("question_mark,f1", "want('howto')", id="home.howto"),
        Binding("p,P", "want('play')", id="home.play"),
        Binding("r,R", "want('replay')", id="home.replay"),
        Binding("t,T", "want('theme')", id="home.theme"),
        Binding("q,Q,escape,ctrl+q,ctrl+c", "want('quit')", id="home.quit"),
    ]

    def __init__(
        self,
        preferences: Preferences,
        log_dir: Path,
        rules: Callable[[Difficulty], MissionSettings],
    ) -> None:
        super().__init__()
        self.preferences = preferences
        self._log_dir = log_dir
        self._rules = rules
        self._past: tuple[PastMission, ...] = ()
        self._readers: dict[MissionKind, int | None] = {}
        self._dwelling: Timer | None = None
        self.seed = ""
        """Digits, where a seed was typed."""
        self._page = HomePage()
        self._selected = 0

    def compose(self) -> ComposeResult:
        with Vertical(id="home-ground"):
            yield self._page
        hint = " ↑ ↓ choose · ← → change · Enter start · F2 settings · ? help · Q quit"
        yield Canvas([((hint, ""),)], id="hint")

    def on_mount(self) -> None:
        self._show()
        self._dwell()
        aside(self, lambda: past_missions(newest_journals(self._log_dir)), self._have_read)

    def _have_read(self, past: tuple[PastMission, ...]) -> None:
        self._past = past
        self._show()

    def prefer(self, preferences: Preferences) -> None:
        """Show other preferences."""
        self.preferences = preferences
        self._show()

    def _show(self) -> None:
        self._page.show(self._items(), self._selected)

    def _items(self) -> tuple[Item, ...]:
        return menu_items(self.preferences, self._reached(), self.seed)

    def _kind(self) -> MissionKind:
        """Building, coach and difficulty of such a mission as is chosen."""
        chosen, named = self.preferences, self.preferences.difficulty
        coach = coach_name(spec_of(chosen.coach))
        return _building_name(chosen.building), coach, difficulty(self._rules(named), named)

    def _reached(self) -> str:
        """The best and the latest result of such a mission, and what a literal reader reaches."""
        kind = self._kind()
        such = of_kind(self._past, kind)
        top, reader = best(such), self._readers.get(kind)
        told = []
        if top is not None:
            latest = max(such, key=lambda it: it.at)
            told.append(f"best {top.rescued}, last time {latest.rescued}")
        if reader is not None:
            told.append(f"doing all that the coach says: {reader}")
        return "; ".join(told)

    def _dwell(self) -> None:
        """Ask a literal reader once the choice has stood for a moment."""
        if self._dwelling is not None:
            self._dwelling.stop()
        self._dwelling = self.set_timer(DWELL_S, self._ask_reader)

    def _ask_reader(self) -> None:
        chosen, kind = self.preferences, self._kind()
        usual = chosen.victims == "drawn" and chosen.difficulty == "standard"
        if kind in self._readers or chosen.building == GENERATED or not usual:
            return
        self._readers[kind] = None
        rules = self._rules(chosen.difficulty)
        aside(self, lambda: (kind, _reader_of(chosen, rules)), self._have_asked)

    def _have_asked(self, told: tuple[MissionKind, int | None]) -> None:
        kind, self._readers[kind] = told[0], told[1]
        self._show()

    def on_row_clicked(self, message: RowClicked) -> None:
        number = self._page.item_at(message.row)
        if number is not None:
            self._selected = number
            self._show()
            self.action_choose()

    def action_move(self, way: int) -> None:
        self._selected = (self._selected + way) % len(self._items())
        self._show()

    def action_change(self, way: int) -> None:
        item = self._items()[self._selected].action
        if item in _CHOICES:
            wanted = after(_CHOICES[item], getattr(self.preferences, item), way)
            self.preferences = self.preferences.replaced(**{item: wanted})
            self._dwell()
        self._show()

    def action_digit(self, digit: str) -> None:
        """Type a digit of the seed."""
        if len(self.seed) < MOST_DIGITS:
            self.seed += digit
        self._select("seed")

    def action_rub_out(self) -> None:
        self.seed = self.seed[:-1]
        self._select("seed")

    def _select(self, action: str) -> None:
        self._selected = [item.action for item in self._items()].index(action)
        self._show()

    def action_choose(self) -> None:
        item = self._items()[self._selected]
        if item.choice:
            self.action_change(1)
        elif item.action == "seed":
            self.action_want("play")
        else:
            self.action_want(item.action)

    def action_want(self, what: str) -> None:
        self.app.post_message(self.Wanted(what, self))


_CHOICES: dict[str, Sequence[Any]] = {
    "building": BUILDINGS,
    "victims": list(VICTIMS),
    "difficulty": get_args(Difficulty),
    "controls": list(CONTROLS),
    "coach": [name for name, _ in COACHES],
    "memorise": [seconds for seconds, _ in MEMORISING],
}
"""What can be chosen, by the menu's item and the preference of the same name."""

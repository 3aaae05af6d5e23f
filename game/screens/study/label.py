"""Labelling: each room of the plan gets a name from the list."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical

from game.screens.study.base import Frame, StudyScreen
from game.screens.widgets.canvas import BLANK, Canvas, Row, padded
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.planmap import PlanMap
from game.screens.widgets.timed import TICK_S, TimeLine
from game.study.protocol.tasks import Labelling
from game.world.building import Room

USED = "✓"


def matching(names: Sequence[str], typed: str) -> tuple[str, ...]:
    """The names that hold what was typed, those beginning with it first."""
    wanted = typed.casefold()
    found = [name for name in names if wanted in name.casefold()]
    return tuple(sorted(found, key=lambda name: not name.casefold().startswith(wanted)))


class NameList(Canvas):
    """What was typed, the names, and at the end the line that finishes."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"item", "used", "selected", "typed", "quiet"}

    def __init__(self, finish: str) -> None:
        super().__init__(classes="names")
        self._finish = finish

    def show(
        self, typed: str, names: Sequence[str], used: Sequence[str], cursor: int, place: str
    ) -> None:
        """Draw the list; `cursor` counts the names, and then the last line."""
        columns = self.size.width
        rows: list[Row] = [((place, "quiet"),), ((f"› {typed}▏" if typed else " ", "typed"),)]
        for number, name in enumerate(names):
            mark = USED if name in used else " "
            style = "selected" if number == cursor else "used" if name in used else "item"
            rows.append(padded(((f" {mark} {name} ", style),), columns, style))
        style = "selected" if cursor == len(names) else "item"
        self.draw([*rows, BLANK, padded(((f" » {self._finish} ", style),), columns, style)])


class LabelScreen(StudyScreen[bool]):
    """Asks about one room after another, in any order the participant likes."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up", "move(-1)", id="label.up"),
        Binding("down", "move(1)", id="label.down"),
        Binding("left,shift+tab", "turn(-1)", id="label.previous"),
        Binding("right,tab", "turn(1)", id="label.next"),
        Binding("enter", "give", id="label.give"),
        Binding("delete", "take_back", id="label.take_back"),
        Binding("backspace", "rub_out", id="label.rub_out"),
        Binding("escape", "clear", id="label.clear"),
    ]
    DEAF_S = 0.3

    def __init__(self, frame: Frame, title: str, labelling: Labelling) -> None:
        words = frame.words
        line = TimeLine(title, words.left, labelling.exposure.limit_ms)
        plan = PlanMap(labelling.building)
        names = NameList(words.finish)
        keys = KeyLine(
            ("↑ ↓", words.choose),
            (frame.keys.enter, words.answer),
            ("← →", words.next),
            (frame.keys.letters, words.filter),
            (frame.keys.delete, words.clear),
            id="keys",
        )
        columns = Horizontal(plan, Vertical(names, classes="name-column"), classes="side-by-side")
        super().__init__(frame, [line, columns, keys])
        self.labelling = labelling
        self._asked = 0
        self._typed = ""
        self._cursor = 0
        self._line = line
        self._map = plan
        self._names = names

    @property
    def room(self) -> Room:
        """The room asked about."""
        return self.labelling.rooms[self._asked]

    def cover(self) -> str:
        self.labelling.exposure.cover()
        return self.frame.words.clock_stopped

    def uncover(self) -> None:
        self.labelling.exposure.uncover()

    def on_mount(self) -> None:
        rooms, given = self.labelling.rooms, self.labelling.given
        self._asked = next((n for n, room in enumerate(rooms) if room.name not in given), 0)
        self.call_after_refresh(self._begin)

    def _begin(self) -> None:
        self.labelling.exposure.begin()
        self._ask()
        self._tick()
        self.set_interval(TICK_S, self._tick)

    def _tick(self) -> None:
        with self.kept():
            self.labelling.exposure.tick()
            self._line.show(self.labelling.exposure.left_ms)
            if self.labelling.exposure.over:
                self.finish(True)

    def _ask(self) -> None:
        """Show the room now asked about, with the cursor on its name or the first unused one."""
        self.labelling.show(self.room)
        self._typed = ""
        given = self.labelling.given
        names = self._found
        own = given.get(self.room.name)
        used = given.values()
        if own is not None:
            self._cursor = names.index(own)
        else:
            self._cursor = next((n for n, name in enumerate(names) if name not in used), len(names))
        self._show()

    @property
    def _found(self) -> tuple[str, ...]:
        return matching(self.labelling.names, self._typed)

    def _show(self) -> None:
        self._map.name_rooms(self.labelling.given, self.room)
        self._show_names()

    def _show_names(self) -> None:
        given, count = self.labelling.given, len(self.labelling.rooms)
        place = f" {self._asked + 1} / {count}   {USED} {len(given)}"
        self._names.show(self._typed, self._found, tuple(given.values()), self._cursor, place)

    def action_move(self, way: int) -> None:
        self._cursor = (self._cursor + way) % (len(self._found) + 1)
        self._show_names()

    def action_turn(self, way: int) -> None:
        self._asked = (self._asked + way) % len(self.labelling.rooms)
        self._ask()

    async def action_give(self) -> None:
        found = self._found
        if self._cursor == len(found):
            self._ask_to_finish()
            return
        with self.kept():
            await self.labelling.give(self.room, found[self._cursor])
            self._go_on()

    def _go_on(self) -> None:
        """To the next room without a name; to the last line when there is none."""
        count = len(self.labelling.rooms)
        following = [(self._asked + step) % count for step in range(1, count)]
        given = self.labelling.given
        open_rooms = [n for n in following if self.labelling.rooms[n].name not in given]
        if open_rooms:
            self._asked = open_rooms[0]
            self._ask()
        else:
            self._typed = ""
            self._cursor = len(self.labelling.names)
            self._show()

    async def action_take_back(self) -> None:
        if self.room.name in self.labelling.given:
            with self.kept():
                await self.labelling.give(self.room, None)
                self._ask()

    def action_rub_out(self) -> None:
        self._type(self._typed[:-1])

    def action_clear(self) -> None:
        self._type("")

    def on_key(self, event: events.Key) -> None:
        """A letter waits its turn among the keys that the app carries out."""
        letter = event.character
        if letter and letter.isprintable() and self.check_action("type", ()):
            self.app.call_later(self._add, letter)
            event.stop()

    def _add(self, letter: str) -> None:
        self._type((self._typed + letter).lstrip())

    def _type(self, typed: str) -> None:
        self._typed = typed
        self._cursor = 0
        self._show_names()

    def _ask_to_finish(self) -> None:
        unnamed = len(self.labelling.rooms) - len(self.labelling.given)
        self.app.push_screen(self.frame.finish_question(unnamed), self._finished)

    def _finished(self, sure: bool | None) -> None:
        if sure:
            self.finish(True)

"""Small windows over a screen: questions, help, and messages."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical, VerticalScroll
from textual.screen import ModalScreen
from textual.widgets import Static

from game.mission_words import ENGLISH, KeyNames
from game.screens.widgets.canvas import BLANK, Canvas, Row
from game.screens.widgets.howto import HowTo
from game.screens.widgets.keyline import KeyLine
from game.world.settings import MissionSettings

LEAST_SIZE = (80, 24)
"""Columns and rows below which nothing useful can be shown."""


class Answers(Canvas):
    """Two answers, each with its key; one may be chosen."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"key", "answer", "chosen", "quiet"}

    def __init__(self, yes: str, no: str, keys: KeyNames = ENGLISH.keys) -> None:
        super().__init__()
        self._enter = keys.enter
        self._answers = (keys.yes, yes), (keys.no, no)
        self.chosen: int | None = None
        self._draw()

    def move(self, way: int) -> None:
        """Choose the other answer; at first, the first or the last."""
        before = self.chosen if self.chosen is not None else (-1 if way > 0 else 2)
        self.chosen = max(0, min(1, before + way))
        self._draw()

    def _draw(self) -> None:
        rows: list[Row] = []
        for number, (key, answer) in enumerate(self._answers):
            picked = number == self.chosen
            mark, style = ("▸ ", "chosen") if picked else ("  ", "answer")
            rows.append((("  ", ""), (f" {key} ", "key"), (f" {mark}{answer} ", style)))
        self.draw([*rows, BLANK, (("  ", ""), (f"↑ ↓   {self._enter}", "quiet"))])


class Question(ModalScreen[bool]):
    """Asks something that is answered by y or n, or by Enter on a chosen answer, as on keyboards
    without these letters; Escape is no."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("y,Y", "answer(True)", id="question.yes"),
        Binding("n,N,escape,q,Q,ctrl+q,ctrl+c", "answer(False)", id="question.no"),
        Binding("up,left,shift+tab", "move(-1)", id="question.up", priority=True),
        Binding("down,right,tab", "move(1)", id="question.down", priority=True),
        Binding("enter", "take", id="question.take", priority=True),
    ]

    def __init__(
        self,
        title: str,
        text: str,
        *,
        yes: str = "Yes",
        no: str = "No",
        keys: KeyNames = ENGLISH.keys,
    ) -> None:
        super().__init__()
        self._title, self._text, self._keys = title, text, keys
        self._answers = Answers(yes, no, keys)

    def compose(self) -> ComposeResult:
        with Vertical(classes="dialog"):
            yield Static(self._title, classes="title", markup=False)
            yield Static(self._text, markup=False)
            yield self._answers

    def on_key(self, event: events.Key) -> None:
        """The letters of another language."""
        letters = {self._keys.yes.casefold(): True, self._keys.no.casefold(): False}
        answer = letters.get((event.character or "").casefold())
        if answer is not None:
            event.stop()
            self.dismiss(answer)

    def action_answer(self, answer: bool) -> None:
        self.dismiss(answer)

    def action_move(self, way: int) -> None:
        self._answers.move(way)

    def action_take(self) -> None:
        if self._answers.chosen is not None:
            self.dismiss(self._answers.chosen == 0)


class Notice(ModalScreen[None]):
    """Says something until a key closes it."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter,escape,space,q,Q", "close", id="notice.close"),
        Binding("ctrl+q,ctrl+c", "close", id="notice.close.ctrl"),
    ]

    def __init__(self, title: str, text: str, *, key: str = "OK", wide: bool = False) -> None:
        super().__init__()
        self._title, self._text, self._key = title, text, key
        self._wide = wide

    def compose(self) -> ComposeResult:
        with Vertical(classes="dialog broad" if self._wide else "dialog"):
            yield Static(self._title, classes="title", markup=False)
            yield Static(self._text, markup=False)
            yield KeyLine(("Enter", self._key))

    def action_close(self) -> None:
        self.dismiss()


def leave_question() -> Question:
    """What is asked before a mission is left."""
    text = "It ends here. What happened so far is saved."
    return Question("Leave the mission?", text, yes="Leave", no="Stay")


class Pause(ModalScreen[bool]):
    """Covers a mission while its clock is stopped; the answer says whether to leave it."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter,escape,space,p,P", "go_on", id="pause.go_on"),
        Binding("question_mark,f1", "help", id="pause.help"),
        Binding("q,Q,ctrl+q,ctrl+c", "leave", id="pause.leave"),
    ]

    def __init__(self, help_window: Callable[[], Help]) -> None:
        super().__init__()
        self._help = help_window

    def compose(self) -> ComposeResult:
        with Vertical(classes="dialog"):
            yield Static("Paused", classes="title", markup=False)
            yield Static("The clock is stopped.", markup=False)
            yield KeyLine(("P", "Resume"), ("?", "Help"), ("Q", "Leave"))

    def action_go_on(self) -> None:
        self.dismiss(False)

    def action_help(self) -> None:
        self.app.push_screen(self._help())

    def action_leave(self) -> None:
        self.app.push_screen(leave_question(), self._answered)

    def _answered(self, leave: bool | None) -> None:
        if leave:
            self.dismiss(True)


class Help(ModalScreen[None]):
    """How to play, over a mission or another screen."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("question_mark,escape,enter,q,Q,space", "close", id="help.close"),
        Binding("ctrl+q,ctrl+c", "close", id="help.close.ctrl"),
    ]

    def __init__(self, rules: MissionSettings, *, key: str = "Back to the mission") -> None:
        super().__init__()
        self._rules = rules
        self._key = key

    def compose(self) -> ComposeResult:
        with Vertical(classes="dialog wide"):
            with VerticalScroll():
                yield HowTo(self._rules)
            yield KeyLine(("Enter", self._key))

    def action_close(self) -> None:
        self.dismiss()


class TooSmall(ModalScreen[None]):
    """Covers everything while the terminal is too small, and goes when it is large enough."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("q,Q,ctrl+q,ctrl+c", "app.leave_now", id="small.quit", priority=True),
    ]

    def __init__(self) -> None:
        super().__init__()
        self._text = Static(markup=False)

    def compose(self) -> ComposeResult:
        yield self._text

    def on_resize(self, event: events.Resize) -> None:
        columns, rows = LEAST_SIZE
        size = event.size
        self._text.update(
            f"The window is too small: {size.width} x {size.height}.\n"
            f"ana needs {columns} x {rows}.\n\n"
            "Make it larger or reduce the font size to continue. Q or Ctrl+C quits."
        )

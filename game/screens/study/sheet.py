"""A page of questions: all of them at once, gone through up and down."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Protocol

from game.screens.study.base import Frame, StudyScreen, TextColumn
from game.screens.widgets.canvas import BLANK, Canvas, Row
from game.screens.widgets.keyline import KeyLine
from game.study.protocol.tasks import Asked, Sheet
from game.study.texts import Page


class QuestionRows(Protocol):
    """Draws a question with its answer so far, `columns` wide; the keys are for the `active` one.
    Every answer takes as many rows."""

    def __call__(
        self, asked: Asked, value: int | None, columns: int, /, *, active: bool
    ) -> list[Row]: ...


class Questions(Canvas):
    """The questions of a page, one below the other."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "text", "active", "quiet", "option", "chosen", "knob", "set", "faint",
    }  # fmt: skip

    def __init__(self, asked: Sequence[Asked], question_rows: QuestionRows) -> None:
        super().__init__()
        self._asked = asked
        self._question_rows = question_rows
        self.show([None] * len(asked), 0)

    def show(self, values: Sequence[int | None], active: int) -> None:
        """Draw the questions with the answers given so far."""
        rows: list[Row] = []
        for number, (asked, value) in enumerate(zip(self._asked, values, strict=True)):
            rows += self._question_rows(asked, value, self.size.width, active=number == active)
            rows += [BLANK, BLANK]
        self.draw(rows)


class SheetScreen(StudyScreen[bool]):
    """Goes on when every question has its answer."""

    def __init__(
        self,
        frame: Frame,
        page: Page,
        sheet: Sheet,
        question_rows: QuestionRows,
        *keys: tuple[str, str],
    ) -> None:
        """`keys` give answers; the first of them is named to the end."""
        questions = Questions(sheet.asked, question_rows)
        turn = "↑ ↓", frame.words.next
        line = KeyLine(*keys, turn, id="keys")
        super().__init__(frame, [TextColumn(page, questions, wide=True), line])
        self._sheet = sheet
        self._active = 0
        self._questions = questions
        self._keys = line
        self._last_keys = keys[0], turn, ("Enter", frame.words.go_on)

    def on_mount(self) -> None:
        self._sheet.begin()
        self.call_after_refresh(self.show)

    def on_resize(self) -> None:
        self.call_after_refresh(self.show)

    @property
    def asked(self) -> Asked:
        """The question that the keys are for."""
        return self._sheet.asked[self._active]

    @property
    def values(self) -> list[int | None]:
        """What each question's answer is shown to be."""
        return [self._sheet.value(asked) for asked in self._sheet.asked]

    def show(self) -> None:
        """Show the answers as they are now."""
        values = self.values
        self._questions.show(values, self._active)
        if None not in values:
            self._keys.set_keys(*self._last_keys)

    async def save(self) -> None:
        """Record what was not recorded when it was answered."""

    def action_turn(self, way: int) -> None:
        self._active = (self._active + way) % len(self._sheet.asked)
        self.show()

    async def action_go_on(self) -> None:
        """To the next question without an answer; where there is none, on."""
        missing = [number for number, value in enumerate(self.values) if value is None]
        if missing:
            later = [number for number in missing if number > self._active]
            self.action_turn((later or missing)[0] - self._active)
            return
        with self.kept():
            await self.save()
            self.finish(True)

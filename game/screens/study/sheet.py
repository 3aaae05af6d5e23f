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
    """Draws a question with its answer so far, `columns` wide; the keys are for the `active` one,
    and `typing` if they may still change its number. Every answer takes as many rows."""

    def __call__(
        self, asked: Asked, value: int | None, columns: int, /, *, active: bool, typing: bool
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
        self.spans: list[range] = []
        """The rows of each question."""
        self.show([None] * len(asked), 0)

    def show(self, values: Sequence[int | None], active: int, *, typing: bool = False) -> None:
        """Draw the questions with the answers given so far."""
        rows: list[Row] = []
        self.spans = []
        for number, (asked, value) in enumerate(zip(self._asked, values, strict=True)):
            here = number == active
            block = self._question_rows(
                asked, value, self.size.width, active=here, typing=here and typing
            )
            self.spans.append(range(len(rows), len(rows) + len(block)))
            rows += [*block, BLANK, BLANK]
        self.draw(rows)


class SheetScreen(StudyScreen[bool]):
    """Goes on when every question has its answer. No question is answered unless all of it is in
    view, and every answer is recorded before it is shown."""

    def __init__(
        self,
        frame: Frame,
        page: Page,
        sheet: Sheet,
        question_rows: QuestionRows,
        *keys: tuple[str, str],
    ) -> None:
        """`keys` give answers."""
        self._questions = Questions(sheet.asked, question_rows)
        self._column = TextColumn(page, self._questions, wide=True)
        super().__init__(frame, [self._column, KeyLine(id="keys")])
        self._sheet = sheet
        self._active = 0
        self._answer_keys = keys

    def on_mount(self) -> None:
        self._sheet.begin()
        self.call_after_refresh(self._fit)

    def on_resize(self) -> None:
        self.call_after_refresh(self._fit)

    def _fit(self) -> None:
        """Draw for the size there is now, and then keep in view what the keys are for."""
        self.show()
        self.call_after_refresh(self._fitted)

    def _fitted(self) -> None:
        if self._started:
            self._bring()
        self.show()

    @property
    def _started(self) -> bool:
        """Whether the participant is past the text at the top."""
        return self._active > 0 or self._column.scroll_y > 0

    @property
    def asked(self) -> Asked:
        """The question that the keys are for."""
        return self._sheet.asked[self._active]

    @property
    def values(self) -> list[int | None]:
        """What each question's answer is shown to be."""
        return [self._sheet.value(asked) for asked in self._sheet.asked]

    @property
    def typing(self) -> bool:
        """Whether the next digit belongs to the number that is shown."""
        return False

    def show(self) -> None:
        """Show the answers as they are now."""
        values, words = self.values, self.frame.words
        self._questions.show(values, self._active, typing=self.typing)
        missing = values.count(None)
        turn = "↑ ↓", words.next
        if missing:
            left = words.still_open.replace("{count}", str(missing))
            self.show_keys(*self._answer_keys, turn, remark=left)
        else:
            self.show_keys(self._answer_keys[0], turn, (self.frame.keys.enter, words.go_on))

    async def answer(self, value: int) -> bool:
        """Record an answer to the question that the keys are for, and show it. Where not all of the
        question is in view, bring it there instead, and give False."""
        if not self._in_view(self._active):
            self._bring()
            return False
        with self.kept():
            await self._sheet.answer(self.asked, value)
            self.show()
        return True

    def _in_view(self, number: int) -> bool:
        return self._column.holds(self._questions, self._questions.spans[number])

    def _bring(self) -> None:
        self._column.bring(self._questions, self._questions.spans[self._active])

    def turn_to(self, number: int) -> None:
        """The keys are for this question from now on."""
        self._active = number
        self._bring()
        self.show()

    def action_turn(self, way: int) -> None:
        self.turn_to(max(0, min(len(self._sheet.asked) - 1, self._active + way)))

    def action_page(self, way: int) -> None:
        """Scroll, and turn to the first question that is then in view."""
        self._column.page(way)
        if not self._in_view(self._active):
            count = len(self._sheet.asked)
            self._active = next((n for n in range(count) if self._in_view(n)), self._active)
        self.show()

    def action_go_on(self) -> None:
        """To the next question without an answer; where there is none, on."""
        missing = [number for number, value in enumerate(self.values) if value is None]
        if missing:
            later = [number for number in missing if number > self._active]
            self.turn_to((later or missing)[0])
        else:
            self.finish(True)

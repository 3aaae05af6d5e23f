"""A form: all its items on one page, gone through up and down."""

from __future__ import annotations

from time import monotonic
from typing import ClassVar

from textual import events
from textual.timer import Timer

from game.forms.items import (
    AnyQuestion,
    ChoiceItem,
    NumberItem,
    ScaleItem,
    SliderItem,
    TextItem,
)
from game.screens.study.answering import STEP, keys_for, moved, too_long, within
from game.screens.study.base import Frame, StudyScreen, TextColumn
from game.screens.study.question_rows import AnswerLook
from game.screens.study.questions import Questions
from game.screens.study.standing_head import StandingHead
from game.screens.widgets.keyline import KeyLine
from game.study.protocol.tasks import Sheet
from game.study.texts import Page

TYPED_S = 1.5
"""Digits typed within so long of each other are one number."""
MOST_DIGITS = 9


class FormScreen(StudyScreen[bool]):
    """Goes on when every question that must be answered has its answer, and all others were the
    active one. No question is answered unless all of it is in view, and every answer is recorded
    before it is shown. What is typed becomes an answer when the question is left."""

    AUTO_FOCUS: ClassVar[str | None] = ""
    DEAF_S = 1.0

    def __init__(self, frame: Frame, page: Page, sheet: Sheet) -> None:
        self._questions = Questions()
        self._column = TextColumn(page, self._questions, wide=True)
        self._column.can_focus = False
        self._head = StandingHead()
        super().__init__(frame, [self._head, self._column, KeyLine(id="keys")])
        self._title = page.title
        self.sheet = sheet
        self._active = sheet.asked[0].id
        self._met = {self._active}
        self._draft: str | None = None
        self._mark = 0
        self._refused = ""
        self._typed_at: float | None = None
        self._settling: Timer | None = None

    def on_mount(self) -> None:
        self.sheet.begin()
        self._begin_writing()
        self.watch(self._column, "scroll_y", self._say_head)
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
        return self._active != self.sheet.asked[0].id or self._column.scroll_y > 0

    # --- what is shown ----------------------------------------------------------------------------

    @property
    def asked(self) -> AnyQuestion:
        """The question that the keys are for."""
        return self._asked[self._place]

    @property
    def _asked(self) -> tuple[AnyQuestion, ...]:
        return self.sheet.asked

    @property
    def _place(self) -> int:
        ids = [question.id for question in self._asked]
        return ids.index(self._active) if self._active in ids else len(ids) - 1

    @property
    def typing(self) -> bool:
        """Whether the next digit belongs to the number that a slider shows."""
        return self._typed_at is not None and monotonic() - self._typed_at < TYPED_S

    @property
    def writing(self) -> bool:
        """Whether letters are typed into the active question."""
        question = self.asked
        if isinstance(question, ChoiceItem) and question.has_other(self.sheet.value(question)):
            return not question.several or self._mark == question.most - 1
        return isinstance(question, TextItem)

    def too_tall(self) -> dict[str, int]:
        """The questions that are never wholly in view, and how many rows each has too many."""
        room = len(self._column.rows_in_view)
        return {it: len(rows) - room for it, rows in self._questions.spans.items()
                if len(rows) > room}  # fmt: skip

    def show(self) -> None:
        """Show the answers as they are now."""
        active = self.asked
        self._questions.show(self.sheet.shown, {it.id: self._look(it) for it in self._asked})
        words, missing = self.frame.words, len(self.sheet.missing)
        turn = "↑ ↓", words.next
        keys = self._keys(active)
        if self._refused:
            self.show_keys(*keys, turn, remark=self._refused)
        elif missing:
            left = words.still_open.replace("{count}", str(missing))
            self.show_keys(*keys, turn, remark=left)
        else:
            self.show_keys(*keys[:1], turn, (self.frame.keys.enter, words.go_on))

    def _say_head(self) -> None:
        """Keep in sight what has scrolled away of the form's title, and of the heading over what is
        at the top."""
        top = self._column.rows_in_view.start
        over = [text for text, rows in self._questions.headings
                if self._column.span(self._questions, rows).start < top]  # fmt: skip
        self._head.say(self._title if top > 0 else "", over[-1] if over else "")

    def _look(self, question: AnyQuestion) -> AnswerLook:
        here = question.id == self.asked.id
        return AnswerLook(
            value=self.sheet.value(question),
            other=self.sheet.other(question),
            active=here,
            typing=here and self.typing,
            draft=self._draft if here else None,
            mark=self._mark,
        )

    def _keys(self, question: AnyQuestion) -> list[tuple[str, str]]:
        """The keys that answer the question, and what they do."""
        clears = not question.required and self.sheet.value(question) is not None
        return keys_for(
            question,
            self.frame.words,
            leaps=not self.scrolls,
            writing=self.writing,
            clears=clears and not self.writing,
        )

    # --- keys -------------------------------------------------------------------------------------

    async def on_key(self, event: events.Key) -> None:
        """Every key in the order it was pressed: what is typed never overtakes what follows it."""
        if not self.check_action("key", ()):
            event.stop()
            return
        if await self._typed(event) or await self._moved(event.key):
            event.stop()
            event.prevent_default()

    async def _typed(self, event: events.Key) -> bool:
        """A key that belongs to the answer of the active question alone."""
        question, key, letter = self.asked, event.key, event.character or ""
        if self.writing and (letter.isprintable() and letter):
            self._write((self._draft or "") + letter)
            return True
        if key == "backspace" and self._draft:
            self._write(self._draft[:-1])
            return True
        if key == "backspace" and self.writing and isinstance(question, ChoiceItem):
            if question.several:
                await self._toggle(question.most)
            return True
        if key == "delete" and not question.required:
            await self._clear()
            return True
        if key == "space" and isinstance(question, ChoiceItem) and question.several:
            await self._toggle(self._mark + 1)
            return True
        if letter.isascii() and letter.isdigit():
            await self._digit(int(letter))
            return True
        if letter == "-" and isinstance(question, NumberItem) and question.least < 0:
            self._write("-")
            return True
        return False

    async def _moved(self, key: str) -> bool:
        """A key that moves: the answer, to another question, or the page."""
        match key:
            case "left" | "h":
                await self._slide(-1)
            case "right" | "l":
                await self._slide(1)
            case "up" | "k" | "shift+tab":
                await self.turn(-1)
            case "down" | "j" | "tab":
                await self.turn(1)
            case "pageup":
                await self._leap(-1)
            case "pagedown":
                await self._leap(1)
            case "home" | "end" if isinstance(self.asked, SliderItem):
                self._typed_at = None
                await self._answer(self.asked.least if key == "home" else self.asked.most)
            case "enter":
                await self._go_on()
            case _:
                return False
        return True

    def _write(self, draft: str) -> None:
        """What is being typed; it is no answer yet."""
        if not self._in_view(self._active):
            self._bring()
            return
        self._draft, self._refused = draft, too_long(self.asked, draft, self.frame.words)
        self.show()
        self.call_after_refresh(self._fitted)

    async def _digit(self, digit: int) -> None:
        question = self.asked
        match question:
            case SliderItem():
                await self._slider_digit(question, digit)
            case NumberItem():
                self._write(((self._draft or "") + str(digit))[:MOST_DIGITS])
            case ChoiceItem(several=True):
                await self._toggle(digit)
            case ChoiceItem() | ScaleItem():
                if 1 <= digit <= question.most:
                    await self._answer(digit)
            case _:
                pass

    async def _slider_digit(self, slider: SliderItem, digit: int) -> None:
        """Digits make a number: 4 and then 2 is 42."""
        before, number = self.sheet.value(slider), digit
        if self.typing and isinstance(before, int) and before >= 0:
            number = 10 * before + digit if 10 * before + digit <= slider.most else digit
        if not slider.least <= number <= slider.most:
            return
        typed_at, self._typed_at = self._typed_at, monotonic()
        if not await self._answer(number):
            self._typed_at = typed_at
            return
        if self._settling is not None:
            self._settling.stop()
        self._settling = self.set_timer(TYPED_S, self.show)

    async def _toggle(self, position: int) -> None:
        """Mark or unmark one of several answers."""
        question = self.asked
        if not isinstance(question, ChoiceItem) or not 1 <= position <= question.most:
            return
        given = self.sheet.value(question)
        before = set(given) if isinstance(given, tuple) else set()
        after = tuple(sorted(before ^ {position}))
        self._mark = position - 1
        if after:
            await self._answer(after)
        elif self._in_view(question.id):
            await self._clear()

    async def _slide(self, way: int) -> None:
        self._typed_at = None
        question = self.asked
        value = self.sheet.value(question)
        number = value if isinstance(value, int) else None
        match question:
            case SliderItem():
                await self._answer(moved(number, way, question))
            case ScaleItem():
                middle = (question.least + question.most) // 2
                after = middle if number is None else within(question, number + way)
                await self._answer(after)
            case ChoiceItem(several=True):
                if await self._leave():
                    self._mark = max(0, min(question.most - 1, self._mark + way))
                    self._begin_writing()
                    self.show()
            case ChoiceItem() if number is not None or way > 0:
                await self._answer(within(question, (number or 0) + way))
            case _:
                pass

    async def _leap(self, way: int) -> None:
        """Scroll; where there is nothing to scroll, move the slider a long way."""
        self._typed_at = None
        if not self.scrolls:
            if isinstance(self.asked, SliderItem):
                before = self.sheet.value(self.asked)
                number = before if isinstance(before, int) else None
                await self._answer(moved(number, -way * STEP, self.asked))
            return
        if not await self._leave():
            return
        self._column.page(way)
        if not self._in_view(self._active):
            seen = [question.id for question in self._asked if self._in_view(question.id)]
            if seen:
                self._make_active(seen[0])
        self.show()

    # --- answers ----------------------------------------------------------------------------------

    async def _answer(self, value: int | tuple[int, ...]) -> bool:
        """Record an answer to the question that the keys are for, and show it. Where not all of the
        question is in view, bring it there instead, and give False."""
        question = self.asked
        if not self._in_view(question.id):
            self._bring()
            return False
        with self.kept():
            await self.sheet.answer(question, value)
            self._refused = ""
            self._begin_writing()
            self.show()
            self.call_after_refresh(self._fitted)
        return True

    async def _clear(self) -> None:
        """Take the answer back."""
        with self.kept():
            await self.sheet.clear(self.asked)
            self._refused = ""
            self._begin_writing()
            self.show()

    async def _leave(self) -> bool:
        """Record what was typed into the active question. False where that is no answer: it is
        said, and the question stays active."""
        question, draft = self.asked, self._draft
        if draft is None:
            return True
        if too_long(self.asked, draft, self.frame.words):
            return False
        with self.kept():
            if isinstance(question, NumberItem):
                return await self._leave_number(question, draft)
            if isinstance(question, ChoiceItem):
                await self.sheet.write_other(question, draft.strip())
            elif draft.strip():
                await self.sheet.answer(question, draft.strip())
            elif self.sheet.value(question) is not None:
                await self.sheet.clear(question)
            return True
        return False

    async def _leave_number(self, question: NumberItem, draft: str) -> bool:
        number = int(draft) if draft.strip("-") else None
        if number is not None and question.least <= number <= question.most:
            await self.sheet.answer(question, number)
        elif draft:
            words = self.frame.words.whole_number.replace("{least}", f"{question.least}")
            self._refused = words.replace("{most}", f"{question.most}")
            self.show()
            return False
        elif self.sheet.value(question) is not None:
            await self.sheet.clear(question)
        return True

    def _begin_writing(self) -> None:
        """What is typed from now on is added to what was written before."""
        question = self.asked
        value = self.sheet.value(question)
        if isinstance(question, TextItem):
            self._draft = str(value or "")
        elif isinstance(question, NumberItem):
            self._draft = None if value is None else str(value)
        else:
            self._draft = self.sheet.other(question) if self.writing else None

    # --- from question to question ----------------------------------------------------------------

    def _in_view(self, question: str) -> bool:
        return self._column.holds(self._questions, self._questions.spans[question])

    def _bring(self) -> None:
        self._column.bring(self._questions, self._questions.spans[self.asked.id])

    def _make_active(self, question: str) -> None:
        self._active = question
        self._met.add(question)
        self._mark, self._typed_at, self._refused = 0, None, ""
        self._begin_writing()

    async def turn_to(self, question: str) -> None:
        """The keys are for this question from now on."""
        if await self._leave():
            self._make_active(question)
            self.show()
            self._bring()
            self.show()

    async def turn(self, way: int) -> None:
        """To the next question, or the one before."""
        place = max(0, min(len(self._asked) - 1, self._place + way))
        await self.turn_to(self._asked[place].id)

    async def _go_on(self) -> None:
        """To the next question without an answer; where there is none, on."""
        if not await self._leave():
            return
        missing = {it.id for it in self.sheet.missing}
        missing |= {it.id for it in self._asked if it.id not in self._met}
        places = [n for n, it in enumerate(self._asked) if it.id in missing]
        if places:
            later = [n for n in places if n > self._place]
            self._make_active(self._asked[(later or places)[0]].id)
            self.show()
            self._bring()
            self.show()
        else:
            self.finish(True)

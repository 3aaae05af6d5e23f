"""What the keys of a form do: pure rules, and the names at the foot of the page."""

from __future__ import annotations

from game.forms.items import (
    AnyQuestion,
    ChoiceItem,
    NumberItem,
    ScaleItem,
    SliderItem,
    TextItem,
)
from game.study.texts import ScreenWords

STEP = 10


def moved(value: int | None, by: int, slider: SliderItem) -> int:
    """The value after a step; the first step leads to the middle."""
    if value is None:
        return (slider.least + slider.most) // 2
    return max(slider.least, min(slider.most, value + by))


def within(question: ScaleItem | ChoiceItem, value: int) -> int:
    """The value, or the nearest that the question allows."""
    return max(question.least, min(question.most, value))


def too_long(question: AnyQuestion, draft: str, words: ScreenWords) -> str:
    """What to tell of a text that has too many letters; empty where it has not."""
    most = question.length if isinstance(question, TextItem) else TextItem.__struct_defaults__[-1]
    too_many = len(draft) - int(most)
    if isinstance(question, NumberItem) or too_many <= 0:
        return ""
    told = words.too_long.replace("{most}", f"{most:,}")
    return told.replace("{count}", f"{too_many:,}")


def keys_for(
    question: AnyQuestion, words: ScreenWords, *, leaps: bool, writing: bool, clears: bool
) -> list[tuple[str, str]]:
    """The keys that answer a question, and what they do: whether Page Up and Down move a slider in
    leaps, whether letters are written, and whether the answer can be cleared."""
    names = words.mission.keys
    digits = f"1-{min(9, question.most)}"
    match question:
        case SliderItem():
            leap = [(names.page, f"±{STEP}")] if leaps else []
            keys = [("← →", words.move), ("0-9", words.number), *leap]
        case ScaleItem():
            keys = [("← →", words.answer), (digits, words.answer)]
        case ChoiceItem(several=True):
            keys = [
                ("← →", words.choose),
                (names.space, words.mark),
                (digits, words.mark),
            ]
        case ChoiceItem():
            keys = [("← →", words.choose), (digits, words.choose)]
        case NumberItem():
            keys = [("0-9", words.number)]
        case TextItem():
            keys = [(names.letters, words.write)]
    if writing and not isinstance(question, TextItem):
        keys = [*keys[:-1], (names.letters, words.write)]
    if clears:
        keys.append((names.delete, words.clear))
    return keys

"""Reading forms.toml, and items.toml of earlier studies as one."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any, NamedTuple, get_args

import msgspec

from game.errors import AnaError, choose_from
from game.forms.form import CHECK, EACH, Composite, Form, Forms, Place, Repeats
from game.forms.items import (
    ChoiceItem,
    Condition,
    HeadingItem,
    Item,
    NumberItem,
    Role,
    ScaleItem,
    SliderItem,
    TextItem,
    Weights,
)
from game.forms.placeholders import check_text
from game.toml_words import NOT_UTF8, SAVE_AS_UTF8, in_plain_words, listed, parted

FORMS, ITEMS = "forms.toml", "items.toml"
FILLED = "instructor"
"""What can be filled in on a page that is asked after a mission."""

_KINDS = {
    "slider": SliderItem,
    "scale": ScaleItem,
    "choice": ChoiceItem,
    "number": NumberItem,
    "text": TextItem,
    "heading": HeadingItem,
}
_PATH = re.compile(r"\[(\d+)\]|\.(\w+)")


class FormsError(AnaError):
    """A file of forms cannot be used as it is."""


def paper_text() -> str:
    """The forms.toml of a new study: what the paper asked (5.3)."""
    return (resources.files("game.forms") / "paper.toml").read_text(encoding="utf-8")


@cache
def paper_forms() -> Forms:
    """The same, read."""
    return forms_in(tomllib.loads(paper_text()), "paper.toml")


class Pages(NamedTuple):
    """The pages of texts.toml that the forms of an earlier study stood on: title and body."""

    sliders: tuple[str, str]
    likert: tuple[str, str]
    check: tuple[str, str]


BLANK = Pages(("", ""), ("", ""), ("", ""))
"""For those who read what is asked, and not how."""


class ReadForms(NamedTuple):
    """The forms of a study, the name of their file, and what its reader should know of that."""

    forms: Forms
    name: str
    note: str = ""


def read_forms(folder: Path, pages: Pages | None) -> ReadForms:
    """The forms in `folder`. Where there is no forms.toml, those of items.toml, on `pages`.

    Raises FormsError, naming the file, the form and the item.
    """
    path, older = folder / FORMS, folder / ITEMS
    if path.exists() and older.exists():
        raise FormsError(
            f"there is a {ITEMS} as well, and only one of them can be asked",
            place=str(path),
            hint="Delete the one that is not meant",
        )
    if path.exists() or not older.exists():
        text = _text(path)
        return ReadForms(forms_in(_tree(text, path), str(path), text), FORMS)
    if pages is None:
        raise FormsError(
            f"there is no {FORMS}, and {ITEMS} of an earlier study needs the pages mental_state, "
            "likert and check in texts.toml",
            place=str(older),
            hint=f"Copy {FORMS} from a new study folder, and delete {ITEMS}",
        )
    forms = _of_items(_tree(_text(older), older), str(older), pages)
    return ReadForms(
        forms,
        ITEMS,
        f"{ITEMS} of an earlier version is read as forms; to ask more, begin a {FORMS} with "
        "`ana study forms paper`",
    )


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise FormsError(
            f"the file cannot be read ({error.strerror})",
            place=str(path),
            hint="Copy the file from a new study folder",
        ) from error
    except UnicodeDecodeError as error:
        raise FormsError(NOT_UTF8, place=str(path), hint=SAVE_AS_UTF8) from error


def _tree(text: str, path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise FormsError(
            f"this is not TOML: {error}", place=str(path), hint="Mend the line that it names"
        ) from error


def forms_in(tree: Mapping[str, Any], place: str, text: str = "") -> Forms:
    """The forms of a file's `tree`. Raises FormsError, which names `place`, and where an id stands
    twice its lines in the file's `text`."""
    try:
        forms = msgspec.convert(_with_answers(tree), Forms)
    except msgspec.ValidationError as error:
        message, path = parted(str(error))
        where, kind = _where(tree, path)
        where = where or _lines(message, text)
        raise FormsError(
            in_plain_words(message),
            place=f"{place}, {where}" if where else place,
            hint=listed(message, path, _with_answers(tree)) or _hint(message, kind),
        ) from error
    _check_placeholders(forms, place)
    return forms


def _with_answers(tree: Mapping[str, Any]) -> dict[str, Any]:
    """The tree with the answers of each form in those of its scales that name none."""
    return {
        key: [_form_with_answers(it) if isinstance(it, dict) else it for it in value]
        if key == "form" and isinstance(value, list)
        else value
        for key, value in tree.items()
    }


def _form_with_answers(form: dict[str, Any]) -> dict[str, Any]:
    items, answers = form.get("item"), form.get("answers")
    if not (isinstance(items, list) and answers):
        return form
    return form | {
        "item": [
            it | {"answers": answers}
            if isinstance(it, dict) and it.get("kind") == "scale" and "answers" not in it
            else it
            for it in items
        ]
    }


def _where(tree: Mapping[str, Any], path: str) -> tuple[str, str]:
    """The place that a path of msgspec's means, in words, and its last key; of an item its kind."""
    here: Any = tree
    named: list[str] = []
    last = ""
    for index, key in _PATH.findall(path):
        if index:
            here = here[int(index)] if isinstance(here, list) and int(index) < len(here) else {}
            label = here.get("id") if isinstance(here, dict) else None
            named[-1] += f" {int(index) + 1} ({label})" if label else f" {int(index) + 1}"
            if last == "item" and isinstance(here, dict):
                last = str(here.get("kind"))
        else:
            last = key
            named.append(key)
            here = here.get(key, {}) if isinstance(here, dict) else {}
    return ", ".join(named), last


def _lines(message: str, text: str) -> str:
    """In which lines of the text the id stands that a message calls doubled."""
    doubled = re.match(r"two \w+ have the id (\w+)", message)
    if doubled is None or not text:
        return ""
    given = re.compile(rf"""\s*id\s*=\s*["']{doubled[1]}["']""")
    lines = [str(n) for n, line in enumerate(text.splitlines(), start=1) if given.match(line)]
    return f"lines {' and '.join(lines)}" if lines else ""


_KEYS_OF = {"form": Form, "composite": Composite, "shown_when": Condition, "weights": Weights,
            "": Forms, **_KINDS}  # fmt: skip
_CHOICES: dict[str, tuple[str, ...]] = {
    "kind": tuple(_KINDS),
    "place": get_args(Place),
    "repeats": get_args(Repeats),
    "role": get_args(Role),
    "order": ("fixed", "drawn"),
    "of": ("sum", "mean"),
}


def _hint(message: str, key: str) -> str:
    unknown = re.search(r"unknown field `(\w+)`", message)
    if unknown is not None and key in _KEYS_OF:
        return choose_from(unknown[1], _KEYS_OF[key].__struct_encode_fields__)
    invalid = re.search(r"[Ii]nvalid (?:enum )?value '(.*)'", message)
    if key in _CHOICES:
        return choose_from(invalid[1] if invalid else "", _CHOICES[key])
    return "docs/lab.md lists every key" if in_plain_words(message) != message else ""


def _check_placeholders(forms: Forms, place: str) -> None:
    for form in forms.forms:
        known = {FILLED} if set(form.places) == {EACH} else set()
        for text in (form.title, form.body):
            check_text(text, known, f"{place}, form {form.id}")
        for item in form.items:
            name = "a heading" if isinstance(item, HeadingItem) else f"item {item.id}"
            check_text(item.text, set(), f"{place}, form {form.id}, {name}")


# --- items.toml -----------------------------------------------------------------------------------


_OLD_POINTS = 5


class _Old(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    id: str
    text: str


class _OldSlider(_Old, frozen=True):
    low: str
    high: str


class _OldScale(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    answers: tuple[str, ...]

    def __post_init__(self) -> None:
        if len(self.answers) != _OLD_POINTS:
            raise ValueError(f"the scale must have {_OLD_POINTS} answers, not {len(self.answers)}")


class _OldCheck(_Old, frozen=True, kw_only=True):
    answers: tuple[str, ...]
    right: int


class _OldItems(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    version: str
    slider: tuple[_OldSlider, ...]
    statement: tuple[_Old, ...]
    scale: _OldScale
    check: tuple[_OldCheck, ...]


PREFERENCE = ("pref1", "pref2", "pref3", "pref4")
"""The statements whose sum is the paper's measure of preference (5.3)."""


def _of_items(tree: Mapping[str, Any], place: str, pages: Pages) -> Forms:
    try:
        old = msgspec.convert(tree, _OldItems)
        statements = [it.id for it in old.statement]
        summed = all(name in statements for name in PREFERENCE)
        forms = Forms(
            version=old.version,
            forms=tuple(
                form
                for form in (
                    _page("check", CHECK, pages.check, [_old_check(it) for it in old.check]),
                    _page("sliders", EACH, pages.sliders, [_old_slider(it) for it in old.slider]),
                    _page(
                        "likert",
                        EACH,
                        pages.likert,
                        [_old_statement(it, old.scale.answers) for it in old.statement],
                        Composite(id="preference", items=PREFERENCE, of="sum") if summed else None,
                    ),
                )
                if form is not None
            ),
        )
    except (msgspec.ValidationError, ValueError) as error:
        raise FormsError(
            str(error), place=place, hint="Compare the file with docs/lab.md"
        ) from error
    _check_placeholders(forms, place)
    return forms


def _page(
    name: str,
    place: Any,
    page: tuple[str, str],
    items: list[Item],
    composite: Composite | None = None,
) -> Form | None:
    if not items:
        return None
    return Form(
        id=name,
        place=place,
        title=page[0],
        body=page[1],
        order="fixed" if place == CHECK else "drawn",
        items=tuple(items),
        composites=() if composite is None else (composite,),
    )


def _old_slider(it: _OldSlider) -> Item:
    return SliderItem(id=it.id, text=it.text, low=it.low, high=it.high, role="mental_state")


def _old_statement(it: _Old, answers: tuple[str, ...]) -> Item:
    return ScaleItem(id=it.id, text=it.text, answers=answers, role="preference")


def _old_check(it: _OldCheck) -> Item:
    return ChoiceItem(id=it.id, text=it.text, answers=it.answers, right=it.right)

"""Reading `instructions.toml`, and what can be wrong with it."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from types import MappingProxyType
from typing import Any, get_args

from game.coach.acts import Level
from game.coach.instructions.phrasebook import (
    ARTICLE,
    FORMS,
    NO_ARTICLE,
    NUMBER,
    OTHER,
    ROOM,
    NoticeName,
    Phrasebook,
)
from game.coach.instructions.vocabulary import MOST_COUNTED
from game.errors import AnaError, choose_from, did_you_mean
from game.toml_lines import at_line, line_of

_PARTS = ("language", "between_sentences", "plural", "ordinals", *Level.__members__, "notices")
_BRACES = re.compile(r"\{([^{}]*)\}|[{}]")
_SAME: Mapping[str, str] = {
    "Proceed Room": "Proceed Hallway",
    "Enter Hallway": "Enter Room",
    **{
        form: form.replace("Exit", "Enter")
        for form in FORMS[Level.C2]
        if form.startswith("Exit ") and "Door" in form
    },
}
"""Forms that ask for the same walk, and so may have the same sentence."""


class PhrasebookError(AnaError):
    """An `instructions.toml` cannot be used as it is."""


@cache
def english() -> Phrasebook:
    """The shipped sentences."""
    shipped = resources.files("game.coach.instructions") / "instructions.toml"
    return parse_phrasebook(shipped.read_text(encoding="utf-8"), "instructions.toml")


def text_to_keep(phrases: Phrasebook | None) -> str | None:
    """What a journal keeps of the phrasebook that a coach speaks by; nothing of the shipped one."""
    return None if phrases is None or phrases.text == english().text else phrases.text


def phrasebook_of(text: str | None) -> Phrasebook:
    """The phrasebook that a journal keeps: the shipped English where it keeps none. Raises
    PhrasebookError."""
    return english() if text is None else parse_phrasebook(text, "instructions.toml")


def parse_phrasebook(text: str, place: str) -> Phrasebook:
    """The phrasebook in the file `place`, whose content is `text`.

    Raises PhrasebookError, naming line and fix: for what is no TOML, a tuple without a sentence, a
    name that is none, a placeholder that cannot be filled in, a plural form that is missing, and
    two tuples that sound alike.
    """
    try:
        tree = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise PhrasebookError(f"this is not TOML: {error}", place=place) from error
    return _Reading(text, place, tree).phrasebook()


@dataclass(frozen=True)
class _Reading:
    """A file that is being read: its text, its name, and what it holds."""

    text: str
    place: str
    tree: Mapping[str, Any]

    def phrasebook(self) -> Phrasebook:
        self._known(self.tree, _PARTS, "part")
        plural, ordinals = self._plural(), self._ordinals()
        sentences: dict[tuple[Level, str], str | Mapping[str, str]] = {}
        for level in Level:
            for form, given in self._sentences(level):
                plurals = (*dict.fromkeys(plural.values()), OTHER)
                sentences[level, form] = self._sentence(level, form, given, plurals, ordinals)
        self._different(sentences)
        return Phrasebook(
            text=self.text,
            language=self._string(("language",)),
            between=self._string(("between_sentences",), blank=True),
            sentences=MappingProxyType(sentences),
            notices=MappingProxyType(self._notices()),
            plural=MappingProxyType(plural),
            ordinals=MappingProxyType(ordinals),
        )

    # --- the parts --------------------------------------------------------------------------------

    def _plural(self) -> dict[int, str]:
        """The form of each number that has one of its own."""
        found: dict[int, str] = {}
        for form, numbers in self._table("plural").items():
            path = "plural", form
            if form == OTHER:
                raise self._error(path, "every number not listed takes the form other", "Remove it")
            if not isinstance(numbers, list) or not all(_natural(it) for it in numbers):
                raise self._error(path, f"{form} must be a list of numbers", "As in one = [1]")
            for number in numbers:
                if number in found:
                    raise self._error(path, f"{number} has two forms", f"Or is it {found[number]}?")
                found[number] = form
        return found

    def _ordinals(self) -> dict[str, tuple[str, ...]]:
        found: dict[str, tuple[str, ...]] = {}
        for name, words in self._table("ordinals").items():
            path = "ordinals", name
            if name == "number" or not name.isidentifier():
                raise self._error(path, f"a list cannot be called {name}", "Use letters, as in nth")
            ok = isinstance(words, list) and all(isinstance(it, str) and it for it in words)
            if not ok or len(words) != MOST_COUNTED:
                count = f", not {len(words)}" if isinstance(words, list) else ""
                message = f"{name} must be a list of {MOST_COUNTED} words{count}"
                raise self._error(path, message, "Give the words for first to tenth")
            found[name] = tuple(words)
        return found

    def _sentences(self, level: Level) -> Iterator[tuple[str, Any]]:
        """Each form of a level, or whole tuple, with what is given for it."""
        given, forms = self._table(level.name), FORMS[level]
        for key in given:
            if not any(_matches(form, key) for form in forms):
                hint = did_you_mean(key, forms) or "See docs/instructions.md for all tuples"
                raise self._error((level.name, key), f"{level.name} has no tuple '{key}'", hint)
        self._complete(level.name, forms, given)
        yield from given.items()

    def _notices(self) -> dict[NoticeName, str]:
        given, names = self._table("notices"), get_args(NoticeName)
        self._known(given, names, "notice", "notices")
        self._complete("notices", names, given)
        return {name: self._filled(("notices", name), given[name], ()) for name in names}

    def _sentence(
        self,
        level: Level,
        form: str,
        given: Any,
        plurals: tuple[str, ...],
        ordinals: Mapping[str, tuple[str, ...]],
    ) -> str | Mapping[str, str]:
        """What is given for a form, checked."""
        path = level.name, form
        steps, room = form.endswith("Steps") and NUMBER in form, form == f"Goto {ROOM}"
        known = {"room": room, "number": NUMBER in form}
        fillable = [name for name, is_known in known.items() if is_known]
        if NUMBER in form and not steps:
            fillable += ordinals
        must = plurals if steps and len(plurals) > 1 else ()
        if isinstance(given, dict):
            allowed = (ARTICLE, NO_ARTICLE) if room else plurals if NUMBER in form else ()
            if not allowed:
                raise self._error(path, f"'{form}' has only one form", "Give one sentence")
            self._known(given, allowed, "form", *path)
            must = allowed
        elif not must:
            sentence = self._filled(path, given, fillable)
            self._tells(path, form, sentence)
            return sentence
        forms = given if isinstance(given, dict) else {}
        missing = [name for name in must if name not in forms]
        if missing:
            forms_text = ", ".join(f'{name} = "..."' for name in must)
            what = "plural form" if NUMBER in form else "form"
            many = "s" if len(missing) > 1 else ""
            raise self._error(
                path, f"'{form}' lacks the {what}{many} {', '.join(missing)}",
                f"Write {{ {forms_text} }}",
            )  # fmt: skip
        read = {name: self._filled(path, forms[name], fillable) for name in must}
        self._tells(path, form, read[must[-1]])
        return MappingProxyType(read)

    def _tells(self, path: tuple[str, ...], form: str, sentence: str) -> None:
        """Refuse a sentence that does not say the part of the tuple that varies."""
        if ROOM in form and ROOM not in sentence:
            raise self._error(path, f"the sentence lacks {ROOM}", f"Add {ROOM}")
        if NUMBER in form and not _BRACES.search(sentence):
            names = " or ".join(f"{{{it}}}" for it in ("number", *self._table("ordinals")))
            raise self._error(path, "the sentence does not say which number", f"Add {names}")

    def _different(self, sentences: Mapping[tuple[Level, str], str | Mapping[str, str]]) -> None:
        """Refuse two tuples of one level that sound alike but ask for different things."""
        heard: dict[tuple[Level, str], str] = {}
        for (level, form), given in sentences.items():
            for sentence in [given] if isinstance(given, str) else given.values():
                other = heard.setdefault((level, sentence), form)
                if _SAME.get(form, form) != _SAME.get(other, other):
                    raise self._error(
                        (level.name, form),
                        f"'{form}' has the same sentence as '{other}'",
                        "Nobody could tell which is meant; change one of them",
                    )

    # --- what is common to all -------------------------------------------------------------------

    def _table(self, name: str) -> Mapping[str, Any]:
        table = self.tree.get(name, {} if name in ("plural", "ordinals") else None)
        if not isinstance(table, dict):
            raise self._error((name,), f"the table [{name}] is missing", f"Add [{name}]")
        return table

    def _string(self, path: tuple[str, ...], *, blank: bool = False) -> str:
        value = self.tree.get(path[0])
        if not isinstance(value, str) or not (blank or value.strip()):
            raise self._error(path, f"{path[0]} is missing", f'Add {path[0]} = "..."')
        return value

    def _filled(self, path: tuple[str, ...], given: Any, fillable: Iterable[str]) -> str:
        """A sentence in which nothing but `fillable` is to be filled in."""
        if not isinstance(given, str) or not given.strip() or _unfit(given):
            problem = "the sentence is missing" if given in ("", None) else "this is not a sentence"
            raise self._error(path, problem, "Write one line of text between quotation marks")
        known = [f"{{{name}}}" for name in fillable]
        for match in _BRACES.finditer(given):
            if match[0] not in known:
                hint = choose_from(match[0], known) if known else "Write the words themselves"
                raise self._error(path, f"there is no {match[0]} to be filled in", hint)
        return given

    def _known(self, given: Mapping[str, Any], names: Iterable[str], what: str, *path: str) -> None:
        for name in given:
            if name not in (known := tuple(names)):
                hint = choose_from(name, known)
                raise self._error((*path, name), f"there is no {what} '{name}'", hint)

    def _complete(self, table: str, names: Iterable[str], given: Mapping[str, Any]) -> None:
        missing = [name for name in names if name not in given]
        if missing:
            listed = ", ".join(f"'{name}'" for name in missing[:3])
            more = f" and {len(missing) - 3} more" if len(missing) > 3 else ""
            raise self._error(
                (table,), f"[{table}] lacks {listed}{more}",
                f'Add the line "{missing[0]}" = "..." and so on',
            )  # fmt: skip

    def _error(self, path: tuple[str, ...], message: str, hint: str) -> PhrasebookError:
        return PhrasebookError(
            message, place=at_line(self.place, line_of(self.text, *path)), hint=hint
        )


def _natural(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value > 0


def _unfit(sentence: str) -> bool:
    """Whether it is more than one line, or has blanks around it."""
    return sentence != sentence.strip() or len(sentence.splitlines()) > 1


def _matches(form: str, key: str) -> bool:
    """Whether `key` is a form, or a whole tuple of that form."""
    varying = {NUMBER: r"[1-9]\d*", ROOM: r"[^\s{}][^{}]*"}
    pattern = "".join(varying.get(it) or re.escape(it) for it in re.split(r"(\{.*?\})", form))
    return key == form or re.fullmatch(pattern, key) is not None

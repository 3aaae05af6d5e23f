"""Which facts texts can have filled in: those of the shipped text at the same place."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from typing import Any

from game.errors import AnaError, choose_from, nearest

REQUIRED = (("debrief", "code"),)
"""Pages that must have a fact: without the completion code nobody can be paid."""

_PLACEHOLDER = re.compile(r"\{(\w+)\}")
_ALMOST = re.compile(r"[{\uff5b]+\s*(\w+)\s*[}\uff5d]*|[{\uff5b]*\s*(\w+)\s*[}\uff5d]+")
"""Something in braces, also where they are doubled, half missing, or the wide ones of Chinese and
Japanese keyboards."""


class PlaceholderError(AnaError):
    """A text asks for a fact that there is not, or lacks one that it must have."""


def check_placeholders(given: Mapping[str, Any], shipped: Mapping[str, Any], place: str) -> None:
    """Raise PlaceholderError, naming `place` and the key, unless `given`, a tree of texts, asks
    only for what `shipped` has there."""
    for key, text, known in _texts(given, shipped, ""):
        check_text(text, known, f"{place}, {key}")
    for page, name in REQUIRED:
        if name not in _names(given.get(page, {})):
            raise PlaceholderError(
                f"the page lacks {{{name}}}", place=f"{place}, {page}", hint=f"Add {{{name}}}"
            )


def check_text(text: str, known: Collection[str], place: str) -> None:
    """Raise PlaceholderError, naming `place`, where a text asks for anything but `known`."""
    for name in _PLACEHOLDER.findall(text):
        if name not in known:
            hint = (
                choose_from(name, [f"{{{one}}}" for one in sorted(known)])
                if known
                else "Nothing can be filled in here; write the words themselves"
            )
            raise PlaceholderError(
                f"there is no {{{name}}} to be filled in", place=place, hint=hint
            )
    for almost in _ALMOST.finditer(text):
        word, written = almost[1] or almost[2], almost[0].strip()
        name = nearest(word, known)
        if name and written != f"{{{name}}}":
            raise PlaceholderError(
                f"'{written}' is not filled in", place=place, hint=f"Write {{{name}}}"
            )


def _texts(
    given: Mapping[str, Any], shipped: Mapping[str, Any], path: str
) -> Iterator[tuple[str, str, frozenset[str]]]:
    """Every text with its key and what can be filled in: title and body of a page share that."""
    together = _names({key: it for key, it in shipped.items() if key in ("title", "body")})
    for key, value in given.items():
        here = f"{path}.{key}" if path else key
        same = shipped.get(key, {})
        if isinstance(value, str):
            known = together if key in ("title", "body") else _names({key: same})
            yield here, value, known
        elif isinstance(value, Mapping) and isinstance(same, Mapping):
            yield from _texts(value, same, here)


def _names(texts: Mapping[str, Any]) -> frozenset[str]:
    found = (_PLACEHOLDER.findall(text) for text in texts.values() if isinstance(text, str))
    return frozenset(name for names in found for name in names)

"""Where a key stands in a TOML file, for messages that name the line."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator

_HEADER = re.compile(r"\s*\[+\s*(.*?)\s*\]+\s*(?:#.*)?$")
_KEY = re.compile(r"""\s*("(?:[^"\\]|\\.)*"|'[^']*'|[\w.-]+)\s*=""")
_QUOTES = re.compile(r"\"\"\"|'''")


def line_of(text: str, *path: str) -> int | None:
    """The line, from 1, of the table or key that `path` leads to; of the nearest table above it
    where it has none of its own; None where that has none either."""
    found = dict(reversed([*_keys(text)]))
    for upto in range(len(path), 0, -1):
        if path[:upto] in found:
            return found[path[:upto]]
    return None


def at_line(place: str, line: int | None) -> str:
    """`place, line 3`."""
    return place if line is None else f"{place}, line {line}"


def _keys(text: str) -> Iterator[tuple[tuple[str, ...], int]]:
    """Each table and key with its line; the lines of a text between three quotes hold none."""
    table: tuple[str, ...] = ()
    inside = ""
    for number, line in enumerate(text.splitlines(), start=1):
        if not inside:
            if (header := _HEADER.match(line)) is not None:
                table = _parts(header[1])
                yield table, number
            elif (key := _KEY.match(line)) is not None:
                yield (*table, *_parts(key[1])), number
        for quotes in _QUOTES.findall(line):
            inside = "" if inside == quotes else inside or quotes


def _parts(dotted: str) -> tuple[str, ...]:
    """The names in a dotted key."""
    try:
        tree = tomllib.loads(f"{dotted} = 0")
    except tomllib.TOMLDecodeError:
        return ()
    names = []
    while isinstance(tree, dict):
        ((name, tree),) = tree.items()
        names.append(name)
    return tuple(names)

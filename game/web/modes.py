"""What a terminal that joins late must be told before it is painted on."""

from __future__ import annotations

import re

RESET = b"\x1bc"
_MODE = re.compile(rb"\x1b\[\?([0-9;]{1,40})([hl])")
_TORN = re.compile(rb"\x1b(?:\[(?:\?[0-9;]{0,40})?)?$")
_PASSING = (2026,)
"""Modes that hold for one paint only."""


class Modes:
    """The private modes (alternate screen, hidden cursor, bracketed paste, ...) that a program's
    output has set so far."""

    def __init__(self) -> None:
        self._set: dict[int, bytes] = {}
        self._torn = b""

    def feed(self, data: bytes) -> None:
        """Note the modes in more output; a sequence may be torn between two pieces."""
        data = self._torn + data
        for numbers, way in _MODE.findall(data):
            for number in filter(None, numbers.split(b";")):
                if int(number) not in _PASSING:
                    self._set.pop(int(number), None)
                    self._set[int(number)] = way
        torn = _TORN.search(data[-48:])
        self._torn = torn[0] if torn else b""

    def prelude(self) -> bytes:
        """Resets a terminal, and sets the modes in the order in which they were last set."""
        return RESET + b"".join(b"\x1b[?%d%b" % mode for mode in self._set.items())

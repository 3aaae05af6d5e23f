"""What counts as a key: the one reader between the terminal's bytes and the program.

A terminal sends more than keys: answers to questions that some program asked, reports of the mouse
and of focus, sequences that a bad line tore or mangled. Nothing of it may act. So the bytes are cut
into whole characters and whole escape sequences (ECMA-48), and a sequence becomes a key only if
Textual knows all of it as one.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator

from textual import events
from textual._ansi_sequences import ANSI_SEQUENCES_KEYS
from textual._keyboard_protocol import FUNCTIONAL_KEYS
from textual._xterm_parser import XTermParser
from textual.message import Message
from textual.messages import TerminalSupportsSynchronizedOutput

_told = os.environ.get("ESCDELAY", "")
ESCAPE_S = int(_told) / 1000 if _told.isdecimal() else 0.5
"""How long an escape character may still be the beginning of a key."""
PATIENCE_S = 2.0
"""How long the rest of a sequence is waited for; a slow line may tear it in two."""
PASTE_PATIENCE_S = 5.0
"""How long the rest of a paste is waited for."""
MOST_PASTED = 1 << 22
"""Bytes of a paste that are kept; the rest is dropped."""
BURST = 100
"""Characters that come at once and are no longer typing."""
LONGEST_KEY = 32
"""Bytes of the longest sequence that is a key; Textual gives up beyond it."""

_ESC = b"\x1b"
_CSI = rb"(?:\x1b\[|\xc2?\x9b)"
_CHARACTER = (
    rb"(?:[\x00-\x1a\x1c-\x7f]|[\xc2-\xdf][\x80-\xbf]|[\xe0-\xef][\x80-\xbf]{2}"
    rb"|[\xf0-\xf4][\x80-\xbf]{3})"
)
_CHARACTER_BEGUN = rb"(?:[\xc2-\xdf]|[\xe0-\xef][\x80-\xbf]?|[\xf0-\xf4][\x80-\xbf]{0,2})"

_WHOLE = re.compile(
    rb"(?P<mouse>%(csi)bM[^\x00-\x1f]{3})"
    rb"|(?P<sequence>\x1b\[\[[ -~]|%(csi)b(?![M\[])[0-?]*[ -/]*[@-~]|\x1bO[0-?]*[@-~])"
    rb"|(?P<string>(?:\x1b|(?P<bits8>\xc2?(?=[\x90\x98\x9d-\x9f])))[PX\]^_\x90\x98\x9d-\x9f])"
    rb"|(?P<alt>\x1b(?:[ -/]+[0-~]|(?![OPX\[\]^_])[0-~]|(?=[^\x00-\x7f])%(char)b))"
    rb"|(?P<escape>\x1b(?=[\x00-\x1f\x7f]))"
    rb"|(?P<control>\xc2?[\x80-\x9a\x9c-\x9f])"
    rb"|(?P<text>(?:(?!\xc2[\x80-\x9f])%(char)b)+)" % {b"csi": _CSI, b"char": _CHARACTER}
)
"""Something whole: a mouse report of three bytes, a control sequence or function key, the beginning
of a control string, a key with Alt, Escape before another key, a control of eight bits, or
characters."""
_BEGUN = re.compile(
    rb"%(csi)b(?:M[^\x00-\x1f]{0,2}|\[|[0-?]*[ -/]*)"
    rb"|\x1b(?:O[0-?]*|%(char)b|[ -/]*)|%(char)b" % {b"csi": _CSI, b"char": _CHARACTER_BEGUN}
)
"""The beginning of one of these."""

_PASTE_BEGINS = b"\x1b[200~"
_PASTE_ENDS = re.compile(rb"\x1b\[201~")
_SYNCHRONIZED = re.compile(rb"\x1b\[\?2026;[1-4]\$y")
_CLICK = re.compile(rb"\x1b\[<0;\d{1,4};\d{1,4}[Mm]")
"""The first button of the mouse, pressed or released."""
_LETTER_KEY = re.compile(rb"\x1b\[1?;\d+[A-HPQS]")
_NUMBER_KEY = re.compile(rb"\x1b\[(\d+)(?:;\d+)?~")
_CODE_KEY = re.compile(rb"\x1b\[\d+(?:;\d*(?:;[\d:]*)?)?u")
_NO_TEXT = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f]")


class Keyboard:
    """Makes events of what a terminal sends; `now_s` is any steady time in seconds.

    Takes any bytes, cut anywhere, and never raises.
    """

    def __init__(self) -> None:
        self.pointing = False
        """Whether a click of the mouse is believed too."""
        self._rest = bytearray()
        self._end: re.Pattern[bytes] | None = None
        self._pasted: bytearray | None = None
        self._until_s: float | None = None

    def feed(self, data: bytes, now_s: float) -> Iterator[Message]:
        """The events that these bytes complete."""
        self._rest += data
        before: object = None
        while self._rest and before != (now := (len(self._rest), self._end)):
            before = now
            yield from self._read() if self._end is None else self._pass()
        self._until_s = now_s + self._patience_s if self._rest or self._end else None

    def tick(self, now_s: float) -> Iterator[Message]:
        """The events that follow from nothing more having come; call it a few times a second."""
        if self._until_s is None or now_s < self._until_s:
            return
        rest, pasted = bytes(self._rest), self._pasted
        self._rest.clear()
        self._end = self._pasted = self._until_s = None
        if pasted is not None:
            yield _paste(pasted + rest)
        elif rest == _ESC:
            yield from _typed("\x1b")
        elif rest[:1] > b"\xc2":
            yield from _typed("\N{REPLACEMENT CHARACTER}")

    @property
    def _patience_s(self) -> float:
        if self._pasted is not None:
            return PASTE_PATIENCE_S
        alone = self._end is None and self._rest == _ESC
        return ESCAPE_S if alone else PATIENCE_S

    def _read(self) -> Iterator[Message]:
        """Take one whole thing from the front of what came."""
        whole = _WHOLE.match(self._rest)
        begun = _BEGUN.match(self._rest)
        if begun is not None and begun.end() == len(self._rest) and not _ended(whole, begun):
            return
        if whole is None:
            broken = bytes(self._rest[: begun.end() if begun is not None else 1])
            del self._rest[: len(broken)]
            if not re.match(rb"\x1b|\xc2?\x9b", broken):
                yield from _typed("\N{REPLACEMENT CHARACTER}")
            return
        found = whole.group()
        del self._rest[: whole.end()]
        match whole.lastgroup:
            case "text":
                yield from _typed(found.decode(errors="replace"))
            case "escape":
                yield from _typed("\x1b")
            case "sequence" if found == _PASTE_BEGINS:
                self._end, self._pasted = _PASTE_ENDS, bytearray()
            case "sequence" if self.pointing and _CLICK.fullmatch(found):
                yield from XTermParser().feed(found.decode())
            case "sequence":
                yield from _believed(found)
            case "string" | "bits8":
                self._end = _string_end(found)
            case _:
                pass

    def _pass(self) -> Iterator[Message]:
        """Pass over a control string, or gather a paste, as far as it has come."""
        assert self._end is not None
        end = self._end.search(self._rest)
        if end is None:
            keep = self._rest.rfind(_ESC, max(0, len(self._rest) - len(_PASTE_BEGINS) + 1))
            upto = after = len(self._rest) if keep < 0 else keep
        else:
            upto, after = end.span()
        if self._pasted is not None and len(self._pasted) < MOST_PASTED:
            self._pasted += self._rest[:upto]
        del self._rest[:after]
        if end is not None:
            pasted, self._end, self._pasted = self._pasted, None, None
            if pasted is not None:
                yield _paste(pasted)


def _ended(whole: re.Match[bytes] | None, begun: re.Match[bytes]) -> bool:
    """Whether nothing more can belong to what is whole."""
    return whole is not None and whole.end() >= begun.end()


def _string_end(introducer: bytes) -> re.Pattern[bytes]:
    """What ends a control string: its terminator, another sequence, or a key that is to be heard
    whatever was torn: Ctrl+C."""
    ends = [rb"\x1b\\", rb"(?=\x1b[^\\])", rb"(?=[\x03\x18\x1a])"]
    if introducer[-1:] in (b"]", b"\x9d"):
        ends.append(rb"\x07")
    if introducer[:1] != _ESC:
        ends.append(rb"\xc2?\x9c")
    return re.compile(b"|".join(ends))


def _believed(sequence: bytes) -> Iterator[Message]:
    """The key that a whole sequence stands for, or nothing."""
    if _SYNCHRONIZED.fullmatch(sequence):
        yield TerminalSupportsSynchronizedOutput()
    elif _is_key(sequence):
        yield from _keys(sequence.decode())


def _is_key(sequence: bytes) -> bool:
    if len(sequence) > LONGEST_KEY:
        return False
    if sequence.decode(errors="replace") in ANSI_SEQUENCES_KEYS or _LETTER_KEY.fullmatch(sequence):
        return True
    if number := _NUMBER_KEY.fullmatch(sequence):
        return f"{number[1].decode()}~" in FUNCTIONAL_KEYS
    return _CODE_KEY.fullmatch(sequence) is not None


def _typed(text: str) -> Iterator[Message]:
    """Characters as keys; so many at once come from a paste that the terminal did not mark."""
    if len(text) >= BURST and not _NO_TEXT.search(text):
        yield events.Paste(_lines(text))
    elif text == "\x1b":
        yield events.Key("escape", text)
    else:
        yield from XTermParser().feed(text)


def _keys(sequence: str) -> Iterator[events.Key]:
    """Textual's own reading of a whole sequence, by a parser that has seen nothing else."""
    try:
        keys = [it for it in XTermParser().feed(sequence) if isinstance(it, events.Key)]
    except (ValueError, OverflowError):
        return
    told = sequence.count(";") == 2
    for key in keys:
        text = key.character or ""
        if text.isprintable() or (text in "\x7f\r\t" and not told):
            yield key


def _paste(data: bytes | bytearray) -> events.Paste:
    return events.Paste(_NO_TEXT.sub("", _lines(data.decode(errors="replace"))))


def _lines(text: str) -> str:
    return text.replace("\r\n", "\n").replace("\r", "\n")

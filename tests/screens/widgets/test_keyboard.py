"""What a terminal sends, and which of it are keys."""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from hypothesis import given
from hypothesis import strategies as st
from textual import events
from textual.message import Message

from game.screens.widgets.keyboard import BURST, PASTE_PATIENCE_S, PATIENCE_S, Keyboard

LATER_S = 60.0
FFFD = "replacement_character"

KEYS = {
    b"\x1b[A": "up",
    b"\x1b[B": "down",
    b"\x1bOC": "right",
    b"\x1b[1;2D": "shift+left",
    b"\x1b[5~": "pageup",
    b"\x1b[3;5~": "ctrl+delete",
    b"\x1b[[A": "f1",
    b"\x1bOP": "f1",
    b"\x1b[Z": "shift+tab",
    b"\x1b[97;;97u": "a",
    b"\x1b[97;5u": "ctrl+a",
    b"\x1b[13u": "enter",
    b"\x1b[57441u": "left_shift",
    b"\r": "enter",
    b"\x03": "ctrl+c",
    b"\x7f": "backspace",
    b" ": "space",
    b"j": "j",
    "ä".encode(): "ä",
    "日".encode(): "日",
    "🙂".encode(): "slightly_smiling_face",
}
"""Keys as terminals send them, whole."""

BODY = (
    st.binary(max_size=40)
    .map(lambda data: bytes(byte & 0x7F for byte in data))
    .map(lambda data: bytes(byte for byte in data if byte >= 0x20 and byte != 0x7F))
)
NO_KEYS = st.one_of(
    st.sampled_from(
        [
            b"\x1b[?62;1;4c",
            b"\x1b[>1;115;0c",
            b"\x1b[24;80R",
            b"\x1b[8;40;120t",
            b"\x1b[48;99999999;99999999;1;1t",
            b"\x1b[?2048;2$y",
            b"\x1b[I",
            b"\x1b[O",
            b"\x1b[<0;120;40M",
            b"\x1b[<64;10;10M",
            b"\x1b[201~",
            b"\x1b[55296u",
            b"\x1b[97;1;55296u",
            b"\x1b[97;1;13u",
            b"\x1b[97:65;2:3u",
            b"\x1b[1114112u",
            b"\x1b[" + b"9" * 5_000 + b"u",
            b"\x1b[65;1A",
            b"\x1b[49;1~",
            b"\x1b[?1u",
            b"\x1b(B",
            b"\x1bn",
            "\x1bä".encode(),
            b"\x80",
            b"\x9bA",
            b"\xc2\x9bA",
            b"\xc2\x85",
        ]
    ),
    st.builds(
        lambda kind, body, end: b"\x1b" + kind + body + end,
        st.sampled_from([b"P", b"X", b"]", b"^", b"_"]),
        BODY,
        st.just(b"\x1b\\"),
    ),
    BODY.map(lambda body: b"\x1b]" + body + b"\x07"),
    st.lists(st.integers(0x20, 0xFF), min_size=3, max_size=3).map(
        lambda report: b"\x1b[M" + bytes(report)
    ),
)
"""Whole sequences and bytes that are no keys."""


def heard(pieces: Iterable[bytes], pause_s: float = 0.0) -> list[Message]:
    keyboard, now_s, found = Keyboard(), 0.0, []
    for piece in pieces:
        found += list(keyboard.feed(piece, now_s))
        now_s += pause_s
        found += list(keyboard.tick(now_s))
    return [*found, *keyboard.tick(now_s + LATER_S)]


def keys(pieces: Iterable[bytes], pause_s: float = 0.0) -> list[str]:
    return [event.key for event in heard(pieces, pause_s) if isinstance(event, events.Key)]


@st.composite
def pieces(draw: st.DrawFn, data: bytes) -> list[bytes]:
    """The bytes cut anywhere."""
    cuts = sorted(draw(st.lists(st.integers(0, len(data)), max_size=8)))
    return [data[a:b] for a, b in zip([0, *cuts], [*cuts, len(data)], strict=True)]


@given(st.data(), st.lists(st.one_of(st.sampled_from([*KEYS]), NO_KEYS), max_size=12))
def test_keys_are_heard_and_nothing_else(data: st.DataObject, sent: list[bytes]) -> None:
    wanted = [KEYS[piece] for piece in sent if piece in KEYS]
    assert keys(data.draw(pieces(b"".join(sent))), pause_s=0.4) == wanted


NOISE = st.lists(
    st.one_of(
        st.binary(max_size=6),
        st.sampled_from(
            [*KEYS, b"\x1b", b"\x1b[", b"\x1b]", b"\x1b[M", b"\x1bO", b"\x9b", b"\xe4"]
        ),
        st.sampled_from([b"\x1b[200~", b"\x1b[201~", b"\x1b\\", b"\x07", b"\xf0\x9f"]),
        NO_KEYS,
    ),
    max_size=12,
).map(b"".join)


@given(st.data(), NOISE)
def test_any_bytes_in_any_split_give_the_same_and_never_raise(
    data: st.DataObject, noise: bytes
) -> None:
    cut = data.draw(pieces(noise))
    if len(noise) < BURST:
        assert keys(cut) == keys([noise])
    else:
        keys(cut)


@given(NOISE)
def test_a_key_is_made_of_bytes_that_were_sent(noise: bytes) -> None:
    keypad = "*+,-./0123456789=" if b"\x1bO" in noise else ""
    text = noise.decode(errors="replace") + keypad
    for event in heard([noise]):
        if isinstance(event, events.Key) and event.key != FFFD:
            sent = event.character or ""
            assert all(letter in text or str(ord(letter)) in text for letter in sent)


@given(NOISE)
def test_ctrl_c_is_heard_after_any_bytes(noise: bytes) -> None:
    keyboard = Keyboard()
    list(keyboard.feed(noise, 0.0))
    list(keyboard.tick(PASTE_PATIENCE_S))
    after = [*keyboard.feed(b"\x03", PASTE_PATIENCE_S + 1)]
    assert [event.key for event in after if isinstance(event, events.Key)] == ["ctrl+c"]


@pytest.mark.parametrize(
    ("sent", "wanted"),
    [
        (b"\x80", []),
        (b"\xe4 ", [FFFD, "space"]),
        (b"\xc3 ", [FFFD, "space"]),
        (b"\x9bA", []),
        (b"\xff\xfej", [FFFD, FFFD, "j"]),
        (b"\x1b", ["escape"]),
        (b"\x1b\x1b", ["escape", "escape"]),
        (b"\x1b\r", ["escape", "enter"]),
        (b"\x1b[1\x1b[A", ["up"]),
        (b"\x1b]10;rgb:dddd\x1b[A", ["up"]),
        (b"\x1b]10;rgb:dddd\x03", ["ctrl+c"]),
        (b"\x1b[200~qqq\x1b[201~j", ["j"]),
        (b"\x1b[200~qqq", []),
    ],
)
def test_examples(sent: bytes, wanted: list[str]) -> None:
    assert keys([sent]) == keys([bytes([byte]) for byte in sent]) == wanted


def test_escape_alone_waits_for_the_rest_of_a_key_but_not_for_ever() -> None:
    keyboard = Keyboard()
    assert [*keyboard.feed(b"\x1b", 0.0), *keyboard.tick(0.3)] == []
    (event,) = keyboard.tick(0.6)
    assert isinstance(event, events.Key) and event.key == "escape"


def test_a_torn_answer_is_waited_for_and_then_forgotten() -> None:
    keyboard = Keyboard()
    assert [*keyboard.feed(b"\x1b]11;rgb:dd", 0.0), *keyboard.tick(PATIENCE_S - 0.1)] == []
    assert [*keyboard.feed(b"dd/aa\x1b\\", PATIENCE_S - 0.1)] == []
    assert [*keyboard.feed(b"\x1b]11;rgb:dd", 10.0), *keyboard.tick(10 + PATIENCE_S)] == []
    (event,) = keyboard.feed(b"j", 20.0)
    assert isinstance(event, events.Key) and event.key == "j"


@pytest.mark.parametrize("marked", [True, False])
def test_a_large_paste_is_one_event_a_read(marked: bool) -> None:
    text = "schön und gut\r\n" * 4_000
    sent = b"\x1b[200~%b\x1b[201~" % text.encode() if marked else text.encode()
    found = heard([sent[at : at + 4_096] for at in range(0, len(sent), 4_096)])
    pasted = [event.text for event in found if isinstance(event, events.Paste)]
    assert len(found) == (1 if marked else len(pasted))
    assert "".join(pasted).count("schön") >= 3_990
    assert "\r" not in "".join(pasted)


def test_what_is_pasted_holds_no_controls() -> None:
    (event,) = heard([b"\x1b[200~a\x1b]0;b\x07\x00c\td\x1b[201~"])
    assert isinstance(event, events.Paste) and event.text == "a]0;bc\td"

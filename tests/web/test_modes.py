"""What a terminal that joins late is told."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from game.web.modes import RESET, Modes

pieces = st.lists(
    st.one_of(
        st.tuples(st.sampled_from([1, 25, 1000, 1049, 2004, 2026]), st.booleans()).map(
            lambda mode: b"\x1b[?%d%b" % (mode[0], b"h" if mode[1] else b"l")
        ),
        st.sampled_from([b"\x1b[?25;1049h", b"\x1b[1;31m", b"text", b"\x1b[?1049$p", b"\x1b[2J"]),
    ),
    max_size=12,
).map(b"".join)


@given(pieces, st.data())
def test_where_output_is_torn_makes_no_difference(output: bytes, data: st.DataObject) -> None:
    whole, torn = Modes(), Modes()
    whole.feed(output)
    at = 0
    while at < len(output):
        size = data.draw(st.integers(1, 9))
        torn.feed(output[at : at + size])
        at += size
    assert torn.prelude() == whole.prelude()


def test_the_last_word_on_a_mode_holds_and_paints_are_no_modes() -> None:
    modes = Modes()
    modes.feed(b"\x1b[?1049h\x1b[?25l\x1b[?2026hpaint\x1b[?2026l\x1b[?25h")
    assert modes.prelude() == RESET + b"\x1b[?1049h\x1b[?25h"
    assert Modes().prelude() == RESET

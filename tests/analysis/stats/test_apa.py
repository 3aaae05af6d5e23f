"""Numbers as a manuscript has them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.sources.absent import Absent
from analysis.stats.apa import bounded, decimal, p_value, p_words


@pytest.mark.parametrize(
    ("p", "text"),
    [(0.0, "< .001"), (0.00099, "< .001"), (0.001, ".001"), (0.0214, ".021"), (0.9996, "> .999"),
     (1.0, "> .999"), (0.05, ".050"), (None, "–"), (Absent("none"), "–")],
)  # fmt: skip
def test_p(p: float | Absent | None, text: str) -> None:
    assert p_value(p) == text
    assert p_words(p) == (f"p {text}" if text[0] in "<>" else f"p = {text}")


def test_numbers() -> None:
    assert [decimal(x) for x in (-0.001, 26.444, -3.0)] == ["0.00", "26.44", "−3.00"]
    assert [bounded(x, 2) for x in (-0.25, 0.164, 1.0, 10.5)] == ["−.25", ".16", "1.00", "10.50"]
    assert decimal(Absent("none")) == bounded(None) == "–"


@given(st.floats(0, 1))
def test_a_p_is_never_printed_as_nil(p: float) -> None:
    assert p_value(p).strip("<>= ") not in ("0", ".000", "0.000", "1.000")

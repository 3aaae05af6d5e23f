"""Numbers as the Publication Manual of the American Psychological Association (7th ed.) has them.

What cannot exceed 1 in size has no leading zero; p has three digits, and is never 0; what cannot be
had is a dash.
"""

from analysis.sources.absent import Absent

DASH = "–"
MINUS = "−"


def decimal(value: float | Absent | None, digits: int = 2) -> str:
    """A number with so many digits, "−0.00" never among them."""
    if value is None or isinstance(value, Absent):
        return DASH
    text = f"{value:.{digits}f}"
    if float(text) == 0:
        text = f"{0:.{digits}f}"
    return text.replace("-", MINUS)


def bounded(value: float | Absent | None, digits: int = 3) -> str:
    """A number that lies between -1 and 1 without its leading zero: ".164"."""
    text = decimal(value, digits)
    return text.replace("0.", ".", 1) if text.lstrip(MINUS).startswith("0.") else text


def share(value: float | Absent | None, digits: int = 3) -> str:
    """A share of variance, never below nothing: ".164", or "< .001" where it rounds to nil."""
    text = bounded(value, digits)
    least = f".{'0' * (digits - 1)}1"
    return f"< {least}" if text == f".{'0' * digits}" else text


def equals(text: str) -> str:
    """What a sentence has after a symbol: "= .021", or the text that has a sign already."""
    return text if text[0] in "<>" else f"= {text}"


def p_value(p: float | Absent | None) -> str:
    """ ".021", "< .001" or "> .999"."""
    if p is None or isinstance(p, Absent):
        return DASH
    if p < 0.001:
        return "< .001"
    return "> .999" if f"{p:.3f}" == "1.000" else bounded(p)


def p_words(p: float | Absent | None) -> str:
    """ "p = .021" or "p < .001"."""
    return f"p {equals(p_value(p))}"

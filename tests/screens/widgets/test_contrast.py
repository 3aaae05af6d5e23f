"""The colours of every theme can be told apart: by everybody, by a protanope, and in greyscale.

Contrast is that of WCAG 2.1: (L1 + .05) / (L2 + .05) of relative luminances, all that is left in
greyscale. Colour blindness is simulated as by Machado, Oliveira and Fernandes (2009), severity 1.
"""

from collections.abc import Mapping

import pytest
from rich.color import Color, ColorSystem

from game.screens.widgets.preferences import Ground
from game.screens.widgets.theme import THEMES, theme_name

Matrix = tuple[tuple[float, float, float], ...]

EYES: dict[str, Matrix] = {
    "everybody and greyscale": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "a protanope": (
        (0.152286, 1.052583, -0.204868),
        (0.114503, 0.786281, 0.099216),
        (-0.003882, -0.048116, 1.051998),
    ),
    "a deuteranope": (
        (0.367322, 0.860646, -0.227968),
        (0.280085, 0.672501, 0.047413),
        (-0.011820, 0.042940, 0.968881),
    ),
}
TEXT, SHAPE, GROUND = 4.5, 2.8, 1.5
LEAST: dict[tuple[str, str], float] = {
    ("red", "floor"): TEXT,
    ("red", "known-floor"): 4.4,
    ("blue", "floor"): TEXT,
    ("name", "floor"): TEXT,
    ("player", "on-red-ground"): TEXT,
    ("player", "on-blue-ground"): TEXT,
    ("treated-red", "treated"): TEXT,
    ("treated-blue", "treated"): TEXT,
    ("bar-text", "bar"): TEXT,
    ("on-notice", "notice"): TEXT,
    ("text", "dark"): TEXT,
    ("quiet", "dark"): TEXT,
    ("player", "player-tile"): 4.3,
    ("rescued", "floor"): SHAPE,
    ("expired", "floor"): SHAPE,
    ("seen-red", "seen-floor"): SHAPE,
    ("seen-blue", "seen-floor"): SHAPE,
    ("seen-rescued", "seen-floor"): SHAPE,
    ("seen-expired", "seen-floor"): SHAPE,
    ("wall", "floor"): SHAPE,
    ("door", "floor"): SHAPE,
    ("seen-wall", "seen-floor"): SHAPE,
    ("seen-door", "seen-floor"): SHAPE,
    ("seen-floor", "unseen"): GROUND,
    ("known-floor", "map-floor"): GROUND,
    ("map-wall", "map-floor"): GROUND,
    ("map-door", "map-floor"): GROUND,
    ("wall", "seen-wall"): GROUND,
    ("door", "wall"): GROUND,
    ("known-door", "known-wall"): GROUND,
    ("floor", "seen-floor"): 1.15,
}
"""How much each pair of colours differs at least."""

GROUNDS = ("dark", "light")
DEPTHS: dict[str, Mapping[str, str]] = {
    "truecolor": {"COLORTERM": "truecolor"},
    "256": {"TERM": "xterm-256color"},
}


def as_sent(colour: str, depth: str) -> str:
    """What a terminal of so many colours is sent for `#rrggbb`."""
    if depth == "truecolor":
        return colour
    return Color.parse(colour).downgrade(ColorSystem.EIGHT_BIT).get_truecolor().hex


def luminance(colour: str, eyes: Matrix) -> float:
    """Relative luminance of `#rrggbb`, as these eyes see it."""
    parts = [int(colour[start : start + 2], 16) / 255 for start in (1, 3, 5)]
    light = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    seen = [min(1.0, max(0.0, sum(a * b for a, b in zip(row, light, strict=True)))) for row in eyes]
    return 0.2126 * seen[0] + 0.7152 * seen[1] + 0.0722 * seen[2]


def contrast(one: str, other: str, eyes: Matrix) -> float:
    low, high = sorted((luminance(one, eyes), luminance(other, eyes)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("eyes", EYES)
@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("ground", GROUNDS)
def test_colours_can_be_told_apart(ground: Ground, depth: str, eyes: str) -> None:
    name = theme_name(DEPTHS[depth], ground)
    inks = {
        ink: as_sent(colour, depth)
        for theme in THEMES
        if theme.name == name
        for ink, colour in theme.variables.items()
    }
    found = {
        (one, other): contrast(inks[f"ana-{one}"], inks[f"ana-{other}"], EYES[eyes])
        for one, other in LEAST
    }
    assert {pair: round(it, 2) for pair, it in found.items() if it < LEAST[pair]} == {}


def test_contrast_is_what_it_should_be() -> None:
    plain = EYES["everybody and greyscale"]
    assert contrast("#000000", "#ffffff", plain) == pytest.approx(21)
    assert contrast("#777777", "#ffffff", plain) == pytest.approx(4.48, abs=0.01)
    red, grey = "#ff0000", "#5f5f5f"
    assert contrast(red, grey, EYES["a protanope"]) < contrast(red, grey, plain)


def test_the_colours_of_256_are_sent_as_they_are_named() -> None:
    usual = {theme.name: theme.variables for theme in THEMES}
    for ground in GROUNDS:
        for ink, colour in usual[f"ana-{ground}-256"].items():
            if colour != usual[f"ana-{ground}"][ink]:
                assert as_sent(colour, "256") == colour


def test_the_themes_have_the_same_colours() -> None:
    names = [
        set(theme.variables) & {f"ana-{ink}" for pair in LEAST for ink in pair} for theme in THEMES
    ]
    assert all(found == names[0] for found in names)

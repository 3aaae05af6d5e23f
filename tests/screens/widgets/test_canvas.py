"""A canvas on a screen: what is painted of its rows."""

from __future__ import annotations

from typing import ClassVar

import pytest
from textual.app import App, ComposeResult
from textual.geometry import Region

from game.screens.widgets.canvas import Canvas, Row

ROWS: list[Row] = [
    (("ab", "ink"), ("   ", "ink"), ("室室", "ink/paper")),
    (),
    (("long" * 9, "ink"),),
]


class Drawing(Canvas):
    COMPONENT_CLASSES: ClassVar[set[str]] = {"ink", "paper"}


class Page(App[None]):
    CSS = """
    Drawing { width: 20; height: 4; color: #ffffff; background: #000000; }
    Drawing > .ink { color: #ff0000; background: #0000ff; text-style: bold; }
    Drawing > .paper { background: #00ff00; }
    """

    def compose(self) -> ComposeResult:
        yield Drawing(ROWS)


class PaddedPage(Page):
    CSS = Page.CSS + "Drawing { padding: 1; }"


@pytest.mark.parametrize("crop", [Region(0, 0, 20, 4), Region(3, 0, 5, 2), Region(6, 0, 14, 3)])
async def test_it_paints_just_what_is_asked_for(crop: Region) -> None:
    app = Page()
    async with app.run_test():
        drawing = app.query_one(Drawing)
        whole = drawing.render_lines(Region(0, 0, 20, 4))
        part = drawing.render_lines(crop)
        assert [strip.cell_length for strip in part] == [crop.width] * crop.height
        for strip, y in zip(part, crop.line_range, strict=True):
            assert strip.text == whole[y].crop(crop.x, crop.right).text


async def test_only_a_line_that_changed_is_made_anew() -> None:
    app = Page()
    async with app.run_test() as pilot:
        drawing = app.query_one(Drawing)
        before = drawing.render_lines(Region(0, 0, 20, 4))
        drawing.draw([ROWS[0], (("new", "ink"),), ROWS[2]])
        after = drawing.render_lines(Region(0, 0, 20, 4))
        assert [old is new for old, new in zip(before, after, strict=True)] == [
            True,
            False,
            True,
            True,
        ]
        assert after[1].text == "new".ljust(20)
        drawing.styles.width = 10
        await pilot.pause()
        assert {strip.cell_length for strip in drawing.render_lines(Region(0, 0, 10, 4))} == {10}


async def test_a_blank_is_sent_without_ink() -> None:
    app = Page()
    async with app.run_test():
        first, blank, wide, rest = app.query_one(Drawing).render_lines(Region(0, 0, 20, 1))[0]
        assert first.style is not None and first.style.color is not None and first.style.bold
        assert blank.style is not None and blank.style.color is None
        assert blank.style.bgcolor == first.style.bgcolor
        assert wide.style is not None and wide.style.bgcolor != first.style.bgcolor
        assert rest.text == " " * 11


async def test_padding_is_refused() -> None:
    with pytest.raises(AssertionError, match="cannot have a border or padding"):
        async with PaddedPage().run_test():
            pass


async def test_without_colours_none_is_sent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    app = Page()
    async with app.run_test():
        styles = [
            segment.style for segment in app.query_one(Drawing).render_lines(Region(0, 0, 5, 1))[0]
        ]
        colours = [c for style in styles if style for c in (style.color, style.bgcolor) if c]
        assert all(len(set(colour.get_truecolor())) == 1 for colour in colours)

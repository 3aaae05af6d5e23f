"""A page of text: its title, and its paragraphs with what stands out in them."""

from __future__ import annotations

from textual.content import Content
from textual.widgets import Static

from game.study.texts import Page


def heading(page: Page) -> Static:
    """A page's title."""
    return Static(page.title, classes="title", markup=False)


def body(page: Page) -> Static:
    """A page's text; what stands between two pairs of asterisks stands out."""
    plain, *rest = page.body.strip().split("**")
    parts: list[str | tuple[str, str]] = [plain]
    for number, part in enumerate(rest):
        parts.append((part, "bold $primary") if number % 2 == 0 else part)
    return Static(Content.assemble(*parts), classes="body")

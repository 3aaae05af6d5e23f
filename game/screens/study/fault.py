"""What a participant sees when the program fails: a page in the study's own words, and no more."""

from __future__ import annotations

import syslog
from pathlib import PurePath
from traceback import format_exception
from typing import ClassVar

import click
from textual import work

from game.errors import STATUS_DEFECT
from game.screens.study.base import Frame
from game.screens.study.pages import PageScreen
from game.screens.widgets.program import Program
from game.screens.widgets.signals import lead_out
from game.study.study_settings import ScreenSize
from game.study.texts import Page, Texts, filled

SYSTEM_LOG = "ana"
"""The name that lines in the system's log begin with."""


class FaultApp(Program, inherit_bindings=False):
    """A program of one page: the one that failed may have nothing left to show it with."""

    CSS_PATH: ClassVar[list[str | PurePath]] = [
        "../widgets/styles/base.tcss",
        "../widgets/styles/pages.tcss",
        "study.tcss",
    ]

    def __init__(self, page: Page, texts: Texts) -> None:
        super().__init__()
        self._page, self._texts = page, texts

    def on_mount(self) -> None:
        lead_out(lambda _: None, lambda status: self.exit(return_code=status))
        self._show()

    @work
    async def _show(self) -> None:
        columns, rows = self.size
        size = ScreenSize(columns=min(max(columns, 80), 400), rows=min(max(rows, 24), 200))
        await self.push_screen_wait(PageScreen(Frame(size, self._texts.words), self._page))
        self.exit()


def cannot_go_on(error: Exception, texts: Texts) -> int:
    """Log the error with its traceback, and tell the participant that the study cannot continue;
    the exit status."""
    log_to_system("".join(format_exception(error)))
    page = filled(texts.words.trouble, problem=texts.words.fault)
    try:
        FaultApp(page, texts).perform()
    except Exception:
        tell_plainly(page)
    return STATUS_DEFECT


def log_to_system(text: str) -> None:
    """Write lines to the system's log."""
    syslog.openlog(SYSTEM_LOG)
    for line in text.splitlines():
        syslog.syslog(syslog.LOG_ERR, line)


def tell_plainly(page: Page) -> None:
    """Print a page where there are no screens."""
    click.echo(f"\n{page.title}\n\n{page.body.strip()}\n", err=True)

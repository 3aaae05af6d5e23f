"""A participant at the screens of a study: seated, looked for, and let go."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, suppress
from typing import Any

from textual.pilot import Pilot

from game.journal.history import Step
from game.screens.study.app import StudyApp
from game.screens.study.base import StudyScreen
from game.screens.study.form_screen import FormScreen
from game.study.folder import Study
from game.study.lock import SessionBusy, SessionLock
from tests.screens.pilots import until
from tests.study.people import P01, journal_of, rewind

SIZE = (120, 40)


def kinds_of(screen: type[StudyScreen[Any]]) -> Iterator[type[StudyScreen[Any]]]:
    """A class of screens, and all below it."""
    yield screen
    for kind in screen.__subclasses__():
        yield from kinds_of(kind)


@asynccontextmanager
async def at(study: Study, step: Step | None = None) -> AsyncIterator[Pilot[None]]:
    if step is not None:
        rewind(study, step)
    async with StudyApp(study, P01).run_test(size=SIZE) as pilot:
        yield pilot
    await let_go(study)


async def let_go(study: Study) -> None:
    """Wait until the session's lock is free, as it is as soon as its process ends."""
    for _ in range(250):
        with suppress(SessionBusy):
            SessionLock(study.home(P01)).release()
            return
        await asyncio.sleep(0.02)
    raise AssertionError("the lock is still held")


async def closed(pilot: Pilot[Any]) -> None:
    """Wait for the program to end."""
    for _ in range(500):
        if pilot.app._exit:
            return
        await pilot.pause(0.02)
    raise AssertionError("it goes on")


async def form(pilot: Pilot[None], phase: str) -> FormScreen:
    """The form of a phase, once it is on the screen."""
    for _ in range(1000):
        session = pilot.app.session  # type: ignore[attr-defined]
        if session is not None and session.step.phase == phase:
            shown: FormScreen = await until(pilot, FormScreen)
            return shown
        await pilot.pause(0.02)
    raise AssertionError(f"{pilot.app.screen} is shown, not {phase}")


def records(study: Study, kind: type, phase: str = "", segment: int | None = None) -> list[Any]:
    return [
        entry.record
        for entry in journal_of(study).entries
        if isinstance(entry.record, kind)
        and phase in ("", entry.envelope.phase)
        and segment in (None, entry.envelope.segment)
    ]

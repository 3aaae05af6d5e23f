"""Who may come in, and what runs for them: participants of a study, or players on this computer."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Mapping
from contextlib import suppress
from typing import Protocol
from urllib.parse import quote

from game.journal.folders import JOURNAL
from game.journal.journal_error import JournalError
from game.journal.reader import read_journal
from game.journal.records import Debriefed
from game.study.folder import Identity, Study, admit_by_roster, identify
from game.study.lab.sshd import ID_VARIABLE, program
from game.study.links import LINK, LinkError, of_token, panel_pseudonym, study_key, token
from game.study.study_settings import ScreenSize
from game.study.texts import BrowserWords, shipped_texts
from game.web.hosted import Ending, Visitor

PASSED_ON = ("HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "TZ")
"""What a program's environment has from the server's, besides what it needs of a terminal."""


class Door(Protocol):
    """Where visitors come in."""

    title: str
    language: str
    words: BrowserWords
    size: ScreenSize

    def ticket(self, query: Mapping[str, str]) -> str:
        """What a page shows to get a line, given the query of its address.

        Raises AnaError for someone who may not come in.
        """
        ...

    def visitor(self, ticket: str, tab: str) -> Visitor:
        """Who comes with a ticket, in a window of the browser. Raises AnaError."""
        ...


class StudyDoor:
    """Participants come with a link that was made for them, or with a panel's ID."""

    def __init__(self, study: Study) -> None:
        """Raises AnaError where the study's key cannot be used or `ana` is not installed."""
        self.study = study
        self.title = study.settings.name
        self.language = study.phrases.language
        self.words = study.texts.browser
        self.size = study.settings.screen
        self._key = study_key(study.folder)
        self._ana = str(program())

    def ticket(self, query: Mapping[str, str]) -> str:
        panel = self.study.settings.web.panel_id
        if LINK in query:
            of_token(self._key, query[LINK])
            return query[LINK]
        if panel and panel in query:
            return token(self._key, self._of_panel(query[panel]))
        raise LinkError("this address is nobody's link")

    def visitor(self, ticket: str, tab: str) -> Visitor:
        participant, pilot = of_token(self._key, ticket)
        identity = identify(participant, pilot=pilot)
        command = [self._ana, "study", "login", str(self.study.folder.resolve())]

        async def ending(status: int) -> Ending:
            return await asyncio.to_thread(self._ending, identity, status)

        return Visitor(
            "/".join(identity),
            (*command, "--pilot") if pilot else tuple(command),
            environment() | {ID_VARIABLE: identity.participant},
            self.size,
            ending,
        )

    def _of_panel(self, panel_id: str) -> str:
        hashed = panel_pseudonym(self._key, panel_id)
        name = hashed if self.study.settings.web.hash_ids else panel_id
        identity = identify(name)
        admit_by_roster(self.study.folder, identity)
        return identity.participant

    def _ending(self, identity: Identity, status: int) -> Ending:
        """What is left to tell, from the journal of a session that came to its end."""
        code = ""
        with suppress(JournalError, OSError):
            for entry in read_journal(self.study.home(identity) / JOURNAL).entries:
                if isinstance(entry.record, Debriefed):
                    code = entry.record.completion_code
        url = self.study.settings.web.return_url if code and not status else ""
        return Ending(status=status, code=code, url=url.replace("{code}", quote(code, safe="")))


class PlayDoor:
    """Anyone on this computer plays, each window by itself."""

    title = "ana"
    language = "en"
    size = ScreenSize()

    def __init__(self) -> None:
        self.words = shipped_texts().browser

    def ticket(self, query: Mapping[str, str]) -> str:
        return "play"

    def visitor(self, ticket: str, tab: str) -> Visitor:
        if ticket != "play":
            raise LinkError("this address is nobody's link")

        async def ending(status: int) -> Ending:
            return Ending(status=status)

        return Visitor(tab, (sys.executable, "-m", "game"), environment(), self.size, ending)


def environment() -> dict[str, str]:
    """A program's own environment: nothing of the server's reaches it by accident."""
    kept = {name: os.environ[name] for name in PASSED_ON if name in os.environ}
    return kept | {
        "TERM": "xterm-256color",
        "COLORTERM": "truecolor",
        "LANG": "C.UTF-8",
        "PATH": os.defpath,
    }

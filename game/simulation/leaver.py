"""Simulated people who do not take part to the end."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any, cast

from game.rescuers.person import Population
from game.rescuers.person.randomness import stream
from game.study.protocol.conduct import Participant, Stopped
from game.study.protocol.study_session import StudySession

LAST_PAGES = 19
"""So many pages and tasks there are from the first map to memorise to the last question, in the
paper's protocol; whoever leaves does so before one of them."""


class Leaver:
    """Does what another participant does, and stops before the page or task after `pages`, counted
    from the first map to memorise on."""

    def __init__(self, person: Participant, pages: int) -> None:
        self._person = person
        self._pages = pages
        self._begun = False

    @classmethod
    def of(cls, person: Participant, pages: int) -> Participant:
        """The participant who leaves."""
        return cast(Participant, cls(person, pages))

    def __getattr__(self, name: str) -> Callable[..., Awaitable[Any]]:
        does = getattr(self._person, name)

        async def while_there(*asked: Any) -> Any:
            self._begun |= name == "memorise"
            if self._begun:
                if not self._pages:
                    raise Stopped
                self._pages -= 1
            return await does(*asked)

        return while_there


def pages_before_leaving(session: StudySession, population: Population) -> int | None:
    """How many pages and tasks a person sees before they leave; None for those who stay."""
    chance = stream(session.seed, "leaving")
    return chance.randrange(1, LAST_PAGES) if chance.random() < population.leaving else None

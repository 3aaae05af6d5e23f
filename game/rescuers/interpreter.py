"""Simulated people and instructions in another language.

Their grammar is that of English. Somebody in a translated study knows its language, so
an interpreter stands between the bar and them: each sentence becomes the English one of the same
tuple, and takes as long to read as that.
"""

from __future__ import annotations

import re
from functools import cached_property

from game.coach.acts import Level
from game.coach.instructions.phrasebook import Phrasebook, everything_said
from game.coach.instructions.phrasebook_file import english
from game.rescuers.driver import Rescuer, Wait
from game.world.building import Building
from game.world.events import Action
from game.world.observation import Guidance, Observation


class Interpreted:
    """Decides as `rescuer` does, who is shown the instructions of `phrases` in English."""

    def __init__(self, rescuer: Rescuer, phrases: Phrasebook, building: Building) -> None:
        self._rescuer = rescuer
        self._phrases = phrases
        self._rooms = tuple(room.name for room in building.rooms)
        self._known: dict[str, str] = {"": ""}

    def decide(self, observation: Observation) -> Action | Wait | None:
        return self._rescuer.decide(observation._replace(guidance=self._in_english(observation)))

    def _in_english(self, observation: Observation) -> Guidance | None:
        bar = observation.guidance
        return bar and Guidance(self._read(bar.text), self._read(bar.notice))

    def _read(self, text: str) -> str:
        if text not in self._known:
            found = [self._dictionary[it] for it in self._pattern.findall(text)]
            self._known[text] = english().joined(found)
        return self._known[text]

    @cached_property
    def _dictionary(self) -> dict[str, str]:
        """The English of every sentence and notice."""
        here, there = self._phrases, english()
        meanings = {
            here.render(level, (said,)): there.render(level, (said,))
            for level in Level
            for said in everything_said(level, self._rooms)
        }
        return meanings | {here.notices[name]: there.notices[name] for name in here.notices}

    @cached_property
    def _pattern(self) -> re.Pattern[str]:
        return re.compile("|".join(map(re.escape, sorted(self._dictionary, key=len)[::-1])))


def interpreted(rescuer: Rescuer, phrases: Phrasebook, building: Building) -> Rescuer:
    """`rescuer` as they are in a study whose instructors say `phrases`."""
    return rescuer if phrases == english() else Interpreted(rescuer, phrases, building)

"""The bounded person as a rescuer: reads the bar, does what it is understood to say, and goes on
looking when the words make no sense."""

from __future__ import annotations

import re
from collections.abc import Generator
from dataclasses import replace
from functools import lru_cache
from random import Random

from game.rescuers.driver import Wait
from game.rescuers.literal import looking
from game.rescuers.literal.execution import Doing, Stuck
from game.rescuers.literal.grammar import GoTo, ProceedTo, Sentence, TakeDoor, Turn, parse
from game.rescuers.person.experience import Experience, style_of
from game.rescuers.person.hands import Hands
from game.rescuers.person.memory import MapMemory
from game.rescuers.person.parameters import Traits
from game.rescuers.person.wayfinding import BoundedWalker, Search
from game.world.building import Severity
from game.world.events import Action
from game.world.geometry import Cell, Heading
from game.world.observation import Guidance, Observation
from game.world.settings import Controls

TIRED_MS = 240_000
"""When the fatigue of a mission is full."""

_MIRRORED: dict[Sentence, Sentence] = {
    Turn("left"): Turn("right"),
    Turn("right"): Turn("left"),
    Turn("around"): Turn("around"),
}


class BoundedPerson:
    """Somebody with `traits` and a memory of the map, at the keys.

    `weariness` is the fatigue brought along, in shares of `traits.fatigue`. `experience` tells
    afterwards what the mission was like.
    """

    def __init__(
        self,
        traits: Traits,
        memory: MapMemory,
        controls: Controls,
        chance: Random,
        *,
        weariness: float = 0.0,
    ) -> None:
        self.experience = Experience(memory.knowledge)
        self._traits = traits
        self._memory = memory
        self._unknowing = 1 - memory.knowledge
        self._controls: Controls = controls
        self._chance = chance
        self._weariness = weariness
        self._search = Search(memory)
        self._hands = Hands(traits, controls, chance)
        self._bar = Guidance("")
        self._doing: Generator[Action, Observation, None] | None = None
        self._begun = False
        self._puzzled = False
        self._glimpsed: set[Cell] = set()
        self._roaming = False

    def decide(self, observation: Observation) -> Action | Wait | None:
        """The next key, or how long until then; None during a treatment and with an empty bar."""
        now = observation
        self._live_through(now)
        bar = now.guidance
        if now.treatment is not None or now.ended or bar is None or not bar.text:
            self._doing = None
            return None
        if self._doing is None or (self._is_news(bar) and not self._roaming):
            self._turn_to(bar, now)
        elif not self._roaming:
            self._bar = bar
        self._hands.see(now, self._thought_ms(self._traits.reaction_ms, now))
        if self._hands.idle:
            self._hands.mean(self._next_step(now))
        slowness = self._traits.lost_pace if self._search.under_way else 1.0
        return self._hands.press(now, self._traits.slip * self._tiredness(now), slowness)

    # --- attention ------------------------------------------------------------------------------

    def _live_through(self, now: Observation) -> None:
        """Time went by; names of rooms may have come into view."""
        puzzled = self._puzzled or self._hands.correcting
        searching = self._search.under_way
        self.experience.passed(now.time_ms, searching=searching, puzzled=puzzled)
        if now.rescued > self.experience.rescued:
            self._roaming = self._chance.random() < self._traits.stray
        self.experience.rescued = now.rescued
        for room in now.rooms:
            if room.name == self._search.wanted:
                self._memory.learn(room.label, room.name)
            elif room.label not in self._glimpsed:
                self._glimpsed.add(room.label)
                if self._chance.random() < self._traits.retention:
                    self._memory.learn(room.label, room.name)

    def _turn_to(self, bar: Guidance, now: Observation) -> None:
        """Something else is on the bar, or nothing keeps from it any more: read it."""
        if self._is_news(bar):
            self.experience.told(parsed(bar.text), corrected=bool(bar.notice))
            doubted = bar.notice and bar.text == self._bar.text and self._search.under_way
            if doubted and self._chance.random() < self._traits.trust:
                self._search.change_mind()
        self._bar = bar
        self._do(self._roam(now) if self._roaming else self._attend(now))

    def _is_news(self, bar: Guidance) -> bool:
        """Whether there is something to read: a notice that goes away is nothing."""
        return bar.text != self._bar.text or bar.notice not in ("", self._bar.notice)

    def _do(self, doing: Generator[Action, Observation, None]) -> None:
        self._hands.let_go()
        self._search.under_way = self._puzzled = False
        self._doing, self._begun = doing, False

    def _next_step(self, now: Observation) -> Action:
        assert self._doing is not None
        begun, self._begun = self._begun, True
        return self._doing.send(now) if begun else next(self._doing)

    def _tiredness(self, now: Observation) -> float:
        """By what factor everything is harder now than for somebody fresh."""
        spent = self._weariness + min(1.0, now.time_ms / TIRED_MS)
        return 1 + self._traits.fatigue * spent

    def _thought_ms(self, ms: float, now: Observation) -> int:
        return round(ms * self._tiredness(now))

    def _think(self, ms: float, now: Observation) -> None:
        """Press nothing for so long."""
        self._hands.rest_until(now.time_ms + self._thought_ms(ms, now))

    # --- doing what the bar says ----------------------------------------------------------------

    def _attend(self, now: Observation) -> Generator[Action, Observation, None]:
        """Do what the bar says, again and again for as long as it says so."""
        while True:
            began = now
            try:
                now = yield from self._carry_out(now)
                made_sense = now is not began
            except Stuck:
                made_sense = False
            if not made_sense:
                now = yield from self._look_around(self._latest)

    def _carry_out(self, now: Observation) -> Doing:
        """Sentence by sentence; the next one is read while the one before is being done."""
        self._latest = now
        read_ms = now.time_ms + self._thought_ms(self._traits.reaction_ms, now)
        read_ms += self._reading_ms(self._bar.notice, now)
        walker = BoundedWalker(
            self._controls,
            now.heading,
            self._search,
            lambda: self._think(self._traits.recall_ms, self._latest),
        )
        for written in sentences_of(self._bar.text):
            read_ms += self._reading_ms(written, now)
            self._hands.rest_until(read_ms)
            sentence = self._understood(parsed(written)[0], now, read_ms)
            doing = walker.carry_out((sentence,), now)
            now = yield from self._watched(doing, now)
        return now

    def _watched(self, doing: Doing, now: Observation) -> Doing:
        """Do something, and keep what was seen last."""
        try:
            action = next(doing)
            while True:
                now = self._latest = yield action
                action = doing.send(now)
        except StopIteration:
            return now

    def _tried(self, doing: Doing, now: Observation) -> Doing:
        """Do something of one's own, as far as it goes: a wrong key may lead off the way."""
        self._latest = now
        try:
            return (yield from self._watched(doing, now))
        except Stuck:
            return self._latest

    def _reading_ms(self, words: str, now: Observation) -> int:
        return self._thought_ms(len(words.split()) * self._traits.ms_per_word, now)

    def _understood(self, sentence: Sentence, now: Observation, read_ms: int) -> Sentence:
        """What the person takes a sentence to mean that has been read at `read_ms`, and the time to
        make sense of it, which comes after the reading."""
        traits, chance = self._traits, self._chance
        read_ms = max(read_ms, now.time_ms)
        if isinstance(sentence, GoTo):
            self._hands.rest_until(read_ms + self._thought_ms(traits.recall_ms, now))
        elif style_of((sentence,)) == 2:
            sense_ms = self._thought_ms(traits.interpret_ms * self._unknowing, now)
            self._hands.rest_until(read_ms + sense_ms)
        if isinstance(sentence, ProceedTo | TakeDoor):
            if chance.random() < traits.misread:
                sentence = self._misread(sentence)
            return replace(sentence, number=self._counted(sentence.number))
        confusing = isinstance(sentence, Turn) and now.heading is not Heading.NORTH
        return _MIRRORED[sentence] if confusing and chance.random() < traits.mirror else sentence

    def _misread(self, sentence: ProceedTo | TakeDoor) -> ProceedTo | TakeDoor:
        """Another sentence of the same kind."""
        if self._chance.random() < 0.5:
            return replace(sentence, side="right" if sentence.side == "left" else "left")
        return replace(sentence, number=max(1, sentence.number + self._chance.choice((-1, 1))))

    def _counted(self, number: int) -> int:
        """The door or opening that is taken for the `number`th: each may be miscounted."""
        traits, chance = self._traits, self._chance
        wrong = traits.miscount + traits.miscount_unknowing * self._unknowing
        errors = sum(
            chance.choice((-1, 1)) if chance.random() < wrong else 0 for _ in range(number)
        )
        return max(1, number + errors)

    # --- doing something else -------------------------------------------------------------------

    def _look_around(self, now: Observation) -> Doing:
        """Walk somewhere in view, rather to a door, until the patience for it is over."""
        self._puzzled = True
        self._think(self._traits.reaction_ms, now)
        until_ms = now.time_ms + self._traits.patience_s * 1000
        walker = BoundedWalker(self._controls, now.heading, self._search, lambda: None)
        moved = False
        while not moved or now.time_ms < until_ms:
            way = self._way_somewhere(now)
            now = yield from self._tried(walker.go_along(now, way), now)
            moved = True
        self._puzzled = False
        return now

    def _way_somewhere(self, now: Observation) -> list[Cell]:
        plan = now.plan
        in_view = [
            cell for cell in plan.cells(now.visible & plan.walkable_mask) if cell != now.position
        ]
        doors = [cell for cell in in_view if plan.is_door(cell)]
        aim = self._chance.choice(doors or in_view)
        return looking.ways_to_nearest(now.position, aim.__eq__, plan.walkable)[0]

    def _roam(self, now: Observation) -> Generator[Action, Observation, None]:
        """Go one's own way, whatever the bar says: into the nearest room that was not seen yet,
        treat who lies there in view, and attend to the bar again."""
        self._latest = now
        walker = BoundedWalker(self._controls, now.heading, self._search, lambda: None)
        unseen = frozenset(self._memory.sites) - self._glimpsed
        aim = self._memory.nearest(now.terrain.floodfills, now.position, unseen)
        if aim is not None:
            now = yield from self._tried(walker.head_for(now, aim), now)
        for severity in Severity:
            for victim in looking.waiting(now, severity):
                ways = looking.ways_to_nearest(now.position, victim.__eq__, now.plan.walkable)
                now = yield from self._tried(walker.treat_at(now, ways[0]), now)
        self._roaming = False
        self._bar = now.guidance or self._bar
        yield from self._attend(now)


@lru_cache(maxsize=4096)
def sentences_of(text: str) -> tuple[str, ...]:
    """The sentences of a text as they are written."""
    return tuple(sentence.strip() for sentence in re.findall(r"[^.]+\.", text))


@lru_cache(maxsize=4096)
def parsed(text: str) -> tuple[Sentence, ...]:
    """The sentences of a text."""
    return parse(text)

"""Every number that makes a simulated person, with the reason for it.

Sources: Brysbaert, M. (2019), How many words do we read per minute?, Journal of Memory and
Language 109: 238 words of English prose a minute. Hick, W. E. (1952), On the rate of gain of
information, Quarterly Journal of Experimental Psychology 4: about 0.3 to 0.4 s to choose one of
four keys. The others are judgements, marked so; `docs/simulated-people.md` shows which conclusions
depend on them.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

from game.rescuers.person.randomness import clipped, normal, stream


@dataclass(frozen=True)
class Traits:
    """What one person is like. The defaults are the typical person of the population `default`."""

    ability: float = 0.45
    """Rate at which unknown rooms are learned from the map, a minute: the share known after m
    minutes is 1 - exp(-ability m). Gives 0.36 after one minute and 0.74 after three, as the paper
    asks for "a wide, near-uniform spread of participant preparedness" (5.3)."""
    gist: float = 0.5
    """Chance that of a room that was not learned its part of the building is (judgement)."""
    gist_cells: float = 12
    """How far off, in cells each way, such a hunch is (judgement)."""
    mix_up: float = 0.04
    """Chance that a learned room is taken for a neighbour (judgement)."""
    retention: float = 0.85
    """Chance that the name of a room that is seen in passing is remembered (judgement)."""
    ms_per_word: float = 190
    """Silent reading: 252 ms a word of prose, faster for stock phrases read again and again."""
    reaction_ms: float = 380
    """From a change on the bar until reading begins, and from seeing an error to correcting it."""
    step_ms: float = 210
    """Between two presses of one key; a held key walks at the mission's pace, which is 200 ms."""
    key_change_ms: float = 300
    """Between presses of two different keys: a choice of one in four, partly prepared."""
    lost_pace: float = 1.2
    """How many times longer a step takes somebody who walks without knowing where to and slows down
    at openings and doors to look (judgement; set so that who knows no room rescues about 11)."""
    recall_ms: float = 900
    """To call a known room's place to mind and choose a way, once its name has been read
    (judgement; the mental operator of the keystroke-level model is 1.35 s)."""
    interpret_ms: float = 700
    """To match the words door, hallway and intersection to what the screen shows, for somebody who
    knows nothing of the map; in proportion less with knowledge (paper 5.5; judgement)."""
    slip: float = 0.004
    """Chance that a press is the wrong key (judgement)."""
    mirror: float = 0.025
    """Chance that left and right of a turn are mixed up, unless the way leads up the screen."""
    miscount: float = 0.03
    """Chance that a door or intersection that is counted is missed or counted twice."""
    miscount_unknowing: float = 0.07
    """What is added to that without any knowledge of the map (paper 5.5; judgement)."""
    misread: float = 0.08
    """Chance that a sentence that counts doors or openings is taken for one that means the other
    side, or the one before or after. People failed 32% of the routes that others had described to
    them freely, without corrections (MacMahon and Stankiewicz 2006). Our words are never ambiguous:
    with this, people go astray on one leg in eight at C2 (judgement)."""
    patience_s: float = 5
    """How long somebody looks around before trying another way when words make no sense."""
    trust: float = 0.8
    """Chance that a correction of the instructor changes the mind of somebody who searches."""
    stray: float = -0.25
    """Chance, after each rescue, of going one's own way: into the nearest room not seen yet,
    whatever the bar says. Below 0 means never: one person in six does at all, and one in forty
    after every fourth rescue (judgement)."""
    fatigue: float = 0.12
    """By how much all that takes thought is slower, and slips are more frequent, at the end of a
    mission; and half of that again in the second round (judgement)."""
    guess: float = 0.5
    """Chance to guess a name in the quiz where there is not even a hunch."""
    recall_quiz_ms: float = 4_000
    """To find and choose a name in the quiz."""
    mood: float = 0
    """How positively this person answers, whatever happened, in standard deviations."""
    coarseness: float = 0.5
    """Below a third the person answers to the point, below two thirds in fives, else in tens."""


LIMITS = Traits(
    ability=1.6,
    gist=1,
    gist_cells=40,
    mix_up=0.5,
    retention=1,
    ms_per_word=450,
    reaction_ms=900,
    step_ms=400,
    key_change_ms=800,
    lost_pace=3,
    recall_ms=3_000,
    interpret_ms=3_000,
    slip=0.05,
    mirror=0.2,
    miscount=0.3,
    miscount_unknowing=0.5,
    misread=0.5,
    patience_s=20,
    trust=1,
    stray=1,
    fatigue=0.5,
    guess=1,
    recall_quiz_ms=10_000,
    mood=3,
    coarseness=1,
)
"""Nobody is beyond these, nor below a tenth of the typical person."""

SPREAD = Traits(
    ability=0.28,
    gist=0.15,
    gist_cells=3,
    mix_up=0.03,
    retention=0.1,
    ms_per_word=40,
    reaction_ms=80,
    step_ms=15,
    key_change_ms=50,
    lost_pace=0.1,
    recall_ms=250,
    interpret_ms=200,
    slip=0.003,
    mirror=0.015,
    miscount=0.015,
    miscount_unknowing=0.03,
    misread=0.03,
    patience_s=1.5,
    trust=0.15,
    stray=0.25,
    fatigue=0.06,
    guess=0.25,
    recall_quiz_ms=900,
    mood=1,
    coarseness=0.35,
)
"""The standard deviations between people."""


@dataclass(frozen=True)
class Population:
    """People of one kind: the typical one, how they differ, and how their answers come about.

    `effect` multiplies everything that a mission does to answers: 0 plants no effect at all, 1 the
    effects of `game.rescuers.person.responses`. `noise` is the standard deviation of an answer
    around what the person means, in points of 1 to 100. `leaving` is the share of people who stop
    taking part in a study, at some point after they have been given a place, and `cut_off` that of
    people whose line drops once and who log in again.
    """

    name: str
    typical: Traits = Traits()
    spread: Traits = SPREAD
    effect: float = 1.0
    noise: float = 9.0
    leaving: float = 0.0
    cut_off: float = 0.0


SIGNED = ("mood",)
"""Traits that may lie on either side of 0."""
_FROM_NOTHING = ("stray", "coarseness")
_TENTH = 0.1


def drawn(population: Population, *seed: object) -> Traits:
    """One person of a population; the same for the same seed."""
    values = {}
    for trait in fields(Traits):
        name = trait.name
        typical, spread = getattr(population.typical, name), getattr(population.spread, name)
        limit = getattr(LIMITS, name)
        low = -limit if name in SIGNED else 0 if name in _FROM_NOTHING else _TENTH * typical
        value = typical + spread * normal(stream(*seed, "trait", name))
        values[name] = round(clipped(value, low, limit), 9)
    return Traits(**values)

"""Every number of the coach `knowledge`, with its reason. The journal holds them whole."""

from __future__ import annotations

from typing import Literal

import msgspec

from game.coach.acts import Level

QuizMark = Literal["right", "wrong", "blank"]
"""How the rescuer labelled a room after memorising the map."""


class Assumed(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Times are milliseconds, distances cells.

    Where a reason says `chosen`, the number is the one with which simulated people that were set
    aside for choosing saved most; `docs/coaches.md` reports on others.
    """

    # --- what the rescuer knows ------------------------------------------------------------------

    share_prior: tuple[float, float] = (1.3, 1.3)
    """Beta prior of the share of rooms that are known: "a wide, near-uniform spread of participant
    preparedness" (paper 5.3), a little less at the ends."""
    share_points: int = 20
    """The share is held on a grid of so many points; more changed no decision."""
    rationality: float = 2.0
    """Beta of the policy (R^HR's `per_cell`): in a corridor a step leads nearer to where the walker
    is heading with probability .98 (chosen)."""
    astray: tuple[float, float] = (0.02, 0.3)
    """Chance, at each step, that somebody who knows the way goes astray, by a wrong key or in
    thought, and that they find back (chosen): one slip of several steps is one error, not several.
    """
    retarget: float = 0.04
    """Chance, at each step, that a searcher thinks of another place (chosen)."""
    reach_cells: float = 12.0
    """How far off searchers look: a place twice as far is e times less likely (judgement)."""
    walk_limit: float = 12.0
    """No walk says more than this about a room, in log odds: the model of walks is too simple."""
    retention: float = 0.75
    """Chance that a name that came into view is remembered with its place (judgement)."""
    pace_mean: tuple[float, float] = (0.0, 0.3)
    pace_sd: tuple[float, float] = (0.1, 0.25)
    """Mean and standard deviation, between walks, of the pace of somebody who knows the way and of
    somebody who looks for it: the logarithm of how many times as long as usual a step takes. Who
    searches needs a third longer (judgement)."""
    pace_noise: float = 0.25
    """Standard deviation of a single step about the pace of its walk (judgement)."""
    pace_limit: float = 0.8
    """No single step is taken to be slower or faster than this: people pause for other reasons."""
    lost_evidence: float = 2.0
    """Log odds against knowing the way when a rescuer has stood, paced or circled for so long that
    the coach notices (judgement)."""
    asked_evidence: float = 1.0
    """Log odds against knowing the way in a request for simpler words while walking to a room by
    its name, and for it in one for shorter words (judgement)."""
    quiz_right: tuple[float, float] = (0.95, 0.25)
    quiz_wrong: tuple[float, float] = (0.03, 0.45)
    quiz_blank: tuple[float, float] = (0.02, 0.30)
    """Chance of each answer in the label quiz from people who know the room, and from others: some
    are right by a hunch (judgement). Only `knowledge+quiz` is given answers."""

    # --- how long a leg takes --------------------------------------------------------------------

    react_ms: float = 400.0
    """From a change on the bar until reading begins (Hick, 1952: a choice of one in four keys)."""
    word_ms: float = 190.0
    """Silent reading at 252 ms a word (Brysbaert, 2019), faster for stock phrases."""
    step_ms: float = 215.0
    """A step before any has been timed: the mission's pace and a little."""
    turn_ms: float = 90.0
    """What another key than the last one adds."""
    slip_c1: float = 0.02
    """Chance of a misstep at each turn of C1, left for right."""
    slip_c1_ms: float = 3_000.0
    """What it costs to notice and correct it."""
    interpret_ms: float = 700.0
    """To match each sentence of C2 to the screen, once it has been read, for people who know no
    room; in proportion less with knowledge (paper 5.5)."""
    miscount: tuple[float, float] = (0.03, 0.05)
    """Chance of a miscount for each door or opening counted at C2: for everybody, and what is added
    for people who know no room."""
    miscount_ms: float = 5_000.0
    """What it costs to notice and correct it."""
    detour: float = 1.06
    """How much longer the way of somebody who knows the room is than the shortest."""
    look_ms: float = 300.0
    """To find the victim in the room at C3."""

    # --- what is learned of this person's ways ---------------------------------------------------

    slowness_sd: float = 0.45
    slowness_noise: float = 0.35
    """Logarithm of how slowly the person reads and thinks: its spread between people, and of one
    answer about it."""
    slowness_most: float = 25.0
    """So many answers are remembered, so that a person who tires is followed."""
    factor_means: tuple[float, float, float] = (0.0, 0.2, 0.0)
    factor_sd: float = 0.15
    factor_noise: float = 0.18
    """Logarithm of how much longer a leg at C1, C2, C3 takes than is said above: C2 takes longer
    from the start, for counting and looking; spread between people, and of one leg."""
    search_ms: float = 8_500.0
    search_finds: float = 2.0
    """By how much finding a room that is not known takes longer than walking to one that is, and
    how many searches that were carried to their end this expectation weighs as much as (chosen)."""
    search_most_ms: float = 16_000.0
    """No search counts for more: whoever takes longer did something else."""

    # --- choosing --------------------------------------------------------------------------------

    first_level: Level = Level.C3
    """Only C3 tells anything about knowledge; the first choice may still be another."""
    optimism: float = 0.6
    """How many standard deviations of the share are added to P known when a goal is chosen for: the
    value of learning what the person knows (chosen)."""
    belief_optimism: float = 1.2
    """The same for the preset `belief`: just enough for the first goal to be told at C3."""
    switch_gain_ms: float = 1_000.0
    """Another level must save so much: switching costs attention (chosen: fewer switches, no fewer
    rescues)."""
    asked_ms: float = 2_000.0
    """What each request for simpler words adds to the expected time of a level for each level that
    it lies above C1; one for shorter words takes it off (judgement: a few decide most legs)."""
    show_ms: float = 2_000.0
    """How long it takes until a walk shows that the room is not known."""
    doubt_below: float = 0.6
    """While P known is higher, a walk at C3 is left alone."""
    later_ms: float = 2_000.0
    """What going on for now and helping later would cost somebody who does not know the way."""
    help_gain_ms: float = 300.0
    """Helping in mid-leg must save so much."""


ASSUMED = Assumed()

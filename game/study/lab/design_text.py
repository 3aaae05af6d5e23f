"""A study's design in words: what is crossed, how even it comes out, and what it can find."""

from __future__ import annotations

from collections.abc import Iterator

from game.forms.form import Forms
from game.study.design import ORDER_CODES, Balance, balances, memorise_code
from game.study.power import ALPHA, EFFECTS, POWER, corrected, power_of, smallest_effect
from game.study.study_settings import StudySettings
from game.tables.asked import outcomes_of
from game.tables.designs import LABELLED_LATE, PaperTest, labelled_late, supported

LEAST_IN_CELL = 2
"""Fewer people in a cell of the analysis have no variance."""
MOST_CELLS = 48
"""So many design cells are listed at most."""


def design_lines(settings: StudySettings, forms: Forms) -> Iterator[str]:
    """The lines of `ana study design`."""
    design, places = settings.design, settings.all_places
    first, second = settings.instructors or ("static", settings.coach)
    yield f"{settings.name}: {places} places, {design.block} design cells"
    yield f"  instructors      {_led(settings, 0, first)}, {_led(settings, 1, second)}"
    yield f"  rounds           {settings.rounds}: {', '.join(settings.round_phases)}"
    yield f"  phases           {', '.join(settings.phases)}"
    yield ""
    yield "Balance when every place is taken:"
    found = list(balances(design, settings.seed, places))
    for balance in found:
        yield from _balance_lines(settings, balance)
    yield f"      ({_codes(settings)})"
    if places % design.block:
        yield (
            f"  Every design cell comes equally often with a multiple of {design.block} places; "
            f"each memorise time, order and level with a multiple of {design.part}: "
            f"{_near(places, design.part)}."
        )
    yield ""
    yield from _power_lines(settings, forms)
    yield ""
    yield "The paper's tests:"
    for test in supported(
        pair=(first, second),
        levels=tuple(level.name for level in design.levels),
        rounds=settings.rounds,
        labels="label" in settings.round_phases,
        preference="preference" in settings.phases,
        forms=forms,
    ):
        yield f"  {'yes' if test.possible else 'no '}  {test.name}{test.told}{_few(test, places)}"
    if labelled_late(settings.round_phases):
        yield f"  note: {LABELLED_LATE}"


def _few(test: PaperTest, places: int) -> str:
    """What to say where the places cannot put two people into each cell of a test."""
    if not test.possible or places >= LEAST_IN_CELL * test.cells:
        return ""
    return (
        f"; but too few people: {places} for {test.cells} cells, each of which needs "
        f"{LEAST_IN_CELL} or more"
    )


def _led(settings: StudySettings, which: int, name: str) -> str:
    one = settings.pair[which]
    if one.takes("preset"):
        return f"{one.kind} ({one.preset or settings.preset})"
    return name


def _balance_lines(settings: StudySettings, balance: Balance) -> Iterator[str]:
    counts = balance.counts
    if balance.factor == "design cell":
        values = sorted(set(counts.values()))
        often = f"{values[0]}" if len(values) == 1 else f"{values[0]} to {values[-1]}"
        times = "once" if often == "1" else f"{often} times"
        yield f"  design cells     {len(counts)}, each {times}"
        if len(counts) <= MOST_CELLS:
            for line in range(0, len(counts), 4):
                names = list(counts)[line : line + 4]
                yield "      " + "  ".join(f"{name:>11} {counts[name]:>3}" for name in names)
        return
    if len(counts) == 1:
        return
    told = ", ".join(f"{_value(settings, balance.factor, it)} {n}" for it, n in counts.items())
    even = "" if balance.even else "  (not even)"
    yield f"  {balance.factor:<16} {told}{even}"


def _codes(settings: StudySettings) -> str:
    """What the parts of a design cell's name mean in this study."""
    design, pair = settings.design, settings.instructors or ("static", settings.coach)
    times = (
        f"{memorise_code(which)}: {settings.memorise_seconds[which]} s to memorise"
        for which in range(design.memorise)
        if "memorise" in settings.round_phases
    )
    orders = (f"{code}: {name} first" for code, name in zip(ORDER_CODES, pair, strict=True))
    buildings = (f"b{place}: {name} first" for place, name in enumerate(settings.buildings))
    return ", ".join((*times, *orders, *buildings))


def _value(settings: StudySettings, factor: str, value: str) -> str:
    match factor:
        case "memorise time":
            return f"{settings.memorise_seconds[int(value)]} s:"
        case "order":
            pair = settings.instructors or ("static", settings.coach)
            return f"{pair[int(value)]} first:"
        case "first building":
            return f"{settings.buildings[int(value)]}:"
        case _:
            return f"{value}:"


def _near(places: int, part: int) -> str:
    below = places - places % part
    return f"{below} or {below + part}" if below else f"{part}"


def _power_lines(settings: StudySettings, forms: Forms) -> Iterator[str]:
    outcomes, primary = settings.primary.outcomes, settings.primary
    n = settings.all_places
    alpha = corrected(ALPHA, len(outcomes), primary.correction)
    within = settings.rounds > 1
    people = n if within else n / 4
    what = "within people, d of the differences" if within else "between two halves of the people"
    yield (
        f"Power for {', '.join(outcomes)} ({len(outcomes)} tests, {primary.correction}: first at "
        f"{alpha:.4g}), by the normal approximation, if all {n} are analysed:"
    )
    effects = ", ".join(f"d = {d:g}: {power_of(d, people, alpha):.2f}" for d in EFFECTS)
    yield f"  one instructor against the other ({what}): {effects}"
    yield f"    smallest effect found with power {POWER:g}: {smallest_effect(people, alpha):.2f}"
    levels = len(settings.design.levels)
    if levels > 1:
        group = n / levels / 2
        yield (
            f"  one static level against another ({n / levels:.0f} people each): smallest effect "
            f"{smallest_effect(group, alpha):.2f}"
        )
    unknown = [it for it in outcomes if it != "victims" and it not in _asked(forms)]
    if unknown:
        yield f"  {', '.join(unknown)}: not asked after each mission in forms.toml"


def _asked(forms: Forms) -> set[str]:
    asked = outcomes_of(forms)
    return {*asked.ranges, *asked.composites}

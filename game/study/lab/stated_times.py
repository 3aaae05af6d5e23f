"""Times that the texts state and study.toml does not have: a consent that still speaks of a
four-minute mission after the mission was shortened."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from itertools import takewhile
from typing import Any

import msgspec

from game.forms.form import EACH, Forms
from game.forms.reading import FORMS
from game.study.folder import TEXTS, Study
from game.study.study_settings import StudySettings
from game.study.texts import Units

_NUMBERS = {
    number: value
    for value, numbers in {
        1: "one ein eine einer einem einen eines", 2: "two zwei", 3: "three drei", 4: "four vier",
        5: "five fünf", 6: "six sechs", 7: "seven sieben", 8: "eight acht", 9: "nine neun",
        10: "ten zehn", 12: "twelve zwölf", 15: "fifteen fünfzehn", 20: "twenty zwanzig",
        25: "twenty-five fünfundzwanzig", 30: "thirty dreißig", 40: "forty vierzig",
        45: "forty-five fünfundvierzig",
        50: "fifty fünfzig", 60: "sixty sechzig", 90: "ninety neunzig",
    }.items()
    for number in numbers.split()
}  # fmt: skip
"""Numbers in words, of the languages that come with the program; any other writes digits."""

_PRACTICE_MS, _PAGES_MS, _ITEM_MS = 6 * 60_000, 3 * 60_000, 10_000
"""How long practice, all pages and each question take at most. Simulated people need 4 minutes for
the practice of a new study, and 2 for its pages and its questions together."""


def contradicted(study: Study) -> Iterator[str]:
    """A sentence for each time in the texts and forms that the settings contradict.

    A time is a number, in digits or in a word, right before a unit of texts.toml or another word
    of its stem (`20 minutes`, `four-minute`, `vierminütigen`). It is right where a clock of the
    study has it, or where a session can take so long. It is wrong, too, where a clock had it by
    default and has another time now.
    """
    settings = study.settings
    now = dict(_clocks(settings))
    usual = dict(_clocks(_by_default(settings)))
    shortest, longest = _session_ms(settings, study.forms)
    for place, text in _texts(study):
        for said, ms in stated(text, study.texts.units):
            changed = [it for it, times in usual.items() if ms in times and ms not in now[it]]
            if changed:
                why = "; ".join(f"{it} is {_told(now[it])}" for it in changed)
            elif any(ms in times for times in now.values()) or shortest <= ms <= longest:
                continue
            else:
                why = (
                    f"no clock of study.toml has this time, and a session takes between "
                    f"{shortest // 60_000} and {-(-longest // 60_000)} minutes"
                )
            yield f'{place} says "{said}", but {why}: change the text or the setting'


def stated(text: str, units: Units) -> Iterator[tuple[str, int]]:
    """The times that a text states, each as it stands there and in milliseconds."""
    plain = _plain(text)
    numbers = "|".join(sorted(map(_plain, _NUMBERS), key=len, reverse=True))
    values = {_plain(number): value for number, value in _NUMBERS.items()}
    for unit, length_ms in (
        ((units.minute, units.minutes), 60_000),
        ((units.second, units.seconds), 1_000),
    ):
        number = rf"(?:(?<!\w)(\d+(?:[.,]\d+)?)|(?<![\w-])({numbers}))"
        pattern = rf"{number}[\s\u2010-\u2015-]*{_stem(*unit)}\w*"
        for found in re.finditer(pattern, plain):
            digits, word = found.groups()
            value = float(digits.replace(",", ".")) if digits else values[word]
            yield text[found.start() : found.end()], round(value * length_ms)


def _plain(text: str) -> str:
    """The text in small letters without marks, letter for letter: `minütig` is `minutig`."""
    return "".join(unicodedata.normalize("NFD", letter)[0].lower()[0] for letter in text)


def _stem(one: str, several: str) -> str:
    """What both forms of a unit begin with, but for a last vowel: `minut`."""
    pairs = zip(_plain(one), _plain(several), strict=False)
    common = "".join(letter for letter, _ in takewhile(lambda pair: pair[0] == pair[1], pairs))
    stem = common or _plain(one)
    return re.escape(stem[:-1] if len(stem) > 4 and stem[-1] in "aeiou" else stem)


def _clocks(settings: StudySettings) -> Iterator[tuple[str, tuple[int, ...]]]:
    """The times of study.toml by key, in milliseconds; none of a phase that is left out."""
    there = settings.round_phases
    seconds = settings.memorise_seconds if "memorise" in there else ()
    yield "memorise_seconds", tuple(it * 1000 for it in seconds)
    yield "label_seconds", (settings.label_seconds * 1000,) if "label" in there else ()
    yield "duration_ms", (settings.mission.duration_ms,)
    yield "red_expiry_ms", (settings.mission.reds_expire_ms,)


def _by_default(settings: StudySettings) -> StudySettings:
    """Settings as these, with the times of a new study."""
    return StudySettings(
        name=settings.name,
        seed=settings.seed,
        buildings=settings.buildings,
        practice_building=settings.practice_building,
        rounds=settings.rounds,
    )


def _session_ms(settings: StudySettings, forms: Forms) -> tuple[int, int]:
    """How long a session takes at least and at most: the clocks that nobody can end early, and all
    of them with whatever has no clock."""
    clocks = dict(_clocks(settings))
    memorise, label = clocks["memorise_seconds"], clocks["label_seconds"]
    mission = settings.mission.duration_ms
    shortest = settings.rounds * (min(memorise, default=0) + mission)
    longest = settings.rounds * (max(memorise, default=0) + max(label, default=0) + mission)
    practice = _PRACTICE_MS if "practice" in settings.phases else 0
    asked = sum(
        len(form.questions) * (settings.rounds if place == EACH else 1)
        for form in forms.forms
        for place in form.places
    )
    return shortest, longest + practice + _PAGES_MS + asked * _ITEM_MS


def _told(times: tuple[int, ...]) -> str:
    return " or ".join(f"{ms / 1000:g} s" for ms in times) or "left out"


def _texts(study: Study) -> Iterator[tuple[str, str]]:
    """Every text that participants read, with its place."""
    yield from _strings(TEXTS, msgspec.to_builtins(study.texts))
    for form in study.forms.forms:
        yield from _strings(f"{FORMS}, form {form.id}", [form.title, form.body])


def _strings(place: str, tree: Any) -> Iterator[tuple[str, str]]:
    match tree:
        case str():
            yield place, tree
        case dict():
            for key, value in tree.items():
                yield from _strings(
                    f"{place}, {key}" if place == TEXTS else f"{place}.{key}", value
                )
        case list() | tuple():
            for value in tree:
                yield from _strings(place, value)
        case _:
            pass

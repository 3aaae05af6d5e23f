"""Kinds of people as data: a TOML file says in what they differ from the people of `default`."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from hashlib import sha256
from importlib import resources
from pathlib import Path
from types import MappingProxyType
from typing import Any

from game.errors import AnaError, choose_from
from game.rescuers.person.parameters import LIMITS, SIGNED, SPREAD, Population, Traits

ENDING = ".toml"
MAY_BE_NEGATIVE = (*SIGNED, "stray")


class WorldError(AnaError):
    """A file of people cannot be used as it is."""


NUMBERS: Mapping[str, tuple[float, float]] = {
    "effect": (0, 10),
    "noise": (0, 100),
    "leaving": (0, 1),
    "cut_off": (0, 1),
}
"""What a world says of its people as a whole, and between which numbers."""
TABLES = ("typical", "spread")


def world(name: str) -> Population:
    """The shipped world of this name, or the one in the file of this name, whose own name then ends
    with the beginning of the file's SHA-256.

    Raises WorldError, naming the file and the key, for what cannot be used.
    """
    if name in POPULATIONS:
        return POPULATIONS[name]
    path = Path(name)
    if path.suffix == ENDING:
        try:
            text = path.read_text(encoding="utf-8-sig")
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
            raise WorldError(f"the people cannot be read ({reason})", place=name) from error
        digest = sha256(text.encode()).hexdigest()[:8]
        return parse_world(f"{path.stem} {digest}", text, name)
    hint = choose_from(name, POPULATIONS, f", or give a file whose name ends in {ENDING}")
    raise WorldError(f"there is no world '{name}'", hint=hint)


def parse_world(name: str, text: str, place: str) -> Population:
    """The world that `text` describes. Raises WorldError, naming `place` and the key."""
    try:
        tree = tomllib.loads(text)
    except ValueError as error:
        raise WorldError(f"this is not TOML: {error}", place=place) from error
    keys = ("about", *NUMBERS, *TABLES)
    for key in tree:
        if key not in keys:
            raise WorldError(f"there is no key {key}", place=place, hint=choose_from(key, keys))
    about = tree.get("about")
    if not isinstance(about, str) or not about.strip():
        raise WorldError(
            "about is missing", place=place, hint='Say in a line who they are: about = "..."'
        )
    numbers = {
        key: _number(key, tree[key], low, high, place)
        for key, (low, high) in NUMBERS.items()
        if key in tree
    }
    return Population(
        name,
        typical=_changed(Traits(), tree.get("typical", {}), f"{place}, typical", MAY_BE_NEGATIVE),
        spread=_changed(SPREAD, tree.get("spread", {}), f"{place}, spread", ()),
        **numbers,
    )


def _changed(traits: Traits, changes: object, place: str, signed: Sequence[str]) -> Traits:
    """`traits` with the numbers of a table; those that are `signed` may be negative."""
    if not isinstance(changes, Mapping):
        raise WorldError("this must be a table of traits", place=place)
    names = [trait.name for trait in fields(Traits)]
    known: dict[str, Any] = {}
    for name, value in changes.items():
        if name not in names:
            raise WorldError(
                f"there is no trait {name}", place=place, hint=choose_from(name, names)
            )
        limit = getattr(LIMITS, name)
        known[name] = _number(name, value, -limit if name in signed else 0, limit, place)
    return replace(traits, **known)


def _number(name: str, value: object, low: float, high: float, place: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise WorldError(f"{name} must be a number, not {value!r}", place=place)
    if not low <= value <= high:
        raise WorldError(f"{name} must be between {low:g} and {high:g}, not {value}", place=place)
    return float(value)


def _shipped() -> Mapping[str, Population]:
    folder = resources.files("game.rescuers") / "worlds"
    files = sorted((it for it in folder.iterdir() if it.name.endswith(ENDING)), key=_default_first)
    worlds = (
        parse_world(it.name.removesuffix(ENDING), it.read_text(encoding="utf-8"), it.name)
        for it in files
    )
    return MappingProxyType({one.name: one for one in worlds})


def _default_first(file: Any) -> tuple[bool, str]:
    return file.name != f"default{ENDING}", file.name


POPULATIONS = _shipped()
"""The kinds of people that come with `ana`, by name; `default` first."""

CUBE: Mapping[str, tuple[float, float]] = {
    "ability": (0.15, 1.0),
    "gist": (0.0, 0.9),
    "gist_cells": (4, 24),
    "mix_up": (0.0, 0.2),
    "retention": (0.3, 1.0),
    "ms_per_word": (120, 400),
    "reaction_ms": (250, 600),
    "step_ms": (190, 300),
    "key_change_ms": (200, 500),
    "lost_pace": (1.0, 2.0),
    "recall_ms": (300, 2_000),
    "interpret_ms": (100, 1_500),
    "slip": (0.0, 0.02),
    "mirror": (0.0, 0.08),
    "miscount": (0.0, 0.1),
    "miscount_unknowing": (0.0, 0.2),
    "misread": (0.0, 0.2),
    "trust": (0.4, 1.0),
}
"""The traits in which random worlds differ, and how far: about half to twice the typical person, or
as far as a person can be imagined (judgement)."""


def world_at(point: Sequence[float], name: str) -> Population:
    """The world at a point of the unit cube, whose axes are those of `CUBE` in order."""
    changes: dict[str, Any] = {
        trait: round(low + (high - low) * share, 6)
        for (trait, (low, high)), share in zip(CUBE.items(), point, strict=True)
    }
    return Population(name, typical=replace(Traits(), **changes))

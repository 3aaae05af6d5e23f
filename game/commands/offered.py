"""What a shell offers as the value of an option: names that `ana` knows, and files."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import fields
from typing import Literal, get_args, get_origin, get_type_hints

import click
from click.shell_completion import CompletionItem

from game.world.settings import MissionSettings

Offering = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def offering(names: Callable[[], Iterable[str]], *, files: bool = False) -> Offering:
    """Offers the `names` that begin with what is typed, and with `files` the shell's own files."""

    def offer(_ctx: click.Context, _parameter: click.Parameter, typed: str) -> list[CompletionItem]:
        found = [CompletionItem(name) for name in names() if name.startswith(typed)]
        if files and not found:
            found.append(CompletionItem(typed, type="file"))
        return found

    return offer


def buildings() -> tuple[str, ...]:
    """The buildings that come with `ana`, and how a generated one is named."""
    from game.world.library import GENERATED, shipped_buildings

    return (*shipped_buildings(), f"{GENERATED}:")


def coaches() -> tuple[str, ...]:
    """The kinds of coach."""
    from game.coach.registry import KINDS

    return tuple(KINDS)


def presets() -> tuple[str, ...]:
    """The ways in which `ana` adapts."""
    from game.coach.presets import PRESETS

    return tuple(PRESETS)


def levels() -> tuple[str, ...]:
    """The levels of a static coach."""
    from game.coach.acts import Level

    return tuple(str(int(level)) for level in Level)


def rescuers() -> tuple[str, ...]:
    """Who can be watched."""
    from game.rescuers.catalogue import RESCUERS

    return tuple(RESCUERS)


def settings() -> Iterator[str]:
    """Every setting with the values it can have, or with its usual one."""
    kinds = get_type_hints(MissionSettings)
    for field in fields(MissionSettings):
        kind = kinds[field.name]
        if kind is bool:
            values: tuple[object, ...] = ("true", "false")
        elif get_origin(kind) is Literal:
            values = get_args(kind)
        else:
            usual = getattr(MissionSettings(), field.name)
            values = (MissionSettings().reds_expire_ms if usual is None else usual,)
        yield from (f"{field.name}={value}" for value in values)

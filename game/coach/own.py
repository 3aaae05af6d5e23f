"""Coaches of one's own, loaded from a Python file outside the house."""

from __future__ import annotations

import importlib.util
import sys
from hashlib import sha256
from pathlib import Path
from typing import cast

from game.coach.api import Briefing, Coach
from game.errors import AnaError, did_you_mean

SEPARATOR = ":"
SURFACE = ("guidance", "next_evaluation_ms", "begin", "on_event", "evaluate")
"""What `game.coach.api.Coach` asks for."""


def source_hash(source: str) -> str:
    """SHA-256 of the file in `FILE.py:CLASS`. Raises AnaError where it cannot be read."""
    path = source.rpartition(SEPARATOR)[0]
    try:
        return sha256(Path(path).read_bytes()).hexdigest()
    except OSError as error:
        raise AnaError(
            f"the coach's file cannot be read ({error.strerror})",
            place=path,
            hint="Give it as FILE.py:CLASS.",
        ) from error


def own_coach(source: str, digest: str, briefing: Briefing) -> Coach:
    """A coach of the class in `FILE.py:CLASS`, which is called with the briefing.

    Raises AnaError where the file is not the one of `digest`, cannot be run, has no such class, or
    where the class lacks a part of the surface of a coach.
    """
    path, _, name = source.rpartition(SEPARATOR)
    if source_hash(source) != digest:
        raise AnaError("the coach's file has changed since the mission", place=path)
    spec = importlib.util.spec_from_file_location(f"own_coach_{digest}", path)
    if spec is None or spec.loader is None:
        raise AnaError("this is not a Python file", place=path, hint="Its name must end in .py.")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up there
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        del sys.modules[spec.name]
        raise AnaError(f"the coach's file cannot be run: {error!r}", place=path) from error
    made = getattr(module, name, None)
    if not callable(made):
        hint = did_you_mean(name, vars(module))
        raise AnaError(f"there is no class {name}", place=path, hint=hint)
    try:
        coach = made(briefing)
    except Exception as error:
        raise AnaError(f"{name} cannot be made from a briefing: {error!r}", place=path) from error
    missing = [part for part in SURFACE if not hasattr(coach, part)]
    if missing:
        raise AnaError(
            f"{name} is not a coach: it lacks {', '.join(missing)}",
            place=path,
            hint="docs/write-your-own-coach.md shows a complete one.",
        )
    return cast(Coach, coach)

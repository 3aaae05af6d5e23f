"""Randomness in a study: hashes of the seed and a purpose, equal on every machine and Python."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from hashlib import sha256
from typing import TypeVar

Thing = TypeVar("Thing")


def digest(*parts: object) -> bytes:
    """The SHA-256 of the parts: the first is the seed, the others name the purpose."""
    return sha256("/".join(str(part) for part in parts).encode()).digest()


def number(*parts: object) -> int:
    """A number from 0 to 2^32 - 1."""
    return int.from_bytes(digest(*parts)[:4])


def shuffled(
    things: Iterable[Thing], name: Callable[[Thing], str], *parts: object
) -> tuple[Thing, ...]:
    """The things in random order; `name` tells them apart."""
    return tuple(sorted(things, key=lambda thing: digest(*parts, name(thing))))

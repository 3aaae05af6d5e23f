"""What every text that participants read must be."""

from __future__ import annotations


def not_empty(what: str, *texts: str) -> None:
    """Raise ValueError unless all are there."""
    if not all(text.strip() for text in texts):
        raise ValueError(f"{what} must not be empty")


def told_apart(what: str, *texts: str) -> None:
    """Raise ValueError unless all are there and different."""
    not_empty(what, *texts)
    if len({text.strip().casefold() for text in texts}) < len(texts):
        raise ValueError(f"{what} must differ from each other")

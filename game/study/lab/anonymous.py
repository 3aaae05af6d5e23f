"""Journals that no longer point to a person: another pseudonym, other dates, no words of their own.

Neither the new pseudonyms nor the shifts are kept anywhere, so that nobody can undo them.
"""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from secrets import SystemRandom

import msgspec

from game.journal.reader import Transcript, parse_journal

MOST_DAYS = 3_650
_chance = SystemRandom()


def new_names(count: int) -> list[str]:
    """So many pseudonyms in random order."""
    names = [f"A{number:03}" for number in range(1, count + 1)]
    _chance.shuffle(names)
    return names


def anonymised(journals: Sequence[tuple[Transcript, bytes]]) -> list[tuple[Transcript, bytes]]:
    """The sessions with new pseudonyms, ordered by them; each one's dates are shifted by a random
    time of its own."""
    found = []
    names = new_names(len(journals))
    for (transcript, lines), name in zip(journals, names, strict=True):
        shift = timedelta(seconds=_chance.randint(1, MOST_DAYS * 86_400))
        changed = b"".join(_changed(line, name, shift) for line in lines.splitlines())
        found.append((parse_journal(changed, transcript.source), changed))
    return sorted(found, key=lambda one: one[0].started.participant)


def _changed(line: bytes, name: str, shift: timedelta) -> bytes:
    fields = msgspec.json.decode(line)
    moved = datetime.fromisoformat(fields["utc"]).astimezone(UTC) - shift
    fields["utc"] = moved.isoformat(timespec="milliseconds").replace("+00:00", "Z")
    if "participant" in fields:
        fields["participant"] = name
    if "session" in fields:
        fields["session"] = name
    return msgspec.json.encode(fields) + b"\n"

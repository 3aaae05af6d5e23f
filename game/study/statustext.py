"""The state of a study in words, for a page of text and for a screen alike."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from game.study.overview import CellCount, StudyStatus, Totals
from game.study.roll import SessionStatus

HEADER = ("participant", "mode", "state", "phase", "clock", "last event", "broke in", "resumed")

_RARE = ("turned_away",)
"""Counts that are told only where there is something to count."""
_TOTALS = (
    ("started", "started"),
    ("taking_part", "taking part"),
    ("left", "left"),
    ("cut_off", "cut off"),
    ("finished", "finished"),
    ("declined", "declined"),
    ("turned_away", "turned away"),
    ("withdrawn", "withdrawn"),
    ("dropped", "dropped out"),
)


def heading(status: StudyStatus) -> str:
    """The study, and whether it is open."""
    totals = status.totals
    state = "closed" if status.closed else "open"
    unblinded = f", unblinded {_times(status.unblinded)}" if status.unblinded else ""
    return f"{status.study}: {state}{unblinded}; {totals.taken} of {totals.places} places taken"


def totals_line(totals: Totals) -> str:
    """The counts of live sessions, on one line."""
    counts = ((name, words, getattr(totals, name)) for name, words in _TOTALS)
    return ", ".join(
        f"{words} {count}" for name, words, count in counts if count or name not in _RARE
    )


def session_cells(session: SessionStatus) -> tuple[str, ...]:
    """A session's row under `HEADER`."""
    phase = f"{session.phase}, round {session.round}" if session.round else session.phase
    return (
        session.participant,
        session.mode,
        session.state,
        phase,
        _clock(session),
        age(session.silent_s),
        str(session.interruptions),
        str(session.resumed),
    )


def page(status: StudyStatus, cells: Sequence[CellCount] = ()) -> Iterator[str]:
    """The lines of a plain report."""
    yield heading(status)
    yield f"Live sessions: {totals_line(status.totals)}"
    if status.sessions:
        yield ""
        yield from _aligned([HEADER, *(session_cells(one) for one in status.sessions)])
    if status.problems:
        yield ""
        yield "Look at:"
        yield from (f"  {problem}" for problem in status.problems)
    if cells:
        rules = list(cells[0].excluded)
        yield ""
        yield from _aligned(
            [
                ("design cell", "allocated", "finished", *(f"excluded: {name}" for name in rules)),
                *(
                    (
                        one.cell,
                        str(one.allocated),
                        str(one.finished),
                        *(str(one.excluded[name]) for name in rules),
                    )
                    for one in cells
                ),
            ]
        )


def age(seconds: float | None) -> str:
    """How long ago something was, in the largest unit that says enough."""
    if seconds is None:
        return "-"
    for unit, length in (("d", 86_400), ("h", 3_600), ("min", 60)):
        if seconds >= 2 * length:
            return f"{seconds / length:.0f} {unit}"
    return f"{seconds:.0f} s"


def _clock(session: SessionStatus) -> str:
    if session.clock_s is None:
        return "-"
    limit = "" if session.limit_s is None else f" of {_minutes(session.limit_s)}"
    return f"{_minutes(session.clock_s)}{limit}"


def _minutes(seconds: float) -> str:
    minutes, rest = divmod(int(seconds), 60)
    return f"{minutes}:{rest:02}"


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"


def _aligned(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    widths = [max(len(row[place]) for row in rows) for place in range(len(rows[0]))]
    for row in rows:
        padded = (text.ljust(width) for text, width in zip(row, widths, strict=True))
        yield "  ".join(padded).rstrip()

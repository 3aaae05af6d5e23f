"""The state of a study in words, for printing and for the screen."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from game.journal.records import STUDY_MODES
from game.study.design import CODES_MEAN
from game.study.lab.attendance import SessionStatus
from game.study.lab.study_status import CellCount, StudyStatus, Totals

HEADER = ("participant", "mode", "state", "phase", "clock", "last event", "interrupted", "resumed")

HINDRANCES = "Something is wrong:"
"""Above what keeps people from logging in."""

_COUNTS = Totals.__struct_fields__[2:]
_RARE = ("turned_away",)
"""Counts that are shown only if they are not 0."""


def study_line(status: StudyStatus) -> str:
    """The study, whether it is open, and how many places are taken."""
    totals = status.totals
    state = "closed" if status.closed else "open"
    unblinded = f", unblinded {_times(status.unblinded)}" if status.unblinded else ""
    return f"{status.study}: {state}{unblinded}; {totals.taken} of {totals.places} places taken"


def totals_line(totals: Totals) -> str:
    """The counts of live sessions, on one line."""
    counts = ((name, getattr(totals, name)) for name in _COUNTS)
    shown = (f"{name} {count}" for name, count in counts if count or name not in _RARE)
    return ", ".join(shown).replace("_", " ").replace("dropped", "dropped out")


def other_lines(sessions: Sequence[SessionStatus]) -> Iterator[str]:
    """A line for the pilots and one for the simulated people, where there are any: how many are in
    each state."""
    for mode in STUDY_MODES[1:]:
        states = [session.state for session in sessions if session.mode == mode]
        if states:
            counts = (f"{state} {states.count(state)}" for state in dict.fromkeys(sorted(states)))
            yield f"{mode.capitalize()} sessions: started {len(states)}, {', '.join(counts)}"


def session_cells(session: SessionStatus) -> tuple[str, ...]:
    """A session's row under `HEADER`."""
    phase = f"{session.phase}, round {session.round}" if session.round else session.phase
    return (
        session.participant,
        session.mode,
        session.state,
        phase,
        _clock(session),
        "-" if session.mode == "simulated" else age(session.silent_s),
        str(session.interruptions),
        str(session.resumed),
    )


def page(status: StudyStatus, cells: Sequence[CellCount] = ()) -> Iterator[str]:
    """The lines of a plain report."""
    yield study_line(status)
    if status.hindrances:
        yield HINDRANCES
        yield from (f"  {hindrance}" for hindrance in status.hindrances)
        yield ""
    yield f"Live sessions: {totals_line(status.totals)}"
    yield from other_lines(status.sessions)
    if status.sessions:
        yield ""
        yield from _aligned([HEADER, *(session_cells(one) for one in status.sessions)])
    if status.problems:
        yield ""
        yield "Problems:"
        yield from (f"  {problem}" for problem in status.problems)
    if status.not_come:
        yield ""
        yield f"On the roster, not begun ({len(status.not_come)}): {', '.join(status.not_come)}"
    if cells:
        rules = list(cells[0].excluded)
        yield ""
        yield f"Design cells ({CODES_MEAN}):"
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
    """How long ago something happened, in the largest unit that is precise enough."""
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

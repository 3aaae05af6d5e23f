"""The steps of a study's sessions: phases in order, and the forms between them."""

from __future__ import annotations

from game.forms.form import Forms, Place
from game.journal.history import Step
from game.journal.records import ROUNDS, ProtocolPhase

Course = tuple[Step, ...]
"""The steps of a session, in order."""

ROUND_PHASES: tuple[ProtocolPhase, ...] = ("memorise", "label", "mission")


def course(forms: Forms) -> Course:
    """The steps of every session of a study."""

    def asked(place: Place, round_: int = 0) -> Course:
        return tuple(
            Step(form.phase(place), round_)
            for form, _ in forms.at(place)
            if not round_ or form.after(round_, len(ROUNDS))
        )

    return (
        Step("preflight"),
        Step("consent"),
        *asked("before"),
        Step("practice"),
        *asked("after practice"),
        *(
            step
            for number in ROUNDS
            for step in (
                *(Step(phase, number) for phase in ROUND_PHASES),
                *asked("after each mission", number),
            )
        ),
        *asked("after both"),
        Step("preference"),
        *asked("at the end"),
        Step("debrief"),
    )

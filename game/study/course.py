"""The steps of a study's sessions: phases in order, and the forms between them."""

from __future__ import annotations

from game.forms.form import Forms, Place
from game.journal.history import Step
from game.study.study_settings import StudySettings

Course = tuple[Step, ...]
"""The steps of a session, in order."""


def course(forms: Forms, settings: StudySettings) -> Course:
    """The steps of every session of a study."""

    def asked(place: Place, round_: int = 0) -> Course:
        return tuple(
            Step(form.phase(place), round_)
            for form, _ in forms.at(place)
            if not round_ or form.after(round_, settings.rounds)
        )

    steps: list[Step] = []
    for phase in settings.phases:
        match phase:
            case "rounds":
                steps += asked("after practice")
                for number in range(1, settings.rounds + 1):
                    steps += (Step(part, number) for part in settings.round_phases)
                    steps += asked("after each mission", number)
                steps += asked("after both")
            case "consent":
                steps += [Step("consent"), *asked("before")]
            case "preference":
                steps += [Step("preference")] if settings.rounds > 1 else []
            case "debrief":
                steps += [*asked("at the end"), Step("debrief")]
            case _:
                steps.append(Step(phase))
    return tuple(steps)

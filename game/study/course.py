"""The steps of a study's sessions: phases in order, and the forms between them."""

from __future__ import annotations

from game.forms.form import Forms, Place
from game.journal.history import Step
from game.study.study_settings import RoundPhase, StudySettings

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
                    for part in _parts(settings):
                        steps += (
                            asked("after each mission", number)
                            if part == "forms"
                            else [Step(part, number)]
                        )
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


def _parts(settings: StudySettings) -> tuple[RoundPhase, ...]:
    """The parts of a round; its forms come last where study.toml does not say."""
    parts = settings.round_phases
    return parts if "forms" in parts else (*parts, "forms")

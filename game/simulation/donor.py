"""A simulated person's mission, for the levels that were spoken in it."""

from __future__ import annotations

from collections.abc import Sequence

from game.coach.acts import Level
from game.coach.yoke import Yoke
from game.journal.history import MissionHistory, Step
from game.journal.records import RunRecord
from game.rescuers.driver import drive
from game.rescuers.person import POPULATIONS, BoundedPerson, drawn, memorised
from game.rescuers.person.randomness import stream
from game.session.playing import assemble, mission_started
from game.session.yoking import levels_of
from game.study.chance import number
from game.study.instructors import Instructor
from game.study.study_settings import StudySettings
from game.world.building import Building


def simulated_donor(
    settings: StudySettings,
    instructor: Instructor,
    building: Building,
    memorise_ms: int,
    who: tuple[object, ...],
) -> Yoke:
    """The levels that `instructor` spoke to a person of the default population, drawn by `who`."""
    traits = drawn(POPULATIONS["default"], *who)
    memory = memorised(building, memorise_ms, traits, stream(*who, "map"))
    spec, seed = instructor.spec(Level.C2, settings.preset), number(*who, "mission")
    history = MissionHistory(
        0, Step("mission"), mission_started(building, settings.mission, spec, seed)
    )

    def note(records: Sequence[RunRecord]) -> None:
        for record in records:
            history.note(0, record)

    run = assemble(building, settings.mission, spec, seed, note)
    controls = settings.mission.controls
    run.begin()
    drive(run, BoundedPerson(traits, memory, controls, stream(*who, "walk")))
    return Yoke("simulated", building.hash, memorise_ms, levels_of(history))

"""One instruction, read literally: put somebody at a pose, give them the text, see what happens."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import accumulate
from pathlib import Path
from textwrap import wrap

from game.coach.acts import Level
from game.coach.instructions import Instruction, Pose, Scene
from game.rescuers.literal.execution import Stuck, Walker
from game.rescuers.literal.grammar import parse
from game.world.building import Building, VictimSite
from game.world.events import TreatmentStarted
from game.world.floodfill import UNREACHABLE, Floodfills
from game.world.geometry import Cell, Heading
from game.world.library import shipped_buildings
from game.world.mission import Mission
from game.world.settings import Controls, MissionSettings

MISSTEP = {Level.C1: 1, Level.C2: 3, Level.C3: 8}
"""How many cells the cost-to-go may not rise above its minimum at each level."""

LONGEST_WALK = 1_000

REFERENCE = Path(__file__).resolve().parents[1] / "reference"
GRIDS = tuple(str(REFERENCE / name) for name in ("annexe.csv", "terraces.csv"))
BUILDINGS = (*shipped_buildings(), *GRIDS)


@dataclass(frozen=True)
class Trial:
    """The cells walked over, where it ended, the victim whose treatment began, and whether the
    reader could do all that the text says."""

    path: tuple[Cell, ...]
    end: Pose
    treated: str | None
    carried_out: bool


class Ground:
    """A building in which instructions are tried out."""

    def __init__(
        self,
        building: Building,
        controls: Controls,
        floodfills: Floodfills | None = None,
        sight_radius: int = 5,
    ) -> None:
        self.building = building
        self.settings = MissionSettings(controls=controls, sight_radius=sight_radius)
        self.floodfills = floodfills or Floodfills(building.plan)
        self.let_wait({site.id: site for site in building.victims})

    def let_wait(self, waiting: Mapping[str, VictimSite]) -> None:
        """From now on only these victims are there."""
        self.waiting = waiting
        self.scene = Scene(self.building, waiting, self.settings)

    def poses(self) -> Iterator[Pose]:
        """Every pose that can be reached from the start."""
        plan, start = self.building.plan, self.building.start
        for cell in plan.cells(plan.walkable_mask):
            if self.floodfills.distance(cell, start) != UNREACHABLE:
                yield from (Pose(cell, heading) for heading in Heading)

    def mission_from(self, pose: Pose) -> Mission:
        """A mission that begins at `pose`, with the victims that wait now."""
        victims = tuple(self.waiting.values())
        return Mission(
            replace(self.building, start=pose.cell, start_heading=pose.heading, victims=victims),
            self.settings,
        )

    def try_out(self, pose: Pose, text: str) -> Trial:
        """Carry a text out from a pose, with a reader who knows nothing but the Observations."""
        mission = self.mission_from(pose)
        places = {room.name: room.label for room in self.building.rooms}
        walker = Walker(self.settings.controls, places, pose.heading)
        doing = walker.carry_out(parse(text), mission.observation())
        path, treated, carried_out = [pose.cell], None, False
        try:
            action = next(doing)
            while len(path) < LONGEST_WALK:
                for event in mission.step(action, 0):
                    if isinstance(event, TreatmentStarted):
                        treated = event.victim
                if mission.position != path[-1]:
                    path.append(mission.position)
                action = doing.send(mission.observation())
        except StopIteration:
            carried_out = True
        except Stuck:
            pass
        return Trial(tuple(path), Pose(mission.position, mission.heading), treated, carried_out)

    def fault(self, instruction: Instruction, trial: Trial) -> str | None:
        """What is wrong with an instruction that was tried out; None if it is sound."""
        distances = self.floodfills.to(self.waiting[instruction.goal].cell)
        walked = [distances[self.building.plan.index(cell)] for cell in trial.path]
        rise = max(at - least for at, least in zip(walked, accumulate(walked, min), strict=True))
        checks = {
            "cannot be carried out": not trial.carried_out,
            "looks like a misstep": rise >= MISSTEP[instruction.shown_level],
            "is too long for the bar": len(wrap(instruction.text, 78)) > 2,
        }
        if instruction.treats:
            checks["treats somebody else"] = trial.treated not in instruction.accepts
        else:
            checks["treats somebody"] = trial.treated is not None
            checks["brings nobody nearer"] = walked[-1] >= walked[0]
            checks["ends elsewhere"] = trial.path[-1] != instruction.end.cell
        return next((fault for fault, found in checks.items() if found), None)


def without_each_sentence(text: str) -> Iterator[tuple[str, str]]:
    """Each sentence of a text, and the text without it."""
    sentences = [f"{sentence}." for sentence in text.rstrip(".").split(". ")]
    for number, sentence in enumerate(sentences):
        yield sentence, " ".join(sentences[:number] + sentences[number + 1 :])

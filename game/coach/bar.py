"""What stands on the yellow bar, and how the rescuer keeps to it."""

from __future__ import annotations

from dataclasses import dataclass

from game.coach.acts import (
    CoachRecord,
    Disobeyed,
    InstructionCompleted,
    InstructionIssued,
    IssueReason,
    Level,
    LostBy,
    Misstep,
    NoticeTakenDown,
)
from game.coach.compliance import NOTHING_ASKED, STRICT_LEVELS, fits, reached, track
from game.coach.instructions import Instruction, Pose, Scene, instruct
from game.coach.instructions.told import ToldWay
from game.world.building import Room
from game.world.geometry import Cell
from game.world.observation import Guidance, Observation


@dataclass(frozen=True)
class OnBar:
    """The instruction on the bar: its number, when it was put there (mission ms) and why, the way
    that it tells, and the notice that came with it."""

    instruction: Instruction
    number: int
    at_ms: int
    reason: IssueReason
    told: ToldWay
    notice: str = ""


class Bar:
    """Puts instructions up and takes them down, and tells what each step means for the present one.

    `shown` is the instruction on the bar, None before the first and when there is nobody left;
    `open` is whether it is still to be carried out.
    """

    def __init__(self) -> None:
        self.guidance = Guidance("")
        self.shown: OnBar | None = None
        self.open = False
        self._number = self._completed = 0
        self._track: frozenset[Pose] = frozenset()
        self._ahead: set[Pose] = set()
        self._compliance = NOTHING_ASKED
        self._treated_instead: set[str] = set()
        self._at: Cell = (0, 0)
        self._left: int | None = None
        self._explored = 0

    # --- putting up and taking down --------------------------------------------------------------

    def issue(
        self,
        at_ms: int,
        scene: Scene,
        pose: Pose,
        goal: str,
        level: Level,
        reason: IssueReason,
        notice: str = "",
    ) -> InstructionIssued:
        """Put up the instruction of `level` from `pose` to `goal`. `restated` tells a rescuer who
        is off the way the same again from there, and changes neither the notice nor the clock."""
        instruction = instruct(scene, pose, goal, level)
        shown_level = instruction.shown_level
        distance = scene.floodfills.distance(pose.cell, scene.victim(goal).cell)
        if reason == "restated":
            notice = self.guidance.notice
            self._compliance = self._compliance.restated(shown_level, distance)
        else:
            self._compliance = self._compliance.issued(
                shown_level, distance, at_ms, *_opening_and_rest(scene, instruction), notice
            )
        self._number += 1
        told = ToldWay(scene, instruction)
        self.shown = OnBar(instruction, self._number, at_ms, reason, told, notice)
        self.open = True
        self._at = pose.cell
        self._left = told.left(pose.cell)
        self._track = track(instruction, scene.settings.controls)
        self._ahead = set(self._track) - {pose}
        self.guidance = Guidance(instruction.text, notice, self._completed)
        return InstructionIssued(
            at_ms,
            number=self._number,
            goal=goal,
            level=instruction.level,
            shown_level=instruction.shown_level,
            fallback=instruction.fallback,
            tuples=instruction.tuples,
            text=instruction.text,
            notice=notice,
            position=pose.cell,
            heading=pose.heading,
            end=instruction.end.cell,
            treats=instruction.treats,
            reason=reason,
        )

    def complete(self, at_ms: int) -> InstructionCompleted:
        """The instruction has been carried out; its words stay until others take their place."""
        self.open = False
        self._completed += 1
        self._compliance = self._compliance.completed()
        return InstructionCompleted(at_ms, self._number)

    def close(self, notice: str) -> None:
        """There is nothing more to do: `notice` stands alone."""
        self.shown, self.open = None, False
        self.guidance = Guidance("", notice)

    # --- what a step means -----------------------------------------------------------------------

    def walked(self, at_ms: int, distance: int, observation: Observation) -> NoticeTakenDown | None:
        """The rescuer acted and is `distance` from the goal now; a notice that has clearly been
        understood goes."""
        assert self.shown is not None
        told, position = self.shown.told, observation.position
        nearer, follows = self._comes_nearer(told, observation), told.follows(self._at, position)
        self._at = position
        self._compliance = self._compliance.acted(distance, at_ms, nearer=nearer, follows=follows)
        if not (self._compliance.heeded and self.guidance.notice):
            return None
        self.guidance = Guidance(self.shown.instruction.text, completed=self._completed)
        return NoticeTakenDown(at_ms, self._number)

    def reached(self, pose: Pose) -> bool:
        """Whether the instruction has been carried out at `pose`."""
        return self.shown is not None and reached(self.shown.instruction, pose)

    @property
    def strict(self) -> bool:
        """Whether the words on the bar can be followed by anybody, whatever they know."""
        return self.shown is not None and self.shown.instruction.shown_level in STRICT_LEVELS

    @property
    def astray(self) -> bool:
        """Whether the last step led too far away, be it a misstep or not yet to be blamed."""
        return self._compliance.astray

    @property
    def misstep(self) -> bool:
        """Whether the last step was a misstep."""
        return self._compliance.misstep

    @property
    def may_notice(self) -> bool:
        """Whether the last notice has been there long enough to be read."""
        return self._compliance.may_notice

    def unread_notice(self, at_ms: int) -> str:
        """The notice on the bar, as long as it cannot have been read; else nothing."""
        return self.guidance.notice if at_ms < self._compliance.notice_ms else ""

    def correct(self, at_ms: int) -> list[CoachRecord]:
        """Count the misstep, and the disobedience where it is one."""
        assert self.shown is not None
        compliance, number = self._compliance, self._number
        level = self.shown.instruction.shown_level
        records: list[CoachRecord] = [Misstep(at_ms, number, level, compliance.excess)]
        if compliance.disobeys:
            records.append(Disobeyed(at_ms, number, "repeat_misstep"))
        self._compliance = compliance.corrected()
        return records

    @property
    def lost_at_ms(self) -> int | None:
        """When the rescuer will be lost if there is no progress until then; None while there is
        nothing to carry out."""
        return self._compliance.lost_at_ms if self.open else None

    @property
    def lost_by(self) -> LostBy:
        """How a rescuer who is lost has spent the time: standing still, or walking about."""
        compliance = self._compliance
        stood = compliance.at_ms <= compliance.nearer_ms
        return "standing" if stood else "wandering"

    def asks_for(self, scene: Scene, victim: str, observation: Observation) -> bool:
        """Whether treating `victim` is what the words ask for."""
        in_view = {seen.cell for seen in observation.victims}
        return self.shown is not None and fits(scene, self.shown.instruction, victim, in_view)

    def treated_other(self, at_ms: int, victim: str) -> list[CoachRecord]:
        """Another victim than the one asked for is being treated: disobedience, once a victim."""
        if victim in self._treated_instead:
            return []
        self._treated_instead.add(victim)
        return [Disobeyed(at_ms, self._number, "other_victim")]

    def misleads(self, scene: Scene, pose: Pose, observation: Observation) -> bool:
        """Whether words that were meant for another pose no longer hold.

        The words of C3 hold anywhere, except inside the goal's room, where they do not name it. The
        approach to a victim that has been found holds in its room. A rescuer who goes astray is
        left to turn back, until it is a misstep.
        """
        assert self.shown is not None
        instruction = self.shown.instruction
        room_at, room = scene.building.room_at, scene.room(instruction.goal)
        if instruction.shown_level is Level.C3:
            told_inside = room is not None and room_at(instruction.start.cell) is room
            return told_inside and room_at(pose.cell) is not room
        if pose in self._track or self._compliance.rising:
            return False
        return instruction.shown_level is Level.C1 or not self._approaching(
            scene, room, observation
        )

    def _comes_nearer(self, told: ToldWay, observation: Observation) -> bool:
        """Whether a pose of the told way was taken for the first time, there is less of it left
        than ever, or more has been seen of the room where the victim has to be looked for."""
        pose = Pose(observation.position, observation.heading)
        if pose in self._ahead:
            self._ahead.remove(pose)
            return True
        left, before = told.left(observation.position), self._left
        if left is not None and (before is None or left < before):
            self._left = left
            return True
        explored, self._explored = self._explored, observation.explored
        return explored != observation.explored and told.searches(observation.position)

    def _approaching(self, scene: Scene, room: Room | None, observation: Observation) -> bool:
        assert self.shown is not None
        instruction = self.shown.instruction
        if not instruction.treats:
            return False
        goal = scene.victim(instruction.goal).cell
        found = any(v.cell == goal for v in (*observation.victims, *observation.remembered))
        return found and scene.building.room_at(observation.position) is room


def _opening_and_rest(scene: Scene, instruction: Instruction) -> tuple[str, str]:
    """The words that say what to do next, as far as the first sentence that is no mere turn
    (without its full stop where others follow), and the others."""
    turns = 0
    for action, _ in instruction.tuples:
        if action != "Turn":
            break
        turns += 1
    opening, rest = (
        scene.phrases.joined(part)
        for part in (instruction.sentences[: turns + 1], instruction.sentences[turns + 1 :])
    )
    return opening[:-1] if rest else opening, rest

"""A mission played by typing lines: the same Observation, the same rules, the same journal.

Time passes only while something is done: a step takes its pace, a treatment its time. So nobody is
hurried by how long reading takes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import assert_never

from game.coach.acts import CoachRecord
from game.coach.api import Briefing, Coach
from game.coach.listening import ListenedCoach
from game.coach.spec import CoachSpec, build_coach
from game.journal.writer import Journal
from game.mission_words import asked_words
from game.rescuers.literal.grammar import Landmark
from game.screens.text.phrases import clock_words, counted, joined
from game.screens.text.surroundings import (
    abreast_of,
    building_map,
    came_abreast,
    in_reach,
    look,
    remembered,
    rooms_told,
    status,
    victims_told,
)
from game.screens.text.typed import (
    HELP,
    Ask,
    Command,
    Face,
    Leave,
    NotUnderstood,
    Tell,
    Topic,
    Treat,
    Wait,
    Walk,
    understood,
)
from game.session.playing import end_free_play
from game.session.run import MissionRun
from game.world.building import Severity
from game.world.events import (
    Acted,
    Action,
    Expired,
    LevelWish,
    MissionEvent,
    Outcome,
    Rescued,
    TreatmentBroken,
)
from game.world.geometry import Cell, Heading
from game.world.observation import Guidance, Observation, VictimState
from game.world.plan import Tile

LONGEST_WAIT_MS = 30_000
"""How long `wait` without a number waits for something to happen."""
_COMPASS = {
    Heading.NORTH: Action.NORTH,
    Heading.EAST: Action.EAST,
    Heading.SOUTH: Action.SOUTH,
    Heading.WEST: Action.WEST,
}
_WARNED_MS = (180_000, 120_000, 60_000, 30_000, 10_000)
"""How much time is left when that is said unasked."""


_ARTICLES: dict[Landmark, str] = {"door": "a door", "intersection": "an intersection"}


class HeardEvents(ListenedCoach):
    """A coach beside whom the mission's events are kept until somebody takes them."""

    def __init__(self, coach: Coach) -> None:
        super().__init__(coach)
        self._events: list[MissionEvent] = []

    @classmethod
    def build(cls, spec: CoachSpec, briefing: Briefing) -> HeardEvents:
        return cls(build_coach(spec, briefing))

    def on_event(self, event: MissionEvent, observation: Observation) -> list[CoachRecord]:
        self._events.append(event)
        return super().on_event(event, observation)

    @property
    def anything(self) -> bool:
        """Whether something has happened since the last time."""
        return bool(self._events)

    def take(self) -> list[MissionEvent]:
        """What has happened since the last time."""
        events, self._events = self._events, []
        return events


class TextMission:
    """One mission; `say` is given each line. Raises JournalError where the journal fails."""

    def __init__(
        self, run: MissionRun, heard: HeardEvents, journal: Journal, say: Callable[[str], None]
    ) -> None:
        self._run = run
        self._heard = heard
        self._journal = journal
        self._say = say
        self._now_ms = 0
        self._facing = run.observation().heading
        self._guidance = Guidance("")
        self._in_view: set[Cell | str] = set()
        """The people and the names that were in view when that was last told."""
        self._leaving = False

    @property
    def over(self) -> bool:
        """Whether the mission has ended or was left."""
        return self._run.ended or self._leaving

    def begin(self) -> None:
        """Say what stands at the beginning."""
        building, rules = self._run.mission.building, self._run.mission.settings
        reds = sum(site.severity is Severity.RED for site in building.victims)
        blues = len(building.victims) - reds
        self._say(f"{building.name}.")
        self._say(
            f"{counted(reds + blues, 'person') if reds + blues == 1 else f'{reds + blues} people'} "
            f"are hurt: {reds} red, {blues} blue. You have {clock_words(rules.duration_ms)}. Red "
            f"victims die unless treated in the first {clock_words(rules.reds_expire_ms)}."
        )
        self._say("The bar tells you where to go. Type help for the commands.")
        self._tell("look")
        self._tell_bar()
        self._note_view()

    def take(self, line: str) -> None:
        """Carry out what was typed, and say what came of it."""
        try:
            commands = understood(line)
        except NotUnderstood as error:
            self._say(f"I do not understand: {error}. Type help for the commands.")
            return
        said = self._run.observation().guidance
        for number, command in enumerate(commands, start=1):
            if self.over:
                return
            if not self._carry_out(command):
                break
            if number < len(commands) and _new_words(self._run.observation().guidance, said):
                self._say("The bar has changed, so the rest of the line is left undone.")
                break
        else:
            if commands and isinstance(commands[-1], Face):
                self._say(f"Ahead is now {self._facing.name.lower()}.")
        if not self._run.ended:
            self._tell_bar()

    def end(self) -> None:
        """End the session and close its journal."""
        end_free_play(self._run, self._journal, self._now_ms)

    # --- doing ----------------------------------------------------------------------------------

    def _carry_out(self, command: Command) -> bool:
        """Whether the rest of the line still makes sense."""
        match command:
            case Face():
                self._face(command.way)
            case Walk():
                return self._walk(command)
            case Treat():
                self._treat()
            case Wait():
                self._wait(command.seconds)
            case Ask():
                self._ask(command.want)
            case Tell():
                self._tell(command.topic)
            case Leave():
                self._leaving = True
            case _:
                assert_never(command)
        return True

    def _face(self, way: str | Heading) -> None:
        facing = self._facing
        sides = {"forward": facing, "left": facing.left, "right": facing.right, "back": facing.back}
        wanted = way if isinstance(way, Heading) else sides[way]
        self._facing = wanted
        if self._run.mission.settings.controls == "turn":
            while self._run.observation().heading is not wanted and not self._run.ended:
                left = self._run.observation().heading.left is wanted
                self._act(Action.TURN_LEFT if left else Action.TURN_RIGHT)
            self._report()

    def _walk(self, walk: Walk) -> bool:
        now, way = self._run.observation(), self._facing
        turning = self._run.mission.settings.controls == "turn"
        action = Action.FORWARD if turning else _COMPASS[way]
        walked, why = 0, ""
        passed: list[str] = []
        most = walk.steps if walk.until is None else max(now.plan.width, now.plan.height)
        while walked < most and not self._run.ended:
            ahead = way.from_cell(now.position)
            blocked = not now.plan.walkable(ahead)
            if walk.until == "end" and now.plan.tile(ahead) is not Tile.FLOOR:
                break
            if blocked and (walked or walk.until):
                why = "" if walk.until == "wall" else "A wall stops you."
                break
            before = now
            self._act(action)
            now = self._run.observation()
            if blocked:
                why = "A wall stops you."
                break
            walked += 1
            passed += _passed(before, now, way)
            if walk.until == "door" and now.plan.is_door(now.position):
                break
            if walked < most and _new_words(now.guidance, before.guidance):
                why = "You stopped, since the bar has changed."
                break
        along = f", {joined(passed)}" if passed else ""
        door = " You stand in a doorway." if now.plan.is_door(now.position) else ""
        self._say(f"{counted(walked, 'step')} {way.name.lower()}{along}.{door} {why}".strip())
        self._report()
        return not why

    def _treat(self) -> None:
        if self._run.mission.settings.controls == "compass":
            self._facing = self._run.observation().heading
        self._run.press(Action.TRIAGE, self._now_ms)
        now = self._run.observation()
        if now.treatment is not None:
            self._pass(now.treatment.total_ms - now.treatment.done_ms)
        self._report()

    def _wait(self, seconds: int | None) -> None:
        if seconds is not None:
            self._pass(1000 * seconds)
        else:
            said, until_ms = self._run.observation().guidance, self._now_ms + LONGEST_WAIT_MS
            while not self._run.ended and self._now_ms < until_ms:
                due_ms = self._run.next_due_ms or until_ms
                self._pass(max(1, min(due_ms, until_ms) - self._now_ms))
                if self._heard.anything or _new_words(self._run.observation().guidance, said):
                    break
        self._report()

    def _ask(self, want: LevelWish) -> None:
        if not self._run.mission.settings.level_key:
            self._say("The coach cannot be asked in this mission.")
            return
        answered = self._run.ask_level(want, self._now_ms)
        self._say(f"{asked_words(want, answered=answered)}.")
        self._report()

    def _act(self, action: Action) -> None:
        self._run.press(action, self._now_ms)
        self._pass(self._run.mission.settings.pace_ms)

    def _pass(self, ms: int) -> None:
        before = self._run.observation()
        self._now_ms += ms
        self._run.advance(self._now_ms)
        self._warn(before, self._run.observation())

    def _warn(self, before: Observation, now: Observation) -> None:
        for left_ms in _WARNED_MS:
            if before.time_left_ms > left_ms >= now.time_left_ms > 0:
                self._say(f"{clock_words(left_ms)} left.")

    # --- telling --------------------------------------------------------------------------------

    def _report(self) -> None:
        """What has happened, and what has come into view."""
        now = self._run.observation()
        if self._run.mission.settings.controls == "turn":
            self._facing = now.heading
        said: set[str] = set()
        for event in self._heard.take():
            told = self._told(event, now)
            if told and told not in said:
                self._say(told)
            said.add(told)
        if self._run.ended:
            return
        victims = [it for it in now.victims if it.cell not in self._in_view]
        rooms = {room.name for room in now.rooms if room.name not in self._in_view}
        for line in (
            *victims_told(now, self._facing, victims),
            *rooms_told(now, self._facing, rooms),
            in_reach(now),
        ):
            if line:
                self._say(line)
        self._note_view()

    def _note_view(self) -> None:
        now = self._run.observation()
        self._in_view = {it.cell for it in now.victims if it.state is VictimState.WAITING}
        self._in_view |= {room.name for room in now.rooms}

    def _told(self, event: MissionEvent, now: Observation) -> str:
        match event:
            case Acted(outcome=Outcome.TREATING):
                return "You treat the victim."
            case Acted(outcome=Outcome.NOBODY):
                return "Nobody is in reach."
            case Acted(outcome=Outcome.TOO_LATE):
                return "It is too late for this red victim."
            case Acted(outcome=Outcome.ALREADY_TREATING):
                return "The treatment is under way."
            case TreatmentBroken():
                return "You walked away before the treatment was done."
            case Rescued():
                points = "" if now.score is None else f", {counted(now.score, 'point')}"
                return f"Rescued. That makes {now.rescued} rescued{points}."
            case Expired():
                return f"Time is up for red victims: {now.lost} died."
            case _:
                return ""

    def _tell(self, topic: Topic) -> None:
        now, ahead = self._run.observation(), self._facing
        match topic:
            case "look":
                lines: Iterable[str] = look(now, ahead)
            case "status":
                lines = status(now, self._run.mission.settings)
            case "seen":
                lines = remembered(now, ahead)
            case "map":
                lines = building_map(now, ahead)
            case "help":
                lines = HELP
            case "bar":
                self._guidance = Guidance("")
                lines = ()
            case _:
                assert_never(topic)
        for line in lines:
            self._say(line)

    def _tell_bar(self) -> None:
        guidance = self._run.observation().guidance or Guidance("")
        repeated = guidance.repeats(self._guidance)
        if guidance == self._guidance and not repeated:
            return
        if guidance.notice and guidance.notice != self._guidance.notice:
            self._say(f"Notice: {guidance.notice}")
        if repeated:
            self._say("The same again, from here.")
        if guidance.text and (repeated or guidance.text != self._guidance.text):
            self._say(f"Bar: {guidance.text}")
        self._guidance = guidance


def _new_words(now: Guidance | None, before: Guidance | None) -> bool:
    """Whether the bar says something that it did not say before."""
    now, before = now or Guidance(""), before or Guidance("")
    return now.notice not in ("", before.notice) or now.text not in ("", before.text)


def _passed(before: Observation, now: Observation, way: Heading) -> list[str]:
    """What was passed with a step: a door that one came out of, doors and intersections abreast."""
    plan = now.plan
    out = plan.is_door(before.position) and not plan.is_door(now.position)
    abreast = came_abreast(abreast_of(before, way), abreast_of(now, way))
    return [
        *(["through a door"] if out else []),
        *(f"past {_ARTICLES[landmark]} on the {side}" for landmark, side in abreast),
    ]

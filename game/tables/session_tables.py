"""The tidy tables of a study, made from its journals: pure, and the same for everyone.

`session_tables` turns one journal into rows, `combined` puts sessions together. Exports write the
rows to files, analyses read them into frames; neither looks at a journal itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import msgspec

from game.coach.acts import Disobeyed
from game.journal.failures import JournalError
from game.journal.history import ROUNDS, Story, Timed, read_story
from game.journal.reader import Transcript
from game.journal.records import Allocated, Phase
from game.tables.mission_tables import MissionTables, level_name
from game.tables.rows import (
    ActionRow,
    FreeTextRow,
    InstructionRow,
    InstructorKind,
    ItemRow,
    LabelRow,
    LevelRow,
    OrderName,
    ParticipantRow,
    PhaseRow,
    PosteriorRow,
    RoundRow,
    Row,
    VictimRow,
)
from game.world.building import Severity
from game.world.events import Outcome

MENTAL_STATES = ("engagement", "confidence", "frustration", "confusion")
LIKERT_ITEMS = ("pref1", "pref2", "pref3", "pref4")
TIMED: tuple[Phase, ...] = ("memorise", "label", "mission")
MS_PER_MINUTE = 60_000


@dataclass(frozen=True)
class Tables:
    """All rows of one session, or of many, in a fixed order."""

    participants: tuple[ParticipantRow, ...] = ()
    rounds: tuple[RoundRow, ...] = ()
    items: tuple[ItemRow, ...] = ()
    labels: tuple[LabelRow, ...] = ()
    victims: tuple[VictimRow, ...] = ()
    actions: tuple[ActionRow, ...] = ()
    instructions: tuple[InstructionRow, ...] = ()
    posteriors: tuple[PosteriorRow, ...] = ()
    levels: tuple[LevelRow, ...] = ()
    phases: tuple[PhaseRow, ...] = ()
    freetext: tuple[FreeTextRow, ...] = ()

    def table(self, name: str) -> tuple[Row, ...]:
        """The rows of the table called `name`."""
        rows: tuple[Row, ...] = getattr(self, name)
        return rows


ROW_TYPES: dict[str, type[Row]] = {
    "participants": ParticipantRow,
    "rounds": RoundRow,
    "items": ItemRow,
    "labels": LabelRow,
    "victims": VictimRow,
    "actions": ActionRow,
    "instructions": InstructionRow,
    "posteriors": PosteriorRow,
    "levels": LevelRow,
    "phases": PhaseRow,
    "freetext": FreeTextRow,
}
"""What a row of each table is."""


def combined(sessions: Iterable[Tables]) -> Tables:
    """The tables of several sessions as one, in the order of the sessions."""
    every = tuple(sessions)
    joined: dict[str, Any] = {
        name: tuple(row for session in every for row in session.table(name)) for name in ROW_TYPES
    }
    return replace(Tables(), **joined)


def session_tables(transcript: Transcript) -> Tables:
    """The rows of one session of a study. Practice is left out, but for its check.

    Raises JournalError for a journal that has rounds and no allocation.
    """
    return _Session(read_story(transcript), transcript.source).tables()


class _Session:
    def __init__(self, story: Story, source: str) -> None:
        self.story = story
        self.source = source
        self.participant = story.started.participant
        self.missions = {
            round_: MissionTables(
                self.participant,
                round_,
                self.adaptivity(round_),
                self.allocated.buildings[round_ - 1],
                mission,
            )
            for round_, mission in story.missions.items()
        }

    @property
    def rounds(self) -> Iterator[int]:
        """The rounds begun."""
        return (number for number in ROUNDS if any(step[1] == number for step in self.story.phases))

    @property
    def allocated(self) -> Allocated:
        if self.story.allocated is None:
            raise JournalError(
                f"the session {self.story.started.session} has rounds but was never allocated",
                place=self.source,
                mend="Give the journal of a study, as ana has written it.",
            )
        return self.story.allocated

    def adaptivity(self, round_: int) -> InstructorKind:
        first = self.allocated.adaptive_first is (round_ == ROUNDS[0])
        return "adaptive" if first else "static"

    def tables(self) -> Tables:
        missions = tuple(self.missions.values())
        return Tables(
            participants=(self.participant_row(),),
            rounds=tuple(self.round_row(round_) for round_ in self.rounds),
            items=tuple(self.items()),
            labels=tuple(self.labels()),
            victims=tuple(row for mission in missions for row in mission.victims()),
            actions=tuple(row for mission in missions for row in mission.actions()),
            instructions=tuple(row for mission in missions for row in mission.instructions()),
            posteriors=tuple(row for mission in missions for row in mission.posteriors()),
            levels=tuple(row for mission in missions for row in mission.levels()),
            phases=tuple(self.phases()),
            freetext=tuple(self.free_texts()),
        )

    # --- the participant -------------------------------------------------------------------------

    def participant_row(self) -> ParticipantRow:
        story, allocated = self.story, self.story.allocated
        terminal, practice = story.terminal, story.practice
        kinds = self.disobeyed(self.missions.values())
        return ParticipantRow(
            participant=self.participant,
            mode=story.started.mode,
            simulated=story.started.simulated,
            rescuer=story.started.rescuer,
            session_ending=story.ending,
            last_phase=story.last_step[0],
            last_round=story.last_step[1],
            slot=allocated.slot if allocated else None,
            refill=allocated.refill if allocated else None,
            complexity=level_name(allocated.static_level) if allocated else None,
            order=_order(allocated) if allocated else None,
            memorise_minutes=allocated.memorise_ms / MS_PER_MINUTE if allocated else None,
            first_building=allocated.buildings[0] if allocated else None,
            second_building=allocated.buildings[1] if allocated else None,
            quiz_static=self.quiz_before("static"),
            quiz_adaptive=self.quiz_before("adaptive"),
            disobeyed=len(kinds),
            repeat_misstep=kinds.count("repeat_misstep"),
            other_victim=kinds.count("other_victim"),
            preferred_instructor=self.preferred(),
            preferred_round=story.preference.preferred_round if story.preference else None,
            preferred_ms=story.preference.response_ms if story.preference else None,
            practice_right=practice.right if practice else None,
            practice_asked=practice.asked if practice else None,
            consent_version=story.consent_version,
            segments=story.segments,
            interruptions=story.interruptions,
            takeovers=story.takeovers,
            amendments=story.amendments,
            torn_bytes=story.torn_bytes,
            started_utc=story.started_utc,
            ended_utc=story.ended_utc,
            term=terminal.term if terminal else None,
            colorterm=terminal.colorterm if terminal else None,
            terminal_columns=terminal.columns if terminal else None,
            terminal_rows=terminal.rows if terminal else None,
            game_version=story.versions.game,
            study_sha256=story.started.study.sha256 if story.started.study else None,
        )

    def quiz_before(self, instructor: InstructorKind) -> float | None:
        for round_, quiz in self.story.quizzes.items():
            if self.adaptivity(round_) == instructor:
                return quiz.right / quiz.asked
        return None

    def preferred(self) -> InstructorKind | None:
        preference = self.story.preference
        return None if preference is None else self.adaptivity(preference.preferred_round)

    @staticmethod
    def disobeyed(missions: Iterable[MissionTables]) -> list[str]:
        return [
            record.kind
            for mission in missions
            for record in mission.records
            if isinstance(record, Disobeyed)
        ]

    # --- the rounds ------------------------------------------------------------------------------

    def round_row(self, round_: int) -> RoundRow:
        story, allocated = self.story, self.allocated
        everywhere = self.disobeyed(self.missions.values())
        timed = {phase: story.phases.get((phase, round_)) for phase in TIMED}
        void = story.is_void(round_)
        quiz = story.quizzes.get(round_)
        empty = dict.fromkeys(RoundRow.__struct_fields__)
        given = self.answers(round_, void) | self.played(round_, void)
        return msgspec.convert(
            empty
            | given
            | {
                "participant": self.participant,
                "simulated": story.started.simulated,
                "round": round_,
                "adaptivity": self.adaptivity(round_),
                "complexity": level_name(allocated.static_level),
                "order": _order(allocated),
                "memorise_minutes": allocated.memorise_ms / MS_PER_MINUTE,
                "memorise_ms": allocated.memorise_ms,
                "building": allocated.buildings[round_ - 1],
                "quiz": quiz.right / quiz.asked if quiz else None,
                "quiz_right": quiz.right if quiz else None,
                "quiz_asked": quiz.asked if quiz else None,
                "disobeyed": len(everywhere),
                "repeat_misstep": everywhere.count("repeat_misstep"),
                "other_victim": everywhere.count("other_victim"),
                "preferred_instructor": self.preferred(),
                "interrupted": any(span is not None and span.broke_off for span in timed.values()),
                "void": void,
            }
            | {f"{phase}_exposure_ms": _exposure(span) for phase, span in timed.items()},
            RoundRow,
        )

    def answers(self, round_: int, void: bool) -> dict[str, int | None]:
        """The sliders and statements, and the sum of the statements where all were answered."""
        if void:
            return {}
        named = (*MENTAL_STATES, *LIKERT_ITEMS)
        values = {
            item: answer.value
            for (_, number, item), answer in self.story.items.items()
            if number == round_ and item in named
        }
        whole = all(item in values for item in LIKERT_ITEMS)
        total = sum(values[item] for item in LIKERT_ITEMS) if whole else None
        return {**values, "preference": total}

    def played(self, round_: int, void: bool) -> dict[str, float | int | str | None]:
        """What the mission of a round adds to its row."""
        mission = self.missions.get(round_)
        if mission is None:
            return {}
        victims, instructions = tuple(mission.victims()), tuple(mission.instructions())
        outcomes = [action.outcome for action in mission.actions()]
        levels, posteriors = tuple(mission.levels()), tuple(mission.posteriors())
        kinds = self.disobeyed([mission])
        clear = [row.comprehension for row in posteriors if row.verdict != "none"]
        saved = [row.severity for row in victims if row.fate == "rescued"]
        outcome: dict[str, int] = {
            "victims": len(saved),
            "reds_rescued": saved.count(Severity.RED),
            "blues_rescued": saved.count(Severity.BLUE),
            "reds_expired": sum(row.fate == "expired" for row in victims),
        }
        return {
            **({} if void else outcome),
            "disobeyed_in_round": len(kinds),
            "repeat_misstep_in_round": kinds.count("repeat_misstep"),
            "other_victim_in_round": kinds.count("other_victim"),
            "missteps": sum(row.missteps_under for row in instructions),
            "instructions": len(instructions),
            "completed": sum(row.completed_ms is not None for row in instructions),
            "fallbacks": sum(row.fallback for row in instructions),
            **_shares(levels, mission.until_ms),
            "switches": max(0, len(levels) - 1),
            "mean_comprehension": sum(clear) / len(clear) if clear else None,
            "moves": outcomes.count(Outcome.MOVED),
            "bumps": outcomes.count(Outcome.BUMPED),
            "preset": mission.mission.started.coach.preset,
        }

    # --- the other tables ------------------------------------------------------------------------

    def items(self) -> Iterator[ItemRow]:
        for (phase, round_, item), answer in self.story.items.items():
            yield ItemRow(
                participant=self.participant,
                phase=phase,
                round=round_,
                adaptivity=self.adaptivity(round_) if round_ else None,
                item=item,
                text=answer.text,
                place=answer.place,
                value=answer.value,
                response_ms=answer.response_ms,
                changes=answer.changes,
            )

    def labels(self) -> Iterator[LabelRow]:
        for (round_, room), (answer, changes) in self.story.labels.items():
            if answer.answer is not None:
                yield LabelRow(
                    participant=self.participant,
                    round=round_,
                    adaptivity=self.adaptivity(round_),
                    building=self.allocated.buildings[round_ - 1],
                    room=room,
                    answer=answer.answer,
                    correct=answer.correct,
                    response_ms=answer.response_ms,
                    changes=changes,
                )

    def phases(self) -> Iterator[PhaseRow]:
        for (phase, round_), span in self.story.phases.items():
            yield PhaseRow(
                participant=self.participant,
                phase=phase,
                round=round_,
                phase_ending=span.ending,
                exposure_ms=span.exposure_ms,
                starts=span.starts,
                started_utc=span.started_utc,
                ended_utc=span.ended_utc,
            )

    def free_texts(self) -> Iterator[FreeTextRow]:
        for text in self.story.free_texts:
            if not text.answer:
                continue
            yield FreeTextRow(
                participant=self.participant,
                item=text.item,
                text=text.text,
                answer=text.answer,
                response_ms=text.response_ms,
            )


def _order(allocated: Allocated) -> OrderName:
    return "adaptive_first" if allocated.adaptive_first else "static_first"


def _exposure(span: Timed | None) -> int | None:
    return None if span is None else span.exposure_ms


def _shares(levels: Sequence[LevelRow], whole_ms: int) -> dict[str, float | None]:
    def share(name: str) -> float | None:
        spent = sum(row.until_ms - row.from_ms for row in levels if row.level == name)
        return spent / whole_ms if whole_ms else None

    return {"share_c1": share("C1"), "share_c2": share("C2"), "share_c3": share("C3")}

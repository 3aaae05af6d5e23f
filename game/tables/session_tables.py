"""The tidy tables of a study, made from its journals: pure, and the same for every use.

`session_tables` turns one journal into rows; `combined` joins the rows of many sessions. Exports
write the rows to files and analyses read them into frames; neither reads a journal itself.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, cast

import msgspec

from game.forms.form import Forms
from game.forms.reading import paper_forms
from game.journal.history import History, PhaseSpan, Step, building_of, read_history
from game.journal.journal_error import JournalError
from game.journal.reader import Transcript
from game.journal.records import Allocated, ProtocolPhase
from game.tables.asked import FAILED, asked_columns, attention_failed, wider
from game.tables.mission_tables import MissionTables, level_name
from game.tables.rows import (
    ActionRow,
    AskedRow,
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
    TableRow,
    VictimRow,
)
from game.world.building import Severity
from game.world.events import Acted, Outcome

MENTAL_STATES = ("engagement", "confidence", "frustration", "confusion")
LIKERT_ITEMS = ("pref1", "pref2", "pref3", "pref4")
TIMED: tuple[ProtocolPhase, ...] = ("memorise", "label", "mission")
MS_PER_MINUTE = 60_000
NO_RESULT: dict[str, None] = dict.fromkeys(
    ("victims", "reds_rescued", "blues_rescued", "reds_expired")
)
"""What the mission of a round that does not count leaves empty."""


@dataclass(frozen=True)
class Tables:
    """All rows of one or more sessions, in a fixed order."""

    participants: tuple[ParticipantRow, ...] = ()
    rounds: tuple[RoundRow, ...] = ()
    items: tuple[ItemRow, ...] = ()
    labels: tuple[LabelRow, ...] = ()
    victims: tuple[VictimRow, ...] = ()
    actions: tuple[ActionRow, ...] = ()
    instructions: tuple[InstructionRow, ...] = ()
    posteriors: tuple[PosteriorRow, ...] = ()
    levels: tuple[LevelRow, ...] = ()
    asked: tuple[AskedRow, ...] = ()
    phases: tuple[PhaseRow, ...] = ()
    freetext: tuple[FreeTextRow, ...] = ()

    def table(self, name: str) -> tuple[TableRow, ...]:
        """The rows of the table called `name`."""
        rows: tuple[TableRow, ...] = getattr(self, name)
        return rows


ROW_TYPES: dict[str, type[TableRow]] = {
    "participants": ParticipantRow,
    "rounds": RoundRow,
    "items": ItemRow,
    "labels": LabelRow,
    "victims": VictimRow,
    "actions": ActionRow,
    "instructions": InstructionRow,
    "posteriors": PosteriorRow,
    "levels": LevelRow,
    "asked": AskedRow,
    "phases": PhaseRow,
    "freetext": FreeTextRow,
}
"""The row type of each table."""


def combined(sessions: Iterable[Tables]) -> Tables:
    """The tables of several sessions joined, in the order of the sessions."""
    every = tuple(sessions)
    joined: dict[str, Any] = {
        name: tuple(row for session in every for row in session.table(name)) for name in ROW_TYPES
    }
    return replace(Tables(), **joined)


@lru_cache(8)
def row_types(forms: Forms) -> dict[str, type[TableRow]]:
    """The row type of each table of a study that asks these forms. Raises FormsError where an id is
    the name of another column."""
    attention = any(it.role == "attention" for form in forms.forms for it in form.questions)
    return wider(ROW_TYPES, asked_columns(forms), attention=attention)


def session_tables(
    transcript: Transcript,
    forms: Forms | None = None,
    wanted: Collection[str] = tuple(ROW_TYPES),
) -> Tables:
    """The rows of one session of a study that asks `forms`, the paper's if not said; tables that
    are not `wanted` stay empty. Practice is left out, except for its check.

    Raises JournalError for a journal that has rounds but no allocation.
    """
    return _Session(transcript, forms or paper_forms()).tables(wanted)


def tables_of(
    transcripts: Iterable[Transcript],
    forms: Forms | None = None,
    wanted: Collection[str] = tuple(ROW_TYPES),
) -> Iterator[Tables]:
    """The rows of each session of a study."""
    return (session_tables(transcript, forms, wanted) for transcript in transcripts)


class _Session:
    def __init__(self, transcript: Transcript, forms: Forms) -> None:
        self._forms = forms
        self._columns = asked_columns(forms)
        self._types = row_types(forms)
        self.started = transcript.started
        self.history: History = read_history(transcript)
        self.source = transcript.source
        self.participant = self.started.participant
        self.person = {"participant": self.participant}
        self.missions = {
            mission.step.round: MissionTables(
                self.participant,
                mission.step.round,
                self.adaptivity(mission.step.round),
                self.allocated.buildings[mission.step.round - 1],
                building_of(mission.started),
                mission,
            )
            for mission in self.history.missions
            if mission.step.phase == "mission" and mission.step.round
        }

    @property
    def rounds(self) -> Iterator[int]:
        """The rounds that were started."""
        return iter(sorted({step.round for step in self.history.phases if step.round}))

    @property
    def allocated(self) -> Allocated:
        if self.history.allocated is None:
            raise JournalError(
                f"the session {self.started.session} has rounds but was never allocated",
                place=self.source,
                hint="Give the journal of a study, unchanged.",
            )
        return self.history.allocated

    def adaptivity(self, round_: int) -> InstructorKind:
        return "adaptive" if self.allocated.second_leads(round_) else "static"

    def tables(self, wanted: Collection[str]) -> Tables:
        missions = tuple(self.missions.values())
        every: dict[str, Iterator[TableRow]] = {
            "participants": (self.participant_row() for _ in (self.participant,)),
            "rounds": (self.round_row(round_) for round_ in self.rounds),
            "items": self.items(),
            "labels": self.labels(),
            "victims": (row for mission in missions for row in mission.victims()),
            "actions": (row for mission in missions for row in mission.actions()),
            "instructions": (row for mission in missions for row in mission.instructions()),
            "posteriors": (row for mission in missions for row in mission.posteriors()),
            "levels": (row for mission in missions for row in mission.levels()),
            "asked": (row for mission in missions for row in mission.asked()),
            "phases": self.phases(),
            "freetext": self.free_texts(),
        }
        made: dict[str, Any] = {name: tuple(every[name]) for name in every if name in wanted}
        return Tables(**made)

    # --- the participant -------------------------------------------------------------------------

    def participant_row(self) -> ParticipantRow:
        history, allocated = self.history, self.history.allocated
        terminal, practice = history.terminal, history.practice
        kinds = self.disobeyed(self.missions.values())
        two = allocated is not None and len(allocated.buildings) > 1
        asked = {it.name: it.value(history, 0) for it in self._columns if it.table != "rounds"}
        failed = attention_failed(self._forms, history)
        if failed is not None:
            asked[FAILED] = failed
        kind = cast("type[ParticipantRow]", self._types["participants"])
        return kind(
            **asked,
            participant=self.participant,
            mode=self.started.mode,
            simulated=self.started.simulated,
            rescuer=self.started.rescuer,
            session_ending=history.ending,
            last_phase=history.step.phase,
            last_round=history.step.round,
            slot=allocated.slot if allocated else None,
            refill=allocated.refill if allocated else None,
            complexity=level_name(allocated.static_level) if allocated else None,
            order=_order(allocated) if allocated else None,
            memorise_minutes=minutes_of(allocated.memorise_ms) if allocated else None,
            first_building=allocated.buildings[0] if allocated else None,
            second_building=allocated.buildings[1] if allocated and two else None,
            quiz_static=self.quiz_before("static"),
            quiz_adaptive=self.quiz_before("adaptive"),
            disobeyed=len(kinds),
            repeat_misstep=kinds.count("repeat_misstep"),
            other_victim=kinds.count("other_victim"),
            preferred_instructor=self.preferred(),
            preferred_round=history.preference.preferred_round if history.preference else None,
            preferred_ms=history.preference.response_ms if history.preference else None,
            practice_right=practice.right if practice else None,
            practice_asked=practice.asked if practice else None,
            consent_version=history.consent_version,
            segments=history.resumed + 1,
            interruptions=history.interruptions,
            takeovers=history.takeovers,
            amendments=history.amendments,
            torn_bytes=history.torn_bytes,
            started_utc=history.started_utc,
            ended_utc=history.ended_utc,
            term=terminal.term if terminal else None,
            colorterm=terminal.colorterm if terminal else None,
            terminal_columns=terminal.columns if terminal else None,
            terminal_rows=terminal.rows if terminal else None,
            game_version=(history.versions or self.started.versions).game,
            study_sha256=self.started.study.sha256 if self.started.study else None,
        )

    def quiz_before(self, instructor: InstructorKind) -> float | None:
        for round_, quiz in self.history.quizzes.items():
            if self.adaptivity(round_) == instructor:
                return quiz.right / quiz.asked
        return None

    def preferred(self) -> InstructorKind | None:
        preference = self.history.preference
        return None if preference is None else self.adaptivity(preference.preferred_round)

    @staticmethod
    def disobeyed(missions: Iterable[MissionTables]) -> list[str]:
        return [kind for mission in missions for kind in mission.mission.disobeyed]

    # --- the rounds ------------------------------------------------------------------------------

    def round_row(self, round_: int) -> RoundRow:
        history, allocated = self.history, self.allocated
        everywhere = self.disobeyed(self.missions.values())
        timed = {phase: history.phases.get(Step(phase, round_)) for phase in TIMED}
        void = history.is_void(round_)
        quiz = history.quizzes.get(round_)
        kind = cast("type[RoundRow]", self._types["rounds"])
        empty = dict.fromkeys(kind.__struct_fields__)
        row = msgspec.convert(
            empty
            | self.answers(round_, void)
            | self.played(round_)
            | {
                "participant": self.participant,
                "simulated": self.started.simulated,
                "round": round_,
                "adaptivity": self.adaptivity(round_),
                "complexity": level_name(allocated.static_level),
                "order": _order(allocated),
                "memorise_minutes": minutes_of(allocated.memorise_ms),
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
            | {f"{phase}_exposure_ms": _exposure(span) for phase, span in timed.items()}
            | {
                "mission_covered_ms": _covered(timed["mission"]),
                "mission_ending": timed["mission"].ending if timed["mission"] else None,
            },
            kind,
        )
        return row if row.counts else msgspec.structs.replace(row, **NO_RESULT)

    def answers(self, round_: int, void: bool) -> dict[str, float | int | bool | None]:
        """What was answered after the mission, and what is computed from it."""
        if void:
            return {}
        columns = (it for it in self._columns if it.table == "rounds")
        return {it.name: it.value(self.history, round_) for it in columns}

    def played(self, round_: int) -> dict[str, float | int | str | None]:
        """The columns that the mission of a round adds to its row."""
        mission = self.missions.get(round_)
        if mission is None:
            return {}
        victims, instructions = tuple(mission.victims()), tuple(mission.instructions())
        outcomes = [it.outcome for it in mission.mission.records if isinstance(it, Acted)]
        levels, posteriors = tuple(mission.levels()), tuple(mission.posteriors())
        kinds, wants = self.disobeyed([mission]), [row.want for row in mission.asked()]
        clear = [row.comprehension for row in posteriors if row.verdict != "none"]
        saved = [row.severity for row in victims if row.fate == "rescued"]
        return {
            "victims": len(saved),
            "reds_rescued": saved.count(Severity.RED),
            "blues_rescued": saved.count(Severity.BLUE),
            "reds_expired": sum(row.fate == "expired" for row in victims),
            "disobeyed_in_round": len(kinds),
            "repeat_misstep_in_round": kinds.count("repeat_misstep"),
            "other_victim_in_round": kinds.count("other_victim"),
            "missteps": sum(row.missteps_under for row in instructions),
            "lost": mission.mission.lost,
            "asked_simpler": wants.count("simpler"),
            "asked_shorter": wants.count("shorter"),
            "instructions": len(instructions),
            "completed": sum(row.completed_ms is not None for row in instructions),
            "fallbacks": sum(row.fallback for row in instructions),
            **_shares(levels, mission.mission.until_ms),
            "switches": max(0, len(levels) - 1),
            "mean_comprehension": sum(clear) / len(clear) if clear else None,
            "moves": outcomes.count(Outcome.MOVED),
            "bumps": outcomes.count(Outcome.BUMPED),
            "preset": mission.mission.started.coach.preset,
        }

    # --- the other tables ------------------------------------------------------------------------

    def items(self) -> Iterator[ItemRow]:
        for (step, _), answer in self.history.items.items():
            instructor = self.adaptivity(step.round) if step.round else None
            yield ItemRow.of(
                answer,
                **step._asdict(),
                **self.person,
                adaptivity=instructor,
                anchors=" | ".join(answer.anchors),
            )

    def labels(self) -> Iterator[LabelRow]:
        for (round_, _), (answer, changes) in self.history.labels.items():
            if answer.answer is not None:
                yield LabelRow.of(
                    answer,
                    **self.person,
                    round=round_,
                    adaptivity=self.adaptivity(round_),
                    building=self.allocated.buildings[round_ - 1],
                    changes=changes,
                )

    def phases(self) -> Iterator[PhaseRow]:
        for step, span in self.history.phases.items():
            yield PhaseRow.of(
                **self.person, **step._asdict(), **vars(span), phase_ending=span.ending
            )

    def free_texts(self) -> Iterator[FreeTextRow]:
        for (step, _), text in self.history.words.items():
            if text.answer:
                yield FreeTextRow.of(text, **self.person, **step._asdict())


def minutes_of(ms: int) -> float:
    """Milliseconds as minutes, as tables have them: to three decimals."""
    return round(ms / MS_PER_MINUTE, 3)


def _order(allocated: Allocated) -> OrderName:
    return "adaptive_first" if allocated.adaptive_first else "static_first"


def _covered(span: PhaseSpan | None) -> int | None:
    return None if span is None else span.covered_ms


def _exposure(span: PhaseSpan | None) -> int | None:
    return None if span is None else span.exposure_ms


def _shares(levels: Sequence[LevelRow], whole_ms: int) -> dict[str, float | None]:
    def share(name: str) -> float | None:
        spent = sum(row.until_ms - row.from_ms for row in levels if row.level == name)
        return spent / whole_ms if whole_ms else None

    return {"share_c1": share("C1"), "share_c2": share("C2"), "share_c3": share("C3")}

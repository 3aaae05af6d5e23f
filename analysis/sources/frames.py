"""The two tidy tables that every analysis starts from, whatever their source.

`participants` has one row a participant (index: participant) with `complexity`, the static
instructor's level, and as far as the source knows them `knowledge`, `quiz_static`, `order`,
`memorise_minutes`, `disobeyed`, `other_victim` and `preferred_instructor`. `rounds` has one row a
participant and instructor with `victims`, the four mental states, the four Likert items, their sum
`preference`, and as far as known `building`. A missing answer is NaN and never 0.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.sources.absent import Refusal, SourceError
from analysis.sources.designs import PAPER_DESIGN, Crossed
from analysis.sources.factors import (
    ADAPTIVITY,
    COMPLEXITY,
    KNOWLEDGE,
    LIKERT_ITEMS,
    PAPER,
    RANGES,
)
from game.tables.asked import Outcomes

Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int64]


@dataclass(frozen=True)
class StudyData:
    """Tidy tables of one study, in a fixed order of rows; `notes` say what a reader must know.

    `every_round` has a `round` besides, and all rounds where an instructor has more than one, of
    which `rounds` has the first; else it is None.
    """

    participants: pd.DataFrame
    rounds: pd.DataFrame
    label: str
    simulated: bool = False
    notes: tuple[str, ...] = ()
    asked: Outcomes = PAPER
    crossed: Crossed = PAPER_DESIGN
    every_round: pd.DataFrame | None = None
    missions: bool = True

    @property
    def outcomes(self) -> tuple[str, ...]:
        """What is analysed: victims, where people had missions, the mental states, and what is
        computed from the answers."""
        performance = ("victims",) if self.missions else ()
        return (*performance, *self.asked.mental_states, *self.asked.composites)

    def has(self, column: str) -> bool:
        """Whether the source knows this column of `participants` or `rounds` at all."""
        for table in (self.participants, self.rounds):
            if column in table.columns and bool(table[column].notna().any()):
                return True
        return False

    @cached_property
    def by_round(self) -> pd.DataFrame:
        """The rounds with a row a participant; columns are (measure, static or adaptive)."""
        return self.rounds.pivot(index="participant", columns="adaptivity")

    @cached_property
    def pairs(self) -> dict[str, "Paired"]:
        """What `paired` has found, by outcome."""
        return {}

    def need_groups(self) -> None:
        """Raise Refusal where there are no knowledge groups."""
        if not self.has("knowledge"):
            raise Refusal(
                "there are no knowledge groups: neither stated nor formed from quiz scores"
            )

    def without(self, participants: Iterable[str]) -> "StudyData":
        """The same study without these participants."""
        gone = list(participants)
        return replace(
            self,
            participants=self.participants.drop(index=gone),
            rounds=_kept(self.rounds, gone),
            every_round=None if self.every_round is None else _kept(self.every_round, gone),
        )

    def with_groups(self, knowledge: pd.Series) -> "StudyData":
        """The same study with these knowledge groups (index: participant)."""
        groups = knowledge.reindex(self.participants.index).astype(object)
        return replace(self, participants=self.participants.assign(knowledge=groups))

    def without_groups(self) -> "StudyData":
        """The same study without the knowledge groups that it states."""
        return replace(
            self, participants=self.participants.drop(columns="knowledge", errors="ignore")
        )

    def noted(self, *notes: str) -> "StudyData":
        """The same study with more notes."""
        return replace(self, notes=(*self.notes, *notes))


def _kept(rows: pd.DataFrame, gone: list[str]) -> pd.DataFrame:
    return rows[~rows["participant"].isin(gone)].reset_index(drop=True)


def make_study(
    participants: pd.DataFrame,
    rounds: pd.DataFrame,
    *,
    label: str,
    simulated: bool = False,
    asked: Outcomes = PAPER,
    crossed: Crossed = PAPER_DESIGN,
    checked: bool = False,
) -> StudyData:
    """Check the two tables, add `preference`, and put their rows in order.

    `participants` is indexed by participant; answers that were `checked` before may be no whole
    numbers. Raises SourceError for an illegal or repeated value, naming the participant.
    """
    if participants.empty:
        raise SourceError(f"{label}: no participants; nothing can be analysed")
    _check_levels(participants, "complexity", COMPLEXITY, label, needed=True)
    if "knowledge" in participants.columns:
        _check_levels(participants, "knowledge", KNOWLEDGE, label, needed=False)
    keyed = rounds.set_index("participant")
    _check_levels(keyed, "adaptivity", ADAPTIVITY, label, needed=True)
    repeated = rounds[rounds.duplicated(["participant", "adaptivity"])]
    if not repeated.empty:
        first = repeated.iloc[0]
        raise SourceError(
            f"{label}: participant {first['participant']} has more than one row for the "
            f"{first['adaptivity']} round; keep one"
        )
    ranges = {} if checked else RANGES | dict(asked.ranges)
    for column, (least, most) in ranges.items():
        if column in keyed.columns:
            _check_range(keyed[column], column, least, most, label)
    if "preference" not in rounds.columns:
        rounds = rounds.assign(preference=rounds[list(LIKERT_ITEMS)].sum(axis=1, skipna=False))
    ordered = rounds.assign(
        adaptivity=pd.Categorical(rounds["adaptivity"], ADAPTIVITY, ordered=True),
    ).sort_values(["participant", "adaptivity"], ignore_index=True)
    ordered["adaptivity"] = ordered["adaptivity"].astype(str)
    return StudyData(
        participants.sort_index(), ordered, label, simulated, asked=asked, crossed=crossed
    )


def missing_notes(study: StudyData) -> list[str]:
    """Who lacks a round of which outcomes, in a sentence for outcomes that the same people lack."""
    lacking: dict[tuple[tuple[str, ...], tuple[str, ...]], list[str]] = {}
    for outcome in study.outcomes:
        if not study.has(outcome):
            continue
        known = study.rounds.dropna(subset=[outcome])["participant"].value_counts()
        rounds = known.reindex(study.participants.index, fill_value=0)
        none, one = (tuple(map(str, rounds.index[rounds == number])) for number in (0, 1))
        lacking.setdefault((none, one if study.crossed.rounds > 1 else ()), []).append(outcome)
    notes = []
    for (none, one), outcomes in lacking.items():
        told = [f"no round of {', '.join(none)}"] if none else []
        if one:
            told.append(
                f"one round only of {', '.join(one)}, kept by the mixed model and left out "
                "wherever both rounds are needed"
            )
        if told:
            notes.append(f"{', '.join(outcomes)}: {'; '.join(told)}")
    return notes


def _check_levels(
    table: pd.DataFrame, column: str, levels: tuple[str, ...], label: str, *, needed: bool
) -> None:
    known = table[column] if needed else table[column].dropna()
    for participant, value in known.items():
        if value not in levels:
            raise SourceError(
                f"{label}: participant {participant}: {column} is {value!r}; "
                f"it must be one of {', '.join(levels)}"
            )


def _check_range(values: pd.Series, column: str, least: int, most: int | None, label: str) -> None:
    for participant, value in values.dropna().items():
        if value < least or (most is not None and value > most) or value != int(value):
            span = f"from {least} to {most}" if most is not None else f"of at least {least}"
            raise SourceError(
                f"{label}: participant {participant}: {column} is {value:g}; it must be a whole "
                f"number {span}, or empty where no answer was given"
            )


@dataclass(frozen=True)
class Paired:
    """Both rounds of one outcome, for the participants who have both and a knowledge group.

    `knowledge` and `complexity` count from 0 in the order of the vocabulary; `static` and
    `adaptive` are the two rounds' values; all have one entry a participant. `levels` are the
    static levels of the design.
    """

    outcome: str
    participants: tuple[str, ...]
    knowledge: Ints
    complexity: Ints
    static: Floats
    adaptive: Floats
    n_dropped: int
    levels: tuple[str, ...] = COMPLEXITY

    @property
    def cell(self) -> Ints:
        """The analysis cell, 3 knowledge + complexity."""
        return len(COMPLEXITY) * self.knowledge + self.complexity

    @property
    def difference(self) -> Floats:
        """adaptive - static."""
        return self.adaptive - self.static

    @property
    def mean(self) -> Floats:
        """The mean of the two rounds."""
        return (self.adaptive + self.static) / 2


def both_rounds(study: StudyData, outcome: str) -> pd.DataFrame:
    """Columns static and adaptive of one outcome by participant, listwise (no NaN)."""
    rounds = study.by_round
    missing = pd.Series(np.nan, index=rounds.index)
    answers = {name: rounds.get((outcome, name), missing) for name in ADAPTIVITY}
    return pd.DataFrame(answers).dropna()


def paired(study: StudyData, outcome: str) -> Paired:
    """The listwise sample of one outcome (both rounds answered, knowledge group known).

    Raises Refusal where the study has no knowledge groups.
    """
    study.need_groups()
    if outcome not in study.pairs:
        study.pairs[outcome] = _paired(study, outcome)
    return study.pairs[outcome]


def _paired(study: StudyData, outcome: str) -> Paired:
    wide = both_rounds(study, outcome)
    people = study.participants.loc[wide.index]
    people = people[people["knowledge"].notna()]
    wide = wide.loc[people.index]
    return Paired(
        outcome=outcome,
        participants=tuple(str(who) for who in people.index),
        knowledge=_codes(people["knowledge"], KNOWLEDGE),
        complexity=_codes(people["complexity"], COMPLEXITY),
        static=wide["static"].to_numpy(dtype=float),
        adaptive=wide["adaptive"].to_numpy(dtype=float),
        n_dropped=len(study.participants) - len(people),
        levels=study.crossed.levels,
    )


def _codes(values: pd.Series, levels: tuple[str, ...]) -> Ints:
    return np.array([levels.index(value) for value in values], dtype=np.int64)

"""Everything that a study's journals tell, as data frames, and the two tables of it that the
statistics need.

A frame has the columns that `game.tables.rows` describes. Its cells are made from the same text
that a written table holds, so a study read from journals and one read from tables are the same.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import pandas as pd

from analysis.sources.absent import SourceError
from analysis.sources.designs import PAPER_DESIGN, Crossed
from analysis.sources.factors import LIKERT_ITEMS, MENTAL_STATES
from analysis.sources.frames import StudyData, make_study
from game.forms.form import Forms
from game.forms.reading import paper_forms
from game.tables.asked import FAILED, outcomes_of
from game.tables.columns import TableColumn, columns
from game.tables.session_tables import ROW_TYPES, row_types

#: What analyses read; actions are many, and texts in own words may identify a person.
ANALYSED = tuple(name for name in ROW_TYPES if name not in ("actions", "freetext"))

#: What `participants` has only where a study asks for it.
PERSON_ASKED = (FAILED,)

PERSON = (
    "complexity",
    "order",
    "memorise_minutes",
    "quiz_static",
    "disobeyed",
    "repeat_misstep",
    "other_victim",
    "preferred_instructor",
)
ROUND = ("participant", "adaptivity", "building", "victims")
MS_PER_SECOND = 1000


@dataclass(frozen=True)
class Recorded:
    """The frames of a study by the names in `ANALYSED`; `notes` say what a reader must know,
    `forms` what was asked, and `crossed` what was compared."""

    frames: Mapping[str, pd.DataFrame]
    label: str
    simulated: bool
    notes: tuple[str, ...] = ()
    forms: Forms = field(default_factory=paper_forms)
    crossed: Crossed = PAPER_DESIGN

    def frame(self, name: str) -> pd.DataFrame:
        """The frame called `name`."""
        return self.frames[name]

    def noted(self, *notes: str) -> "Recorded":
        """The same study with more notes."""
        return replace(self, notes=(*self.notes, *notes))

    def study(self) -> StudyData:
        """Everybody randomised, as the statistics take it.

        Raises SourceError where nobody got as far as the allocation.
        """
        people = self.frame("participants").set_index("participant")
        people = people[people["complexity"].notna()]
        if people.empty:
            raise SourceError(
                f"{self.label}: nobody got as far as the allocation; there is nothing to analyse"
            )
        asked = outcomes_of(self.forms)
        every = self.frame("rounds").sort_values("round", kind="stable")
        repeated = every.duplicated(["participant", "adaptivity"])
        wanted = (*MENTAL_STATES, *LIKERT_ITEMS, *asked.ranges, *asked.composites)
        columns = dict.fromkeys((*ROUND, *(name for name in wanted if name in every.columns)))
        person = (*PERSON, *(name for name in PERSON_ASKED if name in people.columns))
        study = make_study(
            people[list(person)],
            every[~repeated].sort_index()[list(columns)],
            label=self.label,
            simulated=self.simulated,
            asked=asked,
            crossed=self.crossed,
        )
        more = []
        if repeated.any():
            more = [
                "the paper's tests compare two rounds a person: they take the first with each "
                "instructor; `rounds` of each outcome has the mixed model over all rounds"
            ]
            known = every[every["participant"].isin(people.index)]
            study = replace(study, every_round=known[["round", *columns]].reset_index(drop=True))
        return study.noted(
            *self.notes, *more, *_unfinished(self.frame("participants")), *_cut_short(every)
        )

    def of_missions(self, name: str) -> pd.DataFrame:
        """The rows of the frame called `name`, which has a participant and a round, that belong to
        missions with a result."""
        frame, rounds = self.frame(name), self.frame("rounds")
        keys = ["participant", "round"]
        with_result = pd.MultiIndex.from_frame(rounds.loc[rounds["victims"].notna(), keys])
        inside = pd.MultiIndex.from_frame(frame[keys]).isin(with_result)
        return frame[inside].reset_index(drop=True)


def recorded(
    frames: Mapping[str, pd.DataFrame],
    label: str,
    notes: Iterable[str] = (),
    forms: Forms | None = None,
    crossed: Crossed = PAPER_DESIGN,
) -> Recorded:
    """A study of these frames.

    Raises SourceError for no session at all, a participant who is there twice, or real and
    simulated sessions together.
    """
    people = frames["participants"]
    if people.empty:
        raise SourceError(f"{label}: there are no sessions in it")
    twice = people.loc[people["participant"].duplicated(), "participant"]
    if len(twice):
        raise SourceError(f"{label}: participant {twice.iloc[0]} is there twice; keep one session")
    kinds = set(people["simulated"])
    if len(kinds) > 1:
        raise SourceError(f"{label}: it holds real and simulated sessions; they are analysed apart")
    forms = forms or paper_forms()
    told = (*notes, *crossed.notes(forms), *_versions(people))
    return Recorded(frames, label, kinds == {True}, told, forms, crossed)


def typed(name: str, table: Sequence[Sequence[str]], forms: Forms | None = None) -> pd.DataFrame:
    """A frame of text cells with each column's own type; an empty cell is missing.

    `forms` are those of the study, the paper's if not said. Raises ValueError for a cell that its
    column cannot hold.
    """
    described = columns(row_types(forms or paper_forms())[name])
    text = pd.DataFrame(table, columns=[column.name for column in described], dtype=object)
    return pd.DataFrame({column.name: _converted(text, column) for column in described})


def _converted(text: pd.DataFrame, column: TableColumn) -> "pd.Series":
    values = text[column.name]
    if column.values == "true, false":
        truths = values.map({"true": True, "false": False})
        return truths if column.optional else truths.astype(bool)
    if column.values in ("whole number", "number"):
        numbers = pd.to_numeric(values.where(values != "", None))
        whole = column.values == "whole number" and not column.optional
        return numbers.astype("int64" if whole else "float64")
    return values.where(values != "", None) if column.optional else values


def _versions(people: pd.DataFrame) -> list[str]:
    notes = []
    for column, what in (("game_version", "versions of ana"), ("study_sha256", "study.toml files")):
        found = people[column].dropna().unique()
        if len(found) > 1:
            notes.append(f"the sessions were played under {len(found)} different {what}")
    torn = people.loc[people["torn_bytes"] > 0, "participant"]
    if len(torn):
        notes.append(f"an unfinished line was left out of the journal of {', '.join(torn)}")
    return notes


def _unfinished(people: pd.DataFrame) -> list[str]:
    begun = people["complexity"].notna() & (people["session_ending"] != "finished")
    names = people.loc[begun, "participant"]
    return [f"randomised and not finished: {', '.join(names)}"] if len(names) else []


def _cut_short(rounds: pd.DataFrame) -> list[str]:
    """Missions without a result because they are not over, and those that count as they stand."""
    told = {
        "unfinished": "missions that are not over, and so have no result yet",
        "interrupted": "missions that were cut off and count as they stand",
    }
    notes = []
    for ending, words in told.items():
        found = rounds[rounds["mission_ending"] == ending].sort_values(["participant", "round"])
        keys = ["participant", "round", "mission_exposure_ms"]
        names = [
            f"{who} (round {number}, {int(ms / MS_PER_SECOND)} s played)"
            for who, number, ms in found[keys].itertuples(index=False)
        ]
        if names:
            notes.append(f"{words}: {', '.join(names)}")
    return notes

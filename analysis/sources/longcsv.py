"""Reads one table of a study, long (a row a participant and instructor) or wide (a row a
participant), and a table of quiz scores.

Cells are read as text and converted here, so that a complaint can name file, line and column, and
so that only the listed marks, never a participant's name, count as missing.
"""

from dataclasses import replace
from pathlib import Path

import pandas as pd

from analysis.sources.absent import SourceError
from analysis.sources.described import read_described
from analysis.sources.factors import ADAPTIVITY, LIKERT_ITEMS, MENTAL_STATES, ORDERS
from analysis.sources.frames import StudyData, make_study
from analysis.sources.texttable import TextTable, is_missing, read_table

MEASURED = ("victims", *MENTAL_STATES, *LIKERT_ITEMS)
NEEDED = ("participant", "complexity", "adaptivity", *MEASURED)
#: Columns that a source may have besides: (name, is a number). One value a participant.
PERSON_EXTRAS = (
    ("order", False),
    ("memorise_minutes", True),
    ("disobeyed", True),
    ("other_victim", True),
    ("preferred_instructor", False),
)
ROUND_EXTRAS = ("building",)
NUMBERS = (*MEASURED, *(name for name, is_number in PERSON_EXTRAS if is_number))
TRUE_WORDS = frozenset({"true", "yes", "1"})
FALSE_WORDS = frozenset({"false", "no", "0"})
PREFERRED = ("static", "adaptive", "neither")


def read_described_table(path: Path, columns: Path) -> StudyData:
    """Read a table of another study, long as ours, of which a TOML file says what is what.

    Raises SourceError naming file, line, column and a hint.
    """
    described = read_described(columns)
    table = described.translated(read_table(path, described.participant))
    rounds = table.cells[["participant", "adaptivity"]].copy()
    for column, measure in described.measured.items():
        rounds[column] = values = table.numbers(column, tuple(described.measured))
        least, most = measure.range
        for line, value in values[(values < least) | (values > most)].items():
            raise SourceError(
                f"{table.at(line)}: {column} is {value:g}; it must be from {least} to {most}"
            )
    if described.average:
        rounds = rounds.groupby(["participant", "adaptivity"], as_index=False).mean()
    for name, items in described.composites.items():
        rounds[name] = rounds[list(items)].sum(axis=1, skipna=False)
    absent = [name for name in (*MEASURED, "preference") if name not in rounds.columns]
    study = make_study(
        _one_row_a_person(table),
        rounds.assign(**dict.fromkeys(absent, float("nan"))),
        label=path.name,
        asked=described.asked,
        crossed=described.crossed,
        checked=True,
    )
    return replace(study, missions=False).noted(*table.notes)


def read_long_csv(path: Path, quiz: Path | None = None) -> StudyData:
    """Read a table of a study, and the quiz scores if given, into tidy tables.

    The `knowledge` column may be left out where `quiz` is given: groups are then formed from the
    scores. Raises SourceError naming file, line, column and a hint.
    """
    table = _long(read_table(path))
    table.needs(NEEDED)
    text = table.cells
    if "knowledge" not in text.columns and quiz is None:
        raise SourceError(
            f"{path.name}: no column 'knowledge', and no quiz scores to form the groups from; "
            "add the column, or give the scores with --quiz"
        )
    rounds = text[["participant", "adaptivity"]].copy()
    for column in MEASURED:
        rounds[column] = table.numbers(column, NUMBERS)
    for column in ROUND_EXTRAS:
        if column in text.columns:
            rounds[column] = text[column].where(~text[column].map(is_missing))
    participants = _one_row_a_person(table)
    notes = [*table.notes, *_unused(text)]
    if quiz is not None:
        scores, more = _read_quiz(quiz)
        participants = participants.join(scores)
        notes += [*more, *_unmatched(participants, scores)]
    study = make_study(participants, rounds, label=path.name, simulated=_simulated(table))
    return study.noted(*notes)


def _long(table: TextTable) -> TextTable:
    """A wide table (`engagement_static`, `engagement_adaptive`, ...) as a long one.

    Raises SourceError where a measured column is there for one round alone.
    """
    text = table.cells
    in_rounds = {
        column: [f"{column}_{name}" for name in ADAPTIVITY] for column in (*MEASURED, *ROUND_EXTRAS)
    }
    there = {
        column: [name in text.columns for name in names] for column, names in in_rounds.items()
    }
    if "adaptivity" in text.columns or not any(map(any, there.values())):
        return table
    lone = [
        name
        for column, names in in_rounds.items()
        for name, found in zip(names, there[column], strict=True)
        if not found and (any(there[column]) or column in MEASURED)
    ]
    if lone:
        raise SourceError(
            f"{table.name}: a row a participant, but no column {', '.join(map(repr, lone))}; each "
            "measure needs one for either round"
        )
    repeated = text.index[text["participant"].duplicated()]
    if len(repeated):
        raise SourceError(
            f"{table.at(repeated[0])}: participant {text.loc[repeated[0], 'participant']} has a "
            "row already; keep one"
        )
    wide = [name for column, names in in_rounds.items() if all(there[column]) for name in names]
    parts = []
    for at, adaptivity in enumerate(ADAPTIVITY):
        part = text.drop(columns=wide).assign(adaptivity=adaptivity)
        for column, names in in_rounds.items():
            if all(there[column]):
                part[column] = text[names[at]]
        parts.append(part)
    return replace(table, cells=pd.concat(parts))


def _one_row_a_person(table: TextTable) -> pd.DataFrame:
    text = table.cells
    columns = ["complexity"]
    if "knowledge" in text.columns:
        columns.append("knowledge")
    columns += [name for name, _ in PERSON_EXTRAS if name in text.columns]
    for column in columns:
        differing = text.groupby("participant")[column].nunique()
        torn = differing.index[differing > 1]
        if len(torn):
            lines = text.index[text["participant"] == torn[0]]
            raise SourceError(
                f"{table.at(*lines)}: {column} of participant {torn[0]} differs between rows; "
                "it is one value a participant"
            )
    converted = text[["participant", *columns]].copy()
    for column in columns:
        if dict(PERSON_EXTRAS).get(column, False):
            converted[column] = table.numbers(column, NUMBERS)
        else:
            converted[column] = text[column].astype(object).where(~text[column].map(is_missing))
    _check_words(table, converted, "order", ORDERS)
    _check_words(table, converted, "preferred_instructor", PREFERRED)
    return converted.drop_duplicates("participant").set_index("participant")


def _check_words(
    table: TextTable, converted: pd.DataFrame, column: str, words: tuple[str, ...]
) -> None:
    if column not in converted.columns:
        return
    for line, value in converted[column].dropna().items():
        if value not in words:
            raise SourceError(
                f"{table.at(line)}: {column} is {value!r}; "
                f"it must be one of {', '.join(words)}, or empty"
            )


def _simulated(table: TextTable) -> bool:
    text = table.cells
    if "simulated" not in text.columns:
        return False
    kinds = set(text["simulated"].str.lower())
    if kinds <= TRUE_WORDS:
        return True
    if kinds <= FALSE_WORDS:
        return False
    raise SourceError(
        f"{table.name}: column 'simulated' has {', '.join(sorted(map(repr, kinds)))}; real and "
        "simulated sessions are analysed apart: split the file"
    )


def _read_quiz(path: Path) -> tuple[pd.DataFrame, tuple[str, ...]]:
    """The scores by participant, and what to note about their file."""
    table = read_table(path)
    table.needs(("participant", "quiz_static"))
    text = table.cells
    repeated = text.index[text["participant"].duplicated()]
    if len(repeated):
        raise SourceError(
            f"{table.at(repeated[0])}: participant {text.loc[repeated[0], 'participant']} has a "
            "row already; keep one"
        )
    scores = table.numbers("quiz_static", ("quiz_static",))
    negative = scores.index[scores < 0]
    if len(negative):
        raise SourceError(f"{table.at(negative[0])}: a score cannot be below 0")
    frame = pd.DataFrame({"quiz_static": scores.to_numpy()}, index=text["participant"])
    return frame, tuple(f"{path.name}: {note}" for note in table.notes)


def _unused(text: pd.DataFrame) -> list[str]:
    known = {*NEEDED, "knowledge", "simulated", *ROUND_EXTRAS, *dict(PERSON_EXTRAS)}
    unused = [column for column in text.columns if column not in known]
    return [f"columns not used: {', '.join(unused)}"] if unused else []


def _unmatched(participants: pd.DataFrame, scores: pd.DataFrame) -> list[str]:
    unscored = participants.index[participants["quiz_static"].isna()]
    unknown = scores.index.difference(participants.index)
    return [
        f"{words} {', '.join(map(str, names))}"
        for words, names in (
            ("no quiz score for", unscored),
            ("quiz scores of nobody in the study:", unknown),
        )
        if len(names)
    ]

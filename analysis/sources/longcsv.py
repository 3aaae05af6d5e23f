"""Reads one long CSV (a row a participant and instructor) and a CSV of quiz scores.

Cells are read as text and converted here, so that a complaint can name file, line and column, and
so that only the listed marks, never a participant's name, count as missing.
"""

import math
from pathlib import Path

import pandas as pd

from analysis.sources.absent import SourceError
from analysis.sources.factors import LIKERT_ITEMS, MENTAL_STATES, ORDERS
from analysis.sources.frames import StudyData, make_study

MISSING = frozenset({"", "na", "nan", "n/a", "null", "none", "."})
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
TRUE_WORDS = frozenset({"true", "yes", "1"})
FALSE_WORDS = frozenset({"false", "no", "0"})
PREFERRED = ("static", "adaptive", "neither")


def read_long_csv(path: Path, quiz: Path | None = None) -> StudyData:
    """Read a long CSV, and the quiz scores if given, into tidy tables.

    The `knowledge` column may be left out where `quiz` is given: groups are then formed from the
    scores. Raises SourceError naming file, line, column and a hint.
    """
    text = _read_text_table(path, NEEDED)
    if "knowledge" not in text.columns and quiz is None:
        raise SourceError(
            f"{path.name}: no column 'knowledge', and no quiz scores to form the groups from; "
            "add the column, or give the scores with --quiz"
        )
    rounds = text[["participant", "adaptivity"]].copy()
    for column in MEASURED:
        rounds[column] = _numbers(text, column, path)
    for column in ROUND_EXTRAS:
        if column in text.columns:
            rounds[column] = text[column].where(~text[column].map(_is_missing))
    participants = _one_row_a_person(text, path)
    notes = _unused(text)
    if quiz is not None:
        scores = _read_quiz(quiz)
        participants = participants.join(scores)
        notes += _unmatched(participants, scores)
    study = make_study(participants, rounds, label=path.name, simulated=_simulated(text, path))
    return study.noted(*notes)


def _read_text_table(path: Path, needed: tuple[str, ...]) -> pd.DataFrame:
    """All cells as stripped text; index: the line in the file."""
    try:
        table = pd.read_csv(
            path, dtype=str, keep_default_na=False, encoding="utf-8-sig", skip_blank_lines=False
        )
    except FileNotFoundError as error:
        raise SourceError(f"{path}: there is no such file") from error
    except (pd.errors.EmptyDataError, pd.errors.ParserError, UnicodeDecodeError) as error:
        raise SourceError(f"{path.name}: this is not a CSV table: {error}") from error
    table.columns = table.columns.str.strip()
    for column in table.columns:
        table[column] = table[column].fillna("").str.strip()
    table.index = pd.RangeIndex(2, 2 + len(table))
    table = table[(table != "").any(axis=1)]
    missing = [column for column in needed if column not in table.columns]
    if missing:
        raise SourceError(
            f"{path.name}: line 1: no column {', '.join(map(repr, missing))}; "
            f"the header must have {', '.join(needed)}"
        )
    if table.empty:
        raise SourceError(f"{path.name}: a header and no rows; nothing can be analysed")
    nameless = table.index[table["participant"] == ""]
    if len(nameless):
        raise SourceError(f"{path.name}: line {nameless[0]}: the participant is not named")
    return table


def _is_missing(cell: str) -> bool:
    return cell.lower() in MISSING


def _numbers(text: pd.DataFrame, column: str, path: Path) -> pd.Series:
    def number(line: object, cell: str) -> float:
        if _is_missing(cell):
            return math.nan
        try:
            value = float(cell)
        except ValueError:
            value = math.inf
        if not math.isfinite(value):
            raise SourceError(
                f"{path.name}: line {line}: {column} is {cell!r}; it must be a number, or empty "
                "where no answer was given"
            )
        return value

    cells = [number(line, cell) for line, cell in text[column].items()]
    return pd.Series(cells, index=text.index, dtype=float)


def _one_row_a_person(text: pd.DataFrame, path: Path) -> pd.DataFrame:
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
                f"{path.name}: lines {', '.join(map(str, lines))}: {column} of participant "
                f"{torn[0]} differs between rows; it is one value a participant"
            )
    converted = text[["participant", *columns]].copy()
    for column in columns:
        if dict(PERSON_EXTRAS).get(column, False):
            converted[column] = _numbers(text, column, path)
        else:
            converted[column] = text[column].astype(object).where(~text[column].map(_is_missing))
    _check_words(converted, "order", ORDERS, path)
    _check_words(converted, "preferred_instructor", PREFERRED, path)
    return converted.drop_duplicates("participant").set_index("participant")


def _check_words(table: pd.DataFrame, column: str, words: tuple[str, ...], path: Path) -> None:
    if column not in table.columns:
        return
    for line, value in table[column].dropna().items():
        if value not in words:
            raise SourceError(
                f"{path.name}: line {line}: {column} is {value!r}; "
                f"it must be one of {', '.join(words)}, or empty"
            )


def _simulated(text: pd.DataFrame, path: Path) -> bool:
    if "simulated" not in text.columns:
        return False
    kinds = set(text["simulated"].str.lower())
    if kinds <= TRUE_WORDS:
        return True
    if kinds <= FALSE_WORDS:
        return False
    raise SourceError(
        f"{path.name}: column 'simulated' has {', '.join(sorted(map(repr, kinds)))}; real and "
        "simulated sessions are analysed apart: split the file"
    )


def _read_quiz(path: Path) -> pd.DataFrame:
    text = _read_text_table(path, ("participant", "quiz_static"))
    repeated = text.index[text["participant"].duplicated()]
    if len(repeated):
        raise SourceError(
            f"{path.name}: line {repeated[0]}: participant "
            f"{text.loc[repeated[0], 'participant']} has a row already; keep one"
        )
    scores = _numbers(text, "quiz_static", path)
    negative = scores.index[scores < 0]
    if len(negative):
        raise SourceError(f"{path.name}: line {negative[0]}: a score cannot be below 0")
    return pd.DataFrame({"quiz_static": scores.to_numpy()}, index=text["participant"])


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

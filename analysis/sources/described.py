"""What a small TOML file says of a table whose columns are not named as here: where the factors
stand and what their levels are called, which outcomes there are, and their ranges.

```toml
participant = "id"
average = true        # several rows for a person and round are averaged

[knowledge]
column = "treatment"
words = { LOW = "control", MED = "A", HIGH = "B" }

[outcomes]
aggression = { column = "value", range = [0, 20] }

[items]
l1 = { range = [1, 7] }
l2 = { range = [1, 7] }

[composites]
liking = ["l1", "l2"]  # their sum
```
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pandas as pd

from analysis.sources.absent import SourceError
from analysis.sources.designs import Crossed
from analysis.sources.factors import ADAPTIVITY, COMPLEXITY, KNOWLEDGE
from analysis.sources.texttable import KEY, TextTable
from game.tables.asked import Outcomes
from game.toml_words import in_plain_words, parted

_HINT = "docs/analyst.md, section “One table”, shows such a file"


class Factor(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The column of a factor, and what each level is called in it; its own name if not said."""

    column: str
    words: dict[str, str] = {}


class Measure(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The least and the greatest answer of a column, which has the measure's name if not said."""

    range: tuple[int, int]
    column: str = ""


class Described(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the file says. `outcomes` are analysed as they are, `items` as the sums that
    `composites` make of them."""

    outcomes: dict[str, Measure] = {}
    items: dict[str, Measure] = {}
    composites: dict[str, tuple[str, ...]] = {}
    participant: str = KEY
    knowledge: Factor = Factor("knowledge")
    complexity: Factor = Factor("complexity")
    adaptivity: Factor = Factor("adaptivity")
    average: bool = False

    @property
    def measured(self) -> Mapping[str, Measure]:
        """Every column of answers."""
        return {**self.outcomes, **self.items}

    @property
    def asked(self) -> Outcomes:
        """The outcomes, as the statistics take them."""
        ranges = {name: measure.range for name, measure in self.measured.items()}
        return Outcomes(tuple(self.outcomes), self.composites, ranges)

    @property
    def crossed(self) -> Crossed:
        """The design: the levels that are named, and what the two rounds are called."""
        first, second = (self.adaptivity.words.get(name, name) for name in ADAPTIVITY)
        levels = tuple(name for name in COMPLEXITY if name in self.complexity.words)
        return Crossed((first, second), levels or COMPLEXITY)

    def translated(self, table: TextTable) -> TextTable:
        """The table under the names of this program. Rows with a level that is not named are left
        out, and a note counts them.

        Raises SourceError where a column is not there.
        """
        named = dict(self._columns())
        table.needs(tuple(named.values()))
        cells = pd.DataFrame({ours: table.cells[theirs] for ours, theirs in named.items()})
        notes = list(table.notes)
        for factor, levels in _FACTORS.items():
            words: dict[str, str] = getattr(self, factor).words
            if not words or factor not in cells:
                continue
            ours = {theirs: level for level, theirs in words.items()}
            known = cells[factor].isin(list(ours))
            if not known.all():
                others = ", ".join(dict.fromkeys(cells.loc[~known, factor]))
                notes.append(f"rows of another {factor} are not used ({others}): {sum(~known)}")
            cells = cells[known].assign(**{factor: cells.loc[known, factor].map(ours)})
            assert set(cells[factor]) <= set(levels)
        return replace(table, cells=cells, notes=tuple(notes))

    def _columns(self) -> Iterator[tuple[str, str]]:
        yield KEY, self.participant
        for factor in _FACTORS:
            yield factor, getattr(self, factor).column
        for name, measure in self.measured.items():
            yield name, measure.column or name


_FACTORS = {"knowledge": KNOWLEDGE, "complexity": COMPLEXITY, "adaptivity": ADAPTIVITY}


def read_described(path: Path) -> Described:
    """What a TOML file says of a table. Raises SourceError, with the place, for a file that cannot
    be used."""
    try:
        described = msgspec.toml.decode(path.read_bytes(), type=Described)
    except OSError as error:
        raise SourceError(f"the file cannot be read ({error.strerror})", place=str(path)) from error
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        message, where = parted(str(error))
        told = f"{where.removeprefix('$.')}: " if where else ""
        raise SourceError(
            f"{told}{in_plain_words(message)}", place=str(path), hint=_HINT
        ) from error
    for found in _wrong(described):
        raise SourceError(found, place=str(path), hint=_HINT)
    return described


def _wrong(described: Described) -> Iterator[str]:
    yield from _wrong_factors(described)
    yield from _wrong_measures(described)


def _wrong_factors(described: Described) -> Iterator[str]:
    for factor, levels in _FACTORS.items():
        words: Any = getattr(described, factor).words
        for level in words:
            if level not in levels:
                yield f"{factor}.words: there is no {level}; the levels are {', '.join(levels)}"
        if len(set(words.values())) < len(words):
            yield f"{factor}.words: two levels have the same word"
    if described.adaptivity.words and set(described.adaptivity.words) != set(ADAPTIVITY):
        yield f"adaptivity.words: it must name both {' and '.join(ADAPTIVITY)}"


def _wrong_measures(described: Described) -> Iterator[str]:
    if not described.outcomes and not described.composites:
        yield "it names no outcome"
    for name, measure in described.measured.items():
        least, most = measure.range
        if least >= most:
            yield f"{name}: its range must rise, as [1, 7]"
    for name, items in described.composites.items():
        for item in items:
            if item not in described.items:
                yield f"composites.{name}: there is no item {item}"
    for name in described.outcomes:
        if name in described.composites or name in described.items:
            yield f"{name} is there twice"

"""A table of another study, of which a TOML file says what is what."""

import json
from pathlib import Path

import pandas as pd
import pytest
from click.testing import CliRunner

from analysis.command import command
from analysis.sources.absent import SourceError
from analysis.sources.described import read_described
from analysis.sources.longcsv import read_described_table
from tests.analysis.stats.test_reference import differences

REFERENCE = Path(__file__).resolve().parents[2] / "reference"
TABLE = REFERENCE / "obrien_kaiser.csv"
TOML = REFERENCE / "obrien_kaiser.toml"


def test_the_command_gives_rs_numbers_of_a_published_study(tmp_path: Path) -> None:
    out = tmp_path / "out.json"
    arguments = [str(TABLE), "--columns", str(TOML), "--json", str(out)]
    run = CliRunner().invoke(command, arguments, standalone_mode=False)
    assert run.return_value == 0, run.output
    numbers = json.loads(out.read_text(encoding="utf-8"))
    assert list(numbers["outcomes"]) == ["score"]
    ours = numbers["outcomes"]["score"]
    expected = json.loads((REFERENCE / "obrien_kaiser.json").read_text(encoding="utf-8"))["post"]
    for part, theirs in expected.items():
        assert differences(ours[part], theirs, f".{part}.") == []
    assert "rows of another adaptivity are not used (fup): 80" in numbers["notes"]
    inputs = {row["name"] for row in numbers["provenance"]["inputs"]}
    assert {TABLE.name, TOML.name} <= inputs


def test_composites_are_sums_of_items_in_their_own_ranges(tmp_path: Path) -> None:
    table = tmp_path / "liking.csv"
    rows = [
        {"who": name, "knowledge": "LOW", "complexity": "C1", "adaptivity": round_, "a": a, "b": 7}
        for name in ("P1", "P2")
        for round_, a in (("static", 1), ("adaptive", 7))
    ]
    pd.DataFrame(rows).to_csv(table, index=False, sep=";")
    toml = tmp_path / "liking.toml"
    toml.write_text(
        'participant = "who"\nitems = { a = { range = [1, 7] }, b = { range = [1, 7] } }\n'
        'composites = { liking = ["a", "b"] }\n'
    )
    study = read_described_table(table, toml)
    assert study.outcomes == ("liking",)
    assert study.rounds["liking"].tolist() == [8, 14, 8, 14]
    toml.write_text(toml.read_text().replace("a = { range = [1, 7] }", "a = { range = [1, 5] }"))
    with pytest.raises(SourceError, match=r"liking.csv: line 3: a is 7; it must be from 1 to 5"):
        read_described_table(table, toml)


@pytest.mark.parametrize(
    ("written", "told"),
    [
        ("", "it names no outcome"),
        ("outcomes = { y = { range = [7, 1] } }", "y: its range must rise"),
        ("outcomes = { y = { rnge = [1, 7] } }", "there is no key `rnge`"),
        ("outcomes = { y = 7 }", "outcomes"),
        ('composites = { y = ["a"] }', "composites.y: there is no item a"),
        ("outcomes = {", "TOML|Expected|Invalid|inline"),
        (
            'knowledge = { column = "k", words = { SOME = "s" } }',
            "there is no SOME; the levels are",
        ),
        ('complexity = { column = "k", words = { C1 = "s", C2 = "s" } }', "the same word"),
        (
            'adaptivity = { column = "k", words = { static = "s" } }',
            "name both static and adaptive",
        ),
    ],
)
def test_what_is_wrong_in_the_file_is_told(tmp_path: Path, written: str, told: str) -> None:
    path = tmp_path / "columns.toml"
    path.write_text(written)
    with pytest.raises(SourceError, match=told) as error:
        read_described(path)
    assert str(path) in str(error.value)


def test_a_column_that_is_not_there_is_named(tmp_path: Path) -> None:
    path = tmp_path / "columns.toml"
    path.write_text(TOML.read_text().replace('"treatment"', '"treatmnt"'))
    with pytest.raises(SourceError, match=r"no column 'treatmnt'.*treatment"):
        read_described_table(TABLE, path)

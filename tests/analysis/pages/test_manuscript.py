"""The results section: the paper's numbers beside ours, tables, files and provenance."""

import io
import json
import re
import zipfile
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from analysis.battery import analyse_source, run_battery
from analysis.command import command
from analysis.pages import manuscript as pages
from analysis.pages import style
from analysis.pages.apa_table import ApaTable, marked, unmarked
from analysis.pages.manuscript import Found, Section, manuscript, tables_of
from analysis.pages.manuscript.contrasts import turned
from analysis.pages.manuscript.measures import measures
from analysis.pages.manuscript.primary import primary as primary_part
from analysis.pages.other_programs import wide_csv
from analysis.pages.published import PUBLISHED
from analysis.pages.sentences import gain_sentence, level_sentence
from analysis.pages.style import FORMATS
from analysis.sources.designs import Primary
from analysis.sources.frames import StudyData
from analysis.sources.provenance import provenance
from analysis.stats.cellmodel import CELLS
from game.tables.asked import Outcomes
from game.tables.designs import Correction
from game.tables.exclusions import read_rules
from tests.analysis.pages.drawn import faults

ReadTable = Callable[..., StudyData]
MakeTable = Callable[..., pd.DataFrame]


def sections_of(study: StudyData, alpha: float = 0.05) -> list[Section]:
    result = run_battery(study, read_rules(), alpha)
    numbers = json.loads(result.to_json())
    return manuscript(Found(numbers, result.study, study, None, PUBLISHED))


@pytest.fixture(scope="module")
def sections(make_table: MakeTable, tmp_path_factory: pytest.TempPathFactory) -> list[Section]:
    from analysis.sources.longcsv import read_long_csv

    path = tmp_path_factory.mktemp("study") / "long.csv"
    make_table(dict.fromkeys(CELLS, 9)).to_csv(path, index=False)
    return sections_of(read_long_csv(path))


def table_called(sections: list[Section], name: str) -> ApaTable:
    return next(one.table for one in tables_of(sections) if one.table.name == name)


def test_every_printed_number_stands_beside_ours(sections: list[Section]) -> None:
    fig7 = table_called(sections, "fig7_printed")
    assert [row[-1] for row in fig7.rows] == [
        ".019", ".028", ".045", ".039", ".014", "< .001", ".003", ".001", ".011", "–", "–",
    ]  # fmt: skip
    anovas = table_called(sections, "anova_printed")
    columns = [unmarked(column) for column in anovas.columns]
    printed = [[row[columns.index(name)] for row in anovas.rows]
               for name in ("Λ paper", "F paper", "p paper", "η² paper")]  # fmt: skip
    assert printed == [
        ["1.00", "0.992", "1.00", "0.836"],
        ["0.009", "0.771", "0.012", "4.461"],
        [".923", ".382", ".912", ".002"],
        ["–", "–", "–", "0.164"],
    ]
    people = {row[0]: row[2] for row in table_called(sections, "participants").rows}
    assert people["Participants randomised"] == "108"
    assert people["Adaptive instructor first, analysed"] == "48"
    assert people["Static instructor first, analysed"] == "52"
    assert table_called(sections, "alpha").rows[0][-1] == ".855"
    gains = [row for row in table_called(sections, "fig9").rows if row[-1] != "–"]
    assert [(row[0], *row[-2:]) for row in gains] == [("HIGH C1 over LOW C1", "26.44", ".021")]


@pytest.mark.parametrize("people", [1, 5])
def test_few_people_leave_no_empty_table_and_no_sentence_twice(
    people: int, read_table: ReadTable, make_table: MakeTable
) -> None:
    table = make_table(dict.fromkeys(CELLS, 8)).drop(columns="disobeyed")
    few = sections_of(read_table(table.groupby("participant").head(2).head(2 * people)))
    assert all(numbered.table.rows for numbered in tables_of(few))
    told = [sentence for section in few for sentence in section.sentences]
    assert sum("is empty" in sentence for sentence in told) <= 2
    left_out = [lost for section in few for lost in section.left_out]
    for lost in left_out:
        assert sum(lost.title in sentence for sentence in told) == 1
    assert len({lost.name for lost in left_out}) == len(left_out) > 0
    drawn = {figure.name for section in few for figure in section.figures}
    assert ("adaptivity_estimates" in drawn) == (people > 1)


def test_alpha_of_one_person_is_a_dash_with_its_reason(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    study = read_table(make_table(dict.fromkeys(CELLS, 8)).head(2))
    numbers = json.loads(run_battery(study, read_rules()).to_json())
    assert numbers["alpha"]["all"]["listwise"] is None
    reasons = {at: row["reason"] for row in numbers["absent"] for at in row["paths"]}
    assert reasons["alpha.all.listwise"] == "fewer than two people answered"
    rows = table_called(sections_of(study), "alpha").rows
    assert [row[2:4] for row in rows] == [("–", "–")] * 3


def test_the_papers_contrast_is_worded_as_in_the_paper(sections: list[Section]) -> None:
    told = [text for section in sections for text in section.sentences if "26.44" in text]
    assert len(told) == 1
    row = {**ROW, "df": 80, "p_none": 0.01, "p_holm": 0.03}
    words = gain_sentence("engagement", "HIGH C1", "LOW C1", row, 0.05)
    assert words.startswith("(HIGH-knowledge, C1) participants experienced a change")
    assert "(LOW-knowledge, C1) participants, by 2.00 points" in words


@pytest.mark.parametrize("p_holm", [0.049, 0.05, 0.6, None])
def test_a_difference_is_asserted_only_if_it_is_significant(p_holm: float | None) -> None:
    row = {**ROW, "df": 80, "p_none": 0.01, "p_holm": p_holm}
    level = level_sentence("engagement", "LOW", "C1", "C3", row, 0.05)
    gain = gain_sentence("engagement", "HIGH C1", "LOW C1", row, 0.05)
    significant = p_holm is not None and p_holm < 0.05
    assert ("reported higher engagement" in level) == significant
    assert ("was greater than that of" in gain) == significant
    for words in (level, gain):
        assert ("did not differ significantly" in words) == (not significant)


@pytest.mark.parametrize(
    ("correction", "times"), [("none", 1), ("bonferroni", 2), ("holm", 2), ("sidak", 2)]
)
def test_the_primary_outcomes_are_reported_with_the_correction_that_the_settings_name(
    read_table: ReadTable, make_table: MakeTable, correction: Correction, times: int
) -> None:
    study = read_table(make_table(dict.fromkeys(CELLS, 4)))
    primary = Primary(("engagement", "victims"), correction)
    result = run_battery(
        replace(study, crossed=replace(study.crossed, primary=primary)), read_rules()
    )
    effects: Any = result.results["primary"]
    family = effects["effects"]["adaptivity"]
    least = min(family.values(), key=lambda row: row["p"])
    expected = 1 - (1 - least["p"]) ** 2 if correction == "sidak" else times * least["p"]
    assert least["p_corrected"] == pytest.approx(min(1, expected))
    numbers = json.loads(result.to_json())
    part = primary_part(Found(numbers, result.study, study, None, PUBLISHED))
    assert "engagement and victims" in part.sentences[0]
    (table,) = part.tables
    assert {row[0] for row in table.rows} == {"engagement", "victims"}


def test_a_source_without_settings_says_that_it_states_no_primary_outcomes(
    sections: list[Section],
) -> None:
    (section,) = (one for one in sections if one.title == "Primary outcomes")
    assert section.sentences == ("The source states no primary outcomes.",)


def test_the_people_without_a_group_are_counted(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    study = read_table(make_table(dict.fromkeys(CELLS, 4)).drop(columns="disobeyed"))
    groups = study.participants["knowledge"].drop("P001")
    told = [text for one in sections_of(study.with_groups(groups)) for text in one.sentences]
    n = len(study.participants)
    assert any(f"{n - 1} of them with a knowledge group" in text for text in told)


def test_without_groups_nothing_says_that_groups_are_stated(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    study = read_table(make_table(dict.fromkeys(CELLS, 2))).without_groups()
    result = run_battery(study, read_rules())
    numbers = json.loads(result.to_json())
    part = measures(Found(numbers, result.study, study, None, PUBLISHED))
    assert part.sentences[0].startswith("There are no knowledge groups")
    assert "knowledge groups: none" in result.table()


def test_sentences_have_the_form_of_the_manual(sections: list[Section]) -> None:
    told = [text for section in sections for text in section.sentences]
    assert sum("*F*(" in text for text in told) >= 4 + 7
    assert not any(re.search(r"= 0\.000|p\* = 0|nan|None", text) for text in told)
    for text in told:
        assert (text.count("*") % 2 == 0 and text[0].isupper()) or text[0] == "("


def test_no_table_has_an_unformed_number(sections: list[Section]) -> None:
    for one in tables_of(sections):
        for row in one.table.rows:
            assert len(row) == len(one.table.columns)
            assert not {"nan", "None", "0.000", ".000"} & set(row), (one.name, row)
            assert all(row), (one.name, row)


ROW = {"estimate": 2.0, "t.ratio": 1.5, "lower.CL": -1.0, "upper.CL": 5.0, "d": 0.4,
       "d.lower": -0.2, "d.upper": 1.0, "SE": 1.3}  # fmt: skip


def test_a_comparison_turned_twice_is_itself() -> None:
    once = turned(ROW)
    assert (once["lower.CL"], once["upper.CL"], once["d"]) == (-5.0, 1.0, -0.4)
    assert turned(once) == ROW
    assert turned({**ROW, "estimate": None})["estimate"] is None


def empty_cell(table: pd.DataFrame) -> pd.DataFrame:
    return table[~((table["knowledge"] == "HIGH") & (table["complexity"] == "C1"))]


def four_people(table: pd.DataFrame) -> pd.DataFrame:
    return table[table["participant"].isin(["P001", "P011", "P020", "P040"])]


def no_extras(table: pd.DataFrame) -> pd.DataFrame:
    return table.drop(columns=["order", "building", "preferred_instructor", "disobeyed"])


def no_answers(table: pd.DataFrame) -> pd.DataFrame:
    return table.assign(engagement=np.nan, pref1=np.nan)


@pytest.mark.parametrize("damage", [empty_cell, four_people, no_extras, no_answers])
def test_what_cannot_be_had_is_a_dash_or_said(
    read_table: ReadTable, make_table: MakeTable, damage: Callable[[pd.DataFrame], pd.DataFrame]
) -> None:
    sections = sections_of(read_table(damage(make_table())))
    test_no_table_has_an_unformed_number(sections)
    told = " ".join(text for section in sections for text in section.sentences)
    assert "None" not in told and "nan" not in told


def test_another_alpha_is_the_level_of_everything(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    study = read_table(make_table(dict.fromkeys(CELLS, 9)))
    text = json.dumps(
        [[s.sentences, [t.csv() for t in s.tables]] for s in sections_of(study, 0.01)]
    )
    assert "99% CI" in text and "98% CI" in text
    assert "95% CI" not in text and "90% CI" not in text


# --- files

TABLE = ApaTable(
    "odd", "Who & what", ("Outcome", "*p* & more", "95% CI"),
    (("a_b", "< .001", "[−1.00, 2.00]"), ("<b>", "–", "50% {x}")), "*p* is η² > 0.",
).numbered(3)  # fmt: skip


def test_csv_and_html_keep_every_cell() -> None:
    back = pd.read_csv(io.StringIO(TABLE.csv()), keep_default_na=False)
    assert back.to_numpy().tolist() == [list(row) for row in TABLE.table.rows]
    assert list(back.columns) == ["Outcome", "p & more", "95% CI"]
    html = TABLE.html()
    assert "&lt;b&gt;" in html and "<i>p</i> &amp; more" in html and "Table 3" in html


def test_latex_is_escaped_and_balanced() -> None:
    text = TABLE.latex()
    assert r"a\_b & $<$ .001 & [$-$1.00, 2.00] \\" in text
    assert r"\textit{p} \& more" in text and r"50\% \{x\}" in text
    for name in ("table", "threeparttable", "tabular", "tablenotes"):
        assert text.count(f"\\begin{{{name}}}") == text.count(f"\\end{{{name}}}") == 1
    assert text.isascii()


def test_a_document_holds_the_table_with_three_rules_and_no_date() -> None:
    content = TABLE.docx()
    assert content == TABLE.docx()
    with zipfile.ZipFile(io.BytesIO(content)) as parts:
        assert {info.date_time for info in parts.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        tree = ElementTree.fromstring(parts.read("word/document.xml"))
    w = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"
    cells = ["".join(t.text or "" for t in cell.iter(f"{w}t")) for cell in tree.iter(f"{w}tc")]
    assert cells == ["Outcome", "p & more", "95% CI", *(c for row in TABLE.table.rows for c in row)]
    assert len(list(tree.iter(f"{w}tcBorders"))) == 6


@given(st.text(st.characters(codec="ascii", exclude_characters="*\n\r"), max_size=30))
def test_unmarked_text_is_itself(text: str) -> None:
    assert unmarked(text) == text
    assert [italic for _, italic in marked(f"*F*{text}")][:1] == [True]


def tree_of(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_file()}  # fmt: skip


@pytest.mark.parametrize(
    "parts",
    [pages.PRINTED[3:4], pytest.param(pages.PARTS, marks=pytest.mark.slow)],
    ids=["one part", "all"],
)
def test_the_same_input_gives_the_same_bytes_but_for_the_date(
    make_table: MakeTable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, parts: pages.Parts
) -> None:
    monkeypatch.setattr(pages, "manuscript", partial(manuscript, parts=parts))
    monkeypatch.setattr(style, "FORMATS", {"svg": FORMATS["svg"]})  # the others: test_figures
    source = tmp_path / "long.csv"
    make_table().assign(simulated="yes").to_csv(source, index=False)
    trees = []
    for at, date in enumerate(("1700000000", "1800000000")):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", date)
        analyse_source(source, report=tmp_path / str(at))
        trees.append(tree_of(tmp_path / str(at)))
    assert {name for name in trees[0] if trees[0][name] != trees[1][name]} == {
        "results.html",
        "provenance.json",
    }
    for name in ("results.html", "provenance.json"):
        dates = [re.findall(r"20\d\d-\d\d-\d\dT[\d:+]+", tree[name].decode()) for tree in trees]
        assert [len(found) for found in dates] == [1, 1]
        one, other = (tree[name].decode() for tree in trees)
        assert one.replace(dates[0][0], dates[1][0]) == other
    kinds = {Path(name).suffix for name in trees[0]}
    assert kinds == {
        f".{kind}" for kind in ("html", "json", "csv", "tex", "docx", "svg", "txt", "R")
    }
    page = trees[0]["results.html"].decode()
    assert "SIMULATED PEOPLE" in page and "2023-11-14" in page
    assert "http" not in re.sub(r"data:image/svg\+xml;base64,[\w+/=]+", "", page)


def test_provenance_names_every_input_and_setting(make_table: MakeTable, tmp_path: Path) -> None:
    source = tmp_path / "long.csv"
    make_table().to_csv(source, index=False)
    first: Any = analyse_source(source, alpha=0.01).results["provenance"]
    assert {one["name"] for one in first["inputs"]} == {"long.csv", "exclusions.toml"}
    assert first["settings"]["alpha"] == 0.01 and first["libraries"]["numpy"]
    assert set(first) == {"ana", "commit", "date", "inputs_sha256", "inputs", "settings", "seeds",
                          "libraries"}  # fmt: skip
    source.write_text(source.read_text(encoding="utf-8") + "\n", encoding="utf-8")
    again = provenance(source, None, None, {}, {})
    assert again.sha256 != first["inputs_sha256"]


def test_the_command_asks_for_something_to_write(make_table: MakeTable, tmp_path: Path) -> None:
    source = tmp_path / "long.csv"
    make_table().to_csv(source, index=False)
    run = CliRunner().invoke(command, [str(source)])
    assert run.exit_code == 2 and "--report DIR" in run.output


def test_a_study_that_asks_other_questions_has_its_own_outcomes(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    study = read_table(make_table(dict.fromkeys(CELLS, 9)).drop(columns="disobeyed"))
    asked = Outcomes(("calm",), {}, {"calm": (1, 7)})
    calm = study.rounds["engagement"] % 7 + 1
    rounds = study.rounds.assign(calm=calm).drop(columns=["engagement", "preference"])
    other = replace(study, rounds=rounds, asked=asked)
    sections = sections_of(other)
    test_no_table_has_an_unformed_number(sections)
    assert {row[0] for row in table_called(sections, "anova_all").rows} == {"victims", "calm"}
    drawn = [figure for at in (3, 5) for figure in sections[at].figures]
    assert [figure.name for figure in drawn] == ["fig7_mental_states", "fig9_calm", "cells_calm"]
    assert [fault for figure in drawn for fault in faults(figure)] == []
    assert "calm_static" in wide_csv(other).splitlines()[0]
    none = replace(other, asked=Outcomes((), {}, {}))
    assert table_called(sections_of(none), "anova_all").rows[0][0] == "victims"

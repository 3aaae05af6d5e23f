"""Every figure on easy and hard data: all that is drawn is seen, and colours differ to each eye."""

from collections.abc import Callable
from itertools import combinations, islice
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from analysis.pages.behaviour import conclusion_table as conclusions
from analysis.pages.behaviour import separation_figure, shares_figure, verdict_figure
from analysis.pages.coach_inside import (
    calibration_figure,
    evaluations,
    posterior_figure,
    what_if_figure,
)
from analysis.pages.coaches import (
    comparison_figure,
    level_shares_figure,
    read_comparison,
    reliability_figure,
    switches_figure,
    switching_figure,
)
from analysis.pages.figures import (
    adaptivity_estimates,
    fig7_mental_states,
    fig8_performance,
    figures_of,
    side_by_side,
)
from analysis.pages.flow import flow_figure, flow_rows
from analysis.pages.knowledge import knowledge_figure
from analysis.pages.notebook import Opened, open_source
from analysis.pages.power_figure import power_figure, power_points
from analysis.pages.preference import preferred_figure, statements_figure
from analysis.pages.preset_studies import BY, read_missions
from analysis.pages.style import (
    BLUE,
    FORMATS,
    GROUP_COLOURS,
    LEVEL_COLOURS,
    ORANGE,
    VERMILION,
    save_figures,
)
from analysis.pages.traces import all_traces, fig10_traces
from analysis.pages.what_if import judged_missions
from analysis.sources.factors import COMPLEXITY, MENTAL_STATES
from analysis.sources.frames import StudyData, paired
from analysis.stats.adaptivity import overall
from analysis.stats.anova import mixed_anova
from analysis.stats.cellmodel import CELLS
from analysis.stats.preferred import preferred_rows
from tests.analysis.pages.drawn import faults, legend_labels
from tests.analysis.simulated import SHIPPED

ReadTable = Callable[..., StudyData]
MakeTable = Callable[..., pd.DataFrame]


def plain(table: pd.DataFrame) -> pd.DataFrame:
    return table


def static_much_higher(table: pd.DataFrame) -> pd.DataFrame:
    static = table["adaptivity"] == "static"
    return table.assign(victims=table["victims"].where(~static, table["victims"] + 40))


def four_people(table: pd.DataFrame) -> pd.DataFrame:
    people = table.drop_duplicates("participant")
    some = people[people["complexity"] != "C3"]["participant"].iloc[[0, 9, 20, 40]]
    return table[table["participant"].isin(some)].reset_index(drop=True)


def answers_missing(table: pd.DataFrame) -> pd.DataFrame:
    table = table.astype(dict.fromkeys(MENTAL_STATES, float))
    gone = np.random.default_rng(3).random((len(table), len(MENTAL_STATES))) < 0.2
    table[list(MENTAL_STATES)] = table[list(MENTAL_STATES)].mask(gone)
    return table


def at_the_ends(table: pd.DataFrame) -> pd.DataFrame:
    ends = np.random.default_rng(4).choice([1, 100], len(table))
    return table.assign(engagement=ends, victims=np.where(ends > 1, 20, 0))


def all_differ(table: pd.DataFrame) -> pd.DataFrame:
    low, c3 = table["knowledge"] == "LOW", table["complexity"] == "C3"
    middle = (table["knowledge"] == "MED") | (table["complexity"] == "C2")
    noise = np.random.default_rng(5).integers(-1, 2, len(table))
    up = np.where(low & c3, 90, np.where(middle, 50, 10)) + noise
    return table.assign(**dict.fromkeys(MENTAL_STATES, up.astype(int)))


@pytest.mark.parametrize(
    "change",
    [plain, static_much_higher, four_people, answers_missing, at_the_ends, all_differ],
    ids=lambda change: change.__name__,
)
def test_everything_drawn_is_seen(
    read_table: ReadTable, make_table: MakeTable, change: Callable[[pd.DataFrame], pd.DataFrame]
) -> None:
    study = read_table(change(make_table(dict.fromkeys(CELLS, 8)).drop(columns="disobeyed")))
    assert [fault for drawn in islice(figures_of(study), 5) for fault in faults(drawn)] == []


def test_what_lies_outside_is_noticed(study: StudyData) -> None:
    drawn = fig8_performance(study)
    drawn.figure.axes[0].set_ylim(10, 11)
    assert faults(drawn)


@pytest.fixture(scope="module")
def opened() -> Opened:
    return open_source(str(SHIPPED))


@pytest.mark.long
def test_every_figure_of_the_notebooks_is_whole(opened: Opened) -> None:
    missions, table = read_missions(opened.folder), evaluations(opened.recorded, opened.study)
    compared = read_comparison(SHIPPED / "coaches.json")
    drawn = [
        fig7_mental_states(opened.study),
        flow_figure(flow_rows(opened.recorded, opened.rules), simulated=True),
        knowledge_figure(opened.study, opened.clustering),
        fig10_traces(opened.recorded, opened.study),
        all_traces(opened.recorded, opened.study),
        statements_figure(opened.study),
        preferred_figure(preferred_rows(opened.study), simulated=True),
        posterior_figure(table, simulated=True),
        calibration_figure(table, simulated=True),
        what_if_figure(judged_missions(opened.recorded, opened.study)[:8], simulated=True),
        verdict_figure(conclusions(missions, BY), simulated=True),
        shares_figure(missions, BY, simulated=True),
        separation_figure(missions, BY, simulated=True),
        power_figure(power_points([0.1], (1, 1, 1), samples=50)),
        comparison_figure(compared),
        level_shares_figure(compared, "default", ("ana", "knowledge")),
        switches_figure(compared, "default"),
        switching_figure(read_comparison(SHIPPED / "switching.json"), "default"),
        reliability_figure(compared),
    ]
    assert [fault for one in drawn for fault in faults(one)] == []
    for one in drawn:
        assert not any(one.caption[20:60] in text.get_text() for text in one.figure.texts)
    levels = {"shares", "all_traces", "fig7_mental_states", "coach_what_if", "coaches-levels"}
    for one in drawn:
        if one.name.removeprefix("behaviour_") in levels:
            assert legend_labels(one.figure) >= set(COMPLEXITY), one.name


def test_no_two_coaches_look_alike() -> None:
    compared = read_comparison(SHIPPED / "coaches.json")
    (legend,) = switches_figure(compared, "default").figure.legends
    looks = {(str(line.get_marker()), str(line.get_color())) for line in legend.get_lines()}
    assert len(looks) == len(legend.get_texts()) == len({cell.coach for cell in compared.cells})


def test_a_legend_names_every_level_even_with_nobody_at_it(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    table = four_people(make_table(dict.fromkeys(CELLS, 8)).drop(columns="disobeyed"))
    assert set(table["complexity"]) < set(COMPLEXITY)
    figure = fig7_mental_states(read_table(table)).figure
    assert legend_labels(figure) == set(COMPLEXITY)


def test_one_person_has_no_error_bar(read_table: ReadTable, make_table: MakeTable) -> None:
    table = four_people(make_table(dict.fromkeys(CELLS, 8)).drop(columns="disobeyed"))
    for drawn in islice(figures_of(read_table(table)), 3):
        bars = [bar for axes in drawn.figure.axes for bar in axes.containers]
        ones = [axes.get_xticklabels() for axes in drawn.figure.axes]
        assert ones and bars
        if drawn.name != "fig8_performance":
            assert not any(getattr(bar, "has_yerr", False) for bar in bars), drawn.name


def test_the_means_of_fig_7_are_of_the_people_of_its_brackets(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    study = read_table(answers_missing(make_table(dict.fromkeys(CELLS, 8))))
    for axes, state in zip(fig7_mental_states(study).figure.axes, MENTAL_STATES, strict=True):
        pair = paired(study, state)
        means = sorted(float(bar[0].get_ydata()[0]) for bar in axes.containers)
        expected = [pair.static[pair.cell == cell].mean() for cell in np.unique(pair.cell)]
        assert means == pytest.approx(sorted(expected))
        labels = " ".join(tick.get_text() for tick in axes.get_xticklabels())
        counts = np.bincount(pair.cell, minlength=9).reshape(3, 3)
        assert all(f"n = {', '.join(map(str, row))}" in labels for row in counts)


@given(st.lists(st.integers(0, 100), min_size=1, max_size=60))
def test_points_lean_to_no_side(answers: list[int]) -> None:
    values = np.array(answers, dtype=float)
    offsets = side_by_side(values, 0.2)
    assert np.abs(offsets).max() <= 0.2
    assert offsets.sum() == pytest.approx(0, abs=1e-9)
    width = max(np.ptp(values) / 20, 1e-9)
    rows = np.round((values - values.min()) / width)
    for row in np.unique(rows):
        assert offsets[rows == row].sum() == pytest.approx(0, abs=1e-9)


def test_the_estimates_have_the_margin_of_the_anovas_test(study: StudyData) -> None:
    for outcome in (*MENTAL_STATES, "victims"):
        estimate = overall(study, outcome)
        effect = next(e for e in mixed_anova(paired(study, outcome)) if e.effect == "adaptivity")
        assert estimate.equal_cells
        assert (estimate.difference / estimate.se) ** 2 == pytest.approx(effect.test.F)
        low, high = estimate.interval(0.95)
        assert (low > 0 or high < 0) == (effect.test.p < 0.05)


def test_an_empty_cell_leaves_an_estimate_over_people_that_says_so(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    table = four_people(make_table(dict.fromkeys(CELLS, 8)).drop(columns="disobeyed"))
    labels = [
        tick.get_text()
        for tick in adaptivity_estimates(read_table(table)).figure.axes[0].get_yticklabels()
    ]
    assert all("people equal" in label for label in labels)


def test_three_kinds_of_file_without_captions(study: StudyData, tmp_path: Path) -> None:
    drawn = [fig8_performance(study)]
    paths = save_figures(drawn, tmp_path)
    assert [path.suffix[1:] for path in paths] == list(FORMATS)
    first = [path.read_bytes() for path in paths]
    words = drawn[0].caption.split(":")[0]
    assert words in (tmp_path / "captions.txt").read_text(encoding="utf-8")
    assert words not in paths[0].read_text(encoding="utf-8")
    assert [
        path.read_bytes() for path in save_figures([fig8_performance(study)], tmp_path)
    ] == first


# --- colours

#: Full dichromacy in linear RGB (Machado, Oliveira & Fernandes, 2009, severity 1.0).
VISION = {
    "normal": np.eye(3),
    "protanopia": np.array([
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998]]),
    "deuteranopia": np.array([
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881]]),
    "tritanopia": np.array([
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900]]),
}  # fmt: skip
XYZ = np.array([
    [0.4124564, 0.3575761, 0.1804375],
    [0.2126729, 0.7151522, 0.0721750],
    [0.0193339, 0.1191920, 0.9503041]])  # fmt: skip


def lab(colour: str, vision: str = "normal") -> NDArray[np.float64]:
    """CIE L*a*b* (D65) of a colour as an eye of this kind sees it."""
    rgb = np.array(to_rgb(colour))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    seen = np.clip(VISION[vision] @ linear, 0, 1)
    xyz = XYZ @ seen / (XYZ @ np.ones(3))
    f = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


ORDERED = {"levels": LEVEL_COLOURS, "groups": GROUP_COLOURS}


@pytest.mark.parametrize("name", ORDERED)
def test_ordered_colours_keep_their_order_in_grey(name: str) -> None:
    lightness = [lab(colour)[0] for colour in ORDERED[name].values()]
    steps = np.diff(lightness)
    assert (np.sign(steps) == np.sign(steps[0])).all()
    assert np.abs(steps).min() > 18
    assert max(lightness) < 80  # seen on white


@pytest.mark.parametrize("vision", VISION)
@pytest.mark.parametrize("name", ORDERED)
def test_ordered_colours_differ_for_every_eye(name: str, vision: str) -> None:
    for one, other in combinations(ORDERED[name].values(), 2):
        assert np.linalg.norm(lab(one, vision) - lab(other, vision)) > 20


@pytest.mark.parametrize("vision", VISION)
@pytest.mark.parametrize("pair", [(ORANGE, BLUE), (BLUE, VERMILION)])
def test_pairs_of_colours_differ_for_every_eye(pair: tuple[str, str], vision: str) -> None:
    assert np.linalg.norm(lab(pair[0], vision) - lab(pair[1], vision)) > 20

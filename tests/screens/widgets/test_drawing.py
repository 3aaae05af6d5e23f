"""The bar, the small maps, the panel and the charts, as rows."""

from __future__ import annotations

from dataclasses import replace
from textwrap import wrap

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from rich.cells import cell_len
from textual.app import App, ComposeResult

from game.coach.acts import PosteriorEvaluated
from game.screens.play.coachpanel import gauge
from game.screens.widgets.canvas import Row, difference, padded, plain, sliced, width, wrapped
from game.screens.widgets.charts import ChartStep, area_chart, step_chart
from game.screens.widgets.instruction_bar import (
    FLASH_S,
    LINES,
    InstructionBar,
    announces,
    bar_rows,
    sentences_in_rows,
)
from game.screens.widgets.minimap import HALF_BLOCKS, QUARTER_BLOCKS, Scale, SmallMap
from game.screens.widgets.statuspanel import clock_text, next_change_ms, status_rows
from game.world import load_building
from game.world.building import Building
from game.world.events import Action
from game.world.mission import Mission
from game.world.observation import Guidance
from game.world.plan import Tile
from game.world.settings import MissionSettings

HARBOUR = load_building("harbour")
words = st.lists(st.text("abcdefgh.", min_size=1, max_size=12), min_size=1, max_size=60)
rows = st.lists(st.tuples(st.text("xyz室", max_size=6), st.sampled_from("abc")), max_size=8).map(
    tuple
)


RIGHT_HALF = "right half"


def cells(row: Row) -> list[tuple[str, str]]:
    """What stands in each column, and its style."""
    return [
        (half, style)
        for text, style in row
        for letter in text
        for half in ((letter, RIGHT_HALF) if letter == "室" else (letter,))
    ]


@given(words, words.map(lambda w: w[:6]), st.integers(60, 200), st.booleans())
def test_the_bar_is_always_whole(
    text: list[str], notice: list[str], columns: int, fresh: bool
) -> None:
    guidance = Guidance(" ".join(text), " ".join(notice))
    drawn = bar_rows(guidance, columns, fresh=fresh)
    told = " ".join(line[:columns] for line in plain(drawn)).replace("▌", " ").split()
    assert told == [*notice, *text]
    assert len(drawn) >= LINES


@given(words, st.integers(60, 200))
def test_the_bar_breaks_between_sentences_where_that_takes_no_more_rows(
    text: list[str], columns: int
) -> None:
    sentences = [f"{word.capitalize()} {word}." for word in text]
    rows, plainly = (
        sentences_in_rows(" ".join(sentences), columns),
        wrap(" ".join(sentences), columns),
    )
    assert " ".join(rows) == " ".join(plainly)
    assert len(rows) == len(plainly)
    whole = [row for row in rows if row.endswith(".")]
    assert len(whole) >= len([row for row in plainly if row.endswith(".")])


def test_a_sentence_begins_on_a_row_of_its_own() -> None:
    told = "Turn around. Walk forward 12 steps. Turn left. Walk forward 7 steps. Turn right."
    assert sentences_in_rows(told, 60) == [
        "Turn around. Walk forward 12 steps. Turn left.",
        "Walk forward 7 steps. Turn right.",
    ]
    assert wrap(told, 60)[0].endswith("Walk forward")


@given(
    st.lists(st.text("左右へ進む2", min_size=2, max_size=12), min_size=1, max_size=5),
    st.integers(30, 90),
)
def test_sentences_without_blanks_between_keep_every_character(
    text: list[str], columns: int
) -> None:
    told = "".join(f"{sentence}。" for sentence in text)
    rows = sentences_in_rows(told, columns)
    assert "".join(rows) == told
    assert len(rows) <= len(wrapped(told, columns))
    assert all(cell_len(row) <= columns for row in rows)


def test_a_sentence_of_wide_characters_begins_on_a_row_of_its_own() -> None:
    assert sentences_in_rows(
        "左を向いてください。5歩前へ進んでください。右を向いてください。", 44
    ) == [
        "左を向いてください。5歩前へ進んでください。",
        "右を向いてください。",
    ]


def test_german_keeps_its_blanks() -> None:
    told = "Gehen Sie durch die vierte Tür rechts. Gehen Sie durch die fünfte Tür links."
    assert " ".join(sentences_in_rows(told, 76)) == told


def test_two_lines_at_80_columns_leave_the_bar_its_height() -> None:
    guidance = Guidance("word " * 22 + "end", "You have passed the door.")
    assert len(bar_rows(guidance, 80)) == LINES


@given(words.map(lambda w: w[:10]), st.integers(80, 200))
def test_the_words_stay_where_they_are_when_the_notice_goes(text: list[str], columns: int) -> None:
    told = " ".join(text)
    with_notice = bar_rows(Guidance(told, "That is the wrong way."), columns)
    without = bar_rows(Guidance(told), columns)
    assert len(with_notice) == len(without) == LINES
    assert with_notice[1:] == without[1:] and plain(without)[0].isspace()


@given(st.tuples(*[st.sampled_from(["", "one", "two"])] * 2).map(lambda two: Guidance(*two)))
def test_only_what_was_not_said_before_is_announced(guidance: Guidance) -> None:
    before = Guidance("one", "two")
    news = {guidance.text, guidance.notice} - {"", before.text, before.notice}
    swapped = guidance.text == before.notice or guidance.notice == before.text
    assert announces(guidance, before) is bool(news or swapped)
    assert not announces(Guidance(before.text), before)


class BarAlone(App[None]):
    def compose(self) -> ComposeResult:
        yield InstructionBar()


async def test_a_notice_that_goes_does_not_make_the_bar_new() -> None:
    app = BarAlone()
    async with app.run_test() as pilot:
        bar = app.query_one(InstructionBar)

        def edge() -> str:
            return plain(bar.rows)[1][0]

        bar.show(Guidance("Turn left.", "That is the wrong way."))
        assert edge() == "▌"
        bar._fresh_until = 0.0
        bar.show(Guidance("Turn left."))
        assert edge() == " " and "wrong" not in "".join(plain(bar.rows))
        bar.show(Guidance("Turn left.", "Stop."))
        assert edge() == "▌"
        await pilot.pause(FLASH_S)
        bar.show(Guidance("Turn left."))
        assert edge() == " "


def test_a_notice_is_styled_apart() -> None:
    drawn = bar_rows(Guidance("Turn left.", "That is the wrong way."), 80)
    styles = {text.strip(): style for row in drawn for text, style in row if text.strip()}
    assert styles == {"That is the wrong way.": "notice", "Turn left.": "text"}


@given(rows, rows, st.integers(0, 40))
def test_what_lies_outside_the_difference_is_the_same(old: Row, new: Row, columns: int) -> None:
    assume(old != new)
    start, end = difference(old, new, columns)

    before, after = cells(padded(old, columns)), cells(padded(new, columns))
    assert before[:start] == after[:start]
    assert before[max(start, end) :] == after[max(start, end) :]


@given(rows, st.integers(0, 30), st.integers(0, 30))
def test_a_slice_is_a_slice_of_the_columns(row: Row, start: int, length: int) -> None:
    wanted = cells(row)[start : start + length]
    if wanted and wanted[0][0] == RIGHT_HALF:
        wanted[0] = " ", wanted[0][1]
    if wanted and wanted[-1][0] == "室":
        wanted[-1] = " ", wanted[-1][1]
    assert cells(sliced(row, start, start + length)) == wanted


@given(rows, st.integers(1, 40))
def test_a_padded_row_has_its_columns(row: Row, columns: int) -> None:
    assert width(padded(row, columns)) == columns


@given(st.text("abc ", max_size=60) | st.text("室長 ", max_size=60), st.integers(4, 30))
def test_no_line_of_a_wrapped_text_is_too_wide(text: str, columns: int) -> None:
    lines = wrapped(text, columns)
    assert all(width(((line, ""),)) <= columns for line in lines)
    assert "".join(lines).replace(" ", "") == text.replace(" ", "")


@settings(max_examples=10)
@given(st.lists(st.integers(0, 94 * 51), max_size=6))
def test_a_small_map_drawn_again_is_as_if_drawn_anew(steps: list[int]) -> None:
    plan = HARBOUR.plan
    for scale in (HALF_BLOCKS, QUARTER_BLOCKS):
        kept, explored = SmallMap(plan, scale), 0
        for step in steps:
            explored |= 0b11111 << step
            pins = {plan.cell(step): ("●", "here/here")}
            drawn = kept.rows(explored, pins)
            assert drawn == SmallMap(plan, scale).rows(explored, pins)


def test_half_blocks_show_every_wall_and_leave_doors_open() -> None:
    plan = HARBOUR.plan
    lines = plain(SmallMap(plan, HALF_BLOCKS).rows(0, {}))
    assert (len(lines), len(lines[0])) == (plan.height // 2, plan.width)
    walls = {"█": (True, True), "▀": (True, False), "▄": (False, True)}
    for y, line in enumerate(lines):
        for x, character in enumerate(line):
            seen = walls.get(character, (False, False))
            assert seen == tuple(plan.tile((x, 2 * y + i)) is Tile.WALL for i in (0, 1))


@pytest.mark.parametrize("scale", [HALF_BLOCKS, QUARTER_BLOCKS])
def test_signs_stand_for_all_doors_and_for_nothing_else(scale: Scale) -> None:
    plan = HARBOUR.plan
    drawn = SmallMap(plan, scale, signs=True)
    everything = (1 << len(plan.tiles)) - 1
    doors = [cell for cell in plan.cells(everything) if plan.tile(cell) is Tile.DOOR]
    wanted = {(x // scale.across, y // scale.down) for x, y in doors}
    for explored, style in ((0, "map-door"), (everything, "known-door")):
        found = {
            (x, y): ink
            for y, row in enumerate(drawn.rows(explored, {}))
            for x, (sign, ink) in enumerate(cells(row))
            if sign == "+"
        }
        assert found == dict.fromkeys(wanted, f"{style}/{style}")


def test_the_small_map_tells_explored_from_unexplored() -> None:
    for scale in (HALF_BLOCKS, QUARTER_BLOCKS):
        small = SmallMap(HARBOUR.plan, scale)
        styles = {style for row in small.rows(0, {}) for _, style in row}
        everything = (1 << len(HARBOUR.plan.tiles)) - 1
        assert styles.isdisjoint({s for row in small.rows(everything, {}) for _, s in row})


def test_the_clock_counts_begun_seconds() -> None:
    assert [clock_text(ms) for ms in (240_000, 239_001, 239_000, 1, 0)] == [
        "4:00", "4:00", "3:59", "0:01", "0:00",
    ]  # fmt: skip


@given(st.integers(0, 9_999), st.integers(10, 60))
def test_nothing_on_the_panel_changes_before_it_says_so(at_ms: int, columns: int) -> None:
    building = load_building("practice")
    rules = MissionSettings(duration_ms=60_000, red_expiry_ms=30_000)
    mission = Mission(building, rules)
    mission.step(None, at_ms)
    observation = mission.observation()
    due = next_change_ms(observation, columns)
    assert due > at_ms
    before = status_rows(observation, rules, columns)
    mission.step(None, due - 1)
    after = status_rows(mission.observation(), rules, columns)
    assert [row for i, row in enumerate(before) if i != 1] == [
        row for i, row in enumerate(after) if i != 1
    ]


def test_a_hidden_score_is_not_drawn(ward: Building) -> None:
    for show, drawn in ((True, True), (False, False)):
        rules = MissionSettings(show_score=show)
        observation = Mission(ward, rules).observation()
        text = "\n".join(plain(status_rows(observation, rules, 26)))
        assert ("points" in text) is drawn


def test_where_time_is_no_matter_there_is_no_clock(ward: Building) -> None:
    rules = MissionSettings()
    observation = Mission(ward, rules).observation()
    timed, untimed = (
        plain(status_rows(observation, rules, 26, timed=timed)) for timed in (True, False)
    )
    assert not any(":" in line or "━" in line for line in untimed)
    assert {line for line in untimed if line} < set(timed)


def test_the_last_seconds_and_a_victim_in_reach_stand_out(ward: Building) -> None:
    rules = MissionSettings()
    mission = Mission(ward, rules)
    mission.step(None, 209_000)
    assert all(style != "hurry" for _, style in status_rows(mission.observation(), rules, 26)[0])
    mission.step(None, 211_000)
    assert any(style == "hurry" for _, style in status_rows(mission.observation(), rules, 26)[0])


def test_beside_a_victim_the_panel_says_what_to_do(ward: Building) -> None:
    alone, rules = ward.victims[1], MissionSettings()
    (x, y), lines = alone.cell, {}
    for dx, dy in ((0, 0), (-1, 0), (-1, -1), (-2, 0), (-2, 1)):
        mission = Mission(replace(ward, start=(x + dx, y + dy)), rules)
        assert any(victim.cell == alone.cell for victim in mission.observation().victims)
        lines[dx, dy] = plain(status_rows(mission.observation(), rules, 26))[5]
    assert lines[0, 0] == lines[-1, 0] == " Space  treats"
    assert lines[-1, -1] == lines[-2, 0] == "stand beside to treat" and not lines[-2, 1]
    assert len(lines[-2, 0]) <= 26


def test_who_is_rescued_needs_nobody_beside_them(ward: Building) -> None:
    (x, y), rules = ward.victims[1].cell, MissionSettings()
    mission = Mission(replace(ward, start=(x - 1, y)), rules)
    mission.step(Action.TRIAGE, 0)
    mission.step(Action.WEST, 10_000)
    assert mission.observation().rescued == 1
    assert not plain(status_rows(mission.observation(), rules, 26))[5]


def test_reds_have_no_more_time_than_the_mission(ward: Building) -> None:
    settings = MissionSettings(duration_ms=12_000, red_expiry_ms=30_000)
    seen = Mission(ward, settings).observation(None)
    assert "0:12 for reds" in "\n".join(plain(status_rows(seen, settings, 26)))


def test_treatment_progress_grows(ward: Building) -> None:
    victim = ward.victims[0]
    mission = Mission(Building(**{**vars(ward), "start": victim.cell}), MissionSettings())
    mission.step(Action.TRIAGE, 0)
    bars = []
    for at_ms in (0, 1_500, 2_900):
        mission.step(None, at_ms)
        bars.append(plain(status_rows(mission.observation(), MissionSettings(), 26))[5].count("█"))
    assert bars == sorted(set(bars)) and bars[0] == 0


def test_charts_reach_their_last_value() -> None:
    steps = [ChartStep(0, 0), ChartStep(60_000, 3), ChartStep(120_000, 6)]
    area = plain(area_chart("R", steps, 6, 240_000, 240_000, columns=60, rows=4))
    assert area[1].endswith("█") and "█" not in area[1][:28] and "4:00" in area[-1]
    levels = [ChartStep(0, 2), ChartStep(80_000, 1), ChartStep(160_000, 3)]
    labels = [(1, "C1"), (2, "C2"), (3, "C3")]
    lines = plain(step_chart("L", levels, labels, 240_000, 240_000, columns=60, rows=3))
    assert [line[:2] for line in lines[1:4]] == ["C3", "C2", "C1"]
    assert lines[1].endswith("━") and "┓" in lines[2] and "┏" in lines[1]


@given(st.integers(12, 120), st.integers(1, 12))
def test_times_under_a_chart_stand_apart(columns: int, minutes: int) -> None:
    lines = plain(
        area_chart("R", [ChartStep(0, 0)], 4, 0, minutes * 60_000, columns=columns, rows=3)
    )
    times = lines[-1].split()
    assert times[0] == "0:00" and all(len(time.split(":")[1]) == 2 for time in times)
    assert times == sorted(set(times), key=lambda time: int(time.split(":")[0]))


def test_charts_one_below_the_other_are_in_line() -> None:
    steps, labels = [ChartStep(0, 2)], [(1, "C1"), (2, "C2"), (3, "C3")]
    area = plain(area_chart("R", steps, 6, 9, 240_000, columns=60, rows=4))
    levels = plain(step_chart("L", steps, labels, 9, 240_000, columns=60, rows=3))
    assert area[-2].index("└") == levels[-2].index("└") and area[-1] == levels[-1]


def test_the_gauge_marks_both_thresholds() -> None:
    evaluation = PosteriorEvaluated(0, "v01", {}, 0.5, 3, 0.3, 0.8, "keep")
    bar = plain([gauge(evaluation, 20)])[0]
    assert [i for i, c in enumerate(bar) if c == "┃"] == [6, 16] and bar.count("█") == 9
    assert width(gauge(evaluation, 20)) == 20

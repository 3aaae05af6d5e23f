"""Designs other than the paper's: allocation, sessions, and what is said of them."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.cli import main
from game.coach.acts import Level
from game.coach.yoke import LevelFrom, Yoke
from game.journal.history import Step
from game.journal.records import Allocated, MissionStarted
from game.study.design import PAPER, Design, balances, design_cell
from game.study.donors import NOBODY, without_donor
from game.study.folder import Identity, Study, open_study
from game.study.instructors import Instructor, instructor_named
from game.study.lab.hindrances import Hindrances
from game.study.ledger import NoPlace
from game.study.power import power_of, smallest_effect
from game.study.study_settings import SettingsError
from tests.study.people import journal_of, small_study, take_part

designs = st.builds(
    Design,
    memorise=st.integers(1, 4),
    levels=st.sampled_from([(Level.C2,), (Level.C1, Level.C3), tuple(Level)]),
    buildings=st.integers(1, 3),
)


@given(designs, st.integers(0, 10_000), st.integers(0, 3))
def test_every_block_has_every_design_cell_once(design: Design, seed: int, block: int) -> None:
    slots = range(block * design.block, (block + 1) * design.block)
    cells = [design.cell(seed, "live", slot) for slot in slots]
    assert len(set(cells)) == design.block
    assert len({cell.code for cell in cells}) == design.block


@given(designs, st.integers(0, 10_000), st.integers(0, 5))
def test_every_part_is_balanced_by_itself(design: Design, seed: int, part: int) -> None:
    slots = range(part * design.part, (part + 1) * design.part)
    cells = [design.cell(seed, "live", slot) for slot in slots]
    combined = Counter((it.memorise, it.adaptive_first, it.static_level) for it in cells)
    assert set(combined.values()) == {1}
    assert len(combined) == design.part


@given(st.integers(0, 2**31), st.integers(0, 200))
def test_the_papers_design_is_the_default(seed: int, slot: int) -> None:
    assert PAPER.cell(seed, "live", slot) == design_cell(seed, "live", slot)
    assert (PAPER.part, PAPER.block) == (12, 24)


@given(designs, st.integers(0, 1000), st.integers(1, 60))
def test_the_counts_shown_are_those_of_the_allocation(
    design: Design, seed: int, places: int
) -> None:
    for balance in balances(design, seed, places):
        assert sum(balance.counts.values()) == places
        if places % design.block == 0:
            assert balance.even
        if places % design.part == 0 and balance.factor in ("memorise time", "order"):
            assert balance.even


@pytest.mark.parametrize(
    ("name", "instructor"),
    [
        ("static", Instructor("static")),
        ("static:3", Instructor("static", level=Level.C3)),
        ("ana:belief", Instructor("ana", preset="belief")),
        ("knowledge+quiz", Instructor("knowledge+quiz")),
        ("mine.py:Mine", Instructor("mine.py:Mine")),
    ],
)
def test_instructors_are_named_as_coaches_are(name: str, instructor: Instructor) -> None:
    assert instructor_named(name) == instructor


def test_the_names_of_what_may_be_had(tmp_path: Path) -> None:
    changes = {"static_levels": "[1, 3]", "memorise_seconds": "[4]", "places": "7"}
    study = with_settings(tmp_path / "study", **changes)
    assert study.settings.design == Design(1, (Level.C1, Level.C3), 2)
    assert study.settings.all_places == 7
    for number in range(7):
        study.ledger.allocate(f"P{number}", "live", design=study.settings.design, places=7)
    with pytest.raises(NoPlace, match="all 7 places"):
        study.ledger.allocate("P8", "live", design=study.settings.design, places=7)


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("instructors", '["static", "anna"]', "there is no anna. Did you mean ana"),
        ("instructors", '["static", "ana:beliefs"]', "Did you mean belief"),
        ("instructors", '["ana", "ana"]', "must differ"),
        ("instructors", '["static", "yoked"]', "repeats the levels of ana"),
        ("static_levels", "[3, 1]", "must rise"),
        ("static_levels", "[4]", "between 1 and 3"),
        ("memorise_seconds", "[]", "must not be empty"),
        ("rounds", "3", "3 rounds and 2 buildings"),
        ("rounds", "0", "between 1 and 6"),
        ("phases", '["rounds", "debrief"]', "phases must have consent"),
        ("phases", '["debrief", "consent", "rounds"]', "(rounds|consent) before (debrief|rounds)"),
        ("phases", '["consent", "consent", "rounds", "debrief"]', "consent twice"),
        ("phases", '["consent", "preference", "rounds", "debrief"]', "rounds before preference"),
        ("round_phases", '["memorise", "label"]', "must have mission"),
        ("round_phases", '["mission", "memorise"]', "memorise before mission"),
        ("round_phases", '["forms", "mission"]', "mission before forms"),
        ("phases", '["consent", "rounds", "practice", "debrief"]', "practice before rounds"),
        ("phases", '["rounds", "consent", "debrief"]', "consent before rounds"),
        ("places", "0", "places must be between"),
    ],
)
def test_what_cannot_be_is_refused_by_name(tmp_path: Path, key: str, value: str, told: str) -> None:
    with pytest.raises(SettingsError, match=told) as refused:
        with_settings(tmp_path / "study", **{key: value})
    assert "study.toml" in str(refused.value)


def test_phases_can_be_left_out_and_there_may_be_one_round(tmp_path: Path) -> None:
    study = with_settings(
        tmp_path / "study",
        rounds="1",
        phases='["consent", "rounds", "preference", "debrief"]',
        round_phases='["mission"]',
        instructors='["static:1", "knowledge"]',
    )
    assert [step.phase for step in study.course] == [
        "consent", "mission", "sliders", "likert", "debrief",
    ]  # fmt: skip
    assert take_part(study)[0] == "over"
    (allocated,) = records(study, Allocated)
    assert (allocated.memorise_ms, len(allocated.buildings)) == (0, 1)
    assert allocated.instructors == ("static:1", "knowledge")
    (mission,) = (it for it in records(study, MissionStarted))
    assert mission.coach.kind == ("knowledge" if allocated.adaptive_first else "static")


def test_instructors_and_buildings_take_turns_over_three_rounds(tmp_path: Path) -> None:
    study = with_settings(
        tmp_path / "study",
        rounds="3",
        buildings='["foundry", "harbour", "practice"]',
        phases='["consent", "rounds", "debrief"]',
    )
    assert take_part(study)[0] == "over"
    (allocated,) = records(study, Allocated)
    assert sorted(allocated.buildings) == ["foundry", "harbour", "practice"]
    kinds = [it.coach.kind for it in records(study, MissionStarted)]
    assert kinds[0] == kinds[2] != kinds[1]
    assert kinds[0] == ("ana" if allocated.adaptive_first else "static")
    assert study.course.count(Step("sliders", 3)) == 1


def test_a_yoked_instructor_repeats_somebody_elses_levels(tmp_path: Path) -> None:
    study = with_settings(
        tmp_path / "study",
        instructors='["ana", "yoked"]',
        phases='["consent", "rounds", "debrief"]',
    )
    assert study.settings.design.levels == (Level.C2,)
    take_part(study)
    first = next(it for it in records(study, MissionStarted) if it.coach.kind == "yoked")
    assert first.coach.yoke == Yoke(NOBODY, first.building_sha256, None, (LevelFrom(0, Level.C2),))
    for name in ("P02", "P03"):
        take_part(study, Identity("pilot", name))
    yokes = [
        entry.record.coach.yoke
        for entry in journal_of(study, Identity("pilot", "P03")).entries
        if isinstance(entry.record, MissionStarted) and entry.record.coach.kind == "yoked"
    ]
    (yoke,) = yokes
    assert yoke is not None
    assert yoke.session != NOBODY


def test_the_levels_of_somebody_who_memorised_as_long_come_first(tmp_path: Path) -> None:
    study = with_settings(
        tmp_path / "study",
        instructors='["ana", "yoked"]',
        phases='["consent", "rounds", "debrief"]',
    )
    ana = study.settings.yoked_to
    assert ana == Instructor("ana")
    (told,) = (it for it in Hindrances(study.folder).look(study.ledger.entries()) if "pilot" in it)
    assert "no pilot has finished a mission with ana in Foundry Court or Harbour House" in told
    lent: dict[str, set[int]] = {building.name: set() for building in study.buildings}
    for number in range(8):
        identity = Identity("pilot", f"T{number}")
        take_part(study, identity)
        for entry in journal_of(study, identity).entries:
            if isinstance(entry.record, Allocated):
                allocated = entry.record
            if isinstance(entry.record, MissionStarted) and entry.record.coach.kind == "ana":
                lent[entry.record.building].add(allocated.memorise_ms)
    assert set(map(len, lent.values())) == {2}
    assert not without_donor(study.folder, study.buildings, ana)
    assert "pilot" not in " ".join(Hindrances(study.folder).look(study.ledger.entries()))
    for building in study.buildings:
        for memorise_ms in (3_000, 5_000):
            for seen in range(5):
                yoke = study.yoke_for(Identity("live", f"P{seen}"), building, memorise_ms)
                assert yoke.memorise_ms == memorise_ms
        other = study.yoke_for(Identity("live", "P01"), building, 9_000)
        assert other.memorise_ms in (3_000, 5_000)
    assert yoke.session != NOBODY
    assert "P0" not in yoke.session


def test_the_command_says_what_labelling_after_the_mission_means(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = with_settings(tmp_path / "study", round_phases='["memorise", "mission", "label"]')
    assert main(["study", "design", str(study.folder)]) == 0
    assert "rooms are labelled after the mission" in capsys.readouterr().out


def test_the_command_shows_cells_counts_power_and_tests(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = with_settings(tmp_path / "study", static_levels="[1, 3]", places="20")
    assert main(["study", "design", str(study.folder)]) == 0
    told = capsys.readouterr().out
    for words in ("20 places, 16 design cells", "C1: 10, C3: 10", "static first: 11", "16 or 24",
                  "(static levels C1, C3)", "smallest effect", "engagement, victims"):  # fmt: skip
        assert words in told, told


def test_the_command_says_what_cells_are_called_and_when_people_are_too_few(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = with_settings(tmp_path / "study", memorise_seconds="[20]", places="12")
    assert main(["study", "design", str(study.folder)]) == 0
    told = capsys.readouterr().out
    first = study.settings.buildings[0]
    assert f"1: 20 s to memorise, SA: static first, AS: ana first, b0: {first} first" in told
    assert told.count("but too few people: 12 for 9 cells") == 3
    assert "paired\n" in told
    (study.folder / "study.toml").write_text(
        (study.folder / "study.toml").read_text().replace("places = 12", "places = 18")
    )
    assert main(["study", "design", str(study.folder)]) == 0
    assert "too few" not in capsys.readouterr().out


@given(st.floats(0.05, 2), st.integers(4, 500))
def test_power_rises_with_effect_and_people(d: float, n: int) -> None:
    assert power_of(d, n) <= power_of(d * 1.5, n) + 1e-12
    assert power_of(d, n) <= power_of(d, n + 10) + 1e-12
    assert power_of(smallest_effect(n), n) == pytest.approx(0.8, abs=1e-3)


def test_power_agrees_with_the_tables_for_a_paired_test() -> None:
    """Cohen (1988): d = 0.5 needs 34 people for a power of .80 by the t test, 32 by the normal."""
    assert power_of(0.5, 32) == pytest.approx(0.807, abs=0.005)


def with_settings(folder: Path, **changes: str) -> Study:
    """A small study with other settings at the top of study.toml."""
    small_study(folder)
    path = folder / "study.toml"
    lines = path.read_text().splitlines()
    kept = [line for line in lines if line.partition(" = ")[0] not in changes]
    path.write_text("\n".join([*(f"{k} = {v}" for k, v in changes.items()), *kept]) + "\n")
    return open_study(folder)


def records(study: Study, kind: type) -> list[Any]:
    return [it.record for it in journal_of(study).entries if isinstance(it.record, kind)]

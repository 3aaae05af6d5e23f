"""Study folders become tables: faithfully, in one mode, and never silently wrong."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.pages.flow import flow_rows
from analysis.pages.what_if import judged_missions, shares, stretches
from analysis.sources.absent import SourceError
from analysis.sources.designs import Crossed, Primary
from analysis.sources.frames import both_rounds
from analysis.sources.recorded import ANALYSED, Recorded
from analysis.sources.samples import left_by
from analysis.sources.source import load, load_recorded
from analysis.sources.study_folder import read_study_folder
from analysis.sources.tables_folder import DESIGN, read_tables, write_tables
from analysis.stats.groups import grouped
from game.errors import AnaError
from game.journal.journal_error import JournalError
from game.journal.records import SCHEMA_VERSION
from game.tables.exclusions import read_rules
from game.tables.rejudging import with_prior_mass
from tests.analysis.simulated import first_of_the_shipped

JOURNAL = "journal.jsonl"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("study") / "three"
    first_of_the_shipped(folder, 3)
    return folder


@pytest.fixture(scope="module")
def recorded(made: Path) -> Recorded:
    return read_study_folder(made)


@pytest.fixture
def copy(made: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(made, tmp_path / "copy"))


def journal(study: Path, participant: str = "S0001") -> Path:
    return study / "sessions" / "simulated" / participant / JOURNAL


def move_to(study: Path, mode: str, participant: str = "S0001") -> Path:
    """Make one simulated session look like a real one of another mode."""
    home = study / "sessions" / mode / participant
    home.parent.mkdir(exist_ok=True)
    journal(study, participant).parent.rename(home)
    first, rest = (home / JOURNAL).read_bytes().split(b"\n", 1)
    start = json.loads(first) | {"mode": mode, "simulated": False, "rescuer": "person"}
    (home / JOURNAL).write_bytes(json.dumps(start).encode() + b"\n" + rest)
    return home / JOURNAL


def test_everything_the_statistics_need_is_there(recorded: Recorded) -> None:
    study = recorded.study()
    assert study.simulated
    assert list(study.participants.index) == ["S0001", "S0002", "S0003"]
    assert len(study.rounds) == 6
    assert not study.rounds.drop(columns="building").isna().any(axis=None)
    assert study.participants[["complexity", "quiz_static", "order"]].notna().all(axis=None)


def test_written_tables_read_back_the_same(recorded: Recorded, tmp_path: Path) -> None:
    paths = write_tables(recorded, tmp_path / "one")
    again = read_tables(tmp_path / "one")
    for name in ANALYSED:
        pd.testing.assert_frame_equal(recorded.frame(name), again.frame(name))
    for path, other in zip(paths, write_tables(again, tmp_path / "two"), strict=True):
        assert path.read_bytes() == other.read_bytes()


def test_tables_carry_their_design(recorded: Recorded, tmp_path: Path) -> None:
    crossed = Crossed(("ana", "yoked"), ("C2",), 3, primary=Primary(("victims",), "holm"))
    write_tables(replace(recorded, crossed=crossed), tmp_path)
    again = read_tables(tmp_path)
    assert again.crossed == crossed
    assert set(crossed.notes(again.forms)) <= set(again.notes)
    (tmp_path / DESIGN).write_text('{"rounds": "three"}')
    with pytest.raises(SourceError, match=r"design\.json.*the design cannot be read"):
        read_tables(tmp_path)


def test_a_table_of_something_else_is_named(recorded: Recorded, tmp_path: Path) -> None:
    write_tables(recorded, tmp_path)
    (tmp_path / "levels.csv.gz").write_bytes((tmp_path / "items.csv.gz").read_bytes())
    with pytest.raises(SourceError, match=r"levels\.csv\.gz.*columns"):
        read_tables(tmp_path)
    (tmp_path / "levels.csv.gz").unlink()
    with pytest.raises(SourceError, match=r"levels\.csv\.gz"):
        read_tables(tmp_path)


@pytest.mark.parametrize("kind", ["nothing", "a study without sessions"])
def test_no_sessions(kind: str, tmp_path: Path) -> None:
    if kind != "nothing":
        (tmp_path / "study.toml").touch()
    with pytest.raises(SourceError, match=r"no sessions|neither a study folder"):
        load(tmp_path)


def test_a_mode_without_sessions_tells_the_others(made: Path) -> None:
    with pytest.raises(SourceError, match="--mode simulated"):
        load(made, mode="live")


def test_real_and_simulated_together_are_refused_unless_asked(copy: Path) -> None:
    move_to(copy, "live")
    with pytest.raises(SourceError, match="--mode live or --mode simulated"):
        load_recorded(copy)
    live = load_recorded(copy, "live", check=False)
    assert not live.simulated
    assert list(live.frame("participants")["participant"]) == ["S0001"]
    assert len(load_recorded(copy, "simulated", check=False).frame("participants")) == 2


def test_pilots_alone_are_no_data(copy: Path) -> None:
    for name in ("S0001", "S0002", "S0003"):
        move_to(copy, "pilot", name)
    with pytest.raises(SourceError, match="--mode pilot"):
        load_recorded(copy)
    pilot = load_recorded(copy, "pilot", check=False)
    assert "these are pilot sessions, no data of the study" in pilot.study().notes


def test_a_simulated_session_among_the_real_ones(copy: Path) -> None:
    (copy / "sessions" / "simulated").rename(copy / "sessions" / "live")
    with pytest.raises(SourceError, match=r"S0001.*simulated session"):
        load_recorded(copy, "live", check=False)


def test_a_journal_in_another_participants_folder(copy: Path) -> None:
    shutil.copy(journal(copy, "S0002"), journal(copy, "S0001"))
    with pytest.raises(SourceError, match=r"S0001.*participant S0002"):
        load_recorded(copy, check=False)


def test_a_journal_that_does_not_verify_is_named(copy: Path) -> None:
    text = journal(copy).read_text()
    assert '"comprehension":0.5' in text
    journal(copy).write_text(text.replace('"comprehension":0.5', '"comprehension":0.4', 1))
    with pytest.raises(SourceError, match=r"1 of 3 journals.*S0001.*comprehension.*--no-verify"):
        load_recorded(copy)
    assert len(load_recorded(copy, check=False).frame("participants")) == 3


def test_a_line_that_is_gone_is_named(copy: Path) -> None:
    lines = journal(copy).read_text().splitlines(keepends=True)
    journal(copy).write_text("".join(lines[:40] + lines[41:]))
    with pytest.raises(JournalError, match="line 41"):
        load_recorded(copy, check=False)


def test_a_newer_schema_is_named(copy: Path) -> None:
    text = journal(copy).read_text()
    journal(copy).write_text(text.replace(f'"schema":{SCHEMA_VERSION}', '"schema":99', 1))
    with pytest.raises(AnaError, match="schema 99"):
        load_recorded(copy, check=False)


def test_a_torn_and_unfinished_session_is_told(copy: Path) -> None:
    whole = journal(copy).read_bytes()
    journal(copy).write_bytes(whole[: int(len(whole) * 0.8)])
    torn = load_recorded(copy, check=False)
    study = torn.study()
    flow = {row["step"]: row["people"] for row in flow_rows(torn, read_rules())}
    assert flow["were randomised"] == 3
    assert flow["finished both rounds"] == 2
    assert any("unfinished line" in note and "S0001" in note for note in study.notes)
    assert "randomised and not finished: S0001" in study.notes
    assert study.rounds.query("participant == 'S0001'")["preference"].isna().any()


def test_who_found_no_place_has_not_left(copy: Path) -> None:
    lines = journal(copy, "S0002").read_text().splitlines(keepends=True)
    at = next(n for n, line in enumerate(lines) if '"type":"allocated"' in line)
    ended = next(line for line in lines if '"type":"session_ended"' in line)
    envelope, _, _ = lines[at].partition('"type"')
    turned_away = envelope + '"type"' + ended.partition('"type"')[2]
    turned_away = turned_away.replace('"finished"', '"turned_away"')
    journal(copy, "S0002").write_text("".join(lines[:at]) + turned_away)
    notes = {
        row["step"]: row["note"]
        for row in flow_rows(load_recorded(copy, check=False), read_rules())
    }
    assert notes["were randomised"] == "0 left before allocation, 1 found no place"


def test_nobody_randomised(copy: Path) -> None:
    for name in ("S0001", "S0002", "S0003"):
        lines = journal(copy, name).read_text().splitlines(keepends=True)
        at = next(n for n, line in enumerate(lines) if '"type":"allocated"' in line)
        journal(copy, name).write_text("".join(lines[:at]))
    with pytest.raises(SourceError, match="nobody got as far as the allocation"):
        load(copy, check=False)


def test_algorithm_1_again_gives_the_recorded_levels(recorded: Recorded) -> None:
    study = recorded.study().with_groups(
        pd.Series({"S0001": "LOW", "S0002": "MED", "S0003": "HIGH"})
    )
    levels = recorded.frame("levels")
    levels = levels[levels["adaptivity"] == "adaptive"]
    missions = judged_missions(recorded, study)
    assert len(missions) == 3
    changes: list[int] = []
    for mission in missions:
        own = levels[levels["participant"] == mission.participant]
        told = list(zip(own["level"], own["from_ms"], own["until_ms"], strict=True))
        assert stretches(mission) == told
        assert stretches(mission, prior_mass=mission.rule.prior_mass) == told
        changes.append(len(told))
        assert shares(mission, lower_below=0.001)[0] <= shares(mission)[0]
        assert shares(mission, lower_below=0.79)[0] > 0.5
        assert shares(mission).sum() == pytest.approx(1)
    assert max(changes) > 2


@given(*[st.floats(0.001, 0.999)] * 4)
def test_prior_masses_compose(comprehension: float, one: float, two: float, three: float) -> None:
    straight = with_prior_mass(comprehension, one, three)
    around = with_prior_mass(with_prior_mass(comprehension, one, two), two, three)
    assert straight == pytest.approx(around, abs=1e-6)
    assert (straight >= comprehension) or three < one


def test_groups_of_a_study_that_is_too_small_are_refused(recorded: Recorded) -> None:
    study, clustering = grouped(left_by(recorded.study(), None).study)
    assert study.has("knowledge") or "distinct" in str(clustering)


def test_a_mission_that_is_not_over_is_no_result_anywhere(copy: Path) -> None:
    lines = journal(copy).read_bytes().splitlines(keepends=True)
    kinds = [(it["phase"], it["round"], it["type"]) for it in map(json.loads, lines)]
    end = kinds.index(("mission", 2, "phase_ended"))
    journal(copy).write_bytes(b"".join(lines[:end]))
    recorded = read_study_folder(copy, check=False)
    study, _ = grouped(recorded.study())
    own = study.rounds[study.rounds["participant"] == "S0001"]
    assert own["victims"].notna().sum() == 1
    assert "S0001" not in both_rounds(study, "victims").index
    for name in ("levels", "posteriors", "instructions", "victims"):
        kept = recorded.of_missions(name)
        assert set(kept.loc[kept["participant"] == "S0001", "round"]) == {1}, name
    notes = "\n".join(study.notes)
    assert "missions that are not over, and so have no result yet: S0001 (round 2, " in notes
    assert "one round only of S0001" in notes

"""The page of all missions: whole, one file, and true to the journals."""

import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from analysis.pages.missions_page import missions_html
from analysis.sources.replays import Replays, read_replays
from analysis.sources.study_folder import read_study_folder
from analysis.stats.groups import grouped
from tests.analysis.simulated import first_of_the_shipped


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("study") / "four"
    first_of_the_shipped(folder, 4)
    return folder


@pytest.fixture(scope="module")
def page(made: Path) -> str:
    study, _ = grouped(read_study_folder(made, check=False).study())
    return missions_html(read_replays(made), study)


def data_of(page: str) -> Any:
    found = re.search(r'<script id="data" type="application/json">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    return json.loads(found[1].replace("<\\/", "</"))


def test_every_mission_is_there_as_it_was_recorded(made: Path, page: str) -> None:
    data = data_of(page)
    recorded = read_study_folder(made, check=False)
    rounds = recorded.frame("rounds")
    assert len(data["missions"]) == len(rounds) == 8
    assert data["simulated"] is True
    for mission in data["missions"]:
        row = rounds[
            (rounds["participant"] == mission["participant"])
            & (rounds["round"] == mission["round"])
        ].iloc[0]
        building = data["buildings"][mission["building"]]
        assert sum(victim[3] == "rescued" for victim in mission["victims"]) == row["victims"]
        assert mission["scores"]["victims"] == row["victims"]
        assert len(building["tiles"]) == building["width"] * building["height"]
        at = mission["start"]
        for when, x, y in mission["path"]:
            assert abs(x - at[0]) + abs(y - at[1]) == 1 and 0 <= when <= mission["duration"]
            assert building["tiles"][y * building["width"] + x] != "1"
            at = [x, y]
        assert mission["words"][0][0] == 0 and mission["levels"][0][0] == 0
        assert bool(mission["known"]) == (mission["adaptivity"] == "adaptive")


def test_it_is_one_file_that_loads_nothing(page: str) -> None:
    assert "SIMULATED PEOPLE" in page and page.count("<script") == 2
    code = page.replace("http://www.w3.org/2000/svg", "")
    assert not re.search(r"https?://|src=|href=|import |fetch\(|XMLHttp", code)


def test_words_cannot_end_the_script(made: Path) -> None:
    study, _ = grouped(read_study_folder(made, check=False).study())
    replays = read_replays(made)
    replays.missions[0]["words"] = [[0, "</script><b>"]]
    again = missions_html(Replays(replays.buildings, replays.missions), study)
    assert again.count("</script>") == 2
    assert data_of(again)["missions"][0]["words"] == [[0, "</script><b>"]]


@pytest.mark.skipif(shutil.which("chromium") is None, reason="Chromium is not installed")
def test_a_browser_draws_the_points_and_the_chosen_mission(page: str, tmp_path: Path) -> None:
    path = tmp_path / "missions.html"
    path.write_text(page, encoding="utf-8")
    mission = data_of(page)["missions"][2]
    place = f"{path.as_uri()}#{mission['participant']}-{mission['round']}"
    command = [
        "chromium",
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--dump-dom",
        "--virtual-time-budget=2000",
        f"--user-data-dir={tmp_path / 'profile'}",
        place,
    ]
    shown = subprocess.run(command, capture_output=True, text=True, timeout=120).stdout  # fmt: skip
    assert len(re.findall(r'data-mission="\d', shown)) == 8
    assert f'<td id="who">{mission["participant"]}</td>' in shown
    assert f'id="rescued">{mission["scores"]["victims"]:.0f}<' in shown
    assert 'class="point chosen"' in shown

"""`ana compare`: the same people with every coach, the same numbers on any number of cores."""

import json
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from game.cli import main
from game.coach.spec import parse_coach
from game.errors import AnaError
from game.rescuers.person import POPULATIONS
from game.simulation.comparison import Matter, People, Plan, play, trials
from game.simulation.contenders import contender

OWN = """
from game.coach.acts import Level
from game.coach.kinds.static import StaticCoach


class Patient(StaticCoach):
    def __init__(self, briefing):
        super().__init__(briefing, Level.C1)
"""


def plan(*coaches: str, people: int = 1, of: People = "choosing") -> Plan:
    named = tuple(contender(name) for name in coaches)
    return Plan(named, {"default": POPULATIONS["default"]}, ("practice",), people, 3, of)


def test_every_coach_meets_the_same_person() -> None:
    one, same, other = play(plan("static:1", "static:1", "ana"), Matter("default", "practice", 0))
    assert one == same
    assert other.known == one.known


def test_a_static_coach_that_listens_says_what_a_static_coach_says() -> None:
    asked = plan("static:2", "knowledge")
    listening = play(asked, Matter("default", "practice", 0))[0]
    silent = replace(asked.coaches[0], spec=parse_coach("static", 2), rule=None)
    deaf = play(replace(asked, coaches=(silent,)), Matter("default", "practice", 0))[0]
    assert msgspec.structs.replace(listening, comprehension=None) == deaf
    assert listening.comprehension is not None


def test_the_two_sets_of_people_have_nobody_in_common() -> None:
    choosing = [play(plan("static:3"), Matter("default", "practice", n))[0] for n in range(4)]
    reporting = [
        play(plan("static:3", of="reporting"), Matter("default", "practice", n))[0]
        for n in range(4)
    ]
    assert [it.known for it in choosing] != [it.known for it in reporting]


def test_the_number_of_cores_changes_nothing() -> None:
    asked = plan("static:2", "knowledge", people=3)
    told: list[int] = []
    alone = trials(asked, 1, lambda done, _of: told.append(done))
    assert told == [1, 2, 3]
    assert trials(asked, 2, lambda _done, _of: None) == alone


def test_a_coach_that_is_told_the_truth_knows_it() -> None:
    (told,) = play(plan("truth"), Matter("default", "practice", 1))
    assert all((chance > 0.5) == known for chance, known in told.goals[:1])
    assert told.share is not None


def test_a_coach_of_ones_own_takes_part(tmp_path: Path) -> None:
    file = tmp_path / "patient.py"
    file.write_text(OWN, encoding="utf-8")
    one, own = play(plan("static:1", f"{file}:Patient"), Matter("default", "practice", 0))
    assert (own.rescues, own.c1, own.coach) == (one.rescues, one.c1, f"{file}:Patient")


@pytest.mark.parametrize(
    "name",
    ["anna", "yoked", "ana:calibratd", "static:4", "knowledge:serch_ms=1", "ana:floodfill;bta=1"],
)
def test_a_coach_that_there_is_not_is_named(name: str) -> None:
    with pytest.raises(AnaError, match="there is no"):
        contender(name)


@pytest.mark.parametrize(
    ("name", "named", "hint"),
    [
        ("knowledge:first_level=1", "there is no number 'first_level'", ""),
        ("knowledge:serch_ms=1", "there is no number 'serch_ms'", "Did you mean search_ms?"),
        ("knowledge:show_ms=1,search_ms=2", "show_ms cannot be '1,search_ms=2'", "semicolon"),
    ],
)
def test_a_number_that_cannot_be_changed_is_named(name: str, named: str, hint: str) -> None:
    with pytest.raises(AnaError, match=named) as caught:
        contender(name)
    assert hint in (caught.value.hint or "") and "first_level?" not in (caught.value.hint or "")


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, drawn = tmp_path / "out.json", tmp_path / "figures"
    asked = ["compare", "--coaches", "static:1,static:3,ana,knowledge", "--buildings", "practice"]
    asked += ["--worlds", "default,hasty", "--people", "3", "--jobs", "1"]
    assert main([*asked, "--json", str(out), "--figures", str(drawn)]) == 0
    said = capsys.readouterr().out
    assert "Simulated people of the set for reporting" in said
    found = json.loads(out.read_text(encoding="utf-8"))
    assert found["simulated"] is True
    assert {cell["world"] for cell in found["cells"]} == {"default", "hasty"}
    cell = next(it for it in found["cells"] if it["coach"] == "knowledge")
    assert {"group", "n", "rescues", "minus_best_static", "minus_ana", "switches"} < set(cell)
    for cell in found["cells"]:
        for name in ("minus_best_static", "minus_ana"):
            assert cell[name] is None or len(cell[name]) == 3
    assert sum(it["n"] for it in found["cells"] if it["coach"] == "ana") == 6
    assert "SIMULATED" in (drawn / "coaches.svg").read_text(encoding="utf-8")


def test_worlds_drawn_from_a_cube(tmp_path: Path) -> None:
    out = tmp_path / "out.json"
    asked = ["compare", "--coaches", "static:1,ana", "--buildings", "practice", "--jobs", "1"]
    assert main([*asked, "--hypercube", "3", "--people", "2", "--json", str(out)]) == 0
    found = json.loads(out.read_text(encoding="utf-8"))
    assert {cell["world"] for cell in found["cells"]} == {"hypercube"}
    assert sum(it["n"] for it in found["cells"] if it["coach"] == "ana") == 6


@pytest.mark.parametrize(
    ("option", "value", "named"),
    [
        ("--coaches", "ana,anna", "there is no coach 'anna'"),
        ("--worlds", "default,hsty", "Did you mean hasty?"),
        ("--buildings", "harbor", "harbour"),
        ("--coaches", ",", "there must be a coach"),
        ("--people", "0", "--people"),
    ],
)
def test_what_cannot_be_compared_is_refused(
    option: str, value: str, named: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["compare", option, value, "--jobs", "1"]) == 2
    assert named in capsys.readouterr().err


@pytest.mark.parametrize("option", ["--json", "--figures"])
def test_a_place_that_cannot_be_written_to_is_refused_before_anybody_plays(
    option: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("game.simulation.comparison.play", lambda *_: pytest.fail("they played"))
    (tmp_path / "file").write_text("kept", encoding="utf-8")
    place = str(tmp_path / "file" / "out")
    assert main(["compare", "--people", "1", "--jobs", "1", option, place]) == 2
    assert place in capsys.readouterr().err
    assert (tmp_path / "file").read_text(encoding="utf-8") == "kept"


def test_earlier_numbers_are_kept_when_the_comparison_is_refused(tmp_path: Path) -> None:
    out = tmp_path / "out.json"
    out.write_text("earlier", encoding="utf-8")
    assert main(["compare", "--coaches", "anna", "--json", str(out)]) == 2
    assert out.read_text(encoding="utf-8") == "earlier"

"""How a coach is described, in a journal and on the command line."""

from __future__ import annotations

import msgspec
import pytest

from game.coach.kinds.static import StaticCoach
from game.coach.spec import CoachSpec, parse_coach
from game.errors import AnaError
from tests.coach.scripted import ADAPTIVE, EVERY, PACE, STATIC, Game


@pytest.mark.parametrize("spec", EVERY, ids=lambda spec: str(spec.preset or spec.kind))
def test_a_spec_survives_the_journal(spec: CoachSpec) -> None:
    assert msgspec.json.decode(msgspec.json.encode(spec), type=CoachSpec) == spec
    game = Game(spec)
    assert isinstance(game.coach, StaticCoach) == (spec.kind == "static")


@pytest.mark.parametrize(
    "text",
    [
        '{"kind": "ana", "preset": "calibrate"}',
        '{"kind": "ana", "preset": "literal", "level": 1}',
        '{"kind": "static"}',
        '{"kind": "static", "level": 4}',
        '{"kind": "pace", "level": 1, "preset": "literal"}',
    ],
)
def test_a_spec_that_makes_no_sense_is_not_read(text: str) -> None:
    with pytest.raises(msgspec.ValidationError):
        msgspec.json.decode(text, type=CoachSpec)


def test_names_are_parsed_with_the_usual_choices() -> None:
    assert parse_coach("ana") == ADAPTIVE[0]
    assert parse_coach("ana", preset="fig10") == ADAPTIVE[3]
    assert parse_coach("static", 3) == STATIC[2]
    assert parse_coach("pace") == PACE


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (("sttic",), "Did you mean static?"),
        (("ana", None, "calibratd"), "Did you mean calibrated?"),
        (("static", 4), "Give 1, 2 or 3."),
        (("ana", 2), "Leave --level out"),
        (("pace", 2, "literal"), "Leave --preset out"),
    ],
)
def test_a_wrong_name_is_met_by_the_right_one(
    arguments: tuple[str, int | None, str | None], hint: str
) -> None:
    with pytest.raises(AnaError, match=hint.replace("?", r"\?")):
        parse_coach(*arguments)

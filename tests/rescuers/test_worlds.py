"""Kinds of people as data."""

from dataclasses import fields
from pathlib import Path

import pytest

from game.rescuers.person import POPULATIONS, Traits, drawn, world
from game.rescuers.person.parameters import LIMITS
from game.rescuers.person.worlds import CUBE, WorldError, parse_world, world_at

NAMED = ("default", "hasty", "careful", "slow-readers", "poor-explorers", "good-explorers")


def test_the_worlds_that_come_with_it() -> None:
    assert set(NAMED) < set(POPULATIONS)
    assert next(iter(POPULATIONS)) == "default"
    assert POPULATIONS["default"].typical == Traits()
    for name in NAMED[1:]:
        assert world(name).typical != Traits()
        assert drawn(world(name), 1) == drawn(world(name), 1)


def test_a_file_says_in_what_people_differ(tmp_path: Path) -> None:
    file = tmp_path / "sleepy.toml"
    file.write_text('\ufeffabout = "Sleepy people"\n[typical]\nreaction_ms = 800\n', "utf-8")
    sleepy = world(str(file))
    assert sleepy.name.startswith("sleepy ")
    assert sleepy.typical.reaction_ms == 800
    assert sleepy.typical.ability == Traits().ability
    before = sleepy.name
    file.write_text('about = "Sleepier people"\n[typical]\nreaction_ms = 900\n', "utf-8")
    assert world(str(file)).name != before


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ('about = "x"\n[typical]\nabilty = 1', "Did you mean ability?"),
        ('about = "x"\n[typical]\nability = 9', "ability must be between 0 and 1.6, not 9"),
        ('about = "x"\n[typical]\nability = nan', "ability must be between"),
        ('about = "x"\n[spread]\nslip = -1', "people.toml, spread: slip must be"),
        ('about = "x"\n[typicl]\nability = 1', "Did you mean typical?"),
        ("[typical]\nability = 1", "about"),
        (
            'about = "x"\n[typical]\nability = "much"',
            "typical: ability must be a number, not 'much'",
        ),
        ('about = "x"\n[typical]\nability = true', "ability must be a number, not True"),
        ('about = "x"\n[spread]\nstray = -0.1', "people.toml, spread: stray must be between 0"),
        ('about = "x"\ntypical = 3', "people.toml, typical: this must be a table"),
        ('about = "x"\neffect = nan', "effect must be between 0 and 10, not nan"),
        ('about = "x"\neffect = inf', "effect must be between 0 and 10, not inf"),
        ('about = "x"\nnoise = -4', "noise must be between 0 and 100, not -4"),
        ('about = "x"\nleaving = 2', "leaving must be between 0 and 1, not 2"),
        ('about = "x"\nspred-out = 1', "Did you mean spread?"),
        ('about = "  "', "about is missing"),
        (f'about = "x"\nnoise = 1{"0" * 400}', "noise must be between"),
        (f'about = "x"\nnoise = 1{"0" * 5000}', "not TOML"),
        ("about = ", "not TOML"),
    ],
)
def test_what_cannot_be_used_is_named(text: str, named: str) -> None:
    with pytest.raises(WorldError, match=r"people\.toml") as refused:
        parse_world("people", text, "people.toml")
    assert named in str(refused.value)


def test_a_world_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(WorldError, match="Did you mean hasty"):
        world("hastey")
    with pytest.raises(WorldError, match="No such file"):
        world(str(tmp_path / "nobody.toml"))


def test_every_point_of_the_cube_is_a_world() -> None:
    names = {trait.name for trait in fields(Traits)}
    for trait, (low, high) in CUBE.items():
        assert trait in names
        assert 0 <= low < high <= getattr(LIMITS, trait)
    lowest, highest = world_at([0.0] * len(CUBE), "low"), world_at([1.0] * len(CUBE), "high")
    for trait, (low, high) in CUBE.items():
        assert getattr(lowest.typical, trait) == low
        assert getattr(highest.typical, trait) == high

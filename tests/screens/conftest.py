"""What the tests of the screens share: a small building, and the game with everything real."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from pathlib import Path

import pytest
from textual.css.model import RuleSet
from textual.css.stylesheet import Stylesheet
from textual.pilot import Pilot

from game.coach.spec import CoachSpec, parse_coach
from game.screens.play.app import AnaApp
from game.screens.play.options import PlayOptions
from game.world.building import Building
from game.world.reading import parse_building
from game.world.settings import MissionSettings

WARD = """name: Ward

plan:
#####################
#A......#.....#....B#
#.o.....+..^..+...*.#
#....*..#.....#.....#
#####################

legend:
A = room Records Room
B = room Test Lab
^ = start facing north
* = red victim
o = blue victim
"""

Opened = AbstractAsyncContextManager[tuple[AnaApp, Pilot[None]]]


@pytest.fixture(scope="session", autouse=True)
def styles_parsed_once() -> Iterator[None]:
    """Textual parses all styles twice in each app; here equal ones are parsed once for all apps."""
    kept: dict[object, list[RuleSet]] = {}
    parse = Stylesheet._parse_rules

    def once(self: Stylesheet, css: str, *args: object, **kwargs: object) -> list[RuleSet]:
        key = (css, args, frozenset(kwargs.items()), frozenset(self._variables.items()))
        if key not in kept:
            kept[key] = parse(self, css, *args, **kwargs)  # type: ignore[arg-type]
        return kept[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Stylesheet, "_parse_rules", once)
        yield


@pytest.fixture
def ward() -> Building:
    return parse_building(WARD, "ward")


@pytest.fixture
def open_app(
    tmp_path: Path, ward: Building, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., Opened]:
    """Opens the game, by default in a mission; its journals and choices stay in `tmp_path`."""
    monkeypatch.setenv("TERM", "xterm-256color")
    for name in ("NO_COLOR", "COLORTERM", "COLORFGBG"):
        monkeypatch.delenv(name, raising=False)

    @asynccontextmanager
    async def opened(
        first: Callable[[AnaApp], None] | None = None,
        *,
        size: tuple[int, int] = (80, 24),
        coach: CoachSpec | None = None,
        building: Building | None = None,
        **settings: object,
    ) -> AsyncIterator[tuple[AnaApp, Pilot[None]]]:
        options = PlayOptions(
            building=building or ward,
            spec=coach or parse_coach("static", 1),
            settings=MissionSettings(**settings),  # type: ignore[arg-type]
            seed=1,
            log_dir=tmp_path,
        )
        begin = first or (lambda app: app.play_mission(options))
        app = AnaApp(begin, options, preferences=tmp_path / "home.json")
        async with app.run_test(size=size) as pilot:
            await pilot.pause()
            yield app, pilot

    return opened

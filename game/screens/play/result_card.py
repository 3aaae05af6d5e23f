"""A result to show to others: as text to paste, and as a picture (SVG)."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from itertools import pairwise

from game.screens.play.mission_story import MissionStory, coach_name
from game.screens.play.past_missions import difficulty
from game.screens.play.pathmap import STAGES, stage
from game.screens.widgets.statuspanel import clock_text
from game.world.building import Severity
from game.world.geometry import Cell
from game.world.observation import VictimState
from game.world.plan import Plan, Tile

_TEXT_COLUMNS = 40
_CELL = 8
"""Pixels of a cell in the picture."""
_HEAD, _FOOT = 76, 40
_PAPER, _FLOOR, _WALL, _DOOR = "#121316", "#303237", "#8b8f97", "#d7870f"
_INK, _QUIET = "#eaebee", "#b0b3ba"
_RED, _BLUE, _GREEN = "#ff5f52", "#62b6ff", "#4fd58a"
_TRAIL = ("#7d7326", "#a3951d", "#cbb713", "#f5d90a")


def headline(story: MissionStory) -> str:
    """What it came to."""
    saved = {severity: story.count(severity, VictimState.RESCUED) for severity in Severity}
    points = f", {story.score} points" if story.settings.show_score else ""
    return (
        f"{story.rescued} of {len(story.building.victims)} rescued "
        f"({saved[Severity.RED]} red, {saved[Severity.BLUE]} blue){points}"
    )


def circumstances(story: MissionStory) -> str:
    """Where, with whom, by which rules, and from which seed."""
    words = [story.building.name, f"coach {coach_name(story.spec)}"]
    words.append(story.unusual or difficulty(story.settings))
    return ", ".join([*words, f"seed {story.seed}"])


def card_text(story: MissionStory) -> str:
    """The result in a few lines of plain text, without a path of this machine."""
    minutes = f"{clock_text(story.until_ms)} of {clock_text(story.settings.duration_ms)}"
    return "\n".join(
        [
            f"ana: {headline(story)}",
            circumstances(story),
            f"time    0:00 {'·' * _TEXT_COLUMNS} {minutes}",
            f"rescues      {_rescues_line(story)}",
            f"level        {_levels_line(story)}",
        ]
    )


def _rescues_line(story: MissionStory) -> str:
    """A mark where somebody was rescued; a digit where several were."""
    counts = [0] * _TEXT_COLUMNS
    for step in story.rescues[1:]:
        counts[_column(story, step.at_ms)] += 1
    return "".join("·" if not n else "✓" if n == 1 else str(min(n, 9)) for n in counts)


def _levels_line(story: MissionStory) -> str:
    """The level of the words, C1 to C3, over the time that was played."""
    line = [" "] * _TEXT_COLUMNS
    for step, after in zip(story.levels, [*story.levels[1:], None], strict=True):
        until = _TEXT_COLUMNS if after is None else _column(story, after.at_ms)
        for column in range(_column(story, step.at_ms), until):
            line[column] = str(step.value)
    played = _column(story, story.until_ms) + 1
    return "".join(line[:played]).rstrip()


def _column(story: MissionStory, at_ms: int) -> int:
    return min(_TEXT_COLUMNS - 1, _TEXT_COLUMNS * at_ms // story.settings.duration_ms)


def card_svg(story: MissionStory) -> str:
    """The result as a picture: the headline, the building with the way walked, and the levels."""
    plan = story.building.plan
    wide, high = plan.width * _CELL, plan.height * _CELL
    body = [
        f'<rect width="{wide}" height="{high + _HEAD + _FOOT}" fill="{_PAPER}"/>',
        _text(12, 32, headline(story), _INK, 22, bold=True),
        _text(12, 58, circumstances(story), _QUIET, 15),
        f'<g transform="translate(0 {_HEAD})">',
        *_tiles(plan),
        *_way(story),
        *_victims(story),
        "</g>",
        *_levels(story, wide, _HEAD + high),
    ]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide}" height="{high + _HEAD + _FOOT}" '
        f'viewBox="0 0 {wide} {high + _HEAD + _FOOT}">\n' + "\n".join(body) + "\n</svg>\n"
    )


def _text(x: float, y: float, text: str, ink: str, size: int, *, bold: bool = False) -> str:
    weight = ' font-weight="bold"' if bold else ""
    return (
        f'<text x="{x:g}" y="{y:g}" fill="{ink}" font-size="{size}"{weight} '
        f'font-family="sans-serif">{escape(text)}</text>'
    )


def _tiles(plan: Plan) -> Iterator[str]:
    """Floor, walls and doors, each row in runs."""
    colours = {Tile.FLOOR: _FLOOR, Tile.WALL: _WALL, Tile.DOOR: _DOOR}
    for y in range(plan.height):
        x = 0
        while x < plan.width:
            tile, start = plan.tile((x, y)), x
            while x < plan.width and plan.tile((x, y)) is tile:
                x += 1
            yield (
                f'<rect x="{start * _CELL}" y="{y * _CELL}" width="{(x - start) * _CELL}" '
                f'height="{_CELL}" fill="{colours[tile]}"/>'
            )


def _way(story: MissionStory) -> Iterator[str]:
    """The way in lines, one for each stretch of the time."""
    steps = list(zip(story.path, story.walked_ms, strict=True))
    for part in range(STAGES):
        runs: list[list[Cell]] = []
        for (cell, _), (after, at_ms) in pairwise(steps):
            if stage(story, at_ms) != part:
                continue
            if not runs or runs[-1][-1] != cell:
                runs.append([cell])
            runs[-1].append(after)
        for run in runs:
            points = " ".join(f"{_middle(x)},{_middle(y)}" for x, y in run)
            yield (
                f'<polyline points="{points}" fill="none" stroke="{_TRAIL[part]}" '
                'stroke-width="3" stroke-linejoin="round" stroke-linecap="round"/>'
            )
    for cell, ink in ((story.path[0], _INK), (story.path[-1], _TRAIL[-1])):
        x, y = cell
        yield f'<circle cx="{_middle(x)}" cy="{_middle(y)}" r="5" fill="{ink}"/>'


def _victims(story: MissionStory) -> Iterator[str]:
    """Full where red, open where blue; green where rescued, crossed where lost."""
    for fate in (story.fates[victim] for victim in sorted(story.revealed)):
        x, y = (_middle(at) for at in fate.victim.cell)
        red = fate.victim.severity is Severity.RED
        ink = _RED if red else _BLUE
        if fate.state is VictimState.RESCUED:
            ink = _GREEN
        yield (
            f'<circle cx="{x}" cy="{y}" r="5" fill="{ink if red else "none"}" stroke="{ink}" '
            'stroke-width="2"/>'
        )
        if fate.state is VictimState.EXPIRED:
            cross = f"M{x - 6} {y - 6}L{x + 6} {y + 6}M{x - 6} {y + 6}L{x + 6} {y - 6}"
            yield f'<path d="{cross}" stroke="{_INK}" stroke-width="2"/>'


def _levels(story: MissionStory, wide: int, top: int) -> Iterator[str]:
    """The level of the words over time, as a band with its names."""
    per_ms = (wide - 24) / story.settings.duration_ms
    ends = [*(step.at_ms for step in story.levels[1:]), story.until_ms]
    for step, end_ms in zip(story.levels, ends, strict=False):
        x, broad = 12 + step.at_ms * per_ms, (end_ms - step.at_ms) * per_ms
        yield (
            f'<rect x="{x:.1f}" y="{top + 10}" width="{max(0.0, broad):.1f}" height="20" '
            f'fill="{_TRAIL[step.value]}"/>'
        )
        if broad > 24:
            yield _text(x + 4, top + 25, f"C{step.value}", _PAPER, 13, bold=True)


def _middle(cell: int) -> int:
    return cell * _CELL + _CELL // 2

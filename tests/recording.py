"""`python -m tests.recording docs/pictures/mission.gif`: record a mission in a terminal.

A literal reader plays the mission in a pseudo-terminal as a person would, by keys.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import pyte
from PIL import Image, ImageDraw, ImageFont

from game.coach.spec import parse_coach
from game.commands.ana_play import DEFAULT_BUILDING
from game.rescuers.literal import LiteralReader
from game.session.playing import start_in_memory
from game.world import load_building
from game.world.events import Action
from game.world.settings import FREE_PLAY
from tests.bench.coach import KEY_OF
from tests.terminal import Chunk, Shown, Terminal

COLUMNS, ROWS = 100, 30
CELL = (9, 18)
FONT = "DejaVuSansMono.ttf"
SEED, LASTS_MS, EVERY_MS = 1, 42_000, 250
A_SECOND = 5
LAST_FRAME_S = 2.0
COLOURS = 64
_NAMED = {"black": "000000", "brown": "aa5500", "default": ""}
_BLOCKS = {
    "█": ((0, 0, 2, 2),), "▀": ((0, 0, 2, 1),), "▄": ((0, 1, 2, 2),), "▌": ((0, 0, 1, 2),),
    "▐": ((1, 0, 2, 2),), "▘": ((0, 0, 1, 1),), "▝": ((1, 0, 2, 1),), "▖": ((0, 1, 1, 2),),
    "▗": ((1, 1, 2, 2),), "▛": ((0, 0, 2, 1), (0, 1, 1, 2)), "▜": ((0, 0, 2, 1), (1, 1, 2, 2)),
    "▙": ((0, 0, 1, 2), (1, 1, 2, 2)), "▟": ((1, 0, 2, 2), (0, 1, 1, 2)),
    "▚": ((0, 0, 1, 1), (1, 1, 2, 2)), "▞": ((1, 0, 2, 1), (0, 1, 1, 2)),
}  # fmt: skip
"""Blocks as halves of a cell: left, top, right, bottom."""


def presses() -> list[tuple[int, str]]:
    """When a literal reader presses which key, in milliseconds from the start."""
    building, rules = load_building(DEFAULT_BUILDING), FREE_PLAY
    run, _ = start_in_memory(building, rules, parse_coach("ana"), SEED, rescuer="literal")
    reader = LiteralReader(rules.controls, {room.name: room.label for room in building.rooms})
    found: list[tuple[int, str]] = []
    for now_ms in range(EVERY_MS, LASTS_MS, EVERY_MS):
        run.advance(now_ms)
        action = reader.decide(run.observation())
        if isinstance(action, Action):
            found.append((now_ms, KEY_OF[action]))
            run.press(action, now_ms)
    return found


def record() -> list[Chunk]:
    """The output of a mission, from its first picture on."""
    command = [sys.executable, "-m", "game", "play", "--now", "--seed", str(SEED)]
    env = {"COLORTERM": "truecolor"}
    with (
        tempfile.TemporaryDirectory() as log,
        Terminal([*command, "--log", log], columns=COLUMNS, rows=ROWS, env=env) as terminal,
    ):
        pressed = presses()
        terminal.wait_for(" left")
        start = time.perf_counter()
        for at_ms, key in pressed:
            terminal.read_for(max(0.0, start + at_ms / 1000 - time.perf_counter()))
            terminal.press(key)
        terminal.read_for(1)
        return terminal.chunks


def frames(chunks: list[Chunk]) -> list[tuple[Image.Image, int]]:
    """Pictures of the screen, and for how many milliseconds each stands."""
    screen = pyte.Screen(COLUMNS, ROWS)
    stream = pyte.ByteStream(screen)
    drawn: list[tuple[Image.Image, int]] = []
    step_ms = 1000 // A_SECOND
    due = chunks[0].at
    for chunk in chunks:
        while chunk.at > due + step_ms / 1000:
            due += step_ms / 1000
            if screen.dirty or not drawn:
                screen.dirty.clear()
                drawn.append((picture(screen), step_ms))
            else:
                drawn[-1] = drawn[-1][0], drawn[-1][1] + step_ms
        Shown.feed(stream, chunk.data)
    return [*drawn, (picture(screen), round(1000 * LAST_FRAME_S))]


def picture(screen: Any) -> Image.Image:
    """An emulated screen, drawn cell by cell."""
    wide, high = CELL
    font = ImageFont.truetype(FONT, high - 4)
    image = Image.new("RGB", (screen.columns * wide, screen.lines * high), "#121316")
    draw = ImageDraw.Draw(image)
    for row in range(screen.lines):
        for column in range(screen.columns):
            cell = screen.buffer[row][column]
            ink, paper = _colour(cell.fg, "eaebee"), _colour(cell.bg, "121316")
            if cell.reverse:
                ink, paper = paper, ink
            left, top = column * wide, row * high
            draw.rectangle((left, top, left + wide - 1, top + high - 1), fill=paper)
            for west, north, east, south in _BLOCKS.get(cell.data, ()):
                corner = left + west * wide // 2, top + north * high // 2
                end = left + east * wide // 2 - 1, top + south * high // 2 - 1
                draw.rectangle((*corner, *end), fill=ink)
            if cell.data.strip() and cell.data not in _BLOCKS:
                draw.text((left, top), cell.data, font=font, fill=ink)
    return image


def _colour(name: str, default: str) -> str:
    code = _NAMED.get(name, name) or default
    return f"#{code}" if len(code) == 6 and not code.isalpha() else f"#{default}"


def main(path: Path) -> None:
    """Record a mission into `path`, a GIF."""
    pictures = frames(record())
    quantised = [image.quantize(COLOURS) for image, _ in pictures]
    quantised[0].save(
        path,
        save_all=True,
        append_images=quantised[1:],
        duration=[stands for _, stands in pictures],
        loop=0,
        optimize=True,
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]))

"""The building format: a text file with a plan in text art and a legend.

Reading takes two steps: the text becomes a `Drawing`, line by line, and the drawing is checked as a
building. Each step lists every problem it finds; the second runs only if the first found none.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from functools import lru_cache

from game.world.building import Building, Severity
from game.world.drawing import BuildingError, Drawing, Problem, RoomMark, build, survey
from game.world.geometry import Cell, Heading
from game.world.plan import Plan, Tile

TILE_GLYPHS = {"#": Tile.WALL, ".": Tile.FLOOR, "+": Tile.DOOR}
COMMENT = ";"
SMALLEST_SIDE = 3
BUILDINGS_KEPT = 64
"""So many are kept parsed: those of a study, and each leg of practice from where it mostly begins.
"""

_ENTRY = re.compile(r"(\S)\s*=\s*(.*)")
_MEANING = re.compile(
    r"room (?P<room>.+)|start facing (?P<start>north|east|south|west)|(?P<victim>red|blue) victim"
)
_MEANINGS = "'room NAME', 'start facing north|east|south|west', 'red victim' or 'blue victim'"


def parse_building(text: str, source: str = "building") -> Building:
    """The building that `text` describes. Raises BuildingError, which names `source`."""
    building, problems = inspect_text(text, source)
    if building is None:
        raise BuildingError(problems)
    return building


@lru_cache(maxsize=BUILDINGS_KEPT)
def kept_building(text: str, source: str = "building") -> Building:
    """`parse_building`, for readers of many journals: the same text gives the same building."""
    return parse_building(text, source)


def inspect_text(
    text: str, source: str = "building"
) -> tuple[Building | None, tuple[Problem, ...]]:
    """The building that `text` describes, or None and every problem found, in file order."""
    sheet = _Sheet(text, source)
    drawing = sheet.drawing()
    if drawing is None:
        return None, tuple(sorted(sheet.problems))
    problems = survey(drawing)
    return (None, problems) if problems else (build(drawing, text), ())


def decode(data: bytes, source: str) -> str:
    """The text of a file. Raises BuildingError if it is not UTF-8."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line_start = data.rfind(b"\n", 0, error.start) + 1
        problem = Problem(
            source,
            data.count(b"\n", 0, error.start) + 1,
            len(data[line_start : error.start].decode("utf-8-sig")) + 1,
            "this is not UTF-8 text",
            "Save the file as plain text in UTF-8",
        )
        raise BuildingError((problem,)) from None


class _Sheet:
    """One pass over the lines of a building file, collecting sections and problems."""

    def __init__(self, text: str, source: str) -> None:
        self.source = source
        self.problems: list[Problem] = []
        self.name: str | None = None
        self.rows: list[str] = []
        self.top_line = self.legend_line = 0
        self.meanings: dict[str, tuple[int, re.Match[str]]] = {}
        self._lines = [line.rstrip() for line in text.split("\n")]
        if not any(self._lines):
            self._note(1, 1, "the file is empty", "Write the sections name:, plan: and legend:")
            return
        numbered = iter(enumerate(self._lines, start=1))
        self._read_header(numbered)
        self._read_plan(numbered)
        self._read_legend(numbered)

    def drawing(self) -> Drawing | None:
        """The drawing on the sheet; None if there was any problem."""
        if self.problems or self.name is None:
            return None
        marked: dict[str, list[Cell]] = {glyph: [] for glyph in self.meanings}
        for y, row in enumerate(self.rows):
            for x, glyph in enumerate(row):
                if glyph not in TILE_GLYPHS:
                    marked[glyph].append((x, y))
        rooms: list[RoomMark] = []
        victims: list[tuple[Cell, Severity]] = []
        starts: list[tuple[Cell, Heading]] = []
        for glyph, (line, meaning) in self.meanings.items():
            cells = marked[glyph]
            if meaning["room"]:
                rooms.append(RoomMark(meaning["room"], tuple(cells), line))
            elif meaning["start"]:
                starts += [(cell, Heading[meaning["start"].upper()]) for cell in cells]
            else:
                victims += [(cell, Severity(meaning["victim"])) for cell in cells]
        tiles = bytes(TILE_GLYPHS.get(glyph, Tile.FLOOR) for row in self.rows for glyph in row)
        plan = Plan(len(self.rows[0]), len(self.rows), tiles)
        return Drawing(
            self.source,
            self.source,
            self.name,
            plan,
            tuple(rooms),
            tuple(victims),
            tuple(starts),
            self.top_line,
            self.legend_line,
        )

    def _note(self, line: int, column: int, message: str, hint: str) -> None:
        self.problems.append(Problem(self.source, line, column, message, hint))

    def _read_header(self, numbered: Iterator[tuple[int, str]]) -> None:
        for number, line in numbered:
            if line == "plan:":
                break
            if not line or line.startswith(COMMENT):
                continue
            key, colon, value = line.partition(":")
            value = value.strip()
            if key != "name" or not colon:
                self._note(
                    number,
                    1,
                    f"'{line[:30]}' is not a header line",
                    "Above the plan use only 'name: ...', 'plan:' and comments after ';'",
                )
            elif self.name is not None:
                self._note(number, 1, "the building has a second name", "Keep one 'name:' line")
            else:
                self.name = value
                if not value:
                    self._note(number, 6, "the name is empty", "Write it after 'name:'")
        else:
            self._note(
                len(self._lines), 1, "there is no plan", "Write 'plan:' on the line above the plan"
            )
            return
        if self.name is None:
            self._note(1, 1, "the building has no name", "Begin with the line 'name: ...'")
        self.top_line = number + 1

    def _read_plan(self, numbered: Iterator[tuple[int, str]]) -> None:
        for number, line in numbered:
            if line == "legend:":
                self.legend_line = number
                break
            if line or self.rows:
                self.rows.append(line)
            else:
                self.top_line = number + 1
        else:
            if self.top_line:
                self._note(
                    len(self._lines),
                    1,
                    "there is no legend",
                    "Write 'legend:' on a line of its own below the plan",
                )
        while self.rows and not self.rows[-1]:
            self.rows.pop()
        if self.legend_line:
            self._check_shape()

    def _check_shape(self) -> None:
        if not self.rows:
            self._note(self.top_line, 1, "the plan is empty", "Draw it below 'plan:'")
            return
        width = Counter(map(len, self.rows)).most_common(1)[0][0]
        if width < SMALLEST_SIDE or len(self.rows) < SMALLEST_SIDE:
            self._note(
                self.top_line,
                1,
                f"a plan of {width} x {len(self.rows)} cells is too small",
                "Draw a floor with wall all around it",
            )
        for y, row in enumerate(self.rows):
            if len(row) != width:
                off = abs(len(row) - width)
                short = len(row) < width
                self._note(
                    self.top_line + y,
                    min(len(row), width) + 1,
                    f"row {y + 1} of the plan is {off} {'cell' if off == 1 else 'cells'} "
                    f"too {'short' if short else 'long'} ({len(row)} instead of {width})",
                    "Make it as wide as the other rows",
                )

    def _read_legend(self, numbered: Iterator[tuple[int, str]]) -> None:
        for number, line in numbered:
            if line and not line.startswith(COMMENT):
                self._read_entry(number, line)
        if self.legend_line:
            self._check_glyphs()

    def _read_entry(self, number: int, line: str) -> None:
        entry = _ENTRY.fullmatch(line)
        if entry is None:
            self._note(number, 1, f"'{line[:30]}' is not a legend line", "Write 'GLYPH = MEANING'")
            return
        glyph, text = entry[1], entry[2]
        meaning = _MEANING.fullmatch(text)
        if glyph in TILE_GLYPHS:
            self._note(
                number, 1, f"'{glyph}' always means a tile", "Choose another glyph for this entry"
            )
        elif glyph in self.meanings:
            known = self.meanings[glyph][0]
            self._note(
                number,
                1,
                f"'{glyph}' already has a meaning on line {known}",
                "Choose another glyph, or remove one of the two lines",
            )
        elif meaning is None:
            self._note(
                number,
                entry.start(2) + 1,
                f"'{text[:30]}' is not a valid meaning",
                f"Write {_MEANINGS}",
            )
        else:
            self.meanings[glyph] = number, meaning

    def _check_glyphs(self) -> None:
        """Every glyph in the plan has a meaning, and every meaning is used.

        A glyph whose legend line is already reported is not reported again.
        """
        spoken_for = {line[0] for line in self._lines[self.legend_line :] if line}
        unknown: dict[str, tuple[int, int]] = {}
        for y, row in enumerate(self.rows):
            for x, glyph in enumerate(row):
                if glyph not in TILE_GLYPHS and glyph not in spoken_for:
                    unknown.setdefault(glyph, (self.top_line + y, x + 1))
        for glyph, (number, column) in unknown.items():
            if glyph.isspace():
                what = "tab" if glyph == "\t" else "blank"
                hint = "Draw '#' for wall or '.' for floor"
                self._note(number, column, f"there is a {what} inside the plan", hint)
            else:
                hint = f"Add '{glyph} = ...' to the legend, or draw '#', '.' or '+'"
                self._note(number, column, f"'{glyph}' is not in the legend", hint)
        drawn = set("".join(self.rows))
        for glyph, (number, _) in self.meanings.items():
            if glyph not in drawn:
                self._note(
                    number,
                    1,
                    f"'{glyph}' is not in the plan",
                    "Draw it on a floor cell, or remove this line",
                )

"""Draws the two grids of this folder, `terraces.csv` and `annexe.csv`: offices of our own making,
in the plain form of earlier studies (0 floor, 1 wall, 2 door).

    python tests/reference/maps.py
"""

from pathlib import Path
from random import Random

FLOOR, WALL, DOOR = 0, 1, 2
Grid = list[list[int]]


def carve(grid: Grid, left: int, top: int, right: int, bottom: int) -> None:
    """Make floor of all cells from `left`, `top` up to and including `right`, `bottom`."""
    for y in range(top, bottom + 1):
        for x in range(left, right + 1):
            grid[y][x] = FLOOR


def terraces(seed: int = 5) -> Grid:
    """Three hallways one below the other, joined at both ends, with rooms on both sides of each."""
    random, grid = Random(seed), [[WALL] * 87 for _ in range(47)]
    for hall in (8, 23, 38):
        carve(grid, 2, hall, 84, hall + 2)
        for top, bottom, door in ((hall - 6, hall - 2, hall - 1), (hall + 4, hall + 7, hall + 3)):
            left = 6
            while left < 74:
                right = min(left + random.randint(6, 11), 79)
                carve(grid, left, top, right, bottom)
                grid[door][random.randint(left + 1, right - 1)] = DOOR
                left = right + 2
    carve(grid, 2, 8, 4, 40)
    carve(grid, 82, 8, 84, 40)
    return grid


def annexe(seed: int = 8) -> Grid:
    """A broad hallway down the middle with wings to both sides, and rooms along each wing."""
    random, grid = Random(seed), [[WALL] * 75 for _ in range(45)]
    carve(grid, 35, 1, 38, 43)
    for hall in (10, 32):
        carve(grid, 2, hall, 72, hall + 1)
        for top, bottom, door in ((hall - 7, hall - 2, hall - 1), (hall + 3, hall + 9, hall + 2)):
            for start, end in ((2, 32), (41, 71)):
                left = start
                while left < end - 5:
                    right = left + random.randint(6, 9)
                    right = end if end - right < 8 else right
                    carve(grid, left, top, right, bottom)
                    grid[door][random.randint(left + 1, right - 1)] = DOOR
                    left = right + 2
    return grid


if __name__ == "__main__":
    for name, grid in (("terraces", terraces()), ("annexe", annexe())):
        rows = "\n".join(",".join(map(str, row)) for row in grid)
        Path(__file__).with_name(f"{name}.csv").write_text(f"{rows}\n", encoding="utf-8")

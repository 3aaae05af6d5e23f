"""A small office that the tests of the instructions walk through."""

from functools import cache

from game.coach.instructions import Pose, Scene
from game.world.building import Building
from game.world.geometry import Cell, Heading
from game.world.reading import parse_building
from game.world.settings import MissionSettings

OFFICE = """\
; Rooms round a hallway with one side passage.
name: Little Office

plan:
##############################
#......#.......#......#......#
#.*....#.H.o...#......#.A....#
#.G....#.......#..B...#....o.#
###+########+######+######+###
#............................#
#>...........................#
######+######..#######++######
#...........#..#.............#
#..C........#..#........D....#
#.......*...+..#.............#
#......o....#..#......o......#
#...........#..#.............#
#############..###############
#...............#....E.......#
#...............+...........*#
##############################

legend:
> = start facing east
* = red victim
o = blue victim
A = room Office A
B = room Records Room
C = room Copy Room
D = room Canteen
E = room Archive
G = room Post Room
H = room Store Room
"""


@cache
def office() -> Building:
    return parse_building(OFFICE, "office")


def scene(*waiting: Cell, building: Building | None = None) -> Scene:
    """The office with the victims in `waiting` still waiting; all of them where none is named."""
    building = building or office()
    sites = [site for site in building.victims if site.cell in waiting or not waiting]
    return Scene(building, {site.id: site for site in sites}, MissionSettings())


def goal_at(cell: Cell) -> str:
    return next(site.id for site in office().victims if site.cell == cell)


def pose(x: int, y: int, heading: Heading) -> Pose:
    return Pose((x, y), heading)


@cache
def poses() -> tuple[Pose, ...]:
    """Every cell of the office, facing every way."""
    cells = office().plan.cells(office().plan.walkable_mask)
    return tuple(Pose(cell, heading) for cell in cells for heading in Heading)

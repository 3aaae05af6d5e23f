"""What rooms are for: their names, how large they are, and what stands in them."""

from __future__ import annotations

from typing import NamedTuple

from game.world.generation import furniture
from game.world.generation.furniture import Arrangement


class Use(NamedTuple):
    """A room's name, the sizes that suit it (in cells), and how it is furnished."""

    name: str
    least: int
    most: int
    arrange: Arrangement


_ANY = 10_000
_SMALL, _MEDIUM, _LARGE = (0, 115), (95, 215), (185, _ANY)

_NAMES: tuple[tuple[tuple[int, int], Arrangement, str], ...] = (
    (_SMALL, furniture.booths, "Washroom, Cloakroom, Locker Room, Phone Room, Restroom"),
    (
        _SMALL,
        furniture.nothing,
        "Quiet Room, Nurse Room, Badge Office, Key Room, Vault, Spare Room",
    ),
    (_SMALL, furniture.screens, "First Aid Room, Dispatch, Loan Desk, Travel Desk, Help Desk"),
    (_SMALL, furniture.counter, "Pantry, Coffee Bar, Copy Room, Mail Room, Post Room"),
    (_SMALL, furniture.shelves, "Supply Room, Store Room, Tool Room, Lamp Store, Form Store"),
    (_MEDIUM, furniture.shelves, "Archive, Records Room, Map Room, Parts Store, Book Store"),
    (_MEDIUM, furniture.one_table, "Board Room, Meeting Room, Briefing Room, Council Room"),
    (_MEDIUM, furniture.desks, "Payroll Office, Tax Office, Legal Office, Accounts Office"),
    (_MEDIUM, furniture.desks, "Grants Office, Visa Office, Permit Office, Press Office"),
    (_MEDIUM, furniture.screens, "Audit Office, Host Office, Rent Office, Buying Office"),
    (_MEDIUM, furniture.screens, "Security Desk, Media Room, Editing Suite, Exam Room"),
    (_MEDIUM, furniture.machines, "Server Room, Plant Room, Boiler Room, Laundry, Print Shop"),
    (_MEDIUM, furniture.counter, "Kitchen, Gift Shop, Photo Lab, Water Lab, Repair Shop"),
    (_MEDIUM, furniture.tables, "Break Room, Staff Lounge, Tea Room, Craft Room, Card Room"),
    (_MEDIUM, furniture.nothing, "Music Room, Green Room, Studio, Waiting Room, Garden Room"),
    (_LARGE, furniture.workplaces, "Sales Floor, Call Centre, Design Studio, Survey Office"),
    (_LARGE, furniture.workplaces, "Planning Office, Project Room, News Room, Claims Office"),
    (_LARGE, furniture.desks, "Training Room, Drawing Office, Lecture Room, Typing Room"),
    (_LARGE, furniture.tables, "Canteen, Dining Hall, Cafe, Events Room"),
    (_LARGE, furniture.shelves, "Library, Warehouse, Sample Room"),
    (_LARGE, furniture.machines, "Workshop, Test Lab, Research Lab, Gym"),
    (_LARGE, furniture.one_table, "Conference Room, Model Room"),
    (_LARGE, furniture.pillars, "Ballroom, Courtyard, Trophy Room"),
)
USES = tuple(
    Use(name, *sizes, arrange) for sizes, arrange, names in _NAMES for name in names.split(", ")
)
LOBBIES = tuple(
    Use(name, 0, _ANY, furniture.pillars)
    for name in ("Lobby", "Reception", "Foyer", "Atrium", "Entrance Hall", "Front Desk")
)

_FIRST = """
Alder, Aspen, Beacon, Birch, Bridge, Canal, Castle, Cedar, Chapel, Corner, Crown, Elm, Ferry,
Garden, Hazel, Hill, Ivy, Juniper, Lantern, Larch, Laurel, Linden, Maple, Market, Meadow, Mill,
Oak, Orchard, Park, Quay, River, Rowan, Sable, Spring, Station, Stone, Thorn, Tower, Vine,
Willow
"""
BUILDINGS = tuple(
    f"{first} {second}"
    for first in " ".join(_FIRST.split()).split(", ")
    for second in ("House", "Court", "Place", "Point", "Building", "Exchange")
)

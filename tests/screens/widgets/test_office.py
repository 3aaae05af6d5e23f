"""The office view: it shows the Observation, all of it, and nothing else."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st

from game.screens.widgets.camera import MARGIN, Camera
from game.screens.widgets.canvas import plain, width
from game.screens.widgets.glyphs import LARGE, PLAIN, SOLID, Glyph, Kind, player_kind, rows_of
from game.screens.widgets.office import (
    in_reach,
    kinds,
    labels,
    line_row,
    line_rows,
    window_lines,
)
from game.world import load_building
from game.world.building import Building, Room
from game.world.events import Action
from game.world.geometry import Cell
from game.world.mission import COMPASS_ACTIONS, Mission
from game.world.observation import Observation
from game.world.settings import MissionSettings

HARBOUR = load_building("harbour")
walks = st.lists(st.sampled_from([*COMPASS_ACTIONS, Action.TRIAGE]), max_size=120)


def walked(building: Building, actions: list[Action]) -> Observation:
    mission = Mission(building, MissionSettings())
    for number, action in enumerate(actions):
        mission.step(action, 200 * number)
    return mission.observation()


def picture(observation: Observation, columns: int = 40, rows: int = 20) -> list[str]:
    plan = observation.plan
    size = plan.width, plan.height
    camera = Camera.centred(columns, rows, observation.position, size)
    return plain(line_row(line, camera, PLAIN) for line in window_lines(observation, camera))


@settings(max_examples=25)
@given(walks)
def test_unseen_victims_and_names_do_not_show(actions: list[Action]) -> None:
    mission = Mission(HARBOUR, MissionSettings())
    for number, action in enumerate(actions):
        mission.step(action, 200 * number)
    seen = {v.cell for v in (*mission.observation().victims, *mission.observation().remembered)}
    named = {room.name for room in mission.observation().rooms}
    stripped = replace(
        HARBOUR,
        victims=tuple(v for v in HARBOUR.victims if v.cell in seen),
        rooms=tuple(
            room if room.name in named else replace(room, name="Elsewhere")
            for room in HARBOUR.rooms
        ),
    )
    assert picture(walked(stripped, actions)) == picture(mission.observation())


@settings(max_examples=25)
@given(walks)
def test_every_cell_shows_its_kind(actions: list[Action]) -> None:
    observation = walked(HARBOUR, actions)
    cells, plan = kinds(observation), observation.plan
    special = {v.cell for v in (*observation.victims, *observation.remembered)}
    special.add(observation.position)
    for index, kind in enumerate(cells):
        if plan.cell(index) in special:
            assert kind >= Kind.RED
        elif not observation.explored >> index & 1:
            assert kind == Kind.DARK
        else:
            lit = observation.visible >> index & 1
            assert kind == plan.tiles[index] + (Kind.FLOOR if lit else Kind.SEEN_FLOOR)


@settings(max_examples=25)
@given(walks)
def test_names_stand_on_lit_floor_near_their_label(actions: list[Action]) -> None:
    observation = walked(HARBOUR, actions)
    cells, plan = kinds(observation), observation.plan
    for y, label in labels(observation, cells).items():
        over = {(column // 2, y) for column in range(label.column, label.column + len(label.text))}
        assert all(cells[plan.index(cell)] == Kind.FLOOR for cell in over)
        assert any(
            label.text.rstrip("…") in room.name and abs(room.label[1] - y) <= 2
            for room in observation.rooms
        )


in_rooms = st.sampled_from([(r, cell) for r in HARBOUR.rooms for cell in r.cells])


@settings(max_examples=100)
@given(in_rooms, st.sampled_from(["Ab", "Board Room", "A very much longer name of a room"]))
def test_wherever_one_stands_in_a_room_its_name_covers_nothing_but_lit_floor(
    place: tuple[Room, Cell], name: str
) -> None:
    room, here = place
    rooms = tuple(replace(r, name=name) if r == room else r for r in HARBOUR.rooms)
    inside = replace(HARBOUR, start=here, rooms=rooms)
    observation = Mission(inside, MissionSettings()).observation()
    cells, plan = kinds(observation), observation.plan
    names = labels(observation, cells)
    for y, (column, text) in names.items():
        assert all(
            cells[plan.index(((column + n) // 2, y))] == Kind.FLOOR for n in range(len(text))
        )
    drawn = "".join(label.text for label in names.values())
    camera = Camera.centred(40, 20, here, (plan.width, plan.height))
    rows = [line_row(line, camera, SOLID) for line in window_lines(observation, camera)]
    assert sorted(drawn) == sorted("".join(t for row in rows for t, s in row if s == "label"))


def steps_beside(room: Room) -> list[Cell]:
    """The cells two to four above or below a label, so that its row is free."""
    x, y = room.label
    return [cell for cell in room.cells if abs(cell[0] - x) <= 1 and 2 <= abs(cell[1] - y) <= 4]


@settings(max_examples=25)
@given(walks, st.sampled_from(["図書室", "第2 会議室", "コンピューター室とても長い名前"]))
def test_names_in_wide_characters_shift_nothing(actions: list[Action], name: str) -> None:
    renamed = replace(
        HARBOUR,
        rooms=tuple(
            replace(room, name=f"{name}{number}") for number, room in enumerate(HARBOUR.rooms)
        ),
    )
    observation = walked(renamed, actions)
    size = observation.plan.width, observation.plan.height
    camera = Camera.centred(40, 20, observation.position, size)
    shown = [line_row(line, camera, PLAIN) for line in window_lines(observation, camera)]
    nameless = observation._replace(rooms=())
    without = [line_row(line, camera, PLAIN) for line in window_lines(nameless, camera)]
    assert [width(row) for row in shown] == [width(row) for row in without]
    assert "\0" not in "".join(plain(shown))


def test_a_name_keeps_its_place_while_it_fits_there() -> None:
    room = HARBOUR.room("Test Lab")
    places = set()
    for here in steps_beside(room):
        observation = Mission(replace(HARBOUR, start=here), MissionSettings()).observation()
        places.add(tuple(labels(observation, kinds(observation)).items()))
    assert len(steps_beside(room)) > 5 and len(places) == 1


def test_a_name_moves_aside_for_the_rescuer(ward: Building) -> None:
    room = ward.room("Records Room")
    at_label = replace(ward, start=room.label)
    observation = Mission(at_label, MissionSettings()).observation()
    names = labels(observation, kinds(observation))
    assert " ".join(label.text for _, label in sorted(names.items())) == "Records Room"


def test_standing_on_a_victim_shows_both(ward: Building) -> None:
    victim = ward.victims[0]
    observation = Mission(replace(ward, start=victim.cell), MissionSettings()).observation()
    kind = kinds(observation)[ward.plan.index(victim.cell)]
    assert kind == player_kind(observation.heading, victim.severity)
    assert kind != player_kind(observation.heading)


def test_a_treated_victim_stands_out(ward: Building) -> None:
    victim = ward.victims[0]
    beside = victim.cell[0] + 1, victim.cell[1]
    mission = Mission(replace(ward, start=beside), MissionSettings())
    before = kinds(mission.observation())[ward.plan.index(victim.cell)]
    mission.step(Action.TRIAGE, 0)
    treated = kinds(mission.observation())[ward.plan.index(victim.cell)]
    mission.step(None, 10_000)
    rescued = kinds(mission.observation())[ward.plan.index(victim.cell)]
    assert len({before, treated, rescued}) == 3


def test_every_kind_is_told_by_its_shape_where_colours_are_few() -> None:
    drawn = [kind for kind in Kind if kind not in (Kind.DARK_WALL, Kind.DARK_DOOR)]
    same_shape = {Kind.SEEN_RED, Kind.SEEN_BLUE, Kind.SEEN_RESCUED, Kind.SEEN_EXPIRED}
    texts = [
        PLAIN[kind].text for kind in drawn if kind not in same_shape and kind < Kind.TREATED_RED
    ]
    assert len(texts) == len(set(texts))
    assert all(len(glyph.text) == 2 for glyph in (*PLAIN, *SOLID))


def test_every_kind_is_told_apart_where_colours_are_many() -> None:
    looks = [SOLID[kind] for kind in Kind if kind not in (Kind.DARK_WALL, Kind.DARK_DOOR)]
    assert len(looks) == len(set(looks))


@settings(max_examples=25)
@given(walks)
def test_what_is_in_reach_is_what_triage_would_treat(actions: list[Action]) -> None:
    mission = Mission(HARBOUR, MissionSettings())
    for number, action in enumerate(actions):
        mission.step(action, 200 * number)
    site = mission.victim_in_reach()
    assert in_reach(mission.observation()) == (site.cell if site else None)


positions = st.tuples(st.integers(0, 94), st.integers(0, 51))


@given(st.integers(14, 60), st.integers(14, 60), st.lists(positions, min_size=1, max_size=30))
def test_the_camera_keeps_the_field_of_view_in_the_window(
    columns: int, rows: int, places: list[Cell]
) -> None:
    size = (95, 52)
    camera = Camera.centred(columns, rows, places[0], size)
    for x, y in places:
        camera = camera.follow((x, y), size)
        for at, start, window, full in (
            (x, camera.left, columns, size[0]),
            (y, camera.top, rows, size[1]),
        ):
            lowest, highest = max(0, at - MARGIN), min(full - 1, at + MARGIN)
            if window > 2 * MARGIN:
                assert start <= lowest and highest < start + window


def test_the_camera_stands_still_in_its_middle() -> None:
    camera = Camera.centred(40, 20, (50, 25), (95, 52))
    assert camera.follow((55, 27), (95, 52)) is camera


def test_a_plan_smaller_than_the_window_is_centred(ward: Building) -> None:
    observation = Mission(ward, MissionSettings()).observation()
    rows = picture(observation, 41, 25)
    assert not rows[0].strip() and not rows[-1].strip()
    camera = Camera.centred(41, 25, observation.position, (21, 5))
    lines = window_lines(observation, camera)
    assert all(width(line_row(line, camera, SOLID)) in (20, 62) for line in lines), (
        "margin, or margin and plan"
    )


@settings(max_examples=25)
@given(walks, st.sampled_from([PLAIN, SOLID]))
def test_large_cells_show_the_same_as_normal_ones(
    actions: list[Action], glyphs: tuple[Glyph, ...]
) -> None:
    observation = walked(HARBOUR, actions)
    size = HARBOUR.plan.width, HARBOUR.plan.height
    camera = Camera.centred(25, 20, observation.position, size)
    both = rows_of(glyphs, LARGE)
    normal = window_lines(observation, camera)
    large = window_lines(observation, camera, LARGE)
    assert [line.cells for line in large] == [line.cells for line in normal]
    for line in large:
        rows = line_rows(line, camera, both, LARGE)
        assert len(rows) == 2
        assert {width(row) for row in rows} == {4 * len(line.cells)}
        if line.label is not None:
            assert line.label.text in plain(rows)[0]
            assert line.label.text not in plain(rows)[1]


def test_in_large_cells_every_kind_has_a_shape_of_its_own() -> None:
    for glyphs in (PLAIN, SOLID):
        upper, lower = rows_of(glyphs, LARGE)
        drawn = {kind: (upper[kind], lower[kind]) for kind in Kind if glyphs[kind].text.strip()}
        assert all(len(one.text) == len(other.text) == 4 for one, other in drawn.values())
        assert len(set(drawn.values())) == len({glyphs[kind] for kind in drawn})

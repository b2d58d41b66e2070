"""What a floor offers robots of a width: what they cannot come to and why, and where one is in another's way."""

from dataclasses import replace

import pytest

from editor.language.site.surroundings import PlaceFacts
from execution.floor.floor_check import check_floor
from execution.traffic.layout import make_layout
from execution.traffic.messages import FloorZone
from registry.floorplan.lattice import Lattice
from registry.floorplan.plan import FREE, OCCUPIED, Grid
from tests.kit import demo_floor
from vipo_device.protocol.description import Pose, Size

CELL = 0.05
ROBOT = next(device for device in demo_floor.devices() if device.kind == "robot")
MACHINE = next(device for device in demo_floor.devices() if device.kind == "machine")


def floor_of(width_m, height_m, *walls):
    """A floor with a rim and walls (x1, y1, x2, y2) in metres."""
    columns, rows = round(width_m / CELL), round(height_m / CELL)
    cells = bytearray([FREE]) * (columns * rows)
    rim = ((0, 0, width_m, CELL), (0, height_m - CELL, width_m, height_m), (0, 0, CELL, height_m))
    for x1, y1, x2, y2 in (*rim, (width_m - CELL, 0, width_m, height_m), *walls):
        for row in range(round(y1 / CELL), round(y2 / CELL)):
            for column in range(round(x1 / CELL), round(x2 / CELL)):
                cells[row * columns + column] = OCCUPIED
    return Grid(columns, rows, CELL, 0.0, 0.0, bytes(cells))


def machine(name, x, y, width_m=1.0, depth_m=1.0):
    return replace(MACHINE, id=name, name=name.title(), pose=Pose(x, y), size=Size(width_m, depth_m, 1.0))


def place(name, x, y, kind="point"):
    return PlaceFacts(name, name.title(), kind, x, y, 0.0 if kind == "dock" else None)


def zone(rule, x1, y1, x2, y2, name="z", **more):
    return FloorZone(f"site/{name}", name, rule, ((x1, y1), (x2, y1), (x2, y2), (x1, y2)), **more)


def check(grid, *, machines=(), places=(), zones=(), radius_m=0.18):
    layout = make_layout(grid, [replace(ROBOT, radius_m=radius_m), *machines], places, zones)
    return check_floor(grid, layout, places)


def codes(found):
    return [(each.code, each.target, each.other) for each in found.findings]


def test_the_demos_floor_is_sound():
    found = check_floor(demo_floor.grid(), demo_floor.layout(), demo_floor.places())
    assert (found.findings, found.machines, found.places) == ((), (7, 7), (3, 3))


def test_a_machine_behind_a_door_that_is_too_narrow_is_named_with_what_stands_there():
    """A room of 4 x 4 m whose door, between a wall and a shelf, is half a metre wide."""
    grid = floor_of(10, 4, (5, 0, 5.2, 1.0), (5, 2.5, 5.2, 4))
    shelf = machine("shelf", 5.1, 2.0, 0.4, 1.0)
    press = machine("press", 8.0, 3.0)
    found = check(grid, machines=(shelf, press), places=(place("start", 1.5, 1.0),), radius_m=0.3)
    (narrow,) = [each for each in found.findings if each.target == "press"]
    assert narrow.code == "too_narrow"
    assert narrow.width_m == pytest.approx(0.5, abs=2 * CELL)
    assert narrow.needs_m == pytest.approx(0.7)
    assert set(narrow.beside) == {None, "shelf"}
    assert narrow.at == pytest.approx((5.1, 1.25), abs=0.2)
    assert found.machines == (1, 2)


def test_a_machine_with_walls_all_around_has_no_way_and_one_in_a_corner_no_room():
    shut = floor_of(10, 4, (5, 0, 5.2, 4))
    found = check(shut, machines=(machine("press", 8.5, 2.0),), places=(place("a", 1, 1), place("b", 3, 3)))
    assert codes(found) == [("no_way", "press", None)] or codes(found)[0][0] == "no_way"
    tight = floor_of(6, 4, (3.4, 1.2, 5.8, 1.4), (3.4, 2.6, 5.8, 2.8), (3.4, 1.2, 3.6, 2.8))
    found = check(tight, machines=(machine("press", 4.7, 2.0, 2.0, 1.0),), places=(place("a", 1, 1),))
    assert codes(found) == [("no_room", "press", None)]
    assert found.findings[0].needs_m == pytest.approx(0.4)


def test_a_place_at_a_wall_has_no_room():
    found = check(floor_of(6, 4), places=(place("a", 1, 1), place("corner", 0.15, 2.0)))
    assert codes(found) == [("no_room", "corner", None)]
    assert found.places == (1, 2)


def test_rooms_are_no_places_to_come_to():
    assert check(floor_of(6, 4), places=(place("a", 1, 1), place("hall", 0.1, 0.1, "room"))).places == (1, 1)


def test_a_way_that_cells_miss_is_told_as_such():
    """Two doors whose lines lie half a cell apart: no lattice has a line through both."""
    walls = [(x, y1, x + 0.2, y2) for x, door in ((4, 2.0), (8, 2.47)) for y1, y2 in ((0, door), (door + 1.0, 5))]
    grid = floor_of(12, 5, *walls)
    found = check(grid, places=(place("a", 2, 2.5), place("b", 10, 2.5), place("c", 6, 2.5)), radius_m=0.4)
    assert {code for code, *_ in codes(found)} <= {"off_lattice"}


def test_zones_that_keep_out_or_cut_off_are_named():
    grid = floor_of(12, 4)
    places = (place("a", 1.5, 2), place("b", 3, 2), place("c", 10, 2))
    assert codes(check(grid, places=places, zones=(zone("keep_out", 9, 1, 11, 3, "spill"),))) == [
        ("keep_out", "c", "site/spill")
    ]
    assert codes(check(grid, places=places, zones=(zone("keep_out", 5, 0, 6, 4, "belt"),))) == [
        ("cut_off", "c", "site/belt")
    ]
    two = (zone("keep_out", 5, 0, 6, 4, "one"), zone("keep_out", 7, 0, 8, 4, "two"))
    assert codes(check(grid, places=places, zones=two)) == [("cut_off", "c", None)]


@pytest.mark.parametrize("dead_end", ["a", "m", "z"], ids=["its name first", "between", "last"])
@pytest.mark.parametrize(("heading", "code"), [(0.0, "no_way_out"), (180.0, "no_way_in")])
def test_one_way_zones_that_nobody_comes_through_or_back(heading, code, dead_end):
    zones = (zone("one_way", 5, -1, 7, 5, "belt", heading_deg=heading),)
    others = (place("b", 1.5, 2), place("c", 1.5, 1), place("x", 3, 2))
    found = check(floor_of(12, 4), places=(*others, place(dead_end, 10, 2)), zones=zones)
    assert codes(found) == [(code, dead_end, None)]
    assert found.places == (3, 4)


def test_of_as_many_places_on_both_sides_of_a_one_way_zone_those_with_the_first_name_are_sound():
    zones = (zone("one_way", 5, -1, 7, 5, "belt", heading_deg=0.0),)
    found = check(floor_of(12, 4), places=(place("a", 10, 2), place("b", 1.5, 2)), zones=zones)
    assert codes(found) == [("no_way_in", "b", None)]


def test_of_several_dead_ends_behind_one_way_zones_each_is_told():
    zones = (
        zone("one_way", 4, -1, 5, 5, "west", heading_deg=180.0),
        zone("one_way", 11, -1, 12, 5, "east", heading_deg=0.0),
    )
    places = (place("a", 1.5, 2), place("b", 14, 2), place("c", 7, 2), place("d", 9, 2))
    found = check(floor_of(16, 4), places=places, zones=zones)
    assert codes(found) == [("no_way_out", "a", None), ("no_way_out", "b", None)]


def test_docks_that_only_one_robot_can_take_at_a_time():
    docks = (place("dock1", 1.5, 2, "dock"), place("dock2", 1.95, 2, "dock"), place("dock3", 4, 2, "dock"))
    found = check(floor_of(6, 4), places=docks)
    assert codes(found) == [("together", "dock1", "dock2")]
    assert found.findings[0].width_m == pytest.approx(0.45)
    assert found.places == (3, 3)


def test_a_dock_in_a_doorway_is_in_the_way_to_what_lies_behind():
    grid = floor_of(10, 4, (5, 0, 5.2, 1.5), (5, 2.5, 5.2, 4))
    places = (place("a", 1.5, 2), place("b", 8, 2), place("dock", 4.6, 2, "dock"), place("c", 2.5, 3), place("d", 3, 1))
    found = check(grid, places=places)
    assert codes(found) == [("in_the_way", "b", "dock")]


def test_the_width_of_zones_for_one_robot_at_a_time_is_told():
    grid = floor_of(10, 4, (4, 0, 6, 1.5), (4, 2.5, 6, 4))
    found = check(grid, places=(place("a", 1, 2),), zones=(zone("one_at_a_time", 3, -1, 7, 5, robots=1),))
    (width,) = found.zones
    assert (width.zone, width.width_m) == ("z", pytest.approx(1.0, abs=2 * CELL))
    assert width.needs_m == pytest.approx(0.5 + 2 * 0.28)


def test_a_floor_on_which_nobody_fits_and_one_without_anything():
    nothing = check(floor_of(6, 4))
    assert (nothing.findings, nothing.machines, nothing.places) == ((), (0, 0), (0, 0))
    tiny = check(floor_of(1, 1), machines=(machine("press", 0.5, 0.5, 0.4, 0.4),), places=(place("a", 0.2, 0.2),))
    assert {each.target for each in tiny.findings} == {"press", "a"}


def test_how_often_the_floor_is_looked_at_does_not_grow_with_what_is_cut_off(monkeypatch):
    """Twenty zones cut off two hundred places: who draws them must not keep a process busy for hours."""
    looks = []
    distances = Lattice.distances
    monkeypatch.setattr(Lattice, "distances", lambda *given, **more: looks.append(1) or distances(*given, **more))
    places = (
        *(place(f"near{n}", 1 + n % 15 / 10, 1 + n // 15 / 10) for n in range(250)),
        *(place(f"far{n}", 17 + n % 20 / 10, 1 + n // 20 / 10, "dock") for n in range(200)),
    )
    zones = [zone("keep_out", 4 + n / 2, 0, 4.3 + n / 2, 4, f"zone{n}") for n in range(20)]
    found = check(floor_of(22, 4), places=places, zones=zones)
    assert {each.code for each in found.findings if each.target.startswith("far")} == {"cut_off"}
    assert {each.other for each in found.findings if each.code == "cut_off"} == {None}
    assert len(looks) < 60

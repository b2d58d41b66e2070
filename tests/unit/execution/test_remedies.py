"""What would mend a finding of the floor check: each remedy is tried, and the floor is sound with it."""

from dataclasses import replace

import pytest

from execution.floor.floor_check import check_floor
from execution.floor.remedies import RINGS, STEP_M, CheckedFloor, find_remedies
from execution.traffic.layout import make_layout
from registry.floorplan.plan import FREE
from tests.kit import demo_floor
from tests.unit.execution.test_floor_check import CELL, ROBOT, floor_of, machine, place, zone

FARTHEST_M = RINGS[-1] * STEP_M


def open_floor(width_m, height_m, *walls):
    """A floor that is free to the edge of its map."""
    shut = floor_of(width_m, height_m, *walls)
    cells = bytearray(shut.cells)
    for row in range(shut.height):
        for column in range(shut.width):
            if row in (0, shut.height - 1) or column in (0, shut.width - 1):
                cells[row * shut.width + column] = FREE
    return replace(shut, cells=bytes(cells))


def checked(grid, *, machines=(), places=(), zones=(), radius_m=0.18):
    layout = make_layout(grid, [replace(ROBOT, radius_m=radius_m), *machines], places, zones)
    return CheckedFloor(grid, layout, tuple(places), check_floor(grid, layout, places))


def codes(floor):
    return [(each.code, each.target, each.other) for each in floor.check.findings]


def remedies_of(floor, code, target):
    (finding,) = [each for each in floor.check.findings if (each.code, each.target) == (code, target)]
    return find_remedies(floor, finding)


def test_docks_that_are_too_near_to_each_other_are_moved_apart_by_little():
    docks = (place("d1", 2.0, 2.0, "dock"), place("d2", 2.6, 2.0, "dock"))
    first, second = remedies_of(checked(floor_of(10, 6), places=docks), "together", "d1")
    assert (first.target, second.target) == ("d2", "d1")
    assert first.by_m <= second.by_m <= FARTHEST_M
    moved = (docks[0], place("d2", *first.at, "dock"))
    assert codes(checked(floor_of(10, 6), places=moved)) == []
    nearer = (docks[0], place("d2", 2.6 + first.by_m - CELL, 2.0, "dock"))
    assert codes(checked(floor_of(10, 6), places=nearer)) == [("together", "d1", "d2")]


def test_a_place_at_a_wall_is_moved_off_it():
    floor = checked(floor_of(10, 6), places=(place("table", 0.1, 3.0),))
    (remedy,) = remedies_of(floor, "no_room", "table")
    assert remedy.at == pytest.approx((0.3, 3.0), abs=CELL)
    assert codes(checked(floor_of(10, 6), places=(place("table", *remedy.at),))) == []


def test_a_shelf_beside_a_door_is_moved_away_from_the_wall_by_what_is_lacking():
    grid = floor_of(10, 4, (5, 0, 5.2, 1.0), (5, 2.5, 5.2, 4))
    shelf, press = machine("shelf", 5.6, 2.1, 0.4, 1.0), machine("press", 8.0, 3.0)
    floor = checked(grid, machines=(shelf, press), places=(place("start", 1.5, 1.0),), radius_m=0.3)
    (narrow,) = [each for each in floor.check.findings if each.target == "press"]
    (remedy,) = find_remedies(floor, narrow)
    assert remedy.target == "shelf"
    assert narrow.needs_m - narrow.width_m - CELL <= remedy.by_m <= narrow.needs_m - narrow.width_m + 4 * CELL
    moved = replace(shelf, pose=replace(shelf.pose, x=remedy.at[0], y=remedy.at[1]))
    after = checked(grid, machines=(moved, press), places=(place("start", 1.5, 1.0),), radius_m=0.3)
    assert codes(after) == []


def test_a_machine_is_not_moved_into_a_wall_or_another_machine():
    grid = floor_of(10, 4, (5, 0, 5.2, 1.0), (5, 2.5, 5.2, 4))
    shelf = machine("shelf", 5.1, 2.0, 0.4, 1.0)
    floor = checked(grid, machines=(shelf, machine("press", 8.0, 3.0)), places=(place("a", 1.5, 1.0),), radius_m=0.3)
    assert remedies_of(floor, "too_narrow", "press") == ()


def test_a_dock_in_the_only_way_stays_where_a_metre_does_not_help():
    aisle = floor_of(10, 4, (3, 1.5, 9.8, 4))
    places = (place("d", 5, 0.8, "dock"), place("end", 9, 0.8), place("s", 1, 1))
    floor = checked(aisle, places=places, machines=(machine("press", 1, 3),))
    assert remedies_of(floor, "in_the_way", "end") == ()


def test_a_dock_before_a_niche_is_moved_out_of_the_way():
    """The way to `end` is 0.8 m wide and begins 1.5 m above; the dock stands in front of it."""
    wide = floor_of(10, 6, (3, 1.5, 5.8, 6), (6.6, 1.5, 9.95, 6))
    places = (place("d", 6.2, 1.4, "dock"), place("end", 6.2, 4.5), place("s", 1, 1), place("t", 1, 4))
    (remedy, *_) = remedies_of(checked(wide, places=places), "in_the_way", "end")
    assert remedy.target == "d"
    assert 0.1 < remedy.by_m <= FARTHEST_M
    assert codes(checked(wide, places=(place("d", *remedy.at, "dock"), *places[1:]))) == []


def test_rooms_are_in_nobodys_way():
    docks = (place("d1", 2.0, 2.0, "dock"), place("d2", 2.6, 2.0, "dock"))
    rooms = (place("hall", 2.8, 2.0, "room"), place("bay", 1.8, 2.2, "room"))
    alone, among = (
        remedies_of(checked(floor_of(10, 6), places=each), "together", "d1") for each in (docks, (*docks, *rooms))
    )
    assert among == alone != ()


def test_a_place_stays_in_its_room_and_a_machine_on_the_map():
    parted = floor_of(8, 4, (5.0, 0, 5.1, 4))
    places = (place("dock", 5.35, 2.0, "dock"), place("a", 1, 1), place("b", 1, 3), place("c", 3, 1))
    assert remedies_of(checked(parted, places=places), "no_way", "dock") == ()
    grid = open_floor(10, 4, (5, 0, 5.2, 1.0))
    shelf, press = machine("shelf", 5.1, 1.85, 0.4, 0.7), machine("press", 8.0, 3.0)
    for remedy in (
        each
        for finding in checked(grid, machines=(shelf, press), radius_m=0.9).check.findings
        for each in find_remedies(checked(grid, machines=(shelf, press), radius_m=0.9), finding)
    ):
        assert 0.35 <= remedy.at[1] <= 3.65


def test_a_remedy_for_wide_robots_brings_no_finding_for_the_sites_own():
    """Beside a niche in which only small robots stand: what helps wide ones must not push the place off its own."""
    grid = floor_of(10, 6)
    places = (place("d1", 2.0, 2.0, "dock"), place("d2", 3.4, 2.0, "dock"))
    wide, own = checked(grid, places=places, radius_m=0.5), checked(grid, places=places)
    (finding,) = wide.check.findings
    tried = []

    class Fussy(CheckedFloor):
        """The site's own robots find something new wherever anything is moved to the right."""

        @property
        def found(self):
            tried.append(True)
            return frozenset()

    assert find_remedies(wide, finding, own) == find_remedies(wide, finding)
    near = (*places, place("d3", 3.9, 2.0, "dock"))
    strict = Fussy(grid, checked(grid, places=near).layout, near, checked(grid, places=near).check)
    assert find_remedies(wide, finding, strict) == ()
    assert tried


def test_a_search_ends_when_its_time_is_over():
    docks = (place("d1", 2.0, 2.0, "dock"), place("d2", 2.6, 2.0, "dock"))
    floor = checked(floor_of(10, 6), places=docks)
    (finding,) = floor.check.findings
    assert find_remedies(floor, finding, is_over=lambda: True) == ()


def test_what_zones_do_has_no_move():
    machines = (machine("press", 8.0, 3.0),)
    floor = checked(
        floor_of(10, 4), machines=machines, places=(place("a", 1, 1),), zones=(zone("keep_out", 6, 1, 9.9, 3.9),)
    )
    assert [find_remedies(floor, each) for each in floor.check.findings] == [()] * len(floor.check.findings)
    assert floor.check.findings


def test_each_remedy_of_the_demos_floor_mends_its_finding_and_brings_no_other():
    """For robots 1.2 m wide; two of the machines that no lines lead to, and the docks."""
    devices = [replace(each, radius_m=0.6) if each.kind == "robot" else each for each in demo_floor.devices()]

    def look(devices, places):
        layout = make_layout(demo_floor.grid(), devices, places)
        return CheckedFloor(
            demo_floor.grid(), layout, tuple(places), check_floor(demo_floor.grid(), layout, tuple(places))
        )

    floor, count = look(devices, demo_floor.places()), 0
    tried = {"itemInventory01", "paintMixer01", "dock1", "dock2"}
    for finding in (each for each in floor.check.findings if each.target in tried):
        for remedy in find_remedies(floor, finding):
            x, y = remedy.at
            moved = [replace(d, pose=replace(d.pose, x=x, y=y)) if d.id == remedy.target else d for d in devices]
            places = [replace(p, x=x, y=y) if p.id == remedy.target else p for p in demo_floor.places()]
            after = codes(look(moved, places))
            assert (finding.code, finding.target, finding.other) not in after
            assert set(after) <= set(codes(floor))
            count += 1
    assert count >= 3

"""Where the way between two parts of a floor is narrowest, and how wide ways through a polygon are."""

import pytest

from registry.floorplan import bottlenecks
from registry.floorplan.bottlenecks import find_bottlenecks, width_through
from registry.floorplan.lattice import Ground
from registry.floorplan.plan import OCCUPIED, UNKNOWN, Grid, clearance_m

CELL = 0.05


def floor_of(width_m, height_m, *walls, unknown=()):
    """A floor with walls (x1, y1, x2, y2) in metres."""
    columns, rows = round(width_m / CELL), round(height_m / CELL)
    cells = bytearray(columns * rows)
    for kind, boxes in ((OCCUPIED, walls), (UNKNOWN, unknown)):
        for x1, y1, x2, y2 in boxes:
            for row in range(round(y1 / CELL), round(y2 / CELL)):
                for column in range(round(x1 / CELL), round(x2 / CELL)):
                    cells[row * columns + column] = kind
    return Grid(columns, rows, CELL, 0.0, 0.0, bytes(cells))


def ground_of(grid, radius_m=0.2):
    return Ground(grid, clearance_m(grid), radius_m)


def with_door(low_m, high_m, thick_m=0.2):
    return floor_of(8, 4, (4, 0, 4 + thick_m, low_m), (4, high_m, 4 + thick_m, 4))


def test_a_door_that_is_wide_enough_keeps_nobody():
    ground = ground_of(with_door(1.5, 2.5))
    assert find_bottlenecks(ground, [(1.0, 1.0)], (7.0, 1.0), 0.8) == [None]


@pytest.mark.parametrize("width_m", [0.25, 0.45, 0.65, 0.75])
@pytest.mark.parametrize("thick_m", [0.1, 0.5, 1.5])
def test_a_door_that_is_too_narrow_is_found_with_its_width_and_both_sides(width_m, thick_m):
    ground = ground_of(with_door(1.5, 1.5 + width_m, thick_m))
    (found,) = find_bottlenecks(ground, [(1.0, 3.5)], (7.0, 0.5), 0.8)
    assert found.width_m == pytest.approx(width_m, abs=CELL + 1e-6)
    assert 4.0 - CELL <= found.x <= 4.0 + thick_m + CELL
    assert 1.5 <= found.y <= 1.5 + width_m
    assert len(found.sides) == 2
    low, high = sorted(y for _, y in found.sides)
    assert low == pytest.approx(1.5, abs=CELL)
    assert high == pytest.approx(1.5 + width_m, abs=CELL)


def test_of_two_doors_one_behind_the_other_the_narrower_is_told():
    grid = floor_of(9, 4, (3, 0, 3.2, 1), (3, 1.55, 3.2, 4), (6, 0, 6.2, 2), (6, 2.35, 6.2, 4))
    (found,) = find_bottlenecks(ground_of(grid), [(1.0, 3.0)], (8.0, 3.0), 0.8)
    assert found.width_m == pytest.approx(0.35, abs=CELL)
    assert 6.0 - CELL <= found.x <= 6.2 + CELL


def test_of_two_doors_side_by_side_the_wider_is_told():
    grid = floor_of(8, 4, (4, 0, 4.2, 1), (4, 1.3, 4.2, 2.5), (4, 3.05, 4.2, 4))
    (found,) = find_bottlenecks(ground_of(grid), [(1.0, 1.1)], (7.0, 1.1), 0.8)
    assert found.width_m == pytest.approx(0.55, abs=CELL)
    assert 2.5 <= found.y <= 3.05


def test_where_no_way_leads_the_width_is_nothing():
    grid = floor_of(8, 4, (4, 0, 4.2, 4))
    (found,) = find_bottlenecks(ground_of(grid), [(1.0, 1.0)], (7.0, 1.0), 0.8)
    assert (found.width_m, found.x, found.y) == (0.0, 1.0, 1.0)


def test_floor_that_nobody_has_seen_is_as_a_wall():
    grid = floor_of(8, 4, unknown=[(4, 0, 4.2, 4)])
    assert find_bottlenecks(ground_of(grid), [(1.0, 1.0)], (7.0, 1.0), 0.8)[0].width_m == 0.0


def test_a_place_off_the_map_or_in_a_wall_has_no_way():
    ground = ground_of(with_door(1.5, 2.5))
    found = find_bottlenecks(ground, [(-3.0, 1.0), (4.1, 1.0), (1.0, 1.0)], (7.0, 1.0), 0.8)
    assert [each and each.width_m for each in found] == [0.0, 0.0, None]


def test_a_place_in_a_nook_has_its_own_bottleneck():
    """The way from it is narrow from the first cell on."""
    grid = floor_of(8, 4, (0, 1.0, 3, 1.2), (0, 1.5, 3, 1.7))
    (found,) = find_bottlenecks(ground_of(grid), [(1.0, 1.35)], (7.0, 3.0), 0.8)
    assert found.width_m == pytest.approx(0.3, abs=CELL)
    assert found.x <= 3.1


@pytest.mark.parametrize("width_m", [0.6, 1.0, 1.35])
def test_the_width_through_a_zone_is_that_of_its_narrowest_spot(width_m):
    """A corridor of 2 m along x, narrowed between x = 3 and 4."""
    grid = floor_of(8, 2, (3, 0, 4, 1 - width_m / 2), (3, 1 + width_m / 2, 4, 2))
    zone = ((2.0, -1.0), (5.0, -1.0), (5.0, 3.0), (2.0, 3.0))
    assert width_through(grid, ground_of(grid), zone) == pytest.approx(width_m, abs=2 * CELL)


def test_a_zone_with_one_opening_or_none_has_no_width_through():
    grid = floor_of(8, 2, (3, 0, 4, 2))
    ground = ground_of(grid)
    assert width_through(grid, ground, ((2.0, -1.0), (5.0, -1.0), (5.0, 3.0), (2.0, 3.0))) is None
    assert width_through(grid, ground, ((-1.0, -1.0), (9.0, -1.0), (9.0, 3.0), (-1.0, 3.0))) is None
    assert width_through(grid, ground, ((6.0, 0.5), (7.0, 0.5), (7.0, 1.5), (6.0, 1.5))) is None


def test_many_places_behind_one_door_share_what_was_found_of_it():
    ground = ground_of(with_door(1.5, 1.95))
    places = [(0.5 + 0.1 * number, 0.5 + 0.05 * number) for number in range(30)]
    found = find_bottlenecks(ground, places, (7.0, 1.0), 0.8)
    assert len(set(found)) == 1
    assert found[0].x > 3.9


def test_of_more_narrow_ways_than_are_looked_for_the_width_is_told_where_the_place_is(monkeypatch):
    monkeypatch.setattr(bottlenecks, "MOST_SEARCHED", 1)
    grid = floor_of(12, 4, (4, 0, 4.2, 1.5), (4, 1.95, 4.2, 4), (8, 0, 8.2, 1.5), (8, 1.95, 8.2, 4))
    first, second = find_bottlenecks(ground_of(grid), [(1.0, 1.0), (11.0, 1.0)], (6.0, 1.0), 0.8)
    assert 3.9 < first.x < 4.3
    assert (second.x, second.y, second.sides) == (11.0, 1.0, ())
    assert second.width_m == pytest.approx(0.45, abs=CELL)

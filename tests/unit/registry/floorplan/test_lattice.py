"""The lattice on which robots drive: what is a link, and that its lines go through doors that even ones would miss."""

import random
from itertools import pairwise
from math import hypot

import pytest

from bench.lattice.buildings import make_building, share_reached
from registry.floorplan.extent import FloorTooLarge
from registry.floorplan.lattice import (
    MARGIN_M,
    PASSING_MARGIN_M,
    SIDE_M,
    Ground,
    attach,
    make_lattice,
)
from registry.floorplan.plan import FREE, OCCUPIED, Grid, clearance_m


def ground_of(grid, radius_m):
    return Ground(grid, clearance_m(grid), radius_m)


def scribbled(seed):
    """A floor with walls by chance, its origin and cells as odd as may be."""
    chance = random.Random(seed)
    width, height = chance.randint(3, 90), chance.randint(3, 90)
    cells = bytearray(width * height)
    for _ in range(chance.randint(0, 20)):
        x, y = chance.randrange(width), chance.randrange(height)
        for _ in range(chance.randint(1, 20)):
            x, y = (min(width - 1, x + 1), y) if chance.random() < 0.5 else (x, min(height - 1, y + 1))
            cells[y * width + x] = chance.choice((OCCUPIED, 255))
    side = chance.choice((0.02, 0.033, 0.05, 0.1, 0.25))
    return Grid(width, height, side, chance.uniform(-20, 20), chance.uniform(-20, 20), bytes(cells))


@pytest.mark.parametrize("seed", range(40))
def test_links_lead_where_a_robot_can_drive_straight_and_nowhere_else(seed):
    ground = ground_of(scribbled(seed), random.Random(seed).uniform(0.05, 0.5))
    lattice = make_lattice(ground)
    for cell, links in lattice.links.items():
        assert ground.room_m(lattice.centre(cell)) >= ground.radius_m + MARGIN_M
        row, column = divmod(cell, lattice.columns)
        around = [(row, column + 1), (row + 1, column), (row, column - 1), (row - 1, column)]
        near = [r * lattice.columns + c for r, c in around if 0 <= r < lattice.rows and 0 <= c < lattice.columns]
        room_m = ground.radius_m + PASSING_MARGIN_M
        assert links == tuple(
            other
            for other in near
            if other in lattice.links and ground.is_passable(lattice.centre(cell), lattice.centre(other), room_m)
        )


@pytest.mark.parametrize("seed", range(40))
def test_all_cells_of_a_lattice_are_joined(seed):
    lattice = make_lattice(ground_of(scribbled(seed), 0.1))
    if lattice.links:
        assert set(lattice.distances(min(lattice.links))) == set(lattice.links)


def two_rooms(door_from_m, door_to_m):
    """Two rooms of 4 x 4 m side by side, with a door between these heights."""
    cells = bytearray(164 * 80)
    for row in range(80):
        for column in range(80, 84):
            if not door_from_m <= (row + 0.5) * 0.05 < door_to_m:
                cells[row * 164 + column] = OCCUPIED
    return Grid(164, 80, 0.05, 0.0, 0.0, bytes(cells))


@pytest.mark.parametrize("shift_cm", range(0, 100, 10))
def test_a_wide_robot_comes_through_a_door_wherever_that_is(shift_cm):
    ground = ground_of(two_rooms(1.0 + shift_cm / 100, 2.2 + shift_cm / 100), 0.4)
    lattice = make_lattice(ground)
    start = attach(ground, lattice, (2.0, 2.0))
    assert start is not None
    assert attach(ground, lattice, (6.2, 2.0)) in lattice.distances(start)


def test_lines_are_even_from_the_maps_corner_on_where_robots_come_everywhere_so():
    grid = Grid(100, 100, 0.05, -1.5, 2.0, bytes([FREE]) * 10_000)
    lattice = make_lattice(ground_of(grid, 0.18))
    assert lattice.side_m == lattice.gap_m == SIDE_M
    assert (lattice.xs[:2], lattice.ys[:2]) == ((-1.25, -0.75), (2.25, 2.75))


@pytest.mark.parametrize("seed", range(12))
def test_a_turtlebot_comes_to_all_rooms_of_a_make_building(seed):
    ground = ground_of(make_building(seed), 0.18)
    assert share_reached(ground, make_lattice(ground)) > 0.97


@pytest.mark.parametrize(("radius_m", "least"), [(0.3, 0.95), (0.4, 0.85)])
def test_wide_robots_come_to_most_of_many_buildings(radius_m, least):
    grounds = [ground_of(make_building(seed), radius_m) for seed in range(12)]
    assert sum(share_reached(ground, make_lattice(ground)) for ground in grounds) / len(grounds) > least


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("radius_m", [0.18, 0.4])
def test_lines_are_never_nearer_than_a_side_nor_much_farther(seed, radius_m):
    lattice = make_lattice(ground_of(make_building(seed), radius_m))
    gaps = [after - before for lines in (lattice.xs, lattice.ys) for before, after in pairwise(lines)]
    assert min(gaps) >= lattice.side_m - 1e-9
    assert max(gaps) <= 1.25 * lattice.side_m + 0.05
    assert lattice.gap_m == max(gaps)


def test_the_same_floor_gives_the_same_lattice_and_another_one_another_mark():
    one, again, other = (make_lattice(ground_of(make_building(seed), 0.4)) for seed in (1, 1, 2))
    assert one == again
    assert one.mark == again.mark != other.mark


@pytest.mark.parametrize("seed", range(6))
def test_cells_near_a_point_and_in_a_box_are_those_whose_middle_is(seed):
    lattice, chance = make_lattice(ground_of(make_building(seed), 0.4)), random.Random(seed)
    x, y = chance.uniform(0, 26), chance.uniform(0, 16)
    every = [(cell, lattice.centre(cell)) for cell in range(lattice.columns * lattice.rows)]
    near = {cell for cell, (cx, cy) in every if hypot(cx - x, cy - y) <= 2.5}
    found = lattice.cells_within((x, y), 2.5)
    assert set(found) == near
    far = [hypot(lattice.centre(cell)[0] - x, lattice.centre(cell)[1] - y) for cell in found]
    assert far == sorted(far)
    inside = {
        cell for cell, (cx, cy) in every if x - 3 <= cx <= x + 1 and y - 1 <= cy <= y + 4 and cell in lattice.links
    }
    assert set(lattice.cells_in_box(x - 3, y - 1, x + 1, y + 4)) == inside


def test_a_floor_on_which_nobody_fits_has_no_cells():
    assert not make_lattice(ground_of(Grid(4, 4, 0.05, 0.0, 0.0, bytes(16)), 0.4)).links


def test_a_floor_of_square_kilometres_is_refused_before_anything_is_laid():
    with pytest.raises(FloorTooLarge, match="The map is 800 x 700 m with 560\N{NO-BREAK SPACE}000 m² of floor"):
        make_lattice(ground_of(Grid(80, 70, 10.0, 0.0, 0.0, bytes(80 * 70)), 0.2))


def test_floor_counts_so_that_a_large_map_may_be_mostly_unknown():
    cells = bytes([FREE]) * 100 + b"\xff" * 9_900
    assert make_lattice(ground_of(Grid(100, 100, 10.0, 0.0, 0.0, cells), 0.2)).links
    with pytest.raises(FloorTooLarge, match="1\N{NO-BREAK SPACE}500 x 1\N{NO-BREAK SPACE}500 m"):
        make_lattice(ground_of(Grid(100, 100, 15.0, 0.0, 0.0, cells), 0.2))

"""Lanes over a zone, any polygon: every place of it where a robot can stand lies within a lane's width of a lane."""

from contextlib import suppress
from itertools import pairwise
from math import cos, hypot, pi, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from registry.floorplan import coverage
from registry.floorplan.coverage import (
    MOST_LANES,
    STEP_M,
    CannotCover,
    Lane,
    covered_share,
    dense,
    in_order,
    plan_lanes,
    samples,
)
from registry.floorplan.lattice import Ground, attach, make_lattice
from registry.floorplan.plan import Grid, clearance_m
from tests.kit import demo_floor

RADIUS_M = 0.18


def floor(walls=(), side_m=12.0, resolution_m=0.1):
    """Return a square floor with walls (x1, y1, x2, y2 in metres) as traffic sees it."""
    count = round(side_m / resolution_m)
    cells = np.zeros((count, count), dtype=np.uint8)
    cells[[0, -1], :] = cells[:, [0, -1]] = 100
    for x1, y1, x2, y2 in walls:
        low, high = [round(v / resolution_m) for v in (x1, y1)], [round(v / resolution_m) for v in (x2, y2)]
        cells[low[1] : high[1], low[0] : high[0]] = 100
    grid = Grid(count, count, resolution_m, 0.0, 0.0, cells.tobytes())
    ground = Ground(grid, clearance_m(grid), RADIUS_M)
    return ground, make_lattice(ground)


EMPTY = floor()
DIVIDED = floor([(5.8, 0.0, 6.2, 9.0)])
PILLARS = floor([(3.0, 3.0, 3.6, 4.2), (7.0, 6.0, 9.0, 6.4), (2.0, 8.0, 2.4, 8.4)])
DEMO = (demo_floor.layout().ground, demo_floor.layout().lattice)


def flat(blocks):
    return [lane for block in blocks for lane in block]


def check_cover(site, outline, lane_m):
    """Check all that is promised of lanes; return them."""
    ground, lattice = site
    lanes = flat(plan_lanes(ground, lattice, outline, lane_m))
    assert 1 <= len(lanes) <= MOST_LANES
    for lane in lanes:
        points = list(lane.points())
        assert len(points) == lane.stops
        assert all(attach(ground, lattice, point) is not None for point in points)
        assert all(hypot(b[0] - a[0], b[1] - a[1]) <= STEP_M + 0.002 for a, b in pairwise(points))
        assert all(ground.is_passable(a, b, RADIUS_M) for a, b in pairwise(points))
    places = [(float(x), float(y)) for x, y in samples(np.array(outline), 0.25)]
    standing = [place for place in places if attach(ground, lattice, place) is not None]
    if standing:
        far_m = cKDTree(dense(lanes)).query(np.array(standing))[0]
        assert far_m.max() <= lane_m + ground.grid.resolution_m
    return lanes


def test_a_lane_past_a_corner_ends_before_it_and_goes_on_behind_it():
    check_cover(PILLARS, ((2.0, 8.72), (3.4, 2.84), (5.0, 0.0), (6.66, 7.88)), 2.0)


def test_a_rectangle_is_covered_along_its_longer_side_there_and_back():
    lanes = in_order(plan_lanes(*EMPTY, ((2, 2), (8, 2), (8, 4), (2, 4)), 0.5), (2.0, 2.0))
    assert [(lane.x1, lane.y1, lane.x2, lane.y2) for lane in lanes] == [
        (2.25, 2.25, 7.75, 2.25),
        (7.75, 2.75, 2.25, 2.75),
        (2.25, 3.25, 7.75, 3.25),
        (7.75, 3.75, 2.25, 3.75),
    ]
    assert covered_share(EMPTY[0], ((2, 2), (8, 2), (8, 4), (2, 4)), 0.5, lanes) > 0.97
    assert covered_share(EMPTY[0], ((2, 2), (8, 2), (8, 4), (2, 4)), 0.5, lanes[:2]) == pytest.approx(0.5, abs=0.05)


def test_it_begins_at_the_corner_that_is_nearest():
    blocks = plan_lanes(*EMPTY, ((2, 2), (8, 2), (8, 4), (2, 4)), 0.5)
    for start, first in (((9.0, 5.0), (7.75, 3.75)), ((1.0, 5.0), (2.25, 3.75)), ((9.0, 1.0), (7.75, 2.25))):
        lanes = in_order(blocks, start)
        assert (lanes[0].x1, lanes[0].y1) == first
        assert len(lanes) == 4


def test_a_zone_that_a_wall_divides_is_covered_piece_by_piece():
    blocks = plan_lanes(*DIVIDED, ((3, 2), (9, 2), (9, 5), (3, 5)), 0.4)
    long = [block for block in blocks if len(block) > 1]
    assert [sorted({x < 6 for lane in block for x in (lane.x1, lane.x2)}) for block in long] == [[True], [False]]
    sides = [lane.x1 < 6 for lane in in_order(blocks, (1.0, 1.0)) if lane.stops > 1]
    assert sum(a != b for a, b in pairwise(sides)) == 1


@pytest.mark.parametrize(
    "outline",
    [
        ((1, 1), (11, 1.2), (1, 1.4)),  # a needle
        ((1, 1), (10, 1), (10, 10), (9.5, 10), (9.5, 1.5), (1, 1.5)),  # a narrow angle
        ((1, 1), (10, 10), (10, 1), (1, 10)),  # it crosses itself
        ((6, 11), (7, 7), (11, 6), (7, 5), (6, 1), (5, 5), (1, 6), (5, 7)),  # a star
        ((-50, -50), (60, -50), (60, 60), (-50, 60)),  # larger than the map
        ((2, 2), (2, 2), (4, 2), (4, 2), (4, 4)),  # corners twice
    ],
)
@pytest.mark.parametrize("site", [EMPTY, DIVIDED, PILLARS])
def test_hostile_zones_are_covered(site, outline):
    check_cover(site, outline, 0.5)


corners = st.tuples(st.floats(0.0, 12.0), st.floats(0.0, 12.0)).map(lambda p: (round(p[0], 2), round(p[1], 2)))


@settings(max_examples=25, deadline=None)
@given(st.lists(corners, min_size=3, max_size=9), st.floats(0.3, 2.5), st.sampled_from([EMPTY, DIVIDED, PILLARS]))
def test_any_zone_is_covered_or_has_no_place_to_stand(outline, lane_m, site):
    ground, lattice = site
    with suppress(CannotCover):
        check_cover(site, tuple(outline), lane_m)
        return
    inside = samples(np.array(outline), 0.25)
    assert not any(attach(ground, lattice, (float(x), float(y))) is not None for x, y in inside[::5])


def test_the_demo_floor_and_a_turned_zone_on_it_are_covered():
    check_cover(DEMO, ((1, -9), (9, -9), (9, -5), (1, -5)), 0.36)
    turn = [(6 + 2.5 * cos(k * pi / 2 + 0.4), -7.5 + 2.5 * sin(k * pi / 2 + 0.4)) for k in range(4)]
    check_cover(DEMO, tuple(turn), 0.36)


@pytest.mark.parametrize(
    ("outline", "lane_m", "code"),
    [
        (((20, 20), (24, 20), (24, 24)), 0.5, "outside"),
        (((0, 0), (0.1, 0), (0.1, 12), (0, 12)), 0.5, "nothing"),
        (((5.85, 1), (6.15, 1), (6.15, 8), (5.85, 8)), 0.5, "nothing"),
    ],
)
def test_what_cannot_be_covered_says_why(outline, lane_m, code):
    with pytest.raises(CannotCover) as told:
        plan_lanes(*DIVIDED, outline, lane_m)
    assert told.value.code == code


@pytest.mark.parametrize(
    ("lane_m", "why"), [(0.1, "km long"), (0.06, "1000 are the most"), (1e-9, "1000 are the most")]
)
def test_too_many_lanes_are_an_error_before_they_are_worked_out(lane_m, why):
    site = floor(side_m=99, resolution_m=0.5)
    with pytest.raises(CannotCover, match=why) as told:
        plan_lanes(*site, ((-5000, -5000), (5000, -5000), (5000, 5000), (-5000, 5000)), lane_m)
    assert told.value.code == "too_many"


def test_as_many_lanes_as_a_hundred_metres_take_are_worked_out():
    site = floor(side_m=99, resolution_m=0.5)
    assert 100 < len(flat(plan_lanes(*site, ((1, 1), (98, 1), (98, 98), (1, 98)), 0.95))) <= MOST_LANES


def test_where_it_is_closed_no_lane_leads():
    lattice = EMPTY[1]
    shut = frozenset(cell for cell in lattice.links if lattice.centre(cell)[0] > 5)
    blocks = plan_lanes(*EMPTY, ((2, 2), (8, 2), (8, 4), (2, 4)), 0.5, shut)
    assert max(x for lane in flat(blocks) for x in (lane.x1, lane.x2)) <= 5
    with pytest.raises(CannotCover, match="No robot can stand"):
        plan_lanes(*EMPTY, ((2, 2), (8, 2), (8, 4), (2, 4)), 0.5, frozenset(lattice.links))


def test_what_is_closed_within_a_zone_is_looked_at_along_its_edge_and_each_point_once(monkeypatch):
    ground, lattice = floor(side_m=40.0)
    points = []
    monkeypatch.setattr(coverage, "attach", lambda *given: points.append(given[2]) or attach(*given))
    middles = {cell: lattice.centre(cell) for cell in lattice.links}
    shut = frozenset(cell for cell, (x, y) in middles.items() if 5 < x < 35 and 5 < y < 35)
    zone = ((2, 2), (38, 2), (38, 38), (2, 38))
    lanes = flat(plan_lanes(ground, lattice, zone, 0.9, shut))
    closed = [(x, y) for x, y in points if 5 < x < 35 and 5 < y < 35]
    assert len(closed) == len(set(closed)) < 6_500, "of 22,500 points that are closed"
    driven = cKDTree(dense(lanes))
    standing, closed_or_nowhere = [(float(x), float(y)) for x, y in samples(np.array(zone), 0.5)], {None, *shut}
    reached = [place for place in standing if attach(ground, lattice, place) not in closed_or_nowhere]
    assert len(reached) > 1000
    assert driven.query(np.array(reached))[0].max() <= 0.9 + ground.grid.resolution_m
    assert all(attach(ground, lattice, point) not in shut for lane in lanes for point in lane.points())


def test_parts_of_a_lane_keep_its_points():
    lane = Lane(0.0, 0.0, 2.0, 0.0, 6)
    assert [point for part in (*lane.part(0, 2), *lane.part(2, 6)) for point in part.points()] == [*lane.points()]
    assert lane.part(3, 3) == ()

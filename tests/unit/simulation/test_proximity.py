"""Distances between robots, walls and machines."""

from __future__ import annotations

from math import cos, pi, sin

import pytest

from simulation.proximity import Body, Crowd, Obstacles, machine_bodies, wall_bodies
from tests.unit.simulation.stage_set import MACHINES, ROBOT


@pytest.mark.parametrize(("x", "y", "distance_m"), [(2.0, 0.0, 1.0), (0.0, 1.0, 0.5), (4.0, 4.5, 5.0), (0.5, 0.2, 0.0)])
def test_distance_to_a_box(x: float, y: float, distance_m: float) -> None:
    assert Body("box", 0.0, 0.0, 1.0, 0.5).distance_m(x, y) == pytest.approx(distance_m)


def test_distance_to_a_turned_box() -> None:
    turned = Body("box", 1.0, 1.0, 1.0, 0.5, cos(pi / 2), sin(pi / 2))
    assert turned.distance_m(1.0, 3.0) == pytest.approx(1.0)
    assert turned.distance_m(2.0, 1.0) == pytest.approx(0.5)
    assert turned.half_span() == pytest.approx((0.5, 1.0))


def test_obstacles_within_a_metre_of_a_robots_surface_are_found_with_the_gap() -> None:
    obstacles = Obstacles(wall_bodies([(0.0, 0.0, 10.0, 0.1), (5.0, 3.0, 5.1, 9.0)]), 0.18)
    assert [(n.other, round(n.gap_m, 3)) for n in obstacles.near(5.05, 0.6, 0.18)] == [("wall", 0.32)]
    assert [(n.other, round(n.gap_m, 3)) for n in obstacles.near(2.0, 1.2, 0.18)] == [("wall", 0.92)]
    assert obstacles.near(2.0, 1.5, 0.18) == []
    assert obstacles.near(-50.0, -50.0, 0.18) == []


def test_only_machines_with_a_size_stand_in_the_way() -> None:
    assert [b.name for b in machine_bodies([*MACHINES, ROBOT])] == ["shelf", "oven", "rollers", "bench"]


def test_robots_find_each_other_across_cells_and_after_moving() -> None:
    crowd = Crowd({"a": 0.2, "b": 0.3, "c": 0.2})
    for name, x in (("a", 0.0), ("b", 1.4), ("c", 30.0)):
        crowd.put(name, x, 0.0)
    assert [(n.other, round(n.gap_m, 3)) for n in crowd.near("a")] == [("b", 0.9)]
    crowd.put("b", 20.0, 0.0)
    crowd.put("c", -0.5, 0.0)
    assert [(n.other, round(n.gap_m, 3)) for n in crowd.near("a")] == [("c", 0.1)]

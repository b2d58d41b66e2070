"""Where a real robot stands that is simulated for a while: others keep clear of it, its own stand-in does not."""

import random
from dataclasses import replace

import pytest

from execution.traffic import messages as m
from execution.traffic.outlines import touches
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor
from tests.unit.execution.traffic.zones.test_site_zones import WEST, block_round, drive, go

MIDDLE, EAST = (10.0, -8.0), (18.0, -8.0)


def body(robot, at):
    return m.FloorZone(f"body/{robot}", robot, "keep_out", block_round(at, 0.2))


def floor_with(*bodies, poses):
    return PretendFloor(replace(demo_floor.layout(), bodies=bodies), poses)


def is_near(floor, robot, shape):
    return touches(shape.points, floor.at[robot], floor.layout.ground.radius_m - 1e-6)


def test_others_drive_round_it():
    stands = body("robot02", MIDDLE)
    floor = floor_with(stands, poses={"robot01": WEST, "robot02": (3.0, -2.5)})
    go(floor, "r", EAST, "robot01")
    drive(floor, ("r", 1), look=lambda: _keeps_clear(floor, "robot01", stands))
    assert floor.over["r", 1][0] == ""


def _keeps_clear(floor, robot, stands):
    assert not is_near(floor, robot, stands)


def test_its_own_stand_in_begins_and_ends_there():
    stands = body("robot01", MIDDLE)
    floor = floor_with(stands, poses={"robot01": MIDDLE})
    go(floor, "r", EAST, "robot01")
    drive(floor, ("r", 1))
    go(floor, "r", MIDDLE, "robot01", task=2)
    drive(floor, ("r", 2))
    assert {kind for kind, _ in floor.over.values()} == {""}
    assert is_near(floor, "robot01", stands)


def test_who_cannot_pass_it_is_told_whose_it_is():
    floor = floor_with(body("robot02", EAST), poses={"robot01": WEST, "robot02": (3.0, -2.5)})
    go(floor, "r", EAST, "robot01")
    kind, why = floor.over["r", 1]
    assert (kind, why.partition(" stands")[0]) == ("blocked", "The real robot02")
    assert "use the real one again" in why


def test_one_that_is_put_in_the_way_of_a_robot_under_way_stops_and_turns_it():
    floor = floor_with(poses={"robot01": WEST, "robot02": (3.0, -2.5)})
    go(floor, "r", EAST, "robot01")
    stands = body("robot02", MIDDLE)
    for _ in range(12):
        floor.pass_time()
    assert not is_near(floor, "robot01", stands)
    floor.layout = replace(floor.layout, bodies=(stands,))
    drive(floor, ("r", 1), look=lambda: _keeps_clear(floor, "robot01", stands))
    assert floor.over["r", 1][0] == ""


@pytest.mark.parametrize("seed", range(4))
def test_no_robot_comes_near_the_bodies_of_others(seed):
    chance = random.Random(seed)
    layout = demo_floor.layout()
    middles = [layout.lattice.centre(cell) for cell in sorted(layout.lattice.links)]
    starts = dict(zip(("robot01", "robot02", "robot03"), chance.sample(middles, 3), strict=True))
    bodies = {robot: body(robot, at) for robot, at in starts.items()}
    floor = floor_with(*bodies.values(), poses=starts)

    def look():
        for robot in starts:
            for other, stands in bodies.items():
                assert other == robot or not is_near(floor, robot, stands)

    for number, goal in enumerate(chance.sample(middles, 6)):
        go(floor, f"r{number}", goal, f"robot0{number % 3 + 1}")
    for _ in range(1500):
        floor.pass_time()
        look()
    assert [task for task, (kind, _) in floor.over.items() if not kind]

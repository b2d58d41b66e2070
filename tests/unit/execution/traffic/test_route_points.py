"""A Move along drawn points: the robot drives over them in order, without stopping, whatever comes between."""

import json
from math import hypot

from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import floor
from execution.traffic import messages as m
from execution.traffic.floor_state import FloorTask
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor

LAYOUT = demo_floor.layout()
ROUTE = ((5.25, -8.25), (5.25, -6.25), (9.25, -8.25))
NEAR_M = 0.36
"""Half the diagonal of a cell."""


def ask(run, task, target, route=(), wants="robot01"):
    return m.TaskAsked(run, task, TaskOrder("move", Target(target), "robot", route=route), wants, (), f"run {run}")


def trace(world, *settled, limit_s=400.0):
    """Let time pass until the tasks are over; return where robot01 was meanwhile."""
    seen = [world.at["robot01"]]
    while not all(each in world.over for each in settled):
        assert world.now < limit_s, world.describe()
        world.pass_time()
        seen.append(world.at["robot01"])
    return seen


def comes_by(seen, points):
    """Tell whether a way leads near these points one after the other."""
    left = list(points)
    for x, y in seen:
        if left and hypot(left[0][0] - x, left[0][1] - y) <= NEAR_M:
            left.pop(0)
    return not left


def test_a_robot_drives_over_the_points_in_their_order_and_only_then_to_its_goal():
    plain = PretendFloor(LAYOUT)
    plain.tell(ask("a", 1, "dropOff01"))
    assert not comes_by(trace(plain, ("a", 1)), ROUTE)
    for route in (ROUTE, ROUTE[::-1]):
        world = PretendFloor(LAYOUT)
        world.tell(ask("a", 1, "dropOff01", route))
        seen = trace(world, ("a", 1))
        assert world.over["a", 1] == ("", "")
        assert comes_by(seen, route)
        spot = LAYOUT.stations["dropOff01"]
        assert hypot(seen[-1][0] - spot.x, seen[-1][1] - spot.y) < 0.1


def test_it_does_not_stop_at_the_points():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "dropOff01", ROUTE))
    seen = trace(world, ("a", 1))
    stops = [at for at, before in zip(seen[30:-5], seen[29:-6], strict=True) if at == before]
    assert stops == []


def test_a_round_that_ends_where_it_begins_is_driven():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "dropOff01"))
    trace(world, ("a", 1))
    world.tell(ask("a", 2, "dropOff01", (ROUTE[0], ROUTE[2], ROUTE[0])))
    assert comes_by(trace(world, ("a", 2)), (ROUTE[0], ROUTE[2], ROUTE[0]))


def test_what_is_passed_stays_passed_when_the_state_is_kept_and_read_in_between():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "dropOff01", ROUTE))
    seen = [world.at["robot01"]]
    while ("a", 1) not in world.over:
        assert world.now < 400, world.describe()
        world.pass_time()
        seen.append(world.at["robot01"])
        world.state = floor.from_json(json.loads(json.dumps(floor.to_json(world.state))))
    assert comes_by(seen, ROUTE)
    plain = PretendFloor(LAYOUT)
    plain.tell(ask("a", 1, "dropOff01"))
    (task,) = floor.to_json(plain.state)["jobs"]
    assert "points_passed" not in task
    assert "route_at" not in floor.to_json(plain.state)["robots"][0]


def test_a_robot_that_was_started_anew_goes_on_with_the_points_that_are_left():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "dropOff01", ROUTE))
    while task_of(world).points_passed < 1:
        world.pass_time()
    pieces = [c.id for c in world.sent if c.id in world.state.sent and c.device == "robot01"]
    world.queue["robot01"].clear()
    world.tell(*(m.CommandAnswered(piece, "REJECTED", "It begins elsewhere.") for piece in pieces))
    while not world.queue["robot01"]:
        world.pass_time()
    assert len(world.state.robots["robot01"].route_at) == 2
    assert comes_by(trace(world, ("a", 1)), ROUTE[1:])
    assert world.over["a", 1] == ("", "")


def task_of(world) -> FloorTask:
    return world.state.tasks[0]


def test_a_task_that_is_called_off_leaves_its_points_to_nobody():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "dropOff01", ROUTE))
    for _ in range(40):
        world.pass_time()
    world.tell(m.TaskCancelled("a", 1), ask("a", 2, "dropOff01", ROUTE[2:]))
    assert comes_by(trace(world, ("a", 2)), ROUTE[2:])
    assert world.over["a", 2] == ("", "")


def test_a_point_where_no_robot_can_stand_fails_as_blocked():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "dropOff01", (ROUTE[0], (90.0, 90.0))))
    kind, why = world.over["a", 1]
    assert kind == "blocked"
    assert "(90.00, 90.00)" in why


def test_two_robots_on_one_round_in_both_directions_get_round():
    world = PretendFloor(LAYOUT)
    world.tell(
        ask("1", 1, "dropOff01", ROUTE),
        ask("2", 1, "itemInventory01", ROUTE[::-1], wants="robot02"),
    )
    assert comes_by(trace(world, ("1", 1), ("2", 1)), ROUTE)
    assert set(world.over.values()) == {("", "")}
    assert world.nearest >= 0.46

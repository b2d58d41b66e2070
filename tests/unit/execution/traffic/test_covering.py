"""A robot covers a zone: all of it in lanes, with others about, after a pause, a restart, and where somebody stands."""

import json
from math import hypot

import numpy as np
import pytest
from scipy.spatial import cKDTree

from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import floor
from execution.traffic import messages as m
from execution.traffic.covering import LEAVE_OUT_AFTER_S
from registry.floorplan.coverage import samples
from registry.floorplan.lattice import attach
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor

LAYOUT = demo_floor.layout()
HALL = ((1.5, -5.5), (5.5, -5.5), (5.5, -3.5), (1.5, -3.5))


def zone(points=HALL, rule="slow", name="hall"):
    return m.FloorZone(f"p/{name}", name, rule, points, 0.5)


def ask(run="a", lane=0.0, points=HALL, robot="robot01", more=(), rule="slow"):
    order = TaskOrder("cover", Target(), "robot", arguments={"zone": "hall", "lane": lane}, step="s1")
    return m.TaskAsked(run, 1, order, robot, (), f"run {run}", (zone(points, rule), *more))


class World(PretendFloor):
    """The floor, and what it told of the cover."""

    def __init__(self, *args, **more):
        self.told = []
        super().__init__(*args, **more)
        self.seen = {name: [at] for name, at in self.at.items()}

    def tell(self, *events):
        actions = super().tell(*events)
        self.told.extend(action.reason for action in actions if isinstance(action, m.TaskTold))
        return actions

    def pass_time(self, dt_s=0.1):
        actions = super().pass_time(dt_s)
        for name, at in self.at.items():
            self.seen[name].append(at)
        return actions


def far_from(seen, points=HALL):
    """Return how far the places of a zone where robots can stand are from a way at most."""
    places = [(float(x), float(y)) for x, y in samples(np.array(points), 0.2)]
    standing = [place for place in places if attach(LAYOUT.ground, LAYOUT.lattice, place) is not None]
    return cKDTree(np.array(seen)).query(np.array(standing))[0].max()


def settled(world, *runs):
    return lambda: all((run, 1) in world.over for run in runs)


def percent(world):
    return next(told.args["percent"] for told in reversed(world.told) if told.code == "covered")


@pytest.mark.parametrize("lane", [0.0, 0.3, 0.8])
def test_a_robot_covers_the_whole_of_a_zone_and_tells_so(lane):
    world = World(LAYOUT)
    world.tell(ask(lane=lane))
    world.run_until(settled(world, "a"))
    assert world.over["a", 1] == ("", "")
    assert [told.code for told in world.told] == ["cover_begins", "covered"]
    assert far_from(world.seen["robot01"]) <= (lane or 0.36)
    assert percent(world) >= 95
    assert world.told[0].args["lanes"] >= 2 / (lane or 0.36)


def test_the_robot_does_not_stop_where_its_path_is_made_longer():
    world = World(LAYOUT)
    world.tell(ask(lane=0.3))
    world.run_until(settled(world, "a"))
    stops = [a for a, b in zip(world.seen["robot01"][20:-5], world.seen["robot01"][21:-4], strict=True) if a == b]
    assert len(stops) <= 5
    assert max(len(robot.path) for robot in world.state.robots.values()) < 100


def test_two_robots_cover_one_zone_beside_each_other():
    world = World(LAYOUT)
    world.tell(ask("a", robot="robot01"), ask("b", robot="robot02"))
    world.run_until(settled(world, "a", "b"), limit_s=1500)
    assert world.over == {("a", 1): ("", ""), ("b", 1): ("", "")}
    assert world.nearest > 0.36
    for name in ("robot01", "robot02"):
        assert far_from(world.seen[name]) <= 0.36 + 0.3


def test_a_paused_cover_goes_on_where_it_was():
    world = World(LAYOUT)
    world.tell(ask())
    world.run_until(lambda: world.state.tasks[0].points_passed > 20)
    world.tell(m.RunPaused("a"))
    for _ in range(100):
        world.pass_time()
    passed, at = world.state.tasks[0].points_passed, world.at["robot01"]
    for _ in range(50):
        world.pass_time()
    assert (world.state.tasks[0].points_passed, world.at["robot01"]) == (passed, at)
    world.tell(m.RunResumed("a"))
    world.run_until(settled(world, "a"))
    assert [told.code for told in world.told] == ["cover_begins", "covered"]
    assert far_from(world.seen["robot01"]) <= 0.36


@pytest.mark.parametrize("after", [5, 25, 45])
def test_a_floor_that_is_read_from_its_kept_state_goes_on_without_beginning_anew(after):
    world = World(LAYOUT)
    world.tell(ask())
    world.run_until(lambda: world.state.tasks[0].points_passed >= after)
    lanes, passed = world.state.tasks[0].lanes, world.state.tasks[0].points_passed
    world.state = floor.from_json(json.loads(json.dumps(floor.to_json(world.state))))
    assert world.state.tasks[0].lanes == lanes
    world.run_until(settled(world, "a"))
    assert [told.code for told in world.told] == ["cover_begins", "covered"]
    assert far_from(world.seen["robot01"]) <= 0.36
    assert passed >= after


def test_a_robot_that_loses_its_path_in_the_middle_goes_on_with_the_rest():
    world = World(LAYOUT)
    world.tell(ask())
    world.run_until(lambda: world.state.tasks[0].points_passed > 30)
    before = world.seen["robot01"][:]
    sent = next(iter(world.state.sent.values()))
    world.queue["robot01"].clear()
    world.tell(m.CommandAnswered(sent.id, "REJECTED", "I was started anew."))
    world.run_until(settled(world, "a"))
    again = world.seen["robot01"][len(before) :]
    assert min(hypot(x - before[60][0], y - before[60][1]) for x, y in again) > 0.3
    assert far_from(world.seen["robot01"]) <= 0.36


def test_what_somebody_stands_in_is_left_out_and_the_rest_covered():
    """A robot that is away keeps its cells."""
    world = World(LAYOUT, poses={"robot02": (3.5, -4.5)})
    world.tell(m.DeviceOffline("robot02"))
    world.tell(ask())
    world.run_until(settled(world, "a"), limit_s=900)
    assert world.over["a", 1] == ("", "")
    assert world.nearest > 0.36
    assert 60 <= percent(world) < 95
    assert world.now > LEAVE_OUT_AFTER_S
    outside = [(x, y) for x, y in world.seen["robot01"] if hypot(x - 3.5, y + 4.5) < 0.36]
    assert outside == []


def test_who_goes_away_in_time_is_driven_round_first_and_covered_last():
    world = World(LAYOUT, poses={"robot02": (3.5, -4.5)})
    world.tell(m.DeviceOffline("robot02"))
    world.tell(ask())
    world.run_until(lambda: world.state.tasks[0].put_off > 0)
    world.tell(m.DeviceOnline("robot02"))
    world.run_until(settled(world, "a"), limit_s=900)
    assert far_from(world.seen["robot01"]) <= 0.36


def test_a_keep_out_zone_in_it_is_left_out():
    closed = m.FloorZone("p/wet", "wet", "keep_out", ((3.0, -5.5), (4.0, -5.5), (4.0, -3.5), (3.0, -3.5)))
    world = World(LAYOUT)
    world.tell(ask(more=(closed,)))
    world.run_until(settled(world, "a"))
    assert world.over["a", 1] == ("", "")
    assert [x for x, y in world.seen["robot01"] if 3.0 < x < 4.0 and -5.5 < y < -3.5] == []
    assert 40 <= percent(world) < 80


@pytest.mark.parametrize(
    ("points", "lane", "kind", "why"),
    [
        (((90, 90), (94, 90), (94, 94)), 0.5, "blocked", "off the map"),
        (((-0.4, -8), (0.0, -8), (0.0, -5), (-0.4, -5)), 0.5, "blocked", "TurtleBot 1 cannot cover hall."),
    ],
)
def test_a_zone_that_cannot_be_covered_fails_at_once_and_says_why(points, lane, kind, why):
    world = World(LAYOUT)
    world.tell(ask(points=points, lane=lane))
    assert world.over["a", 1][0] == kind
    assert why in world.over["a", 1][1]


def test_a_zone_that_its_program_lacks_is_refused():
    world = World(LAYOUT)
    order = TaskOrder("cover", Target(), "robot", arguments={"zone": "gone", "lane": 0})
    world.tell(m.TaskAsked("a", 1, order, "robot01", (), "run a", (zone(),)))
    assert world.over["a", 1] == ("refused", "The zone is not there any more; choose another one.")


def test_the_nearest_robot_is_chosen():
    world = World(LAYOUT, poses={"robot02": (6.5, -4.5)})
    world.tell(ask(robot=""))
    world.pass_time()
    assert world.state.tasks[0].robot == "robot02"


def test_a_cancelled_cover_stops_and_a_move_follows_it():
    world = World(LAYOUT)
    world.tell(ask())
    world.run_until(lambda: world.state.tasks[0].points_passed > 10)
    world.tell(m.TaskCancelled("a", 1))
    world.tell(m.TaskAsked("a", 2, TaskOrder("move", Target("dropOff01"), "robot"), "robot01", (), "run a", (zone(),)))
    world.run_until(lambda: ("a", 2) in world.over)
    assert world.over["a", 2] == ("", "")


def test_a_zone_ten_times_as_large_keeps_a_short_path_and_state():
    big = ((0.5, -13.5), (20.5, -13.5), (20.5, -0.5), (0.5, -0.5))
    world = World(LAYOUT)
    world.tell(ask(points=big))
    longest = 0
    for _ in range(3000):
        world.pass_time(0.2)
        longest = max(longest, len(world.state.robots["robot01"].path))
    assert world.state.tasks[0].points_passed > 300
    assert longest < 150
    assert len(json.dumps(floor.to_json(world.state))) < 30_000

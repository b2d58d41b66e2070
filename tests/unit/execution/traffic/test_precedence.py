"""Which of several waiting tasks gets a robot: by priority, deadline and how long it has stood behind others."""

import json
from dataclasses import replace

import pytest

from editor.language.plan.instructions import RoleBinding
from execution import floor_protocol as protocol
from execution.floor_protocol import AskingRun, to_floor
from execution.machine import messages as r
from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import floor
from execution.traffic import messages as m
from execution.traffic.floor import GAP_S
from execution.traffic.precedence import AGE_S
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor

LAYOUT = demo_floor.layout()
ROBOTS = ("robot01", "robot02", "robot03")
LOW, NORMAL, HIGH = -1, 0, 1


def ask(run, priority=NORMAL, due=0.0, device=None, goal="paintMachine01", task=1):
    """Return what the floor is told when a run asks for its robot, as the database keeps it between them."""
    order = TaskOrder("move", Target(goal), "robot")
    role = RoleBinding("robot", device, ("move",))
    asking = AskingRun(run, f"run {run}", {"robot": role}, (), priority, due)
    return protocol.floor_message_from_json(
        json.loads(json.dumps(protocol.to_json(to_floor(asking, r.Ask(task, order)))))
    )


def busy_floor():
    """Return a floor where each robot is held by a run; `free` ends one."""
    world = PretendFloor(LAYOUT)
    world.now = 1000.0
    world.tell(*(ask(f"busy{robot}", device=robot) for robot in ROBOTS))
    assert len(world.state.roles) == len(ROBOTS)
    return world


def free(world, robot="robot01"):
    """End the run that holds the robot; returns the runs whose role it then has."""
    world.tell(m.RunOver(f"busy{robot}"))
    return [key.removesuffix("/robot") for key, held in world.state.roles.items() if held == robot]


def keep(world):
    world.state = floor.from_json(json.loads(json.dumps(floor.to_json(world.state))))


@pytest.mark.parametrize("order", [("low", "normal", "high"), ("high", "normal", "low"), ("normal", "high", "low")])
def test_the_higher_priority_gets_the_free_robot_whoever_asked_first(order):
    world = busy_floor()
    for run in order:
        world.tell(ask(run, {"low": LOW, "normal": NORMAL, "high": HIGH}[run]))
    keep(world)
    assert free(world) == ["high"]
    world.tell(m.RunOver("high"))
    assert world.state.roles.get("normal/robot") == "robot01"


def test_a_higher_one_goes_before_one_that_wants_this_very_robot():
    world = busy_floor()
    world.tell(ask("named", device="robot01"), ask("high", HIGH))
    assert free(world) == ["high"]
    world = busy_floor()
    world.tell(ask("any"), ask("named", HIGH, device="robot01"))
    assert free(world) == ["named"]


def test_the_higher_one_chooses_the_nearest_robot_though_the_sum_of_paths_grows():
    near, far = (18.0, -5.0), (2.3, -8.0)
    world = PretendFloor(LAYOUT, {"robot01": near, "robot02": far, "robot03": (2.3, -6.0)})
    world.tell(m.DeviceOffline("robot03"))
    world.tell(ask("a"), ask("b", HIGH))
    assert world.state.roles["b/robot"] == "robot01"


def test_of_equal_priority_the_earlier_deadline_goes_first_and_one_without_last():
    world = busy_floor()
    world.tell(ask("none"), ask("late", due=2000.0), ask("soon", due=1000.0), ask("low", LOW, due=1.0))
    keep(world)
    assert free(world) == ["soon"]
    world.tell(m.RunOver("soon"))
    assert world.state.roles["late/robot"] == "robot01"


def test_nothing_is_taken_from_a_run_that_has_it():
    world = PretendFloor(LAYOUT)
    world.tell(*(ask(f"low{robot}", LOW, device=robot) for robot in ROBOTS))
    before = dict(world.state.roles)
    world.tell(ask("high", HIGH))
    world.tell(m.Tick())
    assert world.state.roles == before


@pytest.mark.parametrize(("ages", "first"), [(0.5, "high"), (1.5, "high"), (2.1, "equal"), (3.1, "low")])
def test_a_low_one_that_stands_behind_others_rises_by_one_with_each_five_minutes(ages, first):
    world = busy_floor()
    world.tell(ask("low", LOW), ask("old high", HIGH))
    begun = world.now
    while world.now < begun + ages * AGE_S:
        world.now += GAP_S / 2
        world.tell(m.Tick())
    keep(world)
    world.tell(m.RunOver("old high"), ask("high", HIGH))
    winners = free(world)
    assert winners in ([["low"], ["high"]] if first == "equal" else [[first]])


def test_the_time_in_which_the_server_was_away_makes_nobody_older():
    world = busy_floor()
    world.tell(ask("low", LOW), ask("high", HIGH))
    world.now += 100 * AGE_S
    world.tell(m.Tick())
    assert free(world) == ["high"]


def test_a_clock_that_goes_back_makes_nobody_younger_than_new():
    world = busy_floor()
    world.tell(ask("low", LOW), ask("normal"))
    world.now -= 100 * AGE_S
    assert free(world) == ["normal"]


def test_a_floor_without_priorities_is_kept_as_the_version_before_reads_it():
    world = busy_floor()
    world.tell(ask("a"), ask("b"))
    parts = {key for task in floor.to_json(world.state)["jobs"] for key in task}
    assert parts.isdisjoint({"priority", "due", "behind_since"})
    world.tell(ask("c", HIGH, due=5.0))
    stored = floor.to_json(world.state)
    assert floor.from_json(json.loads(json.dumps(stored))).tasks == world.state.tasks
    assert {task.behind_since for task in world.state.tasks if task.run in "ab"} == {world.now}


def test_who_waits_alone_or_has_a_robot_does_not_age():
    world = busy_floor()
    world.tell(ask("low", LOW))
    assert [t.behind_since for t in world.state.tasks if t.run == "low"] == [None]
    free(world)
    world.tell(ask("high", HIGH))
    assert [t.behind_since for t in world.state.tasks if t.run in {"low", "high"}] == [None, None]


def test_a_paused_run_takes_no_robot_from_those_that_wait_and_finds_one_when_it_is_resumed():
    world = busy_floor()
    world.tell(ask("paused"), m.RunPaused("paused"), ask("other"))
    assert free(world) == ["other"]
    keep(world)
    assert [t.wait.code for t in world.state.tasks if t.run == "paused"] == ["paused"]
    world.tell(m.RunOver("other"))
    assert "paused/robot" not in world.state.roles
    world.tell(m.RunResumed("paused"))
    assert world.state.roles["paused/robot"] == "robot01"


def test_a_paused_run_does_not_fail_for_a_robot_that_is_not_there_and_takes_it_when_it_is_resumed():
    world = PretendFloor(LAYOUT, deaf=["robot01"])
    lost = replace(world.state.robots["robot01"], path=(), held=(), online=False)
    world.state = replace(world.state, robots={**world.state.robots, "robot01": lost})
    world.tell(m.DeviceOffline("robot01"), ask("a", device="robot01"), m.RunPaused("a"))
    for _ in range(80):
        world.pass_time(0.5)
    assert (world.over, world.state.roles, world.waits[-1].reason.code) == ({}, {}, "paused")
    world.deaf.clear()
    world.tell(m.DeviceOnline("robot01"))
    world.pass_time()
    assert world.state.roles == {}
    world.tell(m.RunResumed("a"))
    assert world.state.roles == {"a/robot": "robot01"}
    world.run_until(lambda: world.over)
    assert world.over == {("a", 1): ("", "")}


def test_a_task_asked_twice_counts_once():
    world = busy_floor()
    world.tell(ask("a", HIGH), replace(ask("a", HIGH), priority=LOW))
    assert [t.priority for t in world.state.tasks if t.run == "a"] == [HIGH]

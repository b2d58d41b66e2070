"""Devices that are away: for a moment, for too long, more than once, or two of them after each other."""

import pytest

from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import messages as m
from execution.traffic.dispatch import ABSENCE_S
from tests.kit import demo_floor
from tests.unit.execution.traffic import simulated_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor

LAYOUT = demo_floor.layout()
OVEN = "curingOven01"
LONG_S = ABSENCE_S + 1


def move(run, robot="robot01", goal="dropOff01"):
    return m.TaskAsked(run, 1, TaskOrder("move", Target(goal), "robot"), robot, (), f"run {run}")


def call(run, robot="", task=1):
    order = TaskOrder("call", Target(OVEN), "robot" if robot else "", method="curePaint", arguments={"time": 1})
    return m.TaskAsked(run, task, order, robot, (), f"run {run}")


def pass_time(world, seconds):
    for _ in range(round(2 * seconds)):
        world.pass_time(0.5)


def be_away(world, device, seconds=1.0):
    world.tell(m.DeviceOffline(device))
    pass_time(world, seconds)
    world.tell(m.DeviceOnline(device))


def test_a_robot_that_is_away_for_a_moment_again_and_again_goes_on(monkeypatch):
    monkeypatch.setattr(simulated_floor, "SPEED_M_S", 0.2)
    world = PretendFloor(LAYOUT)
    world.tell(move("a"))
    for _ in range(3):
        pass_time(world, 20)
        be_away(world, "robot01")
        assert world.over == {}
    world.run_until(lambda: world.over)
    assert world.over == {("a", 1): ("", "")}


@pytest.mark.parametrize("before", [0, 1])
def test_a_robot_that_is_away_for_too_long_fails_its_task_whether_it_was_away_before_or_not(before):
    world = PretendFloor(LAYOUT)
    world.tell(m.CallSent("by hand", "robot01", "wave", {}, "Ada"), move("a"))  # it stands until a person is done
    for _ in range(before):
        be_away(world, "robot01")
        pass_time(world, LONG_S)
    begun = world.now
    world.tell(m.DeviceOffline("robot01"))
    world.run_until(lambda: world.over, 2 * ABSENCE_S)
    assert world.over == {("a", 1): ("offline", "TurtleBot 1 is offline.")}
    assert world.now - begun == pytest.approx(ABSENCE_S, abs=0.2)


def test_a_call_that_has_waited_for_its_machine_to_come_back_and_then_to_be_free_waits_for_it_anew():
    world = PretendFloor(LAYOUT, deaf=[OVEN])
    world.tell(call("a"), m.DeviceOffline(OVEN), call("b"))
    pass_time(world, 1)
    world.tell(m.DeviceOnline(OVEN))
    pass_time(world, LONG_S)
    assert world.waits[-1].reason.code == "machine_busy"
    begun = world.now
    world.tell(m.DeviceOffline(OVEN))
    assert world.over == {}
    world.run_until(lambda: ("b", 1) in world.over, 2 * ABSENCE_S)
    assert world.over["b", 1] == ("offline", "Curing Oven is offline.")
    assert world.now - begun == pytest.approx(ABSENCE_S, abs=0.2)


def test_a_robot_that_was_away_on_its_way_to_a_machine_waits_there_for_it_as_long_as_any_other():
    world = PretendFloor(LAYOUT)
    world.tell(m.DeviceOffline(OVEN), call("a", "robot01"))
    be_away(world, "robot01")
    world.run_until(lambda: any(wait.reason and wait.reason.args.get("device") == OVEN for wait in world.waits))
    begun = world.now
    assert begun > ABSENCE_S / 2
    world.run_until(lambda: world.over, 2 * ABSENCE_S)
    assert world.over == {("a", 1): ("offline", "Curing Oven is offline.")}
    assert world.now - begun == pytest.approx(ABSENCE_S, abs=0.2)


def test_the_time_in_which_its_run_is_paused_is_no_absence():
    world = PretendFloor(LAYOUT)
    world.tell(m.DeviceOffline("robot01"), move("a"))
    pass_time(world, 5)
    world.tell(m.RunPaused("a"))
    pass_time(world, LONG_S)
    world.tell(m.RunResumed("a"))
    assert (world.over, world.waits[-1].reason.code) == ({}, "offline")
    world.run_until(lambda: world.over, 2 * ABSENCE_S)
    assert world.over == {("a", 1): ("offline", "TurtleBot 1 is offline.")}


def test_a_clock_that_is_put_back_lets_limits_run_out_as_long_after_as_ever():
    world = PretendFloor(LAYOUT)
    world.now = 4000.0
    world.tell(m.CallSent("by hand", "robot01", "wave", {}, "Ada"), move("a"))
    world.tell(m.DeviceOffline("robot01"))
    world.now -= 3600.0
    begun = world.now
    world.run_until(lambda: world.over, 2 * ABSENCE_S)
    assert world.over == {("a", 1): ("offline", "TurtleBot 1 is offline.")}
    assert world.now - begun == pytest.approx(ABSENCE_S, abs=0.2)

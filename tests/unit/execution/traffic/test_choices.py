"""Robots that are chosen by what they report: who gets the role, who waits, and what is kept of it."""

import json
from dataclasses import replace

import pytest

from editor.language.expressions.nodes import Constant, Located, Operation, Reading
from editor.language.plan.instructions import RoleBinding
from editor.language.plan.json_form import expression_to_json
from execution import floor_protocol as protocol
from execution.floor_protocol import AskingRun, to_floor
from execution.machine import messages as r
from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import floor
from execution.traffic import messages as m
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor

LAYOUT = demo_floor.layout()
CAN = ("move", "pick", "drop")
BATTERY = Reading(Located(role="robot"), "battery")
CHARGED = Operation(">", (BATTERY, Constant(30)))
GOAL = "paintMachine01"


def ask(run, task=1, where=CHARGED, said="battery > 30 %", holds=0):
    """Return what the floor is told when a run asks for its robot, as the database keeps it between them."""
    order = TaskOrder("move", Target(GOAL), "robot")
    asking = AskingRun(run, f"run {run}", {"robot": RoleBinding("robot", None, CAN, where, said, holds)}, ())
    stored = json.dumps(protocol.to_json(to_floor(asking, r.Ask(task, order))))
    return protocol.floor_message_from_json(json.loads(stored))


def report(**battery):
    return m.RobotsReport({robot: {"battery": value} for robot, value in battery.items()})


def test_the_nearest_robot_that_meets_the_condition_takes_the_role_and_keeps_it_whatever_it_reports_later():
    world = PretendFloor(LAYOUT, {"robot03": (18.0, -5.0)})
    world.tell(report(robot01=10, robot02=31, robot03=30), ask("a"))
    assert world.state.roles == {"a/robot": "robot02"}
    world.run_until(lambda: ("a", 1) in world.over)
    world.tell(report(robot01=90, robot02=1, robot03=90), ask("a", 2))
    assert (world.state.roles, world.over["a", 1]) == ({"a/robot": "robot02"}, ("", ""))


def test_a_run_waits_for_a_robot_says_for_what_and_goes_on_when_one_reports_it():
    world = PretendFloor(LAYOUT)
    world.tell(report(robot01=10, robot02=20), ask("a"))
    reason = world.waits[-1].reason
    assert (world.state.roles, reason.code, reason.args) == ({}, "no_fitting_robot", {"condition": "battery > 30 %"})
    assert reason.text == "It waits for a robot that can do this to be free and online, with battery > 30 %."
    world.tell(report(robot01=29, robot02=30), m.Tick())
    assert world.state.roles == {}
    world.state = floor.from_json(json.loads(json.dumps(floor.to_json(world.state))))
    world.tell(report(robot01=29, robot02=31), m.Tick())
    assert world.state.roles == {"a/robot": "robot02"}
    assert world.waits[-1].reason is None


def test_a_robot_that_nothing_is_known_of_or_that_is_away_does_not_qualify():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a"))
    world.tell(m.RobotsReport({"robot01": {"load": "box"}, "robot02": {"battery": "full"}}), m.Tick())
    world.tell(m.DeviceOffline("robot03"), report(robot03=90), m.Tick())
    assert world.state.roles == {}
    world.tell(m.DeviceOnline("robot03"), report(robot03=90), m.Tick())
    assert world.state.roles == {"a/robot": "robot03"}


def test_what_was_reported_before_is_not_known_any_more():
    world = PretendFloor(LAYOUT)
    world.tell(report(robot01=90))
    world.tell(ask("a"))
    assert world.state.roles == {}


def test_two_runs_that_want_the_only_charged_robot_have_it_one_after_the_other():
    world = PretendFloor(LAYOUT)
    world.tell(report(robot02=80, robot01=5, robot03=5), ask("a"), ask("b"))
    (holder,) = world.state.roles
    other = "b" if holder.startswith("a") else "a"
    assert world.state.roles[holder] == "robot02"
    assert [each.run for each in world.waits if each.reason.code == "no_fitting_robot"] == [other]
    world.tell(report(robot02=80, robot01=5), m.RunOver(holder[0]))
    assert world.state.roles == {f"{other}/robot": "robot02"}


def test_two_runs_with_conditions_that_two_robots_meet_get_one_each():
    world = PretendFloor(LAYOUT)
    low = Operation("<", (BATTERY, Constant(50)))
    world.tell(report(robot01=40, robot02=80, robot03=5), ask("a"), ask("b", where=low))
    assert world.state.roles["a/robot"] in {"robot01", "robot02"}
    assert world.state.roles["b/robot"] in {"robot01", "robot03"}
    assert len(set(world.state.roles.values())) == 2


@pytest.mark.parametrize(
    ("where", "robot"),
    [
        (Operation("and", (CHARGED, Operation("==", (Reading(Located(role="robot"), "load"), Constant(""))))), None),
        (
            Operation("or", (CHARGED, Operation("==", (Reading(Located(role="robot"), "load"), Constant(""))))),
            "robot01",
        ),
        (Operation("not", (CHARGED,)), None),
        (Operation("+", (BATTERY, Constant(1))), None),
        (Operation("/", (BATTERY, Constant(0))), None),
    ],
)
def test_a_condition_that_has_no_value_for_a_robot_leaves_it_out(where, robot):
    world = PretendFloor(LAYOUT)
    world.tell(report(robot01=90), ask("a", where=where))
    assert world.state.roles.get("a/robot") == robot


def test_a_task_without_a_condition_is_kept_and_told_as_before_and_read_by_the_version_before():
    told = protocol.to_json(m.TaskAsked("a", 1, TaskOrder("move", Target(GOAL), "robot"), "", CAN))
    assert not {"where", "said"} & told.keys()
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", where=None, said=""), ask("b"))
    jobs = floor.to_json(world.state)["jobs"]
    assert [{"where", "said"} & job.keys() for job in jobs] == [set(), {"where", "said"}]
    assert jobs[1]["where"] == expression_to_json(CHARGED)
    assert floor.from_json(json.loads(json.dumps(floor.to_json(world.state)))).tasks == world.state.tasks


def sized(**capacity):
    """Return the factory whose robots hold so many objects each."""
    devices = {
        name: replace(device, capacity=capacity.get(name, device.capacity)) for name, device in LAYOUT.devices.items()
    }
    return replace(LAYOUT, devices=devices)


def test_a_robot_that_holds_less_than_its_role_needs_does_not_get_it_however_near_it_is():
    near = {"robot01": (18.0, -5.0)}
    world = PretendFloor(sized(robot01=1, robot02=3, robot03=1), near)
    world.tell(ask("a", where=None, said="", holds=3), ask("b", where=None, said=""))
    assert world.state.roles == {"a/robot": "robot02", "b/robot": "robot01"}
    world.tell(ask("c", where=None, said="", holds=2))
    assert ("c/robot" in world.state.roles, world.waits[-1].reason.code) == (False, "no_free_robot")
    world.state = floor.from_json(json.loads(json.dumps(floor.to_json(world.state))))
    world.tell(m.RunOver("a"))
    assert world.state.roles == {"b/robot": "robot01", "c/robot": "robot02"}


def test_a_robot_that_does_not_say_how_much_it_holds_may_have_the_role():
    world = PretendFloor(sized(robot01=1, robot02=0, robot03=1))
    world.tell(ask("a", where=None, said="", holds=3))
    assert world.state.roles == {"a/robot": "robot02"}


def test_a_role_that_no_robot_is_large_enough_for_is_refused():
    world = PretendFloor(sized(robot01=1, robot02=2, robot03=1))
    world.tell(ask("a", where=None, said="", holds=3))
    why = (
        "No robot of this site can move and pick and drop and hold 3 objects at once. "
        "Approve one that can, or change the role."
    )
    assert (world.over["a", 1], world.state.roles) == (("refused", why), {})


def test_how_much_a_role_needs_is_written_only_where_that_is_more_than_one():
    world = PretendFloor(sized(robot01=1, robot02=1, robot03=3))
    world.tell(m.DeviceOffline("robot03"), ask("a", where=None, said=""), ask("b", where=None, said="", holds=3))
    jobs = floor.to_json(world.state)["jobs"]
    assert [job.get("holds") for job in jobs] == [None, 3]
    assert floor.from_json(json.loads(json.dumps(floor.to_json(world.state)))).tasks == world.state.tasks

"""Methods of a robot's own on the floor: carried out where it stands, by a robot that can, that the run holds."""

from dataclasses import replace

import pytest

from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import floor
from execution.traffic import messages as m
from execution.traffic.dispatch import CALL_LIMIT_S, limit_of
from execution.traffic.layout import make_layout
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor
from vipo_device.kit.arguments import duration_s
from vipo_device.protocol.description import MethodSpec, ParameterSpec

TIMES = ParameterSpec("times", "number", "", 1, 10)
HOLD = ParameterSpec("time", "number", "SEC", 1, 60)


def floor_with(**methods):
    """Return the factory in which some robots describe more methods."""
    devices = [
        replace(device, methods=(*device.methods, *methods.get(device.id, ()))) for device in demo_floor.devices()
    ]
    return PretendFloor(make_layout(demo_floor.grid(), devices, demo_floor.places()))


def honk(*parameters):
    return MethodSpec("honk", "t/honk", parameters=parameters)


def ask(run, number, method, can=(), wants="", **arguments):
    order = TaskOrder("perform", Target(), "robot", method=method, arguments=arguments)
    return m.TaskAsked(run, number, order, wants, can or (method,), f"run {run}")


def test_the_robot_that_describes_it_is_chosen_and_does_it_where_it_stands():
    world = floor_with(robot02=(honk(TIMES),))
    before = world.at["robot02"]
    world.tell(ask("a", 1, "honk", times=5))
    assert [(c.device, c.method, dict(c.arguments)) for c in world.sent] == [("robot02", "honk", {"times": 5})]
    assert world.state.robots["robot02"].run == "a"
    world.run_until(lambda: ("a", 1) in world.over, 10)
    assert (world.over["a", 1], world.at["robot02"]) == (("", ""), before)


def test_two_runs_that_want_the_only_robot_that_can_honk_have_it_one_after_the_other():
    world = floor_with(robot03=(honk(TIMES),))
    world.tell(ask("a", 1, "honk", times=1), ask("b", 1, "honk", times=2))
    assert [c.arguments for c in world.sent] == [{"times": 1}]
    assert world.waits[-1].reason.code == "no_free_robot"
    world.run_until(lambda: ("a", 1) in world.over, 10)
    world.pass_time(1)
    assert len(world.sent) == 1
    world.tell(m.RunOver("a"))
    world.run_until(lambda: ("b", 1) in world.over, 10)
    assert [c.arguments for c in world.sent] == [{"times": 1}, {"times": 2}]


def test_a_robot_that_drives_finishes_its_way_before_it_honks():
    world = floor_with(robot01=(honk(),))
    move = TaskOrder("move", Target("dropOff01"), "robot")
    world.tell(m.TaskAsked("a", 1, move, "robot01", (), "run a"), ask("a", 2, "honk", wants="robot01"))
    assert world.waits[-1].reason.code == "robot_busy"
    world.run_until(lambda: ("a", 1) in world.over)
    world.run_until(lambda: ("a", 2) in world.over, 10)
    assert [c.method for c in world.sent if c.method != "move"] == ["honk"]


def test_no_robot_that_can_honk_is_a_refusal():
    world = floor_with()
    world.tell(ask("a", 1, "honk"))
    refused = ("refused", "No robot of this site can honk. Approve one that can, or change the role.")
    assert (world.over["a", 1], world.sent) == (refused, [])


def test_a_robot_whose_description_has_lost_the_method_refuses_it():
    world = floor_with()
    world.tell(ask("a", 1, "honk", wants="robot01", can=("move",)))
    assert world.over["a", 1] == ("refused", "TurtleBot 1 cannot honk; it offers no such method.")
    assert world.sent == []


@pytest.mark.parametrize("method", ["move", "pick", "drop"])
def test_what_is_a_step_of_its_own_is_not_sent_as_a_method(method):
    world = floor_with()
    world.tell(ask("a", 1, method, wants="robot01"))
    refused = ("refused", f"TurtleBot 1 does {method} only as a step of its own.")
    assert (world.over["a", 1], world.sent) == (refused, [])


def test_a_robot_explores_in_no_run():
    world = floor_with(robot01=(MethodSpec("explore", "t/x"),))
    world.tell(ask("a", 1, "explore"))
    refused = ("refused", "TurtleBot 1 does explore only by hand, while no run is open.")
    assert (world.over["a", 1], world.sent) == (refused, [])


@pytest.mark.parametrize("method", ["move.location", "__class__", "../stop", "鳴らす", "a b"])
def test_any_name_is_only_a_name(method):
    world = floor_with(robot01=(MethodSpec(method, "t/x"),))
    world.tell(ask("a", 1, method))
    assert [(c.device, c.method) for c in world.sent] == [("robot01", method)]


def test_it_is_told_to_stop_when_its_run_is_cancelled_and_serves_the_next_only_when_it_has_answered():
    world = floor_with(robot01=(honk(),))
    world.tell(ask("a", 1, "honk"))
    command = world.sent[0].id
    world.tell(m.RunOver("a"))
    assert [(c.method, c.arguments) for c in world.sent[1:]] == [("cancel", {"command": command})]
    world.tell(ask("b", 1, "honk"))
    assert len(world.sent) == 2
    world.tell(m.CommandAnswered(command, "CANCELED"))
    assert [c.method for c in world.sent] == ["honk", "cancel", "honk"]


def test_it_has_the_time_that_its_arguments_say_and_a_minute():
    world = floor_with(robot01=(honk(HOLD),))
    world.deaf.add("robot01")
    world.tell(ask("a", 1, "honk", time=40))
    world.run_until(lambda: ("a", 1) in world.over, 200)
    assert world.over["a", 1] == ("timed_out", "TurtleBot 1 took too long.")
    assert 119 <= world.now <= 121


def test_a_failure_of_the_robot_is_that_of_the_task():
    world = floor_with(robot01=(honk(),))
    world.tell(ask("a", 1, "honk"))
    world.tell(m.CommandAnswered(world.sent[0].id, "FAILED", "The horn is stuck."))
    assert world.over["a", 1] == ("failed", "The horn is stuck.")


def test_a_stop_holds_it_and_a_reset_lets_it_go_on():
    world = floor_with(robot01=(honk(),))
    world.tell(ask("a", 1, "honk"), m.StopPressed())
    world.tell(m.StopReset(), m.RunResumed("a"))
    world.run_until(lambda: ("a", 1) in world.over, 10)
    assert world.over["a", 1] == ("", "")


def test_a_robot_by_its_id_waits_until_no_other_run_holds_it_and_can_be_called_again():
    world = floor_with(robot01=(honk(),))
    world.tell(ask("a", 1, "honk"))
    order = TaskOrder("call", Target("robot01"), method="honk")
    world.tell(m.TaskAsked("b", 1, order, run_name="run b"))
    assert world.waits[-1].reason.text == "TurtleBot 1 is held by run a."
    world.run_until(lambda: ("a", 1) in world.over, 10)
    world.tell(m.RunOver("a"))
    world.run_until(lambda: ("b", 1) in world.over, 10)
    world.tell(m.TaskAsked("b", 2, order, run_name="run b"))
    world.run_until(lambda: ("b", 2) in world.over, 10)
    assert (world.over["b", 1], world.over["b", 2]) == (("", ""), ("", ""))


def test_a_kept_floor_knows_what_a_robot_is_at():
    world = floor_with(robot01=(honk(TIMES),))
    world.tell(ask("a", 1, "honk", times=3))
    world.state = floor.from_json(floor.to_json(world.state))
    world.run_until(lambda: ("a", 1) in world.over, 10)
    assert world.over["a", 1] == ("", "")


@pytest.mark.parametrize(
    ("name", "unit", "value", "limit_s"),
    [
        ("time", "SEC", 40, 120.0),
        ("soak", "DAY", 6, 1.5 * 6 * 86_400 + 60),
        ("soak", "MilliSEC", 40_000, 120.0),
        ("time", "", 20, 1.5 * 20 * 60 + 60),
        ("soak", "", 20, CALL_LIMIT_S),
        ("time", "DEG_C", 20, CALL_LIMIT_S),
    ],
)
def test_a_call_may_take_what_its_arguments_say_and_half_as_long_again(name, unit, value, limit_s):
    device = replace(demo_floor.devices()[0], methods=(honk(ParameterSpec(name, "number", unit)),))
    assert limit_of(device, "honk", {name: value}) == pytest.approx(limit_s)
    assert duration_s(device.methods[0], {name: value}) == (None if limit_s == CALL_LIMIT_S else (limit_s - 60) / 1.5)


def go_on(world):
    """Let a run have robot01 drive, and nobody tell of it where it is any more until it is sent off."""
    order = TaskOrder("move", Target("dropOff01"), "robot")
    world.tell(m.TaskAsked("b", 1, order, "robot01", (), "run b"))


def carried_off(world):
    x, y = world.at["robot01"]
    world.at["robot01"] = (x + 1.5, y)
    return m.RobotMoved("robot01", *world.at["robot01"])


def floor_with_mover():
    """Return the factory with a robot that stands at no place and describes a method of its own."""
    world = floor_with(robot01=(honk(),))
    world.at["robot01"] = world.layout.lattice.centre(world.layout.lattice.cells_within((1.0, -8.0), 3.0)[0])
    world.tell(m.RobotMoved("robot01", *world.at["robot01"]))
    return world


def test_a_robot_that_its_method_has_moved_drives_on_from_where_it_is():
    world = floor_with_mover()
    world.tell(ask("a", 1, "honk", wants="robot01"))
    world.tell(carried_off(world))
    world.tell(m.CommandAnswered(world.sent[0].id, "DONE"), m.RunOver("a"))
    world.works.clear()
    go_on(world)
    world.run_until(lambda: ("b", 1) in world.over)
    assert world.over["b", 1] == ("", "")


def test_a_run_waits_until_a_person_is_done_that_lets_its_robot_move_by_hand():
    world = floor_with_mover()
    world.tell(m.CallSent("by hand", "robot01", "honk", {}, "Ada"))
    world.tell(carried_off(world))
    go_on(world)
    assert (world.over, world.sent) == ({}, [])
    world.tell(m.CommandAnswered("by hand", "DONE"))
    assert world.over == {}
    world.run_until(lambda: world.over)
    assert world.over["b", 1] == ("", "")


def test_a_robot_that_a_person_lets_move_from_a_run_s_goal_is_not_there_yet():
    world = floor_with(robot01=(honk(),))
    go_on(world)
    world.run_until(lambda: world.over)
    world.over.clear()
    world.tell(m.CallSent("by hand", "robot01", "honk", {}, "Ada"))
    world.tell(carried_off(world))
    world.tell(m.TaskAsked("b", 2, TaskOrder("move", Target("dropOff01"), "robot"), run_name="run b"))
    assert world.over == {}
    assert world.waits[-1].reason.code == "robot_busy"
    world.tell(m.CommandAnswered("by hand", "DONE"))
    world.run_until(lambda: world.over)
    assert world.over["b", 2] == ("", "")
    assert world.at["robot01"] == pytest.approx(world.layout.point("dropOff01"), abs=0.3)


def test_a_robot_that_was_making_room_and_is_carried_off_makes_room_no_more():
    world = floor_with_mover()
    (cell,) = world.state.robots["robot01"].path
    waits = replace(world.state.robots["robot01"], path=(cell, cell + 1), evading="robot02")
    world.state = replace(world.state, robots={**world.state.robots, "robot01": waits})
    world.tell(carried_off(world))
    go_on(world)
    world.run_until(lambda: world.over)
    assert world.over["b", 1] == ("", "")

"""A robot that was taken out: its place, its machine, its zone and its door are free for others."""

from dataclasses import replace

import pytest

from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import floor
from execution.traffic import messages as m
from execution.traffic.floor_state import Sent
from tests.kit import demo_floor
from tests.kit.work import count_work
from tests.unit.execution.traffic.floor_with_door import EAST, WEST, WithDoor, over
from tests.unit.execution.traffic.floor_with_door import go as go_through
from tests.unit.execution.traffic.simulated_floor import PretendFloor

SHELF = "itemInventory01"
ROOM = ((6.0, -9.0), (10.0, -9.0), (10.0, -5.0), (6.0, -5.0))


def ask(run, target, robot, number=1, kind="move", zones=()):
    to = Target(target) if isinstance(target, str) else Target("", target)
    order = TaskOrder(kind, to, "robot", "box", 1, step="s")
    return m.TaskAsked(run, number, order, robot, (kind,), run, zones)


def retire(floor, robot="robot01"):
    """It is silent, and an admin has taken it out; it stands where it stood."""
    floor.deaf.add(robot)
    devices = {key: device for key, device in floor.layout.devices.items() if key != robot}
    floor.layout = replace(floor.layout, devices=devices)
    floor.tell(m.DeviceOffline(robot))


def is_nowhere(floor, robot="robot01"):
    gone = floor.state.robots[robot]
    places = robot in floor.state.stations.values() or robot in floor.state.locks.values()
    return not (gone.path or gone.held or places)


@pytest.fixture
def at_shelf():
    floor = PretendFloor(demo_floor.layout())
    floor.tell(ask("a", SHELF, "robot01"))
    floor.run_until(lambda: ("a", 1) in floor.over)
    assert floor.state.stations == {SHELF: "robot01"}
    return floor


def test_the_machine_of_a_robot_that_was_taken_out_serves_others(at_shelf):
    at_shelf.tell(m.RunOver("a"))
    retire(at_shelf)
    assert is_nowhere(at_shelf)
    at_shelf.tell(ask("b", SHELF, "robot02", kind="pick"))
    at_shelf.run_until(lambda: at_shelf.over.get(("b", 1)) == ("", ""), 120)
    at_shelf.tell(m.RunOver("b"))
    at_shelf.run_until(lambda: at_shelf.state.robots["robot02"].path[0] in {"dock1", "dock2"}, 60)


def test_a_robot_that_is_only_silent_keeps_its_cells_and_its_machine(at_shelf):
    at_shelf.tell(m.RunOver("a"), m.DeviceOffline("robot01"))
    at_shelf.deaf.add("robot01")
    for _ in range(100):
        at_shelf.pass_time()
    assert at_shelf.state.stations == {SHELF: "robot01"}
    assert at_shelf.state.robots["robot01"].held


def test_a_robot_that_waits_for_one_that_is_taken_out_goes_on(at_shelf):
    at_shelf.deaf.add("robot01")
    at_shelf.tell(m.DeviceOffline("robot01"), ask("b", SHELF, "robot02"))
    at_shelf.run_until(lambda: any(wait.reason and wait.reason.code == "machine_held" for wait in at_shelf.waits))
    retire(at_shelf)
    at_shelf.run_until(lambda: at_shelf.over.get(("b", 1)) == ("", ""), 120)


def test_the_tasks_of_a_robot_that_is_taken_out_fail_and_its_run_can_end(at_shelf):
    at_shelf.tell(ask("a", "dropOff01", "robot01", 2))
    for _ in range(20):
        at_shelf.pass_time()
    retire(at_shelf)
    at_shelf.tell(*(m.CommandAnswered(sent, "FAILED", "It is gone.") for sent in at_shelf.state.sent))
    assert at_shelf.over["a", 2] == ("failed", "It is gone.")
    at_shelf.tell(ask("a", SHELF, "robot01", 3))
    at_shelf.run_until(lambda: ("a", 3) in at_shelf.over, 40)
    assert at_shelf.over["a", 3][0] == "offline"
    assert is_nowhere(at_shelf)
    at_shelf.tell(m.RunOver("a"))
    assert (at_shelf.state.tasks, at_shelf.state.sent) == ((), {})


def test_a_robot_keeps_its_cells_until_what_it_was_told_has_ended(at_shelf):
    at_shelf.tell(ask("a", "dropOff01", "robot01", 2))
    for _ in range(20):
        at_shelf.pass_time()
    retire(at_shelf)
    assert at_shelf.state.sent
    assert at_shelf.state.robots["robot01"].held
    at_shelf.run_until(lambda: is_nowhere(at_shelf), 40)
    assert at_shelf.over["a", 2][0] == "offline"


def test_the_zone_of_a_robot_that_was_taken_out_is_free():
    zones = (m.FloorZone("p/z", "The crossing", "one_at_a_time", ROOM),)
    floor = PretendFloor(demo_floor.layout(), {"robot01": (7.0, -7.5), "robot02": (18.0, -7.5)})
    floor.tell(ask("a", (8.0, -7.5), "robot01", zones=zones))
    floor.run_until(lambda: ("a", 1) in floor.over)
    floor.tell(ask("b", (3.0, -7.5), "robot02", zones=zones), m.RunOver("a"))
    assert floor.state.locks == {"p/z": "robot01"}
    retire(floor)
    assert is_nowhere(floor)
    floor.run_until(lambda: floor.over.get(("b", 1)) == ("", ""), 120)


def test_a_door_that_a_robot_was_taken_out_of_is_closed():
    floor = WithDoor({"robot01": WEST})
    go_through(floor, EAST)
    floor.run_until(lambda: floor.inside("robot01"))
    floor.may_be_shut_in = {"robot01"}
    floor.tell(m.DeviceOffline("robot01"))
    floor.deaf.add("robot01")
    floor.run_until(over(floor), 60)
    assert floor.door().robots == ("robot01",)
    retire(floor)
    floor.run_until(lambda: not floor.is_open, 30)


def test_who_makes_room_for_a_robot_that_is_taken_out_goes_on(at_shelf):
    yielding = replace(at_shelf.state.robots["robot02"], yields_to="robot01")
    at_shelf.state = replace(at_shelf.state, robots={**at_shelf.state.robots, "robot02": yielding})
    retire(at_shelf)
    at_shelf.pass_time()
    assert at_shelf.state.robots["robot02"].yields_to == ""


def test_a_robot_that_is_let_come_back_is_on_the_floor_where_it_says_to_be(at_shelf):
    devices = at_shelf.layout.devices
    at_shelf.tell(m.RunOver("a"))
    retire(at_shelf)
    at_shelf.layout = replace(at_shelf.layout, devices=devices)
    at_shelf.deaf.clear()
    at_shelf.tell(m.DeviceOnline("robot01"), m.RobotMoved("robot01", 3.0, -8.0))
    at_shelf.tell(ask("b", SHELF, "robot01"))
    at_shelf.at["robot01"] = (3.0, -8.0)
    at_shelf.run_until(lambda: at_shelf.over.get(("b", 1)) == ("", ""), 120)


def work_among(at_shelf, gone, commands):
    """Return the lines of Python of a step with so many robots that were taken out long ago, and commands to others."""
    before = at_shelf.state
    robots = {f"gone{n}": replace(before.robots["robot01"], id=f"gone{n}", held=()) for n in range(gone)}
    sent = {f"c{n}": Sent(f"c{n}", f"machine{n}", limit_s=3600.0) for n in range(commands)}
    state = replace(before, robots={**before.robots, **robots}, sent=sent)
    state, _ = floor.step(at_shelf.layout, state, [m.Tick()], at_shelf.now)
    assert all(state.robots[each].path == () for each in robots)
    with count_work() as work:
        floor.step(at_shelf.layout, state, [m.Tick()], at_shelf.now)
    return work.lines


def test_a_robot_that_was_taken_out_long_ago_costs_a_step_the_same_however_much_is_under_way(at_shelf):
    def each(commands):
        return work_among(at_shelf, 20, commands) - work_among(at_shelf, 10, commands)

    assert each(commands=200) == each(commands=0)

"""Doors on the floor: opened for who comes, held for who is in, closed behind the last."""

import pytest

from execution.traffic import floor as pure
from execution.traffic import messages as m
from execution.traffic.doors import WAIT_LIMIT_S
from execution.traffic.layout import make_layout
from tests.kit import demo_floor
from tests.unit.execution.traffic.floor_with_door import (
    EAST,
    PASSAGE,
    WEST,
    ZONES,
    WithDoor,
    call,
    door_device,
    go,
    over,
    reasons,
)
from tests.unit.execution.traffic.simulated_floor import PretendFloor


@pytest.mark.parametrize(
    "device",
    [
        door_device(),
        door_device(reading=""),
        door_device("openGate", "shutGate", "state"),
        door_device("raise", "lower", ""),
    ],
    ids=["reading", "no reading", "a gate", "a barrier"],
)
def test_a_door_opens_for_a_robot_and_closes_behind_it(device):
    floor = WithDoor({"robot01": WEST}, device)
    go(floor, EAST)
    floor.run_until(over(floor))
    assert floor.over["r", 1] == ("", "")
    floor.run_until(lambda: not floor.is_open, 30)
    assert floor.line == [method.name for method in device.methods]


def test_a_door_is_asked_before_the_robot_comes_so_that_it_need_not_stop():
    plain = PretendFloor(demo_floor.layout(), {"robot01": WEST})
    go(plain, EAST, zones=())
    plain.run_until(over(plain))
    floor = WithDoor({"robot01": WEST})
    go(floor, EAST)
    floor.run_until(over(floor))
    assert floor.now == pytest.approx(plain.now, abs=0.2)


def test_a_robot_waits_before_a_shut_door_with_the_reason():
    floor = WithDoor({"robot01": (8.0, -8.0)})
    floor.deaf.add("door02")
    go(floor, EAST)
    floor.run_until(lambda: "door_shut" in reasons(floor), 30)
    wait = next(wait.reason for wait in floor.waits if wait.reason and wait.reason.code == "door_shut")
    assert wait == m.Reason(
        "door_shut", "TurtleBot 1 waits for Door 2 to open.", {"robot": "robot01", "device": "door02"}
    )
    for _ in range(100):
        floor.pass_time()
    assert not floor.inside("robot01")


@pytest.mark.parametrize("broken", ["FAILED", "REJECTED", "CANCELED"])
def test_a_door_that_does_not_open_is_tried_again_then_the_task_fails_and_people_are_told(broken):
    floor = WithDoor({"robot01": WEST})
    floor.is_broken = broken
    go(floor, EAST)
    stuck = []
    while ("r", 1) not in floor.over and floor.now < 200:
        stuck += [action for action in floor.pass_time() if isinstance(action, m.DoorStuck)]
    assert floor.over["r", 1] == ("blocked", "Door 2 did not open in time.")
    assert stuck == [m.DoorStuck("door02", "open", "Motor fault")]
    assert floor.line.count("open") > 5
    assert floor.now < 100


def test_a_door_that_says_done_and_stays_shut_lets_nobody_in():
    floor = WithDoor({"robot01": WEST})
    floor.stays_shut = True
    go(floor, EAST)
    floor.run_until(over(floor))
    assert floor.over["r", 1][0] == "blocked"


def test_a_door_that_is_mended_in_time_lets_the_robot_pass():
    floor = WithDoor({"robot01": WEST})
    floor.is_broken = "FAILED"
    go(floor, EAST)
    floor.run_until(lambda: "door_shut" in reasons(floor))
    floor.is_broken = ""
    floor.run_until(over(floor))
    assert floor.over["r", 1] == ("", "")


def test_an_offline_door_is_waited_for_and_then_the_task_fails():
    floor = WithDoor({"robot01": WEST})
    floor.tell(m.DeviceOffline("door02"))
    go(floor, EAST)
    floor.run_until(lambda: "door_away" in reasons(floor))
    assert floor.line == []
    floor.run_until(over(floor))
    assert floor.over["r", 1] == ("blocked", "Door 2 did not open in time.")
    floor.tell(m.DeviceOnline("door02"))
    go(floor, EAST, task=2)
    floor.run_until(over(floor, task=2))
    assert floor.over["r", 2] == ("", "")


def test_an_open_door_that_goes_offline_before_a_robot_is_waited_for_a_minute_and_then_the_task_fails():
    floor = WithDoor({"robot01": WEST})
    floor.is_open = True
    go(floor, EAST)
    floor.tell(m.DeviceOffline("door02"))
    floor.run_until(lambda: "door_away" in reasons(floor))
    begun = floor.now
    floor.run_until(over(floor), 2 * WAIT_LIMIT_S)
    assert floor.over["r", 1] == ("blocked", "Door 2 did not open in time.")
    assert floor.now <= begun + WAIT_LIMIT_S
    floor.tell(m.DeviceOnline("door02"))
    go(floor, EAST, task=2)
    floor.run_until(over(floor, task=2))
    assert floor.over["r", 2] == ("", "")


def test_an_open_door_that_is_back_within_a_minute_lets_the_robot_through():
    floor = WithDoor({"robot01": WEST})
    floor.is_open = True
    go(floor, EAST)
    floor.tell(m.DeviceOffline("door02"))
    floor.run_until(lambda: "door_away" in reasons(floor))
    for _ in range(400):
        floor.pass_time()
    assert floor.over == {}
    floor.tell(m.DeviceOnline("door02"))
    floor.run_until(over(floor))
    assert floor.over["r", 1] == ("", "")


def in_the_doorway(floor, robot="robot01"):
    floor.run_until(lambda: floor.inside(robot))


def test_a_door_that_goes_offline_lets_the_robot_out_that_is_in_it():
    floor = WithDoor({"robot01": WEST})
    go(floor, EAST)
    in_the_doorway(floor)
    floor.tell(m.DeviceOffline("door02"))
    floor.run_until(over(floor))
    assert floor.over["r", 1] == ("", "")
    assert "close" not in floor.line
    floor.tell(m.DeviceOnline("door02"))
    floor.run_until(lambda: not floor.is_open, 30)


def test_a_door_stays_open_for_a_robot_that_has_died_in_it():
    floor = WithDoor({"robot01": WEST})
    go(floor, EAST)
    in_the_doorway(floor)
    floor.deaf.add("robot01")
    floor.tell(m.DeviceOffline("robot01"))
    for _ in range(3000):
        floor.pass_time()
    assert floor.over["r", 1][0] == "offline"
    floor.tell(m.RunOver("r"))
    for _ in range(600):
        floor.pass_time()
    assert floor.is_open
    assert "close" not in floor.line
    floor.deaf.clear()
    floor.at["robot01"] = EAST
    floor.tell(m.DeviceOnline("robot01"))
    floor.run_until(lambda: not floor.is_open, 60)


def test_robots_from_both_sides_pass_one_opening():
    floor = WithDoor({"robot01": (5.5, -8.0), "robot02": (13.5, -8.0)})
    go(floor, EAST)
    go(floor, WEST, run="other", robot="robot02", zones=())
    floor.run_until(lambda: len(floor.over) == 2)
    assert set(floor.over.values()) == {("", "")}
    floor.run_until(lambda: not floor.is_open, 30)
    assert floor.line == ["open", "close"]


def test_the_next_robot_soon_after_finds_the_door_open():
    floor = WithDoor({"robot01": (6.5, -8.0), "robot02": (4.0, -7.5)})
    go(floor, EAST)
    go(floor, (17.0, -7.0), run="other", robot="robot02")
    floor.run_until(lambda: len(floor.over) == 2)
    floor.run_until(lambda: not floor.is_open, 30)
    assert floor.line == ["open", "close"]


def test_a_door_says_nothing_while_all_is_stopped_and_goes_on_after():
    floor = WithDoor({"robot01": WEST})
    go(floor, EAST)
    in_the_doorway(floor)
    floor.tell(m.StopPressed(), m.RunPaused("r"))
    for _ in range(900):
        floor.pass_time()
    assert floor.line == ["open"]
    floor.tell(m.StopReset(), m.RunResumed("r"))
    floor.run_until(over(floor))
    assert floor.over["r", 1] == ("", "")


def test_a_paused_run_holds_the_door_for_its_robot_in_it_and_opens_none_for_one_before_it():
    floor = WithDoor({"robot01": WEST})
    go(floor, EAST)
    in_the_doorway(floor)
    floor.tell(m.RunPaused("r"))
    for _ in range(300):
        floor.pass_time()
        floor.may_be_shut_in = frozenset()
    assert ("close" in floor.line) is not floor.inside("robot01")
    before = WithDoor({"robot01": WEST})
    go(before, EAST)
    before.tell(m.RunPaused("r"))
    for _ in range(300):
        before.pass_time()
    assert before.line == []


def test_a_door_that_somebody_closes_before_the_robot_is_opened_again():
    floor = WithDoor({"robot01": (6.0, -8.0)})
    go(floor, EAST)
    floor.run_until(lambda: floor.is_open and floor.door().is_open)
    assert not floor.inside("robot01")
    floor.is_open = False
    floor.may_be_shut_in = frozenset(["robot01"])  # what was released before somebody closed it is driven
    floor.run_until(over(floor))
    assert floor.over["r", 1] == ("", "")
    assert floor.line.count("open") == 2


def test_a_step_that_closes_the_door_waits_for_who_is_in_it():
    floor = WithDoor({"robot01": WEST})
    go(floor, EAST)
    in_the_doorway(floor)
    call(floor, "close", run="other")
    floor.pass_time()
    reason = next(wait.reason for wait in floor.waits if wait.run == "other")
    assert (reason.code, reason.text) == ("door_in_use", "Door 2 is held open for TurtleBot 1.")
    floor.run_until(over(floor, "other", 9))
    assert floor.over["other", 9] == ("", "")
    assert not floor.is_open


def test_a_door_that_a_step_has_opened_stays_open():
    floor = WithDoor({"robot01": WEST})
    call(floor, "open")
    floor.run_until(over(floor, task=9))
    go(floor, EAST)
    floor.run_until(over(floor))
    for _ in range(300):
        floor.pass_time()
    assert (floor.line, floor.is_open) == (["open"], True)
    call(floor, "close", task=10)
    floor.run_until(over(floor, task=10))
    assert not floor.is_open


def test_a_door_that_closes_by_a_step_lets_nobody_in_until_it_is_open_again():
    floor = WithDoor({"robot01": (8.0, -8.0)})
    floor.is_open = True
    call(floor, "close", run="other")
    go(floor, EAST)
    floor.run_until(over(floor))
    assert floor.line[:2] == ["close", "open"]


def test_a_door_that_stood_open_is_left_open():
    floor = WithDoor({"robot01": WEST})
    floor.is_open = True
    go(floor, EAST)
    floor.run_until(over(floor))
    for _ in range(300):
        floor.pass_time()
    assert floor.line == []


def test_a_door_that_is_taken_out_lets_the_task_fail_at_once():
    floor = WithDoor({"robot01": WEST})
    go(floor, EAST)
    floor.pass_time()
    layout = floor.layout
    devices = [device for device in layout.devices.values() if device.id != "door02"]
    floor.layout = make_layout(layout.ground.grid, devices, demo_floor.places())
    floor.run_until(over(floor))
    assert floor.over["r", 1] == ("blocked", "door02 is no approved device that can be told to open.")


def test_a_robot_without_a_run_has_the_door_opened_on_its_way_home():
    floor = WithDoor({"robot01": WEST, "robot02": (18.0, -5.0), "robot03": (15.0, -3.0)})
    go(floor, EAST)
    floor.run_until(over(floor))
    floor.tell(m.RunOver("r"))
    floor.run_until(lambda: floor.state.robots["robot01"].path[0] in floor.layout.docks)
    floor.run_until(lambda: not floor.is_open, 60)
    floor.run_until(lambda: floor.state.passages == (), 60)
    assert floor.state.doors == {}


def test_what_a_program_says_anew_takes_the_place_of_what_it_said():
    floor = WithDoor({"robot01": WEST})
    go(floor, EAST)
    floor.tell(m.RunOver("r"))
    go(floor, EAST, run="next", robot="robot02", zones=(m.FloorZone("p/y", "Wet", "slow", PASSAGE),))
    assert floor.state.passages == ()


def test_a_floor_that_is_stored_while_it_holds_a_door_goes_on_holding_it():
    floor = WithDoor({"robot01": WEST})
    go(floor, EAST)
    in_the_doorway(floor)
    data = pure.to_json(floor.state)
    assert pure.from_json(data) == floor.state
    assert floor.door().robots == ("robot01",)
    floor.state = pure.from_json(data)
    floor.now += 600.0
    floor.run_until(over(floor))
    assert floor.over["r", 1] == ("", "")
    floor.run_until(lambda: not floor.is_open, 30)
    assert floor.line == ["open", "close"]


def test_a_broken_door_is_not_tried_for_ever_for_a_robot_that_only_goes_home():
    floor = WithDoor({"robot01": EAST, "robot02": (18.0, -5.0), "robot03": (15.0, -3.0)})
    floor.is_broken = "FAILED"
    go(floor, WEST)
    floor.run_until(over(floor))
    floor.tell(m.RunOver("r"))
    tried = len(floor.line)
    for _ in range(6000):
        floor.pass_time()
    assert len(floor.line) <= tried + 1
    floor.is_broken = ""
    go(floor, WEST, run="next")
    floor.run_until(over(floor, "next"))
    assert floor.over["next", 1] == ("", "")


SLOW = (m.FloorZone("p/slow", "Slow", "slow", ((1.0, -12.5), (1.5, -12.5), (1.5, -12.0), (1.0, -12.0)), 0.3),)
ASIDE = (m.FloorZone("p/z", "Door", "door", ((9.0, -2.0), (10.0, -2.0), (10.0, -1.0), (9.0, -1.0)), door="door02"),)


@pytest.mark.parametrize("newer", [SLOW, ASIDE])
def test_the_door_of_a_run_under_way_opens_although_a_newer_version_has_it_no_more_or_elsewhere(newer):
    floor = WithDoor({"robot01": WEST, "robot02": (3.0, -11.0)})
    go(floor, EAST)
    floor.run_until(lambda: floor.at["robot01"][0] > 5.0)
    go(floor, (3.5, -11.0), run="q", robot="robot02", zones=newer)
    floor.run_until(over(floor))
    assert floor.over["r", 1] == ("", "")


def test_the_door_of_a_newer_version_opens_although_a_run_of_the_older_one_goes_on():
    floor = WithDoor({"robot01": WEST, "robot02": (3.0, -11.0)})
    go(floor, (3.5, -11.0), run="older", robot="robot02", zones=ASIDE)
    go(floor, EAST)
    floor.run_until(lambda: floor.at["robot01"][0] > 5.0)
    go(floor, (3.0, -11.0), run="older", task=2, robot="robot02", zones=ASIDE)
    floor.run_until(over(floor))
    assert floor.over["r", 1] == ("", "")


def test_what_a_program_said_of_a_door_before_is_replaced_once_no_open_run_says_it():
    floor = WithDoor({"robot01": WEST, "robot02": (3.0, -11.0)})
    go(floor, (3.5, -11.0), run="older", robot="robot02", zones=ASIDE)
    go(floor, EAST)
    assert set(floor.state.passages) == {*ASIDE, *ZONES}
    floor.tell(m.RunOver("older"))
    go(floor, EAST, task=2)
    assert floor.state.passages == ZONES

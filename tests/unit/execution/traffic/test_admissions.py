"""Zones that a person lets robots into: each waits outside until it is let in, each time anew."""

from __future__ import annotations

from dataclasses import replace

import pytest

from execution.traffic import floor as traffic
from execution.traffic import messages as m
from tests.unit.execution.traffic.simulated_floor import PretendFloor
from tests.unit.execution.traffic.zones.test_site_zones import (
    EAST,
    WEST,
    change,
    drive,
    floor_with,
    go,
    near,
    usual_way,
    zone,
)

POSES = {"robot01": WEST, "robot02": (18.0, -7.6)}
GATE = ((6.0, -13.0), (10.0, -13.0), (10.0, 0.0), (6.0, 0.0))
"""From wall to wall: no way leads round it."""
CLOSED = zone("release", GATE)


def wait(floor: PretendFloor, seconds: float = 120) -> None:
    for _ in range(int(seconds / 0.1)):
        floor.pass_time()


def let_in(floor: PretendFloor, robot: str = "robot01", key: str = "site/z") -> None:
    floor.tell(m.RobotLetIn(key, robot))


def reasons(floor: PretendFloor) -> list[str]:
    return [each.reason.code for each in floor.waits if each.reason]


def test_a_robot_waits_outside_until_it_is_let_in_and_then_drives_through() -> None:
    floor = floor_with(CLOSED, poses=POSES)
    go(floor, "r", EAST, "robot01")
    wait(floor)
    assert not near(floor, "robot01", GATE)
    assert floor.state.awaiting == {"robot01": "site/z"}
    assert reasons(floor)[-1] == "not_let_in"
    assert floor.waits[-1].reason.text == f"{floor.layout.name('robot01')} waits to be let into The crossing."
    let_in(floor)
    drive(floor, ("r", 1))
    assert floor.over["r", 1] == ("", "")
    assert floor.state.awaiting == {}
    assert floor.state.admissions == ()


def test_each_visit_needs_its_own_admission_and_one_robot_s_is_not_another_s() -> None:
    floor = floor_with(CLOSED, poses=POSES)
    go(floor, "a", EAST, "robot01")
    go(floor, "b", (3.0, -7.6), "robot02")
    wait(floor)
    assert floor.state.awaiting == {"robot01": "site/z", "robot02": "site/z"}
    let_in(floor, "robot02")
    drive(floor, ("b", 1))
    assert ("a", 1) not in floor.over
    let_in(floor)
    drive(floor, ("a", 1))
    go(floor, "a", WEST, "robot01", task=2)
    wait(floor)
    assert floor.state.awaiting["robot01"] == "site/z"
    assert ("a", 2) not in floor.over


def test_a_robot_on_its_way_home_waits_to_be_let_in_too() -> None:
    floor = floor_with(CLOSED, poses={"robot01": WEST})
    wait(floor)
    assert floor.state.awaiting == {"robot01": "site/z"}
    assert not near(floor, "robot01", GATE)
    let_in(floor)
    wait(floor, 60)
    assert floor.state.awaiting == {}
    assert floor.at["robot01"][0] > 10


def test_an_admission_for_a_robot_that_does_not_wait_there_changes_nothing() -> None:
    floor = floor_with(CLOSED, poses=POSES)
    go(floor, "r", EAST, "robot01")
    for robot, key in (("robot01", "site/z"), ("robot03", "site/z"), ("nobody", "site/z"), ("robot01", "site/gone")):
        let_in(floor, robot, key)
    wait(floor)
    assert floor.state.admissions == ()
    assert floor.state.awaiting == {"robot01": "site/z"}


def test_two_people_who_let_a_robot_in_at_once_let_it_in_once() -> None:
    floor = floor_with(CLOSED, poses=POSES)
    go(floor, "r", EAST, "robot01")
    wait(floor)
    let_in(floor)
    let_in(floor)
    drive(floor, ("r", 1))
    let_in(floor)
    go(floor, "r", WEST, "robot01", task=2)
    wait(floor)
    assert ("r", 2) not in floor.over


def test_a_robot_goes_round_a_zone_where_it_can_and_waits_for_nobody() -> None:
    bench = ((8.0, -8.4), (9.0, -8.4), (9.0, -7.6), (8.0, -7.6))
    floor = floor_with(zone("release", bench), poses={"robot01": WEST})
    go(floor, "r", EAST, "robot01")
    beside: list[bool] = []
    drive(floor, ("r", 1), look=lambda: beside.append(near(floor, "robot01", bench)))
    assert floor.over["r", 1] == ("", "")
    assert reasons(floor) == []
    assert not any(beside)


def test_a_robot_goes_round_a_zone_whose_opening_is_over() -> None:
    bench = ((8.0, -8.4), (9.0, -8.4), (9.0, -7.6), (8.0, -7.6))
    floor = floor_with(replace(zone("release", bench), open_until=1.0), poses={"robot01": WEST})
    wait(floor, 2)
    go(floor, "r", EAST, "robot01")
    beside: list[bool] = []
    drive(floor, ("r", 1), look=lambda: beside.append(near(floor, "robot01", bench)))
    assert floor.over["r", 1] == ("", "")
    assert reasons(floor) == []
    assert not any(beside)


def test_who_does_not_come_in_for_a_minute_has_to_be_let_in_anew() -> None:
    floor = floor_with(CLOSED, poses=POSES)
    go(floor, "r", EAST, "robot01")
    wait(floor)
    floor.tell(m.RunPaused("r"))
    let_in(floor)
    wait(floor, 70)
    assert floor.state.admissions == ()
    floor.tell(m.RunResumed("r"))
    wait(floor, 30)
    assert floor.state.awaiting["robot01"] == "site/z"
    assert not near(floor, "robot01", GATE)


def test_an_admission_ends_with_the_run_that_wanted_in() -> None:
    floor = floor_with(CLOSED, poses={**POSES, "robot01": (5.0, -8.0)})
    go(floor, "r", EAST, "robot01")
    wait(floor)
    let_in(floor)
    floor.tell(m.RunOver("r"))
    wait(floor)
    assert floor.state.admissions == ()
    assert not near(floor, "robot01", GATE)


@pytest.mark.parametrize("share", [0.3, 0.5])
def test_a_zone_made_ahead_of_a_robot_under_way_stops_it_outside(share: float) -> None:
    track = usual_way()
    floor = floor_with(poses={"robot01": WEST})
    go(floor, "r", EAST, "robot01")
    inside = next(index for index, at in enumerate(track) if at[0] > 6.0)
    for _ in range(int(inside * share)):
        floor.pass_time()
    change(floor, CLOSED)
    wait(floor)
    assert not near(floor, "robot01", GATE)
    assert floor.state.awaiting == {"robot01": "site/z"}


def test_a_robot_that_is_in_a_zone_when_it_is_made_leaves_it() -> None:
    floor = floor_with(CLOSED, poses={"robot01": (8.0, -8.0)})
    go(floor, "r", EAST, "robot01")
    drive(floor, ("r", 1))
    assert floor.over["r", 1] == ("", "")


def test_who_waits_to_be_let_in_makes_room_for_who_wants_past() -> None:
    floor = floor_with(CLOSED, poses={"robot01": WEST, "robot02": (12.0, -8.0)})
    go(floor, "r", EAST, "robot01")
    wait(floor)
    go(floor, "s", WEST, "robot02")
    wait(floor, 30)
    let_in(floor, "robot02")
    drive(floor, ("s", 1))
    assert ("r", 1) not in floor.over


def test_the_floor_is_kept_with_who_waits_and_who_was_let_in() -> None:
    floor = floor_with(CLOSED, poses=POSES)
    go(floor, "r", EAST, "robot01")
    go(floor, "b", (3.0, -7.6), "robot02")
    wait(floor)
    let_in(floor)
    floor.pass_time()
    kept = traffic.from_json(traffic.to_json(floor.state))
    assert kept == floor.state
    assert kept.awaiting == {"robot02": "site/z"}
    assert [(each.zone, each.robot) for each in kept.admissions] == [("site/z", "robot01")]


def test_states_of_before_are_read() -> None:
    floor = floor_with(poses=POSES)
    kept = traffic.to_json(floor.state)
    assert "awaiting" not in kept
    assert "admissions" not in kept
    assert replace(traffic.from_json(kept), now=floor.state.now) == floor.state


def open_for(floor: PretendFloor, seconds: float) -> None:
    """Somebody opens the zone for so long, on the map."""
    change(floor, replace(CLOSED, open_until=floor.state.now + seconds))


def test_while_a_zone_is_open_all_drive_through_it_and_none_waits() -> None:
    floor = floor_with(CLOSED, poses=POSES)
    open_for(floor, 600)
    go(floor, "a", EAST, "robot01")
    go(floor, "b", (3.0, -7.6), "robot02")
    drive(floor, ("a", 1), ("b", 1))
    assert [floor.over[key] for key in (("a", 1), ("b", 1))] == [("", "")] * 2
    assert "not_let_in" not in reasons(floor)


def test_who_waits_drives_on_when_the_zone_is_opened_and_the_next_waits_when_its_time_is_over() -> None:
    floor = floor_with(CLOSED, poses=POSES)
    go(floor, "a", EAST, "robot01")
    wait(floor)
    let_in(floor)  # an admission that the opening makes needless
    open_for(floor, 60)
    drive(floor, ("a", 1))
    assert floor.state.admissions == ()
    wait(floor, 60)
    go(floor, "b", (3.0, -7.6), "robot02")
    wait(floor)
    assert floor.state.awaiting == {"robot02": "site/z"}
    assert not near(floor, "robot02", GATE)


@pytest.mark.parametrize("shuts", ["its time is over", "somebody closes it"])
@pytest.mark.parametrize("share", [0.3, 0.5, 0.9])
def test_a_robot_on_its_way_to_a_zone_stops_outside_when_it_shuts(share: float, shuts: str) -> None:
    track = usual_way()
    floor = floor_with(CLOSED, poses={"robot01": WEST})
    inside = next(index for index, at in enumerate(track) if at[0] > 5.7)
    lasts_s = int(inside * share) * 0.1
    open_for(floor, lasts_s if shuts == "its time is over" else 600)
    go(floor, "r", EAST, "robot01")
    wait(floor, lasts_s)
    if shuts == "somebody closes it":
        change(floor, CLOSED)
    beside: list[bool] = []
    for _ in range(1200):
        floor.pass_time()
        beside.append(near(floor, "robot01", GATE))
    assert not any(beside)
    assert floor.state.awaiting == {"robot01": "site/z"}


def test_a_robot_that_is_in_a_zone_when_it_shuts_leaves_it() -> None:
    floor = floor_with(CLOSED, poses={"robot01": (8.0, -8.0)})
    open_for(floor, 3)
    go(floor, "r", EAST, "robot01")
    wait(floor, 3)
    assert near(floor, "robot01", GATE)
    drive(floor, ("r", 1))
    assert floor.over["r", 1] == ("", "")
    assert floor.state.awaiting == {}


def test_an_open_zone_is_kept_with_its_time_and_others_are_kept_as_before() -> None:
    floor = floor_with(CLOSED, poses=POSES)
    floor.pass_time()
    assert "open_until" not in str(traffic.to_json(floor.state))
    opened = replace(CLOSED, open_until=floor.state.now + 5)
    assert m.zone_from_json(m.zone_to_json(opened)) == opened
    assert [replace(CLOSED, rule="keep_out", open_until=9.0).is_open(1.0), opened.is_open(0.0)] == [False, True]

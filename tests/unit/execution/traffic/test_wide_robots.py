"""Robots that are wider than the demo's: they keep off each other, and one that joins makes the others plan anew."""

import random
from dataclasses import replace
from math import hypot

import pytest

from bench.lattice.buildings import make_building
from execution.traffic import messages as m
from execution.traffic.floor_state import from_json, to_json
from execution.traffic.layout import make_layout
from registry.floorplan.plan import FREE, OCCUPIED, Grid
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor
from tests.unit.execution.traffic.zones.test_site_zones import go

WIDE_M, HIGH_M, CELL_M = 24.0, 14.0, 0.1
WIDTHS = (0.3, 0.4, 0.6)


def hall():
    """An empty hall."""
    columns, rows = round(WIDE_M / CELL_M), round(HIGH_M / CELL_M)
    rim = [OCCUPIED] * columns
    inside = [OCCUPIED, *[FREE] * (columns - 2), OCCUPIED]
    return Grid(columns, rows, CELL_M, 0.0, 0.0, bytes(rim + inside * (rows - 2) + rim))


def robots(radius_m, count=4):
    like = next(device for device in demo_floor.devices() if device.kind == "robot")
    return [replace(like, id=f"robot{number:02}", radius_m=radius_m) for number in range(1, count + 1)]


def all_over(floor, count):
    return lambda: len(floor.over) == count


@pytest.mark.parametrize("radius_m", WIDTHS)
def test_wide_robots_never_touch(radius_m):
    chance = random.Random(2)
    them = robots(radius_m)
    starts = {robot.id: (3.0 + 5 * number, 3.0 + number % 2 * 6) for number, robot in enumerate(them)}
    floor = PretendFloor(make_layout(hall(), them), starts)
    for round_ in range(8):
        for robot in them:
            run = f"{robot.id} {round_}"
            go(floor, run, (chance.uniform(1.5, WIDE_M - 1.5), chance.uniform(1.5, HIGH_M - 1.5)), robot.id)
        floor.run_until(all_over(floor, (round_ + 1) * len(them)))
        for robot in them:
            floor.tell(m.RunOver(f"{robot.id} {round_}"))
    assert floor.nearest > 2 * radius_m


@pytest.mark.parametrize("radius_m", [0.18, *WIDTHS])
def test_who_stands_nearer_than_two_radii_and_ten_centimetres_shares_a_cell(radius_m):
    layout, chance = make_layout(hall(), robots(radius_m, 1)), random.Random(3)
    for _ in range(300):
        x, y = chance.uniform(4, WIDE_M - 4), chance.uniform(4, HIGH_M - 4)
        apart = chance.uniform(0, 2 * radius_m + 0.1)
        turn = complex(chance.uniform(-1, 1), chance.uniform(-1, 1))
        turn *= apart / abs(turn)
        one, other = (layout.spot(f"@{a:.3f},{b:.3f}") for a, b in ((x, y), (x + turn.real, y + turn.imag)))
        assert one.body & other.body


def test_a_wider_robot_that_joins_lets_all_plan_anew_and_nobody_touches():
    narrow, wide = robots(0.18, 3), robots(0.5, 4)[3]
    starts = {"robot01": (3.0, 3.0), "robot02": (20.0, 3.0), "robot03": (3.0, 10.0)}
    floor = PretendFloor(make_layout(hall(), narrow), starts)
    for robot, goal in (("robot01", (20.0, 10.0)), ("robot02", (3.0, 9.0)), ("robot03", (20.0, 4.0))):
        go(floor, robot, goal, robot)
    for _ in range(40):
        floor.pass_time()
    before = floor.state.lattice
    floor.layout = make_layout(hall(), [*narrow, wide])
    floor.state = from_json(to_json(floor.state))
    floor.at[wide.id], floor.queue[wide.id] = (12.0, 12.0), []
    floor.tell(m.DeviceOnline(wide.id), m.RobotMoved(wide.id, 12.0, 12.0))
    assert floor.state.lattice == floor.layout.numbering != before
    for robot in floor.state.robots.values():
        nearest = min(floor.layout.point(node) for node in robot.path)
        assert hypot(nearest[0] - robot.x, nearest[1] - robot.y) < 1.0 or len(robot.path) > 1
        assert set(robot.held) <= set(floor.layout.lattice.links) | set(range(floor.layout.lattice.columns * 99))
    go(floor, wide.id, (12.0, 2.0), wide.id)
    floor.run_until(lambda: len(floor.over) == 4)
    assert {kind for kind, _ in floor.over.values()} == {""}
    assert floor.nearest > 0.36


def test_what_is_kept_of_a_usual_floor_is_read_by_the_version_before_and_goes_on():
    floor = PretendFloor(make_layout(hall(), robots(0.18, 1)), {"robot01": (3.0, 3.0)})
    go(floor, "a", (20.0, 10.0), "robot01")
    for _ in range(20):
        floor.pass_time()
    stored = to_json(floor.state)
    assert "lattice" not in stored
    floor.state = from_json(stored)
    path = floor.state.robots["robot01"].path
    floor.pass_time()
    assert floor.state.robots["robot01"].path == path


def test_what_was_kept_before_lines_went_through_doors_is_numbered_otherwise_and_robots_plan_anew():
    grid = make_building(1)
    layout = make_layout(grid, robots(0.4, 1))
    assert layout.numbering
    start, goal = (layout.lattice.centre(cell) for cell in (min(layout.lattice.links), max(layout.lattice.links)))
    floor = PretendFloor(layout, {"robot01": start})
    go(floor, "a", goal, "robot01")
    for _ in range(20):
        floor.pass_time()
    floor.state = replace(floor.state, lattice="")
    sent = len(floor.sent)
    floor.pass_time()
    assert "cancel" in {command.method for command in floor.sent[sent:]}
    floor.run_until(lambda: floor.over)
    assert floor.over == {("a", 1): ("", "")}
    assert hypot(floor.at["robot01"][0] - goal[0], floor.at["robot01"][1] - goal[1]) < 0.1


def test_a_robot_that_stands_too_far_from_every_way_is_sent_nowhere_and_its_step_says_why():
    """It would refuse the way: straight on to where it begins may lead through a wall."""
    layout = make_layout(hall(), robots(0.6, 1))
    floor = PretendFloor(layout, {"robot01": (0.2, 5.0)})
    go(floor, "r", (12.0, 7.0), "robot01")
    for _ in range(100):
        floor.pass_time()
    begin = layout.point(floor.state.robots["robot01"].path[0])
    assert floor.sent == []
    assert floor.over["r", 1] == (
        "blocked",
        f"{layout.name('robot01')} stands where it has no room to turn: it needs 0.62 m to all sides. "
        f"Drive it by hand to about ({begin[0]:.2f}, {begin[1]:.2f}).",
    )
    floor.tell(m.RunOver("r"))
    floor.at["robot01"] = begin
    floor.pass_time()
    go(floor, "again", (12.0, 7.0), "robot01")
    floor.run_until(lambda: len(floor.over) == 2)
    assert floor.over["again", 1] == ("", "")


def test_a_robot_in_a_room_to_which_no_way_leads_is_told_from_one_without_room():
    grid = hall()
    shut = bytearray(grid.cells)
    for row in range(grid.height):
        shut[row * grid.width + 40] = OCCUPIED
    layout = make_layout(replace(grid, cells=bytes(shut)), robots(0.3, 1))
    floor = PretendFloor(layout, {"robot01": (2.0, 7.0)})
    go(floor, "r", (12.0, 7.0), "robot01")
    begin = layout.point(floor.state.robots["robot01"].path[0])
    assert floor.over["r", 1] == (
        "blocked",
        f"No way leads to where {layout.name('robot01')} stands. Drive it by hand to about "
        f"({begin[0]:.2f}, {begin[1]:.2f}).",
    )
    assert floor.sent == []


def test_a_role_waits_for_another_robot_than_one_that_cannot_be_sent_and_takes_that_one_if_no_other_could():
    layout = make_layout(hall(), robots(0.6, 2))
    floor = PretendFloor(layout, {"robot01": (0.2, 5.0), "robot02": (20.0, 10.0)})
    go(floor, "r", (6.0, 5.0), "")
    floor.run_until(lambda: floor.over)
    assert (floor.over["r", 1], floor.state.robots["robot02"].run) == (("", ""), "r")
    go(floor, "s", (12.0, 5.0), "")
    assert (("s", 1) in floor.over, floor.waits[-1].reason.code) == (False, "no_free_robot")
    floor.tell(m.RunOver("r"))
    floor.run_until(lambda: ("s", 1) in floor.over)
    assert (floor.over["s", 1], floor.state.robots["robot02"].run) == (("", ""), "s")
    floor.tell(m.DeviceOffline("robot02"))
    go(floor, "t", (6.0, 5.0), "")
    assert (floor.over["t", 1][0], floor.state.robots["robot01"].run) == ("blocked", "t")

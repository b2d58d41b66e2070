"""One-way and preferred zones of a site's floor: no robot drives against the first, all rather use the second."""

import random
from dataclasses import replace
from math import cos, hypot, radians, sin

import pytest

from execution.machine.floor_task import Target, TaskOrder
from execution.machine.places import lies_in
from execution.traffic import messages as m
from execution.traffic.directions import edges_against
from execution.traffic.outlines import touches
from execution.traffic.path_planner import ELSEWHERE_COST, drawn, length_m
from execution.traffic.zones import path_outside
from tests.kit import demo_floor
from tests.unit.execution.traffic.zones.test_site_zones import (
    EAST,
    WEST,
    block_round,
    change,
    drive,
    floor_with,
    go,
    usual_way,
    zone,
)

TASKS = 4
STRIP = ((6.0, -14.0), (10.0, -14.0), (10.0, 0.0), (6.0, 0.0))
"""From wall to wall: who drives from west to east, or back, comes through it."""
LATTICE = demo_floor.layout().lattice


def way_between(start, end):
    """The way from the cell whose middle is at a point to that at another."""
    cells = {LATTICE.centre(cell): cell for cell in LATTICE.links}
    ends = [cells[min(cells, key=lambda at: hypot(at[0] - x, at[1] - y))] for x, y in (start, end)]
    assert ends[1] in LATTICE.links[ends[0]]
    return tuple(ends)


ENDS = ("@3.000,-8.000", "@18.000,-8.000")


def one_way(heading_deg, points=STRIP, key="site/z"):
    return zone("one_way", points, key, heading_deg=heading_deg)


def backwards(zones, before, after):
    """Whether somebody has moved against a zone that they were in all the while."""
    for each in zones:
        angle = radians(each.heading_deg)
        along = (after[0] - before[0]) * cos(angle) + (after[1] - before[1]) * sin(angle)
        far = hypot(after[0] - before[0], after[1] - before[1])
        if far > 1e-3 and along < -0.5 * far and lies_in(before, each.points) and lies_in(after, each.points):
            return True
    return False


@pytest.mark.parametrize(
    ("heading_deg", "end", "against"),
    [
        (0, (7.75, -8.15), False),
        (180, (7.75, -8.15), True),
        (90, (7.75, -8.15), False),
        (270, (7.75, -8.15), False),
        (45, (7.75, -8.15), False),
        (135, (7.75, -8.15), True),
        (90, (7.25, -8.65), True),
        (90, (7.25, -7.65), False),
    ],
)
def test_against_is_who_drives_the_other_way_and_not_who_drives_across(heading_deg, end, against):
    assert (way_between((7.25, -8.15), end) in edges_against(LATTICE, [one_way(heading_deg)])) is against


def test_a_way_beside_a_zone_and_a_zone_of_another_rule_are_open():
    shut = edges_against(LATTICE, [one_way(180)])
    assert way_between((4.75, -8.15), (5.25, -8.15)) not in shut
    assert way_between((5.75, -8.15), (6.25, -8.15)) in shut
    assert edges_against(LATTICE, [zone("slow", STRIP, heading_deg=180.0)]) == frozenset()


def test_a_robot_drives_with_a_one_way_zone_and_is_told_that_there_is_no_way_against_it():
    floor = floor_with(one_way(0), poses={"robot01": WEST})
    go(floor, "r", EAST, "robot01")
    drive(floor, ("r", 1))
    assert floor.over["r", 1] == ("", "")
    go(floor, "r", WEST, "robot01", task=2)
    drive(floor, ("r", 2))
    why = f"Zones leave no way for {floor.layout.name('robot01')} to (3.00, -8.00). "
    assert floor.over["r", 2] == ("blocked", why + "Change a zone on the map, or choose another place.")


def test_a_robot_goes_round_what_would_lead_it_against_a_zone():
    track = usual_way()
    block = block_round(track[len(track) // 2])
    floor, against = floor_with(one_way(180, block), poses={"robot01": WEST}), []

    def look():
        here = floor.at["robot01"]
        against.append(backwards([one_way(180, block)], look.before, here))
        look.before = here

    look.before = WEST
    go(floor, "r", EAST, "robot01")
    drive(floor, ("r", 1), look=look)
    assert floor.over["r", 1] == ("", "")
    assert not any(against)


def test_a_robot_under_way_turns_round_before_a_zone_that_is_made_one_way_against_it():
    track = usual_way()
    block = block_round(track[len(track) // 2 + 30], 0.8)
    floor = floor_with(poses={"robot01": WEST})
    go(floor, "r", EAST, "robot01")
    for _ in range(len(track) // 2):
        floor.pass_time()
    assert not touches(block, floor.at["robot01"], 0.2)
    shut = one_way(180, block)
    change(floor, shut)
    against, before = [], floor.at["robot01"]

    def look():
        nonlocal before
        against.append(backwards([shut], before, floor.at["robot01"]))
        before = floor.at["robot01"]

    drive(floor, ("r", 1), look=look)
    assert floor.over["r", 1] == ("", "")
    assert not any(against)


def test_the_robot_that_can_come_is_chosen_and_not_the_nearer_one_that_cannot():
    poses = {"robot01": (8.5, -8.0), "robot02": (1.5, -8.0), "robot03": (18.0, -8.0)}
    chosen = []
    for zones in ((), (one_way(0),)):
        floor = floor_with(*zones, poses=poses)
        go(floor, "r", (5.5, -8.0), "")
        chosen += [task.robot for task in floor.state.tasks]
    assert chosen == ["robot01", "robot02"]


def test_who_can_come_to_a_zone_covers_it_and_not_the_nearer_robot_that_cannot():
    poses = {"robot01": (8.5, -8.0), "robot02": (1.5, -8.0), "robot03": (18.0, -8.0)}
    covered = m.FloorZone("p/hall", "Hall", "slow", block_round((5.2, -8.0), 0.3), 0.5)
    order = TaskOrder("cover", Target(), "robot", arguments={"zone": "hall", "lane": 0.0})
    chosen = []
    for zones in ((), (one_way(0),)):
        floor = floor_with(*zones, poses=poses)
        floor.tell(m.TaskAsked("r", 1, order, "", (), "r", (covered,)))
        chosen += [task.robot for task in floor.state.tasks]
    assert chosen == ["robot01", "robot02"]


@pytest.mark.parametrize("seed", range(6))
def test_no_robot_drives_against_random_one_way_zones(seed):
    chance = random.Random(seed)
    layout = demo_floor.layout()
    middles = [layout.lattice.centre(cell) for cell in sorted(layout.lattice.links)]
    zones = []
    for number in range(5):
        x, y = chance.choice(middles)
        outline = block_round((x, y), chance.uniform(0.6, 2.0))
        zones.append(one_way(chance.choice((0, 30, 45, 90, 135, 180, 225, 270, 315)), outline, f"site/{number}"))
    starts = dict(zip(("robot01", "robot02", "robot03"), chance.sample(middles, 3), strict=True))
    goals = {robot: chance.sample(middles, TASKS) for robot in starts}
    floor = floor_with(*zones, poses=starts)

    def is_over():
        """Each robot gets its next goal when it is through with the one before; every task ends, and says how."""
        for robot in starts:
            told = sum(run == robot for run, _ in floor.over)
            if told < TASKS and not any((task.run, task.number) == (robot, told + 1) for task in floor.state.tasks):
                go(floor, robot, goals[robot][told], robot, task=told + 1)
        return len(floor.over) == TASKS * len(starts)

    before = dict(floor.at)

    def look():
        nonlocal before
        assert not [name for name in starts if backwards(zones, before[name], floor.at[name])]
        before = dict(floor.at)

    for _ in range(9000):
        if is_over():
            break
        floor.pass_time()
        look()
    kinds = [kind for kind, _ in floor.over.values()]
    assert kinds.count("") > TASKS  # else the test says little
    assert set(kinds) <= {"", "blocked"}


def test_robots_in_a_ring_of_one_way_zones_all_arrive():
    """Two lanes, one there and one back, as in a warehouse: nobody meets anybody head-on in them."""
    lanes = (
        one_way(0, ((6.0, -14.0), (10.0, -14.0), (10.0, -8.0), (6.0, -8.0)), "site/there"),
        one_way(180, ((6.0, -7.99), (10.0, -7.99), (10.0, 0.0), (6.0, 0.0)), "site/back"),
    )
    floor = floor_with(*lanes, poses={"robot01": WEST, "robot02": (18.0, -7.6), "robot03": (4.0, -9.0)})
    go(floor, "a", EAST, "robot01")
    go(floor, "b", (3.0, -7.6), "robot02")
    go(floor, "c", (17.0, -9.0), "robot03")
    met = []

    def look():
        inside = [name for name, at in floor.at.items() if lies_in(at, STRIP)]
        met.append(len(inside))

    drive(floor, ("a", 1), ("b", 1), ("c", 1), look=look)
    assert set(floor.over.values()) == {("", "")}
    assert max(met) > 1


def test_robots_go_as_much_farther_as_is_said_to_keep_on_preferred_floor():
    plain = demo_floor.layout()
    shortest = path_outside(plain, (), ENDS)
    aisle = ((4.0, -8.9), (17.0, -8.9), (17.0, -8.4), (4.0, -8.4))
    layout = replace(plain, zones=(zone("preferred", aisle),))
    path = path_outside(layout, layout.zones, ENDS)
    on_aisle = [node for node in path if lies_in(layout.point(node), aisle)]
    assert len(on_aisle) > len(path) / 2
    assert not [node for node in shortest if lies_in(plain.point(node), aisle)]
    assert length_m(drawn(layout, path)) < (1 + ELSEWHERE_COST) * length_m(drawn(plain, shortest))


def test_a_preferred_zone_elsewhere_changes_no_path():
    plain = demo_floor.layout()
    far = replace(plain, zones=(zone("preferred", block_round((1.0, -1.0), 0.4)),))
    assert path_outside(far, far.zones, ENDS) == path_outside(plain, (), ENDS)


def test_ways_are_those_of_the_zones_that_hold_now():
    plain = demo_floor.layout()
    shut = replace(plain, zones=(one_way(180),))
    assert (plain.against, plain.preferred) == (frozenset(), frozenset())
    turned = replace(shut, zones=(one_way(0),))
    assert shut.against == {(b, a) for a, b in turned.against}
    assert replace(shut, zones=()).against == frozenset()


def test_the_cells_in_a_box_are_those_that_lie_there():
    chance = random.Random(1)
    for _ in range(300):
        left, right = sorted(chance.uniform(-3, 28) for _ in range(2))
        bottom, top = sorted(chance.uniform(-16, 3) for _ in range(2))
        middles = {cell: LATTICE.centre(cell) for cell in LATTICE.links}
        inside = [cell for cell, (x, y) in sorted(middles.items()) if left <= x <= right and bottom <= y <= top]
        assert list(LATTICE.cells_in_box(left, bottom, right, top)) == inside
    (x, y) = LATTICE.centre(min(LATTICE.links))
    assert min(LATTICE.links) in set(LATTICE.cells_in_box(x, y, x, y))

"""Zones of a site's floor: they hold for every robot, whatever its run, and from the moment when they are made."""

import random
from dataclasses import replace
from itertools import pairwise

import pytest

from execution.machine.floor_task import Target, TaskOrder
from execution.machine.places import lies_in
from execution.traffic import floor as traffic
from execution.traffic import messages as m
from execution.traffic.outlines import touches, touches_way
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor

CORRIDOR = ((6.0, -9.0), (10.0, -9.0), (10.0, -7.0), (6.0, -7.0))
WEST, EAST = (3.0, -8.0), (18.0, -8.0)


def zone(rule, points=CORRIDOR, key="site/z", **more):
    return m.FloorZone(key, "The crossing", rule, points, **more)


def floor_with(*zones, poses=None):
    return PretendFloor(replace(demo_floor.layout(), zones=zones), poses)


def change(floor, *zones):
    """Somebody changes the zones on the map: the floor has them with its next step."""
    floor.layout = replace(floor.layout, zones=zones)


def go(floor, run, point, wants, task=1):
    order = TaskOrder("move", Target(point=point), "robot", step=f"{run}-step")
    floor.tell(m.TaskAsked(run, task, order, wants, ("move",), run))


def drive(floor, *tasks, look=lambda: None):
    for _ in range(6000):
        if all(task in floor.over for task in tasks):
            return
        floor.pass_time()
        look()
    raise AssertionError(floor.describe())


def near(floor, robot, outline):
    return touches(outline, floor.at[robot], floor.layout.ground.radius_m - 1e-6)


def block_round(point, half_m=0.3):
    x, y = point
    return ((x - half_m, y - half_m), (x + half_m, y - half_m), (x + half_m, y + half_m), (x - half_m, y + half_m))


def usual_way():
    """The points that a robot drives over from west to east while no zone is in its way."""
    floor, track = floor_with(poses={"robot01": WEST}), []
    go(floor, "r", EAST, "robot01")
    drive(floor, ("r", 1), look=lambda: track.append(floor.at["robot01"]))
    return track


@pytest.mark.parametrize("seed", range(6))
def test_no_robot_comes_near_random_zones_to_keep_out_of(seed):
    chance = random.Random(seed)
    layout = demo_floor.layout()
    middles = [layout.lattice.centre(cell) for cell in sorted(layout.lattice.links)]
    starts = dict(zip(("robot01", "robot02", "robot03"), chance.sample(middles, 3), strict=True))
    outlines = []
    while len(outlines) < 5:
        x, y = chance.choice(middles)
        turned = [(x + chance.uniform(-1.2, 1.2), y + chance.uniform(-1.2, 1.2)) for _ in range(3)]
        if not any(touches(tuple(turned), at, 0.6) for at in starts.values()):
            outlines.append(tuple(turned))
    floor = floor_with(*(zone("keep_out", o, f"site/{i}") for i, o in enumerate(outlines)), poses=starts)

    def look():
        assert not any(near(floor, robot, outline) for robot in starts for outline in outlines)

    for number, goal in enumerate(chance.sample(middles, 6)):
        go(floor, f"r{number}", goal, f"robot0{number % 3 + 1}")
    for _ in range(1500):
        floor.pass_time()
        look()
    arrived = [task for task, (kind, _) in floor.over.items() if not kind]
    assert arrived  # else nobody drove, and the test says nothing


def test_a_zone_that_is_narrower_than_the_gap_between_cells_is_not_driven_through():
    layout = demo_floor.layout()
    middles = [layout.lattice.centre(cell) for cell in layout.lattice.links]
    x = next((a + b) / 2 for a, b in pairwise(sorted({x for x, _ in middles})) if a > 8)
    bottom, top = min(y for _, y in middles) - 1, max(y for _, y in middles) + 1
    wire = ((x - 0.01, bottom), (x + 0.01, bottom), (x + 0.01, top), (x - 0.01, top))
    floor = floor_with(zone("keep_out", wire), poses={"robot01": WEST})
    go(floor, "r", EAST, "robot01")
    why = f"Zones leave no way for {layout.name('robot01')} to (18.00, -8.00). "
    assert floor.over["r", 1] == ("blocked", why + "Change a zone on the map, or choose another place.")
    assert floor.at["robot01"] == WEST


def test_a_robot_of_no_run_does_not_go_home_through_a_zone_to_keep_out_of():
    layout = demo_floor.layout()
    docks = [layout.places[dock] for dock in layout.docks]
    ring = block_round((sum(d.x for d in docks) / 3, docks[0].y), 2.5)
    floor = floor_with(zone("keep_out", ring), poses={f"robot0{i}": (2.0 + i, -8.0) for i in (1, 2, 3)})
    for _ in range(400):
        floor.pass_time()
    assert floor.at == {f"robot0{i}": (2.0 + i, -8.0) for i in (1, 2, 3)}


def test_pieces_through_a_slow_zone_carry_its_speed_for_a_run_whose_program_has_no_zones():
    floor = floor_with(zone("slow", speed_m_s=0.2), poses={"robot01": WEST})
    go(floor, "r", EAST, "robot01")
    drive(floor, ("r", 1))
    moves = [command for command in floor.sent if command.method == "move" and command.device == "robot01"]
    through = [each for each in moves if any(lies_in(tuple(point), CORRIDOR) for point in each.arguments["path"])]
    assert through
    assert {each.arguments.get("speed") for each in through} == {0.2}
    assert {each.arguments.get("speed") for each in moves} == {None, 0.2}


def test_the_slowest_of_zones_on_each_other_holds():
    zones = (zone("slow", speed_m_s=0.3), zone("slow", key="site/y", speed_m_s=0.1))
    floor = floor_with(*zones, poses={"robot01": WEST})
    go(floor, "r", EAST, "robot01")
    drive(floor, ("r", 1))
    assert {c.arguments.get("speed") for c in floor.sent if c.method == "move"} == {None, 0.1}


def test_robots_of_two_programs_go_one_at_a_time_through_a_zone_of_the_site():
    poses = {"robot01": WEST, "robot02": (18.0, -7.6)}
    floor, inside = floor_with(zone("one_at_a_time"), poses=poses), []
    go(floor, "a", EAST, "robot01")
    go(floor, "b", (3.0, -7.6), "robot02")
    drive(floor, ("a", 1), ("b", 1), look=lambda: inside.append([lies_in(floor.at[r], CORRIDOR) for r in poses]))
    assert set(floor.over.values()) == {("", "")}
    assert [True, False] in inside
    assert [False, True] in inside
    assert [True, True] not in inside
    assert any(wait.reason and wait.reason.code == "zone_taken" for wait in floor.waits)


@pytest.mark.parametrize("share", [0.25, 0.4, 0.5])
def test_a_zone_made_ahead_of_a_robot_under_way_turns_it_round(share):
    """At 0.5 the zone is made just before the robot, on what was released to it already."""
    track = usual_way()
    block = block_round(track[len(track) // 2 + 14])
    floor, after = floor_with(poses={"robot01": WEST}), []
    go(floor, "r", EAST, "robot01")
    for _ in range(int(len(track) * share)):
        floor.pass_time()
    assert ("r", 1) not in floor.over
    assert not near(floor, "robot01", block)
    change(floor, zone("keep_out", block))
    drive(floor, ("r", 1), look=lambda: after.append(near(floor, "robot01", block)))
    assert floor.over["r", 1] == ("", "")
    assert not any(after)


def test_what_was_released_into_a_new_zone_is_called_off():
    track = usual_way()
    floor = floor_with(poses={"robot01": WEST})
    go(floor, "r", EAST, "robot01")
    for _ in range(len(track) // 2):
        floor.pass_time()
    under_way = set(floor.state.sent)
    change(floor, zone("keep_out", block_round(track[len(track) // 2 + 14])))
    floor.pass_time()
    called_off = {command.arguments["command"] for command in floor.sent if command.method == "cancel"}
    assert called_off == under_way
    assert under_way


def test_a_robot_that_drives_away_from_a_new_zone_is_not_disturbed():
    floor = floor_with(poses={"robot01": WEST})
    go(floor, "r", EAST, "robot01")
    for _ in range(150):
        floor.pass_time()
    path = floor.state.robots["robot01"].path
    change(floor, zone("keep_out", block_round(WEST)))
    floor.pass_time()
    assert floor.state.robots["robot01"].path == path
    assert not [command for command in floor.sent if command.method == "cancel"]


def test_a_robot_in_a_new_zone_leaves_it_and_does_not_come_back():
    floor = floor_with(poses={"robot01": WEST})
    change(floor, zone("keep_out", block_round(WEST, 1.0)))
    go(floor, "r", EAST, "robot01")
    drive(floor, ("r", 1))
    assert floor.over["r", 1] == ("", "")
    go(floor, "r", WEST, "robot01", task=2)
    drive(floor, ("r", 2))
    assert floor.over["r", 2][0] == "blocked"
    assert not near(floor, "robot01", block_round(WEST, 1.0))


def test_a_new_slow_zone_slows_a_robot_that_drives_in_it():
    floor = floor_with(poses={"robot01": WEST})
    go(floor, "r", EAST, "robot01")
    while floor.at["robot01"][0] < 7.0:
        floor.pass_time()
    change(floor, zone("slow", speed_m_s=0.2))
    count = len(floor.sent)
    drive(floor, ("r", 1))
    later = [command for command in floor.sent[count:] if command.method == "move"]
    through = [each for each in later if any(lies_in(tuple(point), CORRIDOR) for point in each.arguments["path"])]
    assert through
    assert {each.arguments.get("speed") for each in through} == {0.2}
    assert floor.over["r", 1] == ("", "")


def test_a_zone_that_is_taken_away_lets_who_waits_for_it_drive_on():
    poses = {"robot01": (8.0, -8.0), "robot02": (18.0, -7.6)}
    floor = floor_with(zone("one_at_a_time"), poses=poses)
    go(floor, "a", (8.0, -7.6), "robot01")
    floor.tell(m.RunPaused("a"))
    go(floor, "b", (3.0, -7.6), "robot02")
    for _ in range(300):
        floor.pass_time()
    assert ("b", 1) not in floor.over
    change(floor)
    floor.tell(m.RunResumed("a"))
    drive(floor, ("b", 1))
    assert floor.over["b", 1] == ("", "")
    assert floor.state.locks == {}


def test_which_zones_are_heeded_is_kept_with_the_floor_and_nothing_is_where_there_are_none():
    floor = floor_with(zone("slow", speed_m_s=0.2))
    floor.pass_time()
    kept = traffic.to_json(floor.state)
    assert traffic.from_json(kept) == floor.state
    assert list(kept["zones"]) == [""]
    change(floor)
    floor.pass_time()
    assert traffic.to_json(floor.state)["zones"] == {}


def test_a_way_touches_an_outline_that_it_crosses_between_its_corners():
    wire = ((0.0, -5.0), (0.1, -5.0), (0.1, 5.0), (0.0, 5.0))
    assert touches_way(wire, (-1.0, 0.0), (1.0, 0.0), 0.0)
    assert touches_way(wire, (-1.0, 0.0), (-0.15, 0.0), 0.2)
    assert touches_way(((0.0, 0.1), (0.1, 1.0), (-0.1, 1.0)), (-1.0, 0.0), (1.0, 0.0), 0.2)
    assert not touches_way(wire, (-1.0, 0.0), (-0.25, 0.0), 0.2)

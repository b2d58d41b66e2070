"""Zones on the floor: kept out of, one robot at a time, slow."""

import random
from dataclasses import replace
from math import hypot

import pytest

from execution.machine.floor_task import Target, TaskOrder
from execution.machine.places import lies_in
from execution.traffic import messages as m
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor

ROOM = ((6.0, -9.0), (10.0, -9.0), (10.0, -5.0), (6.0, -5.0))


def zone(rule, points=ROOM, key="p/z", **more):
    return m.FloorZone(key, "The crossing", rule, points, **more)


def go(floor, run, target, zones, task=1, wants=""):
    point = target if isinstance(target, tuple) else None
    to = Target("" if point else target, point)
    order = TaskOrder("move", to, "robot", step=f"{run}-step")
    floor.tell(m.TaskAsked(run, task, order, wants, ("move",), run, zones))


def bounds():
    layout = demo_floor.layout()
    points = [layout.lattice.centre(cell) for cell in layout.lattice.links]
    return max(p[0] for p in points), min(p[1] for p in points), max(p[1] for p in points)


def drive(floor, settled, look):
    for _ in range(6000):
        if settled():
            return
        floor.pass_time()
        look()
    raise AssertionError(floor.describe())


def path_without(points, start, goal):
    """A way exists without the zone, else the test says nothing."""
    floor = PretendFloor(demo_floor.layout(), {"robot01": start})
    go(floor, "r", goal, (zone("keep_out", points),), wants="robot01")
    inside = []
    drive(floor, lambda: ("r", 1) in floor.over, lambda: inside.append(lies_in(floor.at["robot01"], points)))
    return floor, inside


def test_robots_of_the_run_drive_round_a_zone_that_they_keep_out_of():
    start, goal = (3.0, -8.0), (18.0, -8.0)
    plain = PretendFloor(demo_floor.layout(), {"robot01": start})
    go(plain, "r", goal, (), wants="robot01")
    track = []
    drive(plain, lambda: ("r", 1) in plain.over, lambda: track.append(plain.at["robot01"]))
    x, y = track[len(track) // 2]
    block = ((x - 0.3, y - 0.3), (x + 0.3, y - 0.3), (x + 0.3, y + 0.3), (x - 0.3, y + 0.3))
    floor, inside = path_without(block, start, goal)
    assert floor.over["r", 1] == ("", "")
    assert not any(inside)
    assert any(lies_in(point, block) for point in track)


def test_a_goal_in_a_zone_to_keep_out_of_is_blocked_and_says_so():
    floor = PretendFloor(demo_floor.layout(), {"robot01": (3.0, -8.0)})
    x2, y1, y2 = bounds()
    goal = (18.0, -8.0)
    block = ((16.0, y1), (x2, y1), (x2, y2), (16.0, y2))
    go(floor, "r", goal, (zone("keep_out", block),), wants="robot01")
    assert floor.over["r", 1][0] == "blocked"


def test_a_robot_that_stands_in_a_zone_may_leave_it_and_not_come_back():
    floor = PretendFloor(demo_floor.layout(), {"robot01": (3.0, -8.0)})
    block = ((2.0, -9.0), (4.0, -9.0), (4.0, -7.0), (2.0, -7.0))
    go(floor, "r", (18.0, -8.0), (zone("keep_out", block),), wants="robot01")
    drive(floor, lambda: ("r", 1) in floor.over, lambda: None)
    assert floor.over["r", 1] == ("", "")
    go(floor, "r", (3.0, -8.0), (zone("keep_out", block),), task=2, wants="robot01")
    drive(floor, lambda: ("r", 2) in floor.over, lambda: None)
    assert floor.over["r", 2][0] == "blocked"


def test_other_runs_do_not_care_for_the_zone():
    floor = PretendFloor(demo_floor.layout(), {"robot01": (3.0, -8.0)})
    block = ((2.0, -9.0), (4.0, -9.0), (4.0, -7.0), (2.0, -7.0))
    go(floor, "r", "dock2", (zone("keep_out", block),), wants="robot02")
    go(floor, "other", (3.0, -7.5), (), wants="robot01")
    drive(floor, lambda: ("other", 1) in floor.over, lambda: None)
    assert floor.over["other", 1] == ("", "")


def test_in_a_slow_zone_pieces_carry_the_speed_and_outside_they_do_not():
    floor = PretendFloor(demo_floor.layout(), {"robot01": (3.0, -8.0)})
    go(floor, "r", (18.0, -8.0), (zone("slow", speed_m_s=0.2),), wants="robot01")
    drive(floor, lambda: ("r", 1) in floor.over, lambda: None)
    for command in floor.sent:
        if command.method == "move" and command.device == "robot01":
            touches = any(lies_in(tuple(point), ROOM) for point in command.arguments["path"])
            assert not touches or command.arguments["speed"] == 0.2
    speeds = {command.arguments.get("speed") for command in floor.sent if command.method == "move"}
    assert speeds == {None, 0.2}


def meet(zones, poses, goals):
    """Robots of runs of one program cross; returns the most that were in the zone at once."""
    floor = PretendFloor(demo_floor.layout(), poses)
    for number, (robot, goal) in enumerate(goals.items()):
        go(floor, f"r{number}", goal, zones, wants=robot)
    most = []

    def look():
        most.extend(sum(lies_in(floor.at[robot], each.points) for robot in goals) for each in zones)

    drive(floor, lambda: len(floor.over) == len(goals), look)
    assert set(floor.over.values()) == {("", "")}
    return max(most)


def test_only_one_robot_at_a_time_is_in_the_zone_and_all_arrive():
    poses = {"robot01": (3.0, -8.0), "robot02": (18.0, -7.6)}
    assert meet((zone("one_at_a_time"),), poses, {"robot01": (18.0, -8.0), "robot02": (3.0, -7.6)}) == 1


@pytest.mark.parametrize("robots", [1, 2, 3])
def test_at_most_so_many_robots_are_in_the_zone_at_once_and_all_arrive(robots):
    """Three cross it from both sides; where there is room for two, two are in it, and never the third."""
    poses = {"robot01": (3.0, -8.0), "robot02": (3.0, -7.6), "robot03": (18.0, -7.6)}
    goals = {"robot01": (18.0, -8.0), "robot02": (17.0, -8.2), "robot03": (3.0, -7.6)}
    assert 1 <= meet((zone("one_at_a_time", robots=robots),), poses, goals) <= robots


def test_two_that_follow_each_other_are_in_a_zone_for_two_together():
    poses = {"robot01": (4.5, -8.0), "robot02": (3.0, -8.0)}
    goals = {"robot01": (18.0, -8.0), "robot02": (17.0, -8.2)}
    assert meet((zone("one_at_a_time", robots=2),), poses, goals) == 2


def test_whoever_idles_in_a_zone_for_two_makes_room_for_a_third():
    poses = {"robot01": (7.0, -7.5), "robot02": (9.0, -8.5), "robot03": (18.0, -7.5)}
    floor = PretendFloor(demo_floor.layout(), poses)
    zones = (zone("one_at_a_time", robots=2),)
    for run, robot, point in (("a", "robot01", (7.4, -7.5)), ("b", "robot02", (8.6, -8.5))):
        go(floor, run, point, zones, wants=robot)
        drive(floor, lambda run=run: (run, 1) in floor.over, lambda: None)
    assert floor.state.locks == {"p/z": "robot01", "p/z#2": "robot02"}
    go(floor, "c", (3.0, -7.5), zones, wants="robot03")
    drive(floor, lambda: ("c", 1) in floor.over, lambda: None)
    assert floor.over["c", 1] == ("", "")


def test_a_zone_for_fewer_than_before_lets_who_is_too_many_out():
    poses = {"robot01": (7.0, -7.5), "robot02": (9.0, -8.5)}
    floor = PretendFloor(replace(demo_floor.layout(), zones=(zone("one_at_a_time", robots=2),)), poses)
    for _ in range(20):
        floor.pass_time()
    floor.layout = replace(floor.layout, zones=(zone("one_at_a_time"),))
    go(floor, "a", (18.0, -8.0), (), wants="robot01")
    go(floor, "b", (3.0, -7.6), (), wants="robot02")
    drive(floor, lambda: len(floor.over) == 2, lambda: None)
    assert set(floor.over.values()) == {("", "")}


def test_a_zone_for_one_is_written_as_the_version_before_reads_it():
    assert "robots" not in m.zone_to_json(zone("one_at_a_time"))
    for robots in (1, 4):
        known = zone("one_at_a_time", robots=robots)
        assert m.zone_from_json(m.zone_to_json(known)) == known


def test_neighbouring_zones_do_not_make_robots_wait_for_each_other_for_ever():
    left = ((5.0, -9.0), (8.0, -9.0), (8.0, -5.0), (5.0, -5.0))
    right = ((8.0, -9.0), (11.0, -9.0), (11.0, -5.0), (8.0, -5.0))
    zones = (zone("one_at_a_time", left, "p/a"), zone("one_at_a_time", right, "p/b"))
    poses = {"robot01": (3.0, -8.0), "robot02": (18.0, -7.6)}
    assert meet(zones, poses, {"robot01": (18.0, -8.0), "robot02": (3.0, -7.6)}) == 1


def test_a_zone_has_one_robot_while_a_run_of_another_version_has_it_drawn_elsewhere():
    elsewhere = zone("one_at_a_time", ((1.0, -12.5), (1.5, -12.5), (1.5, -12.0), (1.0, -12.0)))
    floor = PretendFloor(demo_floor.layout(), {"robot01": (3.0, -8.0), "robot02": (13.0, -7.6)})
    go(floor, "a", (18.0, -8.0), (zone("one_at_a_time"),), wants="robot01")
    go(floor, "b", (3.0, -7.6), (zone("one_at_a_time"),), wants="robot02")
    go(floor, "c", "dock3", (elsewhere,), wants="robot03")
    inside = []
    drive(
        floor, lambda: len(floor.over) == 3, lambda: inside.append(sum(lies_in(at, ROOM) for at in floor.at.values()))
    )
    assert (set(floor.over.values()), max(inside)) == ({("", "")}, 1)


def test_a_robot_that_stands_idle_in_the_zone_leaves_it_for_another():
    poses = {"robot01": (7.0, -7.5), "robot02": (18.0, -7.5)}
    floor = PretendFloor(demo_floor.layout(), poses)
    zones = (zone("one_at_a_time"),)
    go(floor, "a", (8.0, -7.5), zones, wants="robot01")
    drive(floor, lambda: ("a", 1) in floor.over, lambda: None)
    go(floor, "b", (3.0, -7.5), zones, wants="robot02")
    drive(floor, lambda: ("b", 1) in floor.over, lambda: None)
    assert floor.over["b", 1] == ("", "")
    assert any(w.reason and w.reason.code == "zone_taken" for w in floor.waits)
    assert hypot(floor.at["robot02"][0] - 3.0, floor.at["robot02"][1] + 7.5) < 0.1


@pytest.mark.parametrize(("seed", "most"), [(3, 1), (17, 1), (52, 1), (23, 1), (5, 2), (24, 3)])
def test_robots_with_many_tasks_through_random_zones_all_arrive(seed, most):
    """With 17 and 52 one waits in a zone for a machine, which another has that waits for the zone.

    With 23 one waits in a zone for the dock behind it, out of which another comes by that zone alone.
    """
    rng = random.Random(seed)
    layout = demo_floor.layout()
    targets = [*layout.stations, *layout.docks]
    zones = []
    for number in range(rng.randint(1, 3)):
        x, y, wide, deep = rng.uniform(1, 18), rng.uniform(-12, -3), rng.uniform(1, 5), rng.uniform(1, 5)
        outline = ((x, y), (x + wide, y), (x + wide, y + deep), (x, y + deep))
        zones.append(zone("one_at_a_time", outline, f"p/z{number}", robots=1 + number % most))
    floor = PretendFloor(layout)
    runs = {f"run{number}": robot for number, robot in enumerate(sorted(floor.state.robots))}
    done = dict.fromkeys(runs, 0)

    def ask():
        for run, robot in runs.items():
            if done[run] < 4 and (not done[run] or (run, done[run]) in floor.over):
                done[run] += 1
                go(floor, run, rng.choice(targets), tuple(zones), done[run], wants=robot)
        assert all(sum(lies_in(at, each.points) for at in floor.at.values()) <= each.robots for each in zones)

    drive(floor, lambda: all((run, 4) in floor.over for run in runs), ask)
    assert set(floor.over.values()) == {("", "")}


def test_a_floor_with_zones_is_stored_and_read_again():
    from execution.traffic import floor as pure

    floor = PretendFloor(demo_floor.layout(), {"robot01": (7.0, -7.5)})
    go(floor, "a", (8.0, -7.5), (zone("one_at_a_time"),), wants="robot01")
    floor.pass_time()
    assert floor.state.locks == {"p/z": "robot01"}
    data = pure.to_json(floor.state)
    assert pure.from_json(data) == floor.state
    older = {key: value for key, value in data.items() if key not in {"zones", "locks"}}
    assert pure.from_json(older).locks == {}

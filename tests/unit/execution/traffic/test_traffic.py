import json
from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import floor
from execution.traffic import messages as m
from execution.traffic.layout import NoSuchSpot, make_layout
from execution.traffic.path_planner import drawn, length_m, plan_path
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor

LAYOUT = demo_floor.layout()
ROBOTS = ("robot01", "robot02", "robot03")
PLACES = sorted({*LAYOUT.stations, *LAYOUT.docks})
CAN = ("move", "pick", "drop")


def ask(run, task, target, kind="move", **more):
    wants = more.pop("wants", "")
    order = TaskOrder(kind, Target(target), more.pop("role", "robot"), "box", 1, **more)
    return m.TaskAsked(run, task, order, wants, () if wants else CAN, f"run {run}")


def test_a_route_of_the_factory_has_few_corners_and_stays_off_the_walls():
    line = drawn(LAYOUT, plan_path(LAYOUT, "itemInventory01", "paintMachine01"))
    assert line == ((2.3, -2.93), (2.3, -7.65), (20.9, -7.65), (20.9, -4.23))
    assert round(length_m(line), 2) == 26.74


def test_no_way_leads_through_cells_that_are_closed():
    closed = set(LAYOUT.needed("paintMachine01")) | set(LAYOUT.lattice.cells_within((20.9, -4.75), 1.2))
    assert plan_path(LAYOUT, "itemInventory01", "paintMachine01", closed=closed) is None


@pytest.mark.parametrize("target", [Target("nothing"), Target(point=(11.4, -1.0)), Target(point=(90.0, 90.0))])
def test_a_target_where_nobody_can_stand_is_refused_with_a_reason(target):
    with pytest.raises(NoSuchSpot, match=r"There is no device or place|cannot stand"):
        LAYOUT.spot_for(target)


def test_the_nearest_free_robot_takes_the_role_and_keeps_it():
    world = PretendFloor(LAYOUT, {"robot03": (18.0, -5.0)})
    world.tell(ask("a", 1, "paintMachine01"))
    assert world.state.roles == {"a/robot": "robot03"}
    world.run_until(lambda: ("a", 1) in world.over)
    world.tell(ask("a", 2, "dropOff01"))
    world.run_until(lambda: ("a", 2) in world.over)
    assert world.state.roles == {"a/robot": "robot03"}
    world.tell(m.RunOver("a"))
    assert world.state.roles == {}


def test_roles_are_given_out_together_so_that_the_sum_of_the_ways_is_least():
    world = PretendFloor(LAYOUT, {"robot01": (8.75, -8.25), "robot02": (5.75, -8.25), "robot03": (22.0, -8.25)})
    world.tell(ask("a", 1, "itemInventory01", role="x"), ask("a", 2, "paintInventory01", role="y"))
    assert world.state.roles == {"a/x": "robot02", "a/y": "robot01"}


def test_a_role_of_one_device_waits_for_it_and_says_who_holds_it():
    world = PretendFloor(LAYOUT)
    world.tell(ask("1", 1, "dropOff01", wants="robot01"))
    world.tell(ask("2", 1, "dropOff01", wants="robot01"))
    assert world.waits[-1].reason.text == "TurtleBot 1 is held by run 1."
    world.tell(m.RunOver("1"))
    assert world.state.roles == {"2/robot": "robot01"}


def test_a_machine_serves_one_robot_after_the_other():
    world = PretendFloor(LAYOUT)
    for number, robot in enumerate(ROBOTS):
        world.tell(ask(str(number), 1, "curingOven01", "pick", wants=robot))
    world.run_until(lambda: len(world.over) == 3)
    assert set(world.over.values()) == {("", "")}
    assert "Curing Oven serves" in " ".join(w.reason.text for w in world.waits if w.reason)
    assert world.nearest >= 0.46


def test_a_robot_is_brought_to_the_device_of_its_pick():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "itemInventory01", "pick", wants="robot02"))
    world.run_until(lambda: ("a", 1) in world.over)
    last = world.sent[-1]
    assert (last.device, last.method) == ("robot02", "pick")
    assert last.arguments == {"device": "itemInventory01", "object": "box", "value": 1}
    assert all(command.method == "move" for command in world.sent[:-1])


def test_a_robot_drives_on_without_stopping_between_the_pieces_of_its_way():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "dropOff01", wants="robot01"))
    world.run_until(lambda: ("a", 1) in world.over)
    path_m = length_m(drawn(LAYOUT, plan_path(LAYOUT, "dock1", "dropOff01")))
    assert world.now <= path_m / 0.5 + 3


def test_an_idle_robot_makes_room_and_stands_elsewhere():
    world = PretendFloor(LAYOUT, {"robot02": (9.75, -9.75)})
    world.tell(ask("a", 1, "curingOven01", wants="robot01"))
    world.run_until(lambda: ("a", 1) in world.over)
    assert world.over["a", 1] == ("", "")
    assert world.at["robot02"] != (9.75, -9.75)


def test_two_robots_that_want_each_others_places_both_arrive():
    world = PretendFloor(LAYOUT, {"robot01": (2.3, -2.93), "robot02": (8.7, -2.955)})
    world.tell(ask("1", 1, "paintInventory01", wants="robot01"), ask("2", 1, "itemInventory01", wants="robot02"))
    world.run_until(lambda: len(world.over) == 2)
    assert set(world.over.values()) == {("", "")}


def test_a_task_to_where_no_way_leads_fails_as_blocked():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "nowhere", wants="robot01"))
    assert world.over["a", 1] == ("blocked", "There is no device or place called “nowhere” on this site.")


def test_no_robot_that_can_is_a_refusal():
    world = PretendFloor(LAYOUT)
    order = TaskOrder("move", Target("dropOff01"), "robot")
    world.tell(m.TaskAsked("a", 1, order, "", ("fly",), "run a"))
    assert world.over["a", 1][0] == "refused"


def refuse(world, name):
    """Let a robot that was started anew refuse the pieces that it is sent, as they begin elsewhere."""
    pieces = [command.id for command in world.sent if command.id in world.state.sent and command.device == name]
    world.queue[name].clear()
    why = "The way begins 1.5 m from where it will be."
    world.tell(*(m.CommandAnswered(piece, "REJECTED", why) for piece in pieces))


def test_a_robot_that_was_started_anew_on_its_way_gets_a_way_from_where_it_stands():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "dropOff01", wants="robot01"))
    for _ in range(4):
        world.pass_time(3)
        refuse(world, "robot01")
        world.run_until(lambda: len(world.queue["robot01"]) == 0)
    world.run_until(lambda: ("a", 1) in world.over)
    assert world.over["a", 1] == ("", "")


def test_a_robot_that_refuses_every_way_fails_with_its_reason():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "dropOff01", wants="robot01"))
    for refusals in range(3):
        assert ("a", 1) not in world.over, refusals
        refuse(world, "robot01")
    assert world.over["a", 1] == ("refused", "The way begins 1.5 m from where it will be.")


def test_a_robot_that_dies_on_its_way_fails_as_offline_and_stays_an_obstacle():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "dropOff01", wants="robot01"))
    world.pass_time(3)
    world.deaf.add("robot01")
    held = set(world.state.robots["robot01"].held)
    world.tell(m.DeviceOffline("robot01"))
    world.run_until(lambda: ("a", 1) in world.over, 60)
    assert world.over["a", 1][0] == "offline"
    assert set(world.state.robots["robot01"].held) == held


def test_while_the_server_is_away_no_limit_runs_out():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "dropOff01", wants="robot01"))
    world.pass_time(3)
    world.tell(m.DeviceOffline("robot01"))
    world.now += 3600
    world.tell(m.Tick())
    assert world.over == {}
    world.tell(m.DeviceOnline("robot01"))
    world.run_until(lambda: ("a", 1) in world.over)
    assert world.over["a", 1] == ("", "")


def test_a_robot_that_does_not_get_on_is_timed_out():
    world = PretendFloor(LAYOUT, deaf=["robot01"])
    world.tell(ask("a", 1, "dropOff01", wants="robot01"))
    world.run_until(lambda: ("a", 1) in world.over, 90)
    assert world.over["a", 1] == ("timed_out", "TurtleBot 1 took too long.")


def test_a_machine_carries_out_one_call_at_a_time():
    world = PretendFloor(LAYOUT)
    order = TaskOrder("call", Target("curingOven01"), method="curePaint", arguments={"time": 1})
    world.tell(m.TaskAsked("1", 1, order, run_name="run 1"), m.TaskAsked("2", 1, order, run_name="run 2"))
    assert [c.device for c in world.sent] == ["curingOven01"]
    assert world.waits[-1].reason.text == "Curing Oven is busy for run 1."
    world.run_until(lambda: len(world.over) == 2, 10)


def test_a_method_that_a_machine_does_not_have_is_refused():
    world = PretendFloor(LAYOUT)
    world.tell(m.TaskAsked("1", 1, TaskOrder("call", Target("curingOven01"), method="fly"), run_name="run 1"))
    assert world.over["1", 1] == ("refused", "Curing Oven cannot fly; it offers no such method.")
    assert world.sent == []


def test_after_stop_nothing_is_sent_but_pauses_until_it_is_reset_and_resumed():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "dropOff01", wants="robot01"))
    before = len(world.sent)
    world.tell(m.StopPressed(), m.RunPaused("a"))
    assert {c.method for c in world.sent[before:]} == {"pause"}
    for _ in range(100):
        world.pass_time()
    world.tell(m.StopReset())
    assert {c.method for c in world.sent[before:]} == {"pause"}
    world.tell(m.RunResumed("a"))
    assert "resume" in {c.method for c in world.sent[before:]}
    world.run_until(lambda: ("a", 1) in world.over)


def test_a_free_robot_that_stands_at_a_machine_goes_home():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "curingOven01", wants="robot01"))
    world.run_until(lambda: ("a", 1) in world.over)
    world.tell(m.RunOver("a"))
    world.run_until(lambda: world.state.robots["robot01"].path == ("dock1",), 60)


def test_the_floor_goes_on_from_its_stored_state():
    world = PretendFloor(LAYOUT)
    world.tell(ask("a", 1, "curingOven01", "pick", wants="robot01"))
    while ("a", 1) not in world.over:
        world.pass_time()
        world.state = floor.from_json(json.loads(json.dumps(floor.to_json(world.state))))
    assert world.over["a", 1] == ("", "")


MISSIONS = st.lists(
    st.tuples(st.sampled_from(ROBOTS), st.sampled_from(PLACES), st.sampled_from(["move", "pick"])),
    min_size=1,
    max_size=9,
)


@settings(max_examples=6, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(MISSIONS)
def test_no_two_robots_hold_a_cell_and_all_tasks_end(tasks):
    world = PretendFloor(LAYOUT)
    for number, (robot, target, kind) in enumerate(tasks):
        kind = kind if target in LAYOUT.stations else "move"
        world.tell(ask(robot, number, target, kind, wants=robot))
    world.run_until(lambda: len(world.over) == len(tasks), 1500)
    assert set(world.over.values()) == {("", "")}
    assert world.nearest >= 0.46


@settings(max_examples=3, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(st.lists(st.sampled_from(PLACES), min_size=1, max_size=2), min_size=6, max_size=6))
def test_six_robots_share_the_floor(targets):
    robots = [d for d in demo_floor.devices() if d.kind == "robot"]
    more = [replace(robots[0], id=f"robot{n:02}", name=f"TurtleBot {n}") for n in range(4, 7)]
    layout = make_layout(demo_floor.grid(), [*demo_floor.devices(), *more], demo_floor.places())
    world = PretendFloor(layout, {"robot04": (2.0, -8.0), "robot05": (6.0, -8.5), "robot06": (12.0, -8.0)})
    for number, (robot, mine) in enumerate(zip(sorted(world.at), targets, strict=True)):
        world.tell(*(ask(robot, 10 * number + i, target, wants=robot) for i, target in enumerate(mine)))
    total = sum(len(mine) for mine in targets)
    world.run_until(lambda: len(world.over) == total, 1500)
    assert set(world.over.values()) == {("", "")}

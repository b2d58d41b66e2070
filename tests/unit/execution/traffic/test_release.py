"""A role that gives its robot back: others have it at once, and nothing is taken from what it is doing."""

import json

import pytest

from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import floor
from execution.traffic import messages as m
from execution.traffic.layout import make_layout
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor


@pytest.fixture
def world():
    return PretendFloor(make_layout(demo_floor.grid(), demo_floor.devices(), demo_floor.places()))


def ask(run, number, kind="release", target="", role="robot", wants=""):
    order = TaskOrder(kind, Target(target), role, "box")
    return m.TaskAsked(run, number, order, wants, () if wants else ("move",), f"run {run}")


def test_the_robot_is_free_at_once_and_a_run_that_waits_for_it_has_it_in_the_same_step(world):
    world.tell(ask("a", 1, "move", "dropOff01", wants="robot01"))
    world.run_until(lambda: ("a", 1) in world.over)
    world.tell(ask("b", 1, "move", "curingOven01", wants="robot01"))
    assert world.waits[-1].reason.code == "role_held"
    world.tell(ask("a", 2, wants="robot01"))
    assert world.over["a", 2] == ("", "")
    assert (world.state.robots["robot01"].run, world.state.roles) == ("b", {"b/robot": "robot01"})
    world.run_until(lambda: ("b", 1) in world.over)


def test_another_role_of_the_same_run_gets_the_robot_and_the_role_itself_gets_one_anew(world):
    for number, role in enumerate(("a", "b", "c"), 1):
        world.tell(ask("run", number, "move", "dropOff01" if role == "a" else "curingOven01", role))
    world.run_until(lambda: ("run", 1) in world.over)
    given = dict(world.state.roles)
    assert len(set(given.values())) == 3
    world.tell(ask("run", 4, "move", "itemInventory01", "d"))
    assert ("run", 4) not in world.over
    world.tell(ask("run", 5, role="a"))
    assert world.state.roles["run/d"] == given["run/a"]
    assert "run/a" not in world.state.roles
    world.tell(ask("run", 6, role="b"), ask("run", 7, "move", "paintMachine01", "a"))
    world.run_until(lambda: ("run", 7) in world.over)
    assert world.state.roles["run/a"] == given["run/b"]


def test_a_role_without_a_robot_has_nothing_to_give_and_gets_none_by_it(world):
    world.tell(ask("a", 1), ask("a", 2, wants="robot02"))
    assert (world.over["a", 1], world.over["a", 2]) == (("", ""), ("", ""))
    assert (world.state.roles, world.state.tasks) == ({}, ())
    assert {robot.run for robot in world.state.robots.values()} == {""}


def test_a_robot_finishes_what_it_was_asked_before(world):
    world.tell(ask("a", 1, "move", "dropOff01"), ask("a", 2))
    world.pass_time()
    assert ("a", 2) not in world.over
    assert world.waits[-1].reason.code == "robot_busy"
    world.run_until(lambda: ("a", 1) in world.over)
    world.run_until(lambda: ("a", 2) in world.over, 5)
    assert world.state.roles == {}


def test_a_pick_that_was_called_off_is_brought_to_its_end_before_the_robot_is_free(world):
    world.tell(ask("a", 1, "pick", "itemInventory01"))
    world.run_until(lambda: any(sent.method == "pick" for sent in world.sent))
    world.tell(m.TaskCancelled("a", 1), ask("a", 2))
    assert ("a", 2) not in world.over
    assert "a/robot" in world.state.roles
    world.run_until(lambda: ("a", 2) in world.over, 60)
    assert not any(sent.method == "cancel" for sent in world.sent)


def test_two_roles_of_one_robot_keep_it_until_both_are_released(world):
    world.tell(ask("a", 1, "move", "dropOff01", "one", "robot01"))
    world.run_until(lambda: ("a", 1) in world.over)
    world.tell(ask("a", 2, "move", "dropOff01", "two", "robot01"))
    world.run_until(lambda: ("a", 2) in world.over)
    world.tell(ask("a", 3, role="one", wants="robot01"))
    assert (world.over["a", 3], world.state.robots["robot01"].run) == (("", ""), "a")
    world.tell(ask("a", 4, role="two", wants="robot01"))
    assert world.state.robots["robot01"].run == ""


@pytest.mark.parametrize(
    ("before", "after", "code"),
    [(m.StopPressed(), m.StopReset(), "stopped"), (m.RunPaused("a"), m.RunResumed("a"), "paused")],
)
def test_a_release_waits_while_all_is_stopped_or_the_run_is_paused(world, before, after, code):
    world.tell(ask("a", 1, "move", "dropOff01"))
    world.run_until(lambda: ("a", 1) in world.over)
    world.tell(before, ask("a", 2))
    assert ("a", 2) not in world.over
    assert world.waits[-1].reason.code == code
    assert "a/robot" in world.state.roles
    world.tell(after)
    assert (world.over["a", 2], world.state.roles) == (("", ""), {})


def test_a_run_that_ends_while_a_release_waits_leaves_nothing(world):
    world.tell(ask("a", 1, "move", "dropOff01"), ask("a", 2))
    assert len(world.state.tasks) == 2
    world.tell(m.RunOver("a"))
    assert (world.state.tasks, world.state.roles) == ((), {})


def test_the_same_message_again_releases_nothing_twice_and_a_kept_state_goes_on(world):
    world.tell(ask("a", 1, "move", "dropOff01"), ask("a", 2), ask("a", 2))
    assert len(world.state.tasks) == 2
    world.state = floor.from_json(json.loads(json.dumps(floor.to_json(world.state))))
    world.run_until(lambda: ("a", 2) in world.over)
    assert (world.state.roles, world.state.tasks) == ({}, ())


def test_the_floor_tells_whose_robot_was_released(world):
    world.tell(ask("a", 1, "move", "dropOff01", wants="robot02"))
    world.run_until(lambda: ("a", 1) in world.over)
    actions = world.tell(ask("a", 2, wants="robot02"))
    told = [action for action in actions if isinstance(action, m.RoleReleased | m.TaskOver)]
    assert told == [m.RoleReleased("a", "robot", "robot02", bound=True), m.TaskOver("a", 2)]

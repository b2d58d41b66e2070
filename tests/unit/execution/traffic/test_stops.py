"""What a stop holds up goes on with its reset: unless its run is paused; a run that is over leaves nothing behind."""

import pytest

from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import messages as m
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor

LAYOUT = demo_floor.layout()
OVEN = "curingOven01"


def move(run="a", number=1, place="dropOff01"):
    order = TaskOrder("move", Target(place), "robot", step="s")
    return m.TaskAsked(run, number, order, "robot01", ("move",), run)


def heat(run="a"):
    return m.TaskAsked(run, 1, TaskOrder("call", Target(OVEN), method="curePaint", arguments={"time": 1}), run_name=run)


@pytest.fixture
def world():
    """Robot 1 drives for run a."""
    world = PretendFloor(LAYOUT)
    world.tell(move())
    world.run_until(lambda: under_way(world))
    return world


def under_way(world):
    return [sent for sent in world.state.sent.values() if sent.upto >= 0]


def told_since(world, before):
    return [command.method for command in world.sent[before:]]


def rests(world):
    return lambda: not world.state.sent and not world.state.robots["robot01"].run


def test_a_robot_that_still_settles_for_a_run_that_is_over_goes_on_with_the_reset(world):
    world.tell(m.RunOver("a"))
    assert [sent.run for sent in under_way(world)] == ["a"]
    world.tell(m.StopPressed())
    for _ in range(50):
        world.pass_time()
    world.tell(m.StopReset())
    world.run_until(rests(world), 30)
    world.tell(m.RunOver("a"), move("b"))
    world.run_until(lambda: world.over.get(("b", 1)) == ("", ""))


def test_a_pick_that_is_finished_for_a_cancelled_run_is_finished_after_the_reset():
    world = PretendFloor(LAYOUT)
    order = TaskOrder("pick", Target("itemInventory01"), "robot", "box", 1, step="s")
    world.tell(m.TaskAsked("a", 1, order, "robot01", ("pick",), "a"))
    world.run_until(lambda: "pick" in {command.method for command in world.sent})
    world.tell(m.RunOver("a"))
    before = len(world.sent)
    world.tell(m.StopPressed())
    world.tell(m.StopReset())
    assert told_since(world, before) == ["pause", "resume"]
    world.run_until(rests(world), 30)


def test_a_run_that_was_resumed_before_the_reset_is_heard_of_goes_on_with_it(world):
    world.tell(m.StopPressed(), m.RunPaused("a"))
    world.tell(m.RunResumed("a"))
    assert {sent.held_up for sent in under_way(world)} == {True}
    world.tell(m.StopReset())
    world.run_until(lambda: world.over.get(("a", 1)) == ("", ""))


def test_a_run_that_says_behind_the_reset_that_it_is_paused_stands_still_until_it_is_resumed(world):
    before = len(world.sent)
    world.tell(m.StopPressed(), m.StopReset(), m.RunPaused("a"))
    assert set(told_since(world, before)) == {"pause"}
    world.tell(m.RunResumed("a"))
    assert "resume" in told_since(world, before)
    world.run_until(lambda: world.over.get(("a", 1)) == ("", ""))


def test_a_run_that_ends_while_all_is_stopped_and_whose_robot_is_away_leaves_it_free(world):
    world.tell(m.DeviceOffline("robot01"), m.StopPressed(), m.RunPaused("a"))
    world.deaf.add("robot01")
    world.tell(m.RunOver("a"), m.StopReset())
    world.run_until(rests(world), 60)


def test_a_call_of_a_run_that_ends_while_all_is_stopped_is_given_up_when_its_machine_stays_away():
    world = PretendFloor(LAYOUT, deaf=[OVEN])
    world.tell(heat())
    world.tell(m.DeviceOffline(OVEN), m.StopPressed(), m.RunPaused("a"))
    world.tell(m.RunOver("a"))
    world.run_until(lambda: not world.state.sent, 40)
    world.deaf.clear()
    world.tell(m.StopReset(), m.DeviceOnline(OVEN), heat("b"))
    world.run_until(lambda: world.over.get(("b", 1)) == ("", ""), 20)


def test_a_call_whose_time_is_over_while_all_is_stopped_is_given_up_when_its_machine_stays_away():
    world = PretendFloor(LAYOUT, deaf=[OVEN])
    world.tell(heat())
    world.tell(m.DeviceOffline(OVEN), m.StopPressed(), m.RunPaused("a"))
    world.tell(m.TaskCancelled("a", 1))
    world.run_until(lambda: not world.state.sent, 40)


def test_who_has_called_a_held_command_off_waits_no_longer_than_for_any_other_answer(world):
    world.deaf.add("robot01")
    world.tell(m.StopPressed(), m.RunPaused("a"))
    for _ in range(1000):
        world.pass_time()
    world.tell(m.RunOver("a"))
    assert under_way(world), "it has had no time to answer"
    world.run_until(rests(world), 65)

"""Many robots with many tasks through one door."""

import random
from dataclasses import replace
from math import hypot

import pytest

from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import messages as m
from tests.unit.execution.traffic.floor_with_door import ZONES, WithDoor, go


def test_all_robots_go_through_one_door_and_back():
    floor = WithDoor({})
    for number, robot in enumerate(sorted(floor.state.robots)):
        go(floor, (18.0 - number, -8.0), run=f"run{number}", robot=robot)
    floor.run_until(lambda: len(floor.over) == len(floor.state.robots), 1200)
    assert set(floor.over.values()) == {("", "")}
    for number, robot in enumerate(sorted(floor.state.robots)):
        go(floor, (3.0 + number, -8.0), run=f"run{number}", task=2, robot=robot)
    floor.run_until(lambda: len(floor.over) == 2 * len(floor.state.robots), 1200)
    assert set(floor.over.values()) == {("", "")}
    assert hypot(floor.at["robot01"][0] - 3.0, floor.at["robot01"][1] + 8.0) < 0.1


@pytest.mark.parametrize("seed", range(8))
def test_robots_with_many_tasks_through_a_door_that_breaks_and_is_shut_now_and_then_all_arrive(seed):
    rng = random.Random(seed)
    floor = WithDoor({})
    runs = {f"run{number}": robot for number, robot in enumerate(sorted(floor.state.robots))}
    floor.may_be_shut_in = frozenset(runs.values())
    narrow = replace(ZONES[0], key="p/one", rule="one_at_a_time", door="")
    zones = (*ZONES, narrow) if seed % 2 else ZONES
    done = dict.fromkeys(runs, 0)
    targets = [*floor.layout.stations, *floor.layout.docks]

    def settled():
        for run, robot in runs.items():
            if done[run] < 4 and (not done[run] or (run, done[run]) in floor.over):
                done[run] += 1
                order = TaskOrder("move", Target(rng.choice(targets)), "robot", step=run)
                floor.tell(m.TaskAsked(run, done[run], order, robot, ("move",), run, zones))
        floor.is_broken = "FAILED" if rng.random() < 0.3 else ""
        if rng.random() < 0.01:
            floor.is_open = False
        return all((run, 4) in floor.over for run in runs)

    floor.run_until(settled, 2000)
    assert set(floor.over.values()) == {("", "")}

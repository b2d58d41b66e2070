"""How much a step of the floor has to do with zones that nothing asks about: as much for forty open runs as for one."""

from dataclasses import replace

from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import floor
from execution.traffic import messages as m
from tests.kit.work import count_work
from tests.unit.execution.traffic.floor_with_door import EAST, WEST, ZONES, WithDoor, go

POINTS = ((1.0, -12.5), (1.5, -12.5), (1.5, -12.0), (1.0, -12.0))
TOLD = (*ZONES, *(m.FloorZone(f"p/{number}", "Bay", "one_at_a_time", POINTS) for number in range(9)))


def work_among(runs, events):
    """Return the lines of Python of a step of a floor where a robot is under way and so many runs are open."""
    under_way = WithDoor({"robot01": WEST})
    go(under_way, EAST, zones=TOLD)
    state = replace(under_way.state, zones={**under_way.state.zones, **{f"other{n}": TOLD for n in range(runs)}})
    assert not state.locks
    floor.step(under_way.layout, state, events, 0.5)
    with count_work() as work:
        floor.step(under_way.layout, state, events, 0.5)
    return work.lines


def test_a_step_looks_at_the_zones_of_no_open_run_while_nobody_is_in_one():
    assert work_among(40, [m.Tick()]) == work_among(1, [m.Tick()])


def test_a_task_is_taken_in_without_a_look_at_the_zones_of_other_runs_of_its_version():
    order = TaskOrder("move", Target("", EAST), "robot", step="s")
    asked = [m.TaskAsked("other0", 1, order, "robot02", ("move",), "other0", TOLD)]
    assert work_among(40, asked) == work_among(1, asked)

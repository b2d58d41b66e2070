"""Places that are moved on the map while robots stand there or are on their way."""

from math import hypot

import pytest

from editor.language.site.surroundings import PlaceFacts
from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import messages as m
from execution.traffic.layout import make_layout
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor

WEST, MIDDLE, EAST = (3.0, -8.0), (10.0, -8.0), (18.0, -8.0)


def layout_with(bay):
    places = (*demo_floor.places(), PlaceFacts("bay", "Bay 1", "point", *bay))
    return make_layout(demo_floor.grid(), demo_floor.devices(), places)


def begin(bay):
    return PretendFloor(layout_with(bay), {"robot01": WEST})


def go(floor, run):
    order = TaskOrder("move", Target("bay"), "robot", step=f"{run}-step")
    floor.tell(m.TaskAsked(run, 1, order, "robot01", ("move",), run))


def arrive(floor, run):
    floor.run_until(lambda: (run, 1) in floor.over, 120.0)
    assert floor.over[run, 1] == ("", "")


def is_at(floor, point):
    x, y = floor.at["robot01"]
    return hypot(x - point[0], y - point[1]) <= 0.2


def holds_where_it_is(floor):
    """Tell whether the robot has the cell on which its middle is."""
    lattice = floor.layout.lattice
    return lattice.cells_within(floor.at["robot01"], 1.0)[0] in floor.state.robots["robot01"].held


def test_a_robot_that_stands_at_a_place_which_is_moved_away_drives_there_for_the_next_run():
    floor = begin(MIDDLE)
    go(floor, "r")
    arrive(floor, "r")
    floor.tell(m.RunOver("r"))
    floor.layout = layout_with(EAST)
    go(floor, "later")
    arrive(floor, "later")
    assert is_at(floor, EAST)


@pytest.mark.parametrize("after_s", [1, 10, 27])
@pytest.mark.parametrize("now", [MIDDLE, (18.0, -11.0), WEST])
def test_a_robot_under_way_to_a_place_that_is_moved_always_holds_where_it_is(after_s, now):
    floor = begin(EAST)
    go(floor, "r")
    for _ in range(int(after_s * 10)):
        floor.pass_time()
    floor.layout = layout_with(now)
    while ("r", 1) not in floor.over:
        floor.pass_time()
        assert holds_where_it_is(floor)
        assert floor.now < 120
    assert is_at(floor, now)

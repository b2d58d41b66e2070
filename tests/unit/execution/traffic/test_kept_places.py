"""Places that are moved or removed on the map while robots are about them."""

from dataclasses import replace
from math import hypot

import pytest

from editor.language.site.surroundings import PlaceFacts
from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import messages as m
from execution.traffic.kept_places import keep_places
from execution.traffic.layout import make_layout
from tests.kit import demo_floor
from tests.unit.execution.traffic.simulated_floor import PretendFloor

WEST, EAST = (3.0, -8.0), (18.0, -8.0)
NEAR_EAST = (17.8, -8.1)


def bay(at, kind="point", theta=0.0):
    return PlaceFacts("bay", "Bay 1", kind, *at, theta)


def layout_with(*places):
    return make_layout(demo_floor.grid(), demo_floor.devices(), (*demo_floor.places(), *places))


def begin(at=EAST, **poses):
    return PretendFloor(layout_with(bay(at)), {"robot01": WEST, **poses})


def go(floor, run="r", task=1, wants="robot01", place="bay"):
    order = TaskOrder("move", Target(place), "robot", step=f"{run}-step")
    floor.tell(m.TaskAsked(run, task, order, wants, ("move",), run))


def drive(floor, seconds):
    for _ in range(int(seconds * 10)):
        floor.pass_time()


def arrive(floor, task=("r", 1)):
    floor.run_until(lambda: task in floor.over, 120.0)
    return floor.over[task]


def far_m(floor, robot, at):
    return hypot(floor.at[robot][0] - at[0], floor.at[robot][1] - at[1])


def holds_where_it_stands(floor, robot):
    """Tell whether a robot has the cells on which its body stands."""
    lattice, held = floor.layout.lattice, set(floor.state.robots[robot].held)
    return {cell for cell in lattice.cells_within(floor.at[robot], 0.2) if cell in lattice.links} <= held


@pytest.mark.parametrize("now", [(), (bay((10.0, -8.0)),), (bay(NEAR_EAST),)], ids=["removed", "moved", "a little"])
@pytest.mark.parametrize("after_s", [0, 5, 29.5])
def test_a_run_goes_where_the_place_was_when_it_began(now, after_s):
    floor = begin()
    go(floor)
    drive(floor, after_s)
    floor.layout = keep_places(layout_with(*now), {"r": [bay(EAST)]})
    assert arrive(floor) == ("", "")
    assert far_m(floor, "robot01", EAST) < 0.01
    drive(floor, 1)
    assert holds_where_it_stands(floor, "robot01")


def test_each_run_goes_where_the_place_was_when_it_began():
    first, then = (8.0, -8.0), (12.0, -8.0)
    layout = keep_places(layout_with(bay(then)), {"old": [bay(first)], "new": [bay(then)]})
    floor = PretendFloor(layout, {"robot01": WEST, "robot02": EAST})
    go(floor, "old")
    go(floor, "new", wants="robot02")
    assert (arrive(floor, ("old", 1)), arrive(floor, ("new", 1))) == (("", ""), ("", ""))
    assert far_m(floor, "robot01", first) < 0.01
    assert far_m(floor, "robot02", then) < 0.01


def test_a_robot_goes_once_more_to_a_place_that_was_removed_while_it_stood_there():
    floor = begin()
    go(floor)
    arrive(floor)
    floor.layout = keep_places(layout_with(), {"r": [bay(EAST)]})
    go(floor, task=2)
    assert arrive(floor, ("r", 2)) == ("", "")
    assert far_m(floor, "robot01", EAST) < 0.01


def test_at_a_dock_that_was_removed_robots_face_where_they_faced_before():
    floor = begin()
    floor.layout = keep_places(layout_with(), {"r": [bay(EAST, "dock", 1.5708)]})
    go(floor)
    assert arrive(floor) == ("", "")
    last = [command for command in floor.sent if command.device == "robot01"][-1]
    assert (last.arguments["path"][-1], last.arguments["theta"]) == ([18.0, -8.0], 1.5708)


@pytest.mark.parametrize("after_s", [0, 5])
@pytest.mark.parametrize(
    ("began", "now", "heading"),
    [
        (bay(EAST, "dock", 1.5708), bay(EAST, "dock", 3.1416), {"theta": 1.5708}),
        (bay(EAST, "dock", 1.5708), bay(EAST), {"theta": 1.5708}),
        (bay(EAST), bay(EAST, "dock", 1.5708), {}),
    ],
    ids=["turned", "no dock any more", "a dock by now"],
)
def test_robots_face_as_they_did_at_a_place_when_the_run_began(began, now, heading, after_s):
    floor = PretendFloor(layout_with(began), {"robot01": WEST})
    go(floor)
    drive(floor, after_s)
    floor.layout = keep_places(layout_with(now), {"r": [began]})
    assert arrive(floor) == ("", "")
    assert far_m(floor, "robot01", EAST) < 0.01
    last = [command for command in floor.sent if command.device == "robot01" and "path" in command.arguments][-1]
    assert last.arguments["path"][-1] == [18.0, -8.0]
    assert {name: value for name, value in last.arguments.items() if name == "theta"} == heading
    drive(floor, 1)
    assert holds_where_it_stands(floor, "robot01")


def test_a_robot_that_stands_at_a_dock_which_was_turned_faces_as_before_when_its_run_goes_there_once_more():
    began = bay(EAST, "dock", 1.5708)
    floor = PretendFloor(layout_with(began), {"robot01": WEST})
    go(floor)
    arrive(floor)
    sent = len(floor.sent)
    floor.layout = keep_places(layout_with(bay(EAST, "dock", 3.1416)), {"r": [began]})
    go(floor, task=2)
    assert arrive(floor, ("r", 2)) == ("", "")
    assert far_m(floor, "robot01", EAST) < 0.01
    assert [each.arguments["theta"] for each in floor.sent[sent:] if "theta" in each.arguments] == [1.5708]


def test_the_heading_of_a_place_that_is_no_dock_does_not_matter():
    layout = layout_with(bay(EAST, theta=3.1416))
    assert keep_places(layout, {"r": [bay(EAST, theta=1.5708)]}) is layout


def test_where_no_run_has_other_places_than_the_map_the_floor_is_the_same():
    layout = layout_with(bay(EAST))
    assert keep_places(layout, {"r": [bay(EAST), *demo_floor.places()], "later": []}) is layout


def test_an_id_that_a_device_has_by_now_is_the_device_s():
    shelf = replace(bay(WEST), id="itemInventory01")
    layout = layout_with()
    assert keep_places(layout, {"r": [shelf]}) is layout


def test_a_removed_place_has_the_name_that_people_know():
    inside = next(d.pose for d in demo_floor.devices() if d.id == "itemInventory01")
    layout = keep_places(layout_with(), {"r": [bay((inside.x, inside.y))]})
    assert layout.name("bay") == "Bay 1"
    floor = PretendFloor(layout, {"robot01": WEST})
    go(floor)
    kind, why = arrive(floor)
    assert kind == "blocked"
    assert why.startswith(f"A robot cannot stand at ({inside.x:.2f}, {inside.y:.2f})")

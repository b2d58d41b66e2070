"""The robot that maps: it drives on its own map by where it believes to be, and maps anew in the same coordinates."""

from __future__ import annotations

import pytest

from registry.floorplan.plan import OCCUPIED, Grid
from simulation.mapping.floor import TrueFloor
from simulation.mapping.scores import score
from simulation.mapping.survey import LONGEST_S, TICK_S, SurveyPlan
from simulation.scout import ScoutActor, ScoutPlan, describe_scout
from simulation.world import Ack, Obstacle, WorldEvent
from tests.kit.floors.halls import bare_hall, hall_with_a_bay
from vipo_device.protocol.description import Pose

FLOOR, START = bare_hall(6.0, 5.0), Pose(1.0, 1.0)
LIMIT_S = 600.0
SHAPE = ("width", "height", "resolution_m", "origin_x_m", "origin_y_m")


class Driven:
    """A scout whose time passes when the test says so."""

    def __init__(self, floor: Grid = FLOOR, start: Pose = START, longest_s: float = LONGEST_S) -> None:
        self.events: list[WorldEvent] = []
        plan = ScoutPlan("hall.scout", "Scout", "hall", SurveyPlan(floor, 1, start=start, longest_s=longest_s))
        self.actor = ScoutActor(describe_scout(plan, start), self.events.append, plan.survey)
        self.now_s = 0.0

    def tell(self, given: str, method: str, **arguments: object) -> None:
        """Give a command, by its id."""
        self.actor.command(self.now_s, method, arguments, given)

    def rest(self) -> None:
        """Let time pass until there is nothing to do."""
        end_s = self.now_s + LIMIT_S
        while self.actor.busy:
            assert self.now_s < end_s, "the robot does not come to an end"
            self.now_s += TICK_S
            self.actor.advance(self.now_s)

    def said(self, command: str) -> list[tuple[str, str]]:
        """What was answered to a command, with the reasons."""
        return [(e.status, e.why) for e in self.events if isinstance(e, Ack) and e.command == command]


def test_moves_are_driven_one_after_the_other_on_the_map_that_it_made() -> None:
    scout = Driven()
    scout.tell("map", "explore")
    scout.rest()
    for number, point in enumerate(([4.0, 1.0], [4.0, 3.5], [1.5, 3.5])):
        scout.tell(f"m{number}", "move", path=[point])
    scout.rest()
    assert [scout.said(f"m{n}")[-1][0] for n in range(3)] == ["DONE"] * 3
    truth = scout.actor.expedition.pose
    assert (truth.x, truth.y) == pytest.approx((1.5, 3.5), abs=0.06)


def test_a_robot_that_was_told_nothing_of_the_floor_drives_too_and_adds_to_its_map() -> None:
    scout = Driven()
    scout.tell("m", "move", path=[[3.0, 2.0]])
    scout.rest()
    assert scout.said("m")[-1][0] == "DONE"
    assert scout.actor.expedition.maker.matches > 5


def test_it_stands_before_what_was_put_there_since_and_says_so() -> None:
    cells = bytearray(FLOOR.cells)
    for row in range(FLOOR.height):
        x, y = 3.0, FLOOR.origin_y_m + (row + 0.5) * FLOOR.resolution_m
        cell = FLOOR.cell_of(x, y)
        if cell is not None:
            cells[cell[0] * FLOOR.width + cell[1]] = OCCUPIED
    scout = Driven(Grid(*(getattr(FLOOR, n) for n in SHAPE), bytes(cells)))
    scout.tell("m", "move", path=[[5.0, 1.0]])
    scout.tell("behind", "move", path=[[5.0, 2.0]])
    scout.rest()
    assert scout.said("m")[-1] == ("FAILED", "Scout cannot go on: something stands in its way.")
    assert scout.said("behind")[-1] == ("CANCELED", "The way before it failed.")
    assert scout.actor.expedition.pose.x < 3.0 - 0.12


def test_it_does_one_of_both_at_a_time() -> None:
    scout = Driven()
    scout.tell("m", "move", path=[[3.0, 2.0]])
    scout.tell("map", "explore")
    assert scout.said("map") == [("REJECTED", "Scout drives. Wait until it stands, or cancel that.")]
    scout.rest()
    scout.tell("map2", "explore")
    scout.tell("m2", "move", path=[[1.0, 1.0]])
    scout.tell("map3", "explore")
    assert scout.said("m2") == [("REJECTED", "Scout explores. Wait until it is done, or cancel that.")]
    assert scout.said("map3") == [("REJECTED", "Scout explores already. Wait until it is done, or cancel that.")]
    scout.tell("end", "cancel", command="map2")
    assert scout.said("map2")[-1][0] == "CANCELED"
    scout.tell("m3", "move", path=[[1.0, 1.0]])
    scout.rest()
    assert scout.said("m3")[-1][0] == "DONE"


def test_a_path_that_leaves_the_floor_or_begins_elsewhere_is_refused() -> None:
    scout = Driven()
    scout.tell("out", "move", path=[[90.0, 1.0]])
    scout.tell("far", "move", path=[[4.0, 4.0]], **{"from": [5.0, 4.0]})
    assert scout.said("out") == [("REJECTED", "The path leaves the map.")]
    assert scout.said("far") == [("REJECTED", "The way begins 5.0 m from where Scout will be.")]


def test_maps_made_one_after_the_other_lie_over_each_other() -> None:
    """A heading that is off by one degree at the start turns a whole map."""
    scout = Driven()
    for number in range(4):
        scout.tell(f"map{number}", "explore")
        scout.rest()
        found = score(scout.actor.expedition.maker.grid(), TrueFloor(FLOOR), START)
        assert (number, found.f1 >= 0.95, found.iou >= 0.97) == (number, True, True), found


def test_what_people_put_on_the_floor_is_seen_driven_round_and_is_on_the_map() -> None:
    scout = Driven()
    scout.actor.put_in_the_way([Obstacle(3.0, 2.5, 0.6)])
    scout.tell("map", "explore")
    scout.rest()
    mapped = scout.actor.expedition.maker.grid()
    row, column = mapped.cell_of(3.0, 2.2) or (0, 0)
    assert OCCUPIED in mapped.cells[(row - 1) * mapped.width + column - 2 : (row + 1) * mapped.width + column + 3]
    scout.tell("over", "move", path=[[3.0, 1.0], [3.0, 4.0]])
    scout.rest()
    why = "Scout cannot go on: something stands in its way."
    assert scout.said("over")[-1] == ("FAILED", why)
    scout.actor.put_in_the_way([])
    x, y = scout.actor.expedition.maker.pose.x, scout.actor.expedition.maker.pose.y
    scout.tell("through", "move", path=[[x, y], [3.0, 4.0]])
    scout.rest()
    assert scout.said("through")[-1][0] == "DONE"


def test_what_is_put_where_the_robot_stands_lies_there_once_it_has_left() -> None:
    scout, thing = Driven(), Obstacle(START.x, START.y, 0.4)
    floor = scout.actor.expedition._floor
    scout.actor.put_in_the_way([thing])
    assert floor.clearance_m(START.x, START.y) > 0
    scout.tell("away", "move", path=[[3.0, 1.0]])
    scout.rest()
    scout.actor.put_in_the_way([thing])
    assert floor.clearance_m(START.x, START.y) == 0


def test_a_scout_that_begins_in_a_bay_is_done_when_it_has_seen_the_hall() -> None:
    floor, start = hall_with_a_bay(0.5)
    scout = Driven(floor, start)
    scout.tell("map", "explore")
    scout.rest()
    assert scout.said("map")[-1] == ("DONE", "")
    assert score(scout.actor.expedition.maker.grid(), TrueFloor(floor), start).iou >= 0.97


def test_a_scout_that_does_not_get_through_fails_and_goes_on_with_its_map_once_it_has_room() -> None:
    floor, start = hall_with_a_bay(0.7)
    scout = Driven(floor, start)
    scout.actor.put_in_the_way([Obstacle(2.5, 1.0, 0.2), Obstacle(2.8, 1.0, 0.2)])
    scout.tell("map", "explore")
    scout.rest()
    why = "Scout did not get through a narrow place behind which there is more to see. "
    assert scout.said("map")[-1] == ("FAILED", why + "Drive it out of there, or make room, and let it explore again.")
    before = scout.actor.expedition
    scout.actor.put_in_the_way([])
    scout.tell("on", "explore")
    scout.rest()
    assert scout.said("on")[-1] == ("DONE", "")
    assert scout.actor.expedition is before
    assert score(before.maker.grid(), TrueFloor(floor), start).iou >= 0.97


def test_a_scout_whose_time_is_over_does_not_say_that_its_map_is_whole_and_goes_on_with_it() -> None:
    scout = Driven(hall_with_a_bay(0.7)[0], Pose(1.0, 2.0), longest_s=5.0)
    begun = scout.actor.expedition
    scout.tell("map", "explore")
    scout.rest()
    why = "The time was over before Scout had seen all that it can reach. "
    assert scout.said("map")[-1] == ("FAILED", why + "Drive it to what is left, and let it explore again.")
    for number in range(60):
        scout.tell(f"on{number}", "explore")
        scout.rest()
        if scout.said(f"on{number}")[-1][0] == "DONE":
            break
    assert (scout.actor.expedition, begun.maker.is_whole) == (begun, True)

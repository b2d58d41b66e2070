"""Robots of any size and speed touch what stands in their way, and it is told, in both worlds."""

from __future__ import annotations

from dataclasses import replace

import pytest

from simulation.services import DriverName, make_world
from simulation.world import Ack, Contact, Scene
from tests.unit.simulation.stage_set import ROBOT, hall, robot
from vipo_device.protocol.description import Description, Size

WALL_M = 6.0


def sized(robot: Description, radius_m: float, speed_m_s: float) -> Description:
    return replace(robot, radius_m=radius_m, speed_m_s=speed_m_s, size=Size(2 * radius_m, 2 * radius_m, 1.0))


@pytest.mark.parametrize("driver", ["kinematic", "physics"])
@pytest.mark.parametrize(("radius_m", "speed_m_s"), [(0.18, 2.0), (0.9, 1.5), (1.5, 1.0)])
def test_a_robot_that_drives_at_a_wall_stands_at_it_and_says_so(
    radius_m: float, speed_m_s: float, driver: DriverName
) -> None:
    world = make_world(scene=Scene(hall(wall_at_x=WALL_M), (sized(ROBOT, radius_m, speed_m_s),)), driver=driver)
    world.command("robot", "move", {"path": [[9.0, 4.0]]}, "m")
    events = [event for _ in range(300) for event in world.advance(0.1)]
    contacts = [event for event in events if isinstance(event, Contact)]
    assert [(c.device, c.other, c.distance_m <= 0) for c in contacts[:1]] == [("robot", "wall", True)]
    final = [event for event in events if isinstance(event, Ack) and event.status == "FAILED"]
    assert [ack.why for ack in final] == ["Robot cannot go on: it touches wall."]
    assert world.robots()["robot"].pose.x + radius_m == pytest.approx(WALL_M, abs=0.1)
    world.close()


def test_two_quick_robots_that_drive_at_each_other_do_not_drive_through_each_other() -> None:
    pair = [sized(robot(name, x, 4.0), 0.18, 2.5) for name, x in (("a", 1.0), ("b", 11.0))]
    world = make_world(scene=Scene(hall(), tuple(pair)), driver="kinematic")
    for name, x in (("a", 11.0), ("b", 1.0)):
        world.command(name, "move", {"path": [[x, 4.0]]}, name)
    events = [event for _ in range(100) for event in world.advance(0.1)]
    assert {(c.device, c.other) for c in events if isinstance(c, Contact)} & {("a", "b"), ("b", "a")}
    poses = world.robots()
    assert poses["a"].pose.x < poses["b"].pose.x
    world.close()

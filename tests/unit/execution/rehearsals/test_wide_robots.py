"""Robots of another width than the demo's are rehearsed like these: they come through the doors, and touch nothing."""

from dataclasses import replace

import pytest

from editor.language.expressions.nodes import PlaceRef
from editor.language.plan.instructions import End, Instruction, Move, Plan, RoleBinding
from execution.rehearsals.rehearsal import Conditions, rehearse
from tests.kit import demo_floor
from vipo_device.protocol.description import Pose, Size

AT_WALL = Pose(0.75, -10.9)
STOPS = ("curingOven01", "dropOff01", "itemInventory01")


def drive(radius_m, driver, **standing):
    moves = tuple(Instruction(Move("robot", PlaceRef(device=stop)), stop) for stop in STOPS)
    plan = Plan((*moves, Instruction(End())), {"robot": RoleBinding("robot", "robot01", ("move",))})
    scene = replace(demo_floor.scene(), poses=standing)
    size = Size(2 * radius_m, 2 * radius_m, 0.3)
    devices = tuple(
        replace(each, radius_m=radius_m, size=size) if each.kind == "robot" else each for each in scene.devices
    )
    return rehearse(plan, replace(scene, devices=devices), places=demo_floor.places(), conditions=Conditions(driver))


@pytest.mark.parametrize("driver", ["kinematic", "physics"])
def test_a_robot_of_eighty_centimetres_comes_to_the_machines_that_the_lattice_at_the_corner_misses(driver):
    result = drive(0.4, driver)
    assert (result["ok"], result["errors"], result["collisions"]) == (True, [], [])
    assert result["robots"]["robot01"]["distance_m"] > 20


def test_one_that_is_too_wide_for_the_floor_is_told_where_it_can_be_read_why():
    result = drive(0.6, "kinematic")
    assert result["ok"] is False
    assert result["errors"][0]["message"].endswith("The map's floor check says why.")


@pytest.mark.parametrize("driver", ["kinematic", "physics"])
def test_one_that_stands_at_a_wall_without_room_to_turn_goes_nowhere_as_in_a_run(driver):
    result = drive(0.4, driver, robot01=AT_WALL)
    assert result["ok"] is False
    assert "stands where it has no room to turn: it needs 0.42 m to all sides." in result["errors"][0]["message"]
    assert result["robots"]["robot01"]["distance_m"] < 0.2

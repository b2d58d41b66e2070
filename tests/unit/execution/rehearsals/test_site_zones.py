"""Rehearsals heed the zones of the site's floor, and where real robots stand that are simulated, as runs do."""

import json
from dataclasses import replace

import pytest

from editor.language import plan_to_json
from editor.language.expressions.nodes import PlaceRef
from editor.language.plan.instructions import End, Instruction, Move, Plan, RoleBinding
from editor.language.site.surroundings import ZoneFacts
from execution.machine.places import lies_in
from execution.rehearsals.child_process import run_job, scene_from_json, scene_to_json
from execution.rehearsals.program_file import rehearse_program
from execution.rehearsals.rehearsal import Conditions, rehearse
from execution.traffic import messages as m
from execution.traffic.outlines import touches
from tests.kit import demo_floor
from vipo_device.protocol.description import Pose, description_to_json

PLAN = Plan(
    (Instruction(Move("robot", PlaceRef(device="itemInventory01")), "s"), Instruction(End())),
    {"robot": RoleBinding("robot", "robot01", ("move",))},
)


def driven(driver, *zones):
    """Rehearse the way to the Item Inventory; return where the robot was, and the result."""
    scene, places = demo_floor.scene(), demo_floor.places()
    result = rehearse(PLAN, scene, places=places, zones=zones, conditions=Conditions(driver))
    return [(x, y) for x, y, _ in result["frames"]["robots"]["robot01"]], result


@pytest.mark.parametrize("driver", ["kinematic", "physics"])
def test_a_rehearsal_goes_round_a_zone_of_the_site_over_its_usual_way(driver):
    usual, _ = driven(driver)
    x, y = usual[len(usual) // 2]
    outline = ((x - 0.4, y - 0.4), (x + 0.4, y - 0.4), (x + 0.4, y + 0.4), (x - 0.4, y + 0.4))
    track, result = driven(driver, ZoneFacts("z", "Spill", "keep_out", outline))
    assert (result["ok"], result["errors"]) == (True, [])
    assert any(lies_in(point, outline) for point in usual)
    assert not any(lies_in(point, outline) for point in track)


def test_a_slow_zone_of_the_site_makes_a_rehearsal_last_longer():
    hall = ((0.0, -14.0), (30.0, -14.0), (30.0, 0.0), (0.0, 0.0))
    usual, slow = driven("kinematic")[1], driven("kinematic", ZoneFacts("z", "Hall", "slow", hall, 0.2))[1]
    assert slow["robots"]["robot01"]["distance_m"] == usual["robots"]["robot01"]["distance_m"]
    assert slow["duration_s"] > 2 * usual["duration_s"]


def test_a_goal_in_a_zone_to_keep_out_of_fails_the_rehearsal():
    everywhere = ((0.0, -6.0), (6.0, -6.0), (6.0, 0.0), (0.0, 0.0))
    _, result = driven("kinematic", ZoneFacts("z", "Goods in", "keep_out", everywhere))
    assert result["ok"] is False
    assert result["errors"][0]["message"].startswith("Zones leave no way for")


HALF = ((6.0, -14.0), (10.0, -14.0), (10.0, 0.0), (6.0, 0.0))
"""From wall to wall across the demo's factory: robots come from the docks in the east."""


def test_a_rehearsal_is_told_that_a_one_way_zone_leaves_no_way_and_drives_where_it_does():
    shut = driven("kinematic", ZoneFacts("z", "Aisle", "one_way", HALF, heading_deg=0.0))[1]
    assert shut["errors"][0]["message"] == (
        "Zones leave no way for TurtleBot 1 to Item Inventory. Change a zone on the map, or choose another place."
    )
    track, open_ = driven("kinematic", ZoneFacts("z", "Aisle", "one_way", HALF, heading_deg=180.0))
    assert (open_["ok"], track) == (True, driven("kinematic")[0])


def test_a_rehearsal_drives_over_preferred_floor():
    usual, _ = driven("kinematic")
    lanes = [((4.0, y), (17.0, y), (17.0, y + 0.5), (4.0, y + 0.5)) for y in (-8.9, -8.4, -7.9, -7.4)]
    inside = [sum(lies_in(point, lane) for point in usual) for lane in lanes]
    lane = lanes[inside.index(min(inside))]
    track, result = driven("kinematic", ZoneFacts("z", "Road", "preferred", lane))
    assert result["ok"]
    assert sum(lies_in(point, lane) for point in track) > len(track) / 4 > min(inside)


def test_a_job_carries_its_zones_and_one_from_before_has_none():
    zones = (
        ZoneFacts("a", "Aisle", "keep_out", ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))),
        ZoneFacts("b", "Door", "slow", ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0)), 0.3),
        ZoneFacts("c", "Lane", "one_way", ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0)), heading_deg=90.0),
        ZoneFacts("d", "Road", "preferred", ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))),
    )
    body = json.loads(json.dumps(scene_to_json(demo_floor.scene(), demo_floor.places(), zones)))
    assert scene_from_json(body)[2] == zones
    del body["zones"]
    assert scene_from_json(body)[2] == ()


def test_a_program_file_is_rehearsed_with_the_zones_of_its_own_site():
    """A hall that is not the demo's: 12 m of empty floor with a shelf at one end, and a wall of a zone across it."""
    box = [[5.0, -6.0], [6.0, -6.0], [6.0, 1.5], [5.0, 1.5]]
    cart = next(device for device in demo_floor.devices() if device.kind == "robot")
    robot = description_to_json(replace(cart, id="cart", name="Cart", pose=Pose(0.0, 0.0)))
    places = [{"id": "far", "name": "Far end", "kind": "point", "x": 12.0, "y": 0.0}]
    site = {"devices": [robot], "places": places}
    drawn = {"format": 2, "steps": {"m": {"kind": "move", "place": ["program", "body", "V"],
                                          "params": {"robot": "any", "to": {"place": "far"}}}}}  # fmt: skip
    plain = rehearse_program(drawn, site, 1, "kinematic")
    zoned = rehearse_program(drawn, {**site, "zones": [{"id": "w", "rule": "keep_out", "points": box}]}, 1, "kinematic")
    assert (plain["ok"], zoned["ok"]) == (True, True)
    assert zoned["robots"]["cart"]["distance_m"] > plain["robots"]["cart"]["distance_m"] + 2


RADIUS_M = next(device.radius_m for device in demo_floor.devices() if device.kind == "robot")


def body(points, robot="robot02", name="TurtleBot 2"):
    return m.FloorZone(f"body/{robot}", name, "keep_out", points)


def rehearsed(*bodies, driver="kinematic"):
    """Carry out a job as it lies in the database; one from before there were bodies has none."""
    scene = scene_to_json(demo_floor.scene(), demo_floor.places())
    job = {"plan": plan_to_json(PLAN), "scene": scene, "driver": driver}
    return run_job(json.loads(json.dumps(job | ({"bodies": list(map(m.zone_to_json, bodies))} if bodies else {}))))


def test_a_real_robot_that_stands_across_the_way_blocks_the_rehearsal_and_is_named():
    result = rehearsed(body(HALF))
    assert result["ok"] is False
    assert [(error["kind"], error["message"]) for error in result["errors"]] == [
        (
            "blocked",
            "The real TurtleBot 2 stands where TurtleBot 1 has to pass to Item Inventory. Let it be moved, or use the "
            "real one again.",
        )
    ]


def test_a_real_robot_is_not_in_the_way_of_what_is_simulated_in_its_place():
    assert rehearsed(body(HALF, "robot01", "TurtleBot 1"))["ok"]


@pytest.mark.parametrize("driver", ["kinematic", "physics"])
def test_a_rehearsal_goes_round_a_real_robot(driver):
    usual = driven(driver)[0]
    x, y = usual[len(usual) // 2]
    stands = body(((x - 0.1, y - 0.1), (x + 0.1, y - 0.1), (x + 0.1, y + 0.1), (x - 0.1, y + 0.1)))
    result = rehearsed(stands, driver=driver)
    track = [(x, y) for x, y, _ in result["frames"]["robots"]["robot01"]]
    assert (result["ok"], result["errors"]) == (True, [])
    assert any(touches(stands.points, point, RADIUS_M) for point in usual)
    assert not any(touches(stands.points, point, RADIUS_M - 0.02) for point in track)

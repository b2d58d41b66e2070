"""Programs that are only text: zones of their own and Moves along points, with simulated robots."""

from math import hypot

import pytest

from editor.language import compile_document, parse_script, tree_to_document
from execution.rehearsals.rehearsal import Conditions, rehearse
from simulation.world import Scene
from tests.kit import demo_floor
from tests.kit.demo_site import factory

SITE = factory()
ROUTE = ((5.25, -8.25), (5.25, -6.25), (9.25, -8.25), (5.25, -8.25))
SCRIPT = """class Task(object):
    def new_task(self):
        self.robot.move(self.drop_off.location{via})

    def run(self, ctx):
        self.robot = ctx.get("robot01")
        self.drop_off = ctx.get("dropOff01")
{zone}        self.new_task()
"""
VIA = f", via=[{', '.join(map(str, ROUTE))}]"


def rehearsed(via="", zone="", conditions="kinematic"):
    """Rehearse a Move as it is written, in the factory."""
    parsed = parse_script(SCRIPT.format(via=via, zone=f"        {zone}\n" if zone else ""), SITE)
    assert parsed.tree is not None, parsed.diagnostics
    compiled = compile_document(tree_to_document(parsed.tree, SITE), SITE)
    assert [d.code for d in compiled.diagnostics] == []
    scene = Scene(demo_floor.grid(), demo_floor.devices(), seed=1)
    result = rehearse(compiled.plan, scene, places=demo_floor.places(), conditions=Conditions(conditions))
    assert (result["ok"], result["errors"]) == (True, [])
    return result


def comes_by(result, points):
    """Tell whether robot01 comes near these points one after the other; half the diagonal of a cell, and a curve."""
    left = list(points)
    for x, y, _ in result["frames"]["robots"]["robot01"]:
        if left and hypot(left[0][0] - x, left[0][1] - y) <= 0.45:
            left.pop(0)
    return not left


@pytest.mark.parametrize("driver", ["kinematic", "physics"])
def test_a_robot_drives_along_the_points_of_a_script_there_and_back(driver):
    result = rehearsed(VIA, conditions=driver)
    assert comes_by(result, ROUTE)
    assert result["steps"][0]["status"] == "done"
    assert not comes_by(rehearsed(conditions=driver), ROUTE)


def test_a_zone_that_a_script_makes_slows_the_robot_down():
    zone = 'self.hall = ctx.zone("hall", [(0, -14), (30, -14), (30, 0), (0, 0)], rule="slow", speed=0.2)'
    quick, slow = rehearsed(), rehearsed(zone=zone)
    distance_m = slow["robots"]["robot01"]["distance_m"]
    assert distance_m == quick["robots"]["robot01"]["distance_m"]
    assert slow["duration_s"] > max(distance_m / 0.2, 1.5 * quick["duration_s"])

"""Zones of a site's floor in its rehearsals, whatever rule people draw, and the bodies of robots that are simulated."""

import pytest

from editor.language.expressions.nodes import PlaceRef
from editor.language.plan.instructions import End, Instruction, Move, Plan, RoleBinding
from execution.models import Rehearsal
from execution.rehearsals import worker
from registry import services as registry
from registry.models import Device, SiteZone
from tests.integration.execution.rehearsals.conftest import SHORT, queue, row
from tests.kit.programs import SITE

pytestmark = pytest.mark.django_db(transaction=True)
ASIDE = ((22.0, -3.0), (24.0, -3.0), (24.0, -1.5), (22.0, -1.5))
NEEDS = {"slow": {"speed_m_s": 0.2}, "one_way": {"heading_deg": 90.0}, "one_at_a_time": {"robots": 1}}


@pytest.mark.parametrize("rule", SiteZone.Rule.values)
def test_a_site_with_a_zone_of_any_rule_can_be_rehearsed(factory, rule):
    zone = registry.ZoneChange(name="Aside", rule=rule, points=ASIDE, **NEEDS.get(rule, {}))
    registry.add_zone(site=SITE, zone=zone)
    rehearsal = queue(SHORT, driver="kinematic")
    worker.carry_out_waiting()
    assert (row(rehearsal).status, row(rehearsal).reason) == (Rehearsal.Status.DONE, "")


def test_a_rehearsal_fails_where_the_real_robot_of_a_stand_in_stands_in_the_way_as_a_run_would(factory):
    way = (Instruction(Move("robot", PlaceRef(device="itemInventory01")), "s"), Instruction(End()))
    plan = Plan(way, {"robot": RoleBinding("robot", "robot01", ("move",))})
    there = {"x": 2.3, "y": -2.93, "z": 0.0, "theta": 0.0}
    found = []
    for aside in (None, {"pose": there}):
        Device.objects.filter(pk="robot02").update(stand_in=aside is not None, aside=aside)
        rehearsal = queue(plan, driver="kinematic")
        worker.carry_out_waiting()
        found.append((row(rehearsal).status, [error["message"] for error in row(rehearsal).result["errors"]]))
    why = "The real TurtleBot 2 stands where TurtleBot 1 has to pass to Item Inventory. "
    assert found == [("done", []), ("done", [why + "Let it be moved, or use the real one again."])]

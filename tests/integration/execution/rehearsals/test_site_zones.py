"""Zones of a site's floor in its rehearsals: whatever rule people draw, the site can be rehearsed."""

import pytest

from execution.models import Rehearsal
from execution.rehearsals import worker
from registry import services as registry
from registry.models import SiteZone
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

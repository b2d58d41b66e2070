"""What zones cost in rehearsals, over HTTP: who may ask, and of which rehearsals."""

import pytest

from execution.models import Rehearsal
from execution.rehearsals import worker
from registry import services as registry
from tests.integration.execution.rehearsals.conftest import SHORT, queue, row
from tests.kit.programs import SITE
from tests.kit.sign_in import from_role, join_and_sign_in

pytestmark = pytest.mark.django_db(transaction=True)
POINTS = ((8.0, -10.0), (14.0, -10.0), (14.0, -6.0), (8.0, -6.0))
COSTS = f"/api/sites/{SITE}/zone-costs"


def draw(name="Corridor", **changes):
    zone = registry.ZoneChange(name=name, rule="one_at_a_time", points=POINTS, robots=1)
    return registry.add_zone(site=SITE, zone=zone).id


@pytest.fixture
def viewer(factory):
    return join_and_sign_in("viewer", SITE)


def test_a_rehearsal_that_is_done_counts_until_its_zone_is_drawn_otherwise(viewer):
    costs = lambda: viewer.get(COSTS).json()  # noqa: E731
    zone = draw()
    assert costs() == [{"zone": zone, "rehearsals": 0, "waited_s": 0.0, "most_s": 0.0, "waited_in": 0}]
    rehearsal = queue(SHORT, driver="kinematic")
    worker.carry_out_waiting()
    (kept,) = row(rehearsal).zone_waits.values()
    assert kept["waited_s"] == 0
    assert costs()[0]["rehearsals"] == 1
    Rehearsal.objects.filter(id=rehearsal).update(zone_waits={zone: {**kept, "waited_s": 21.25}})
    assert costs() == [{"zone": zone, "rehearsals": 1, "waited_s": 21.2, "most_s": 21.2, "waited_in": 1}]
    registry.change_zone(site=SITE, zone_id=zone, zone=registry.ZoneChange(robots=2))
    assert costs()[0]["rehearsals"] == 0


@pytest.mark.parametrize("role", from_role("viewer"))
def test_every_role_may_ask(factory, role):
    draw()
    assert len(join_and_sign_in(role, SITE).get(COSTS).json()) == 1


def test_a_stranger_learns_nothing_and_other_zones_cost_nothing(viewer):
    keep_out = registry.ZoneChange(name="Spill", rule="keep_out", points=POINTS)
    registry.add_zone(site=SITE, zone=keep_out)
    assert viewer.get(COSTS).json() == []
    assert join_and_sign_in("stranger", SITE).get(COSTS).status_code == 404

"""A hundred devices of a site are simulated at once."""

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from execution.stand_ins.stand_ins import StandIns
from registry.models import Device, Site
from tests.kit.programs import SITE

pytestmark = pytest.mark.django_db(transaction=True)


def simulate(count):
    """Let so many robots of the site be simulated, each the copy of one of the factory's."""
    robot = Device.objects.get(pk="robot01")
    for number in range(count):
        described = {**robot.description, "id": f"many{number}"}
        Device.objects.create(
            id=f"many{number}", site=Site.objects.get(slug=SITE), lifecycle="approved", description=described,
            stand_in=True, aside={"since": "2026-11-27"},
        )  # fmt: skip


def statements(stand_ins, now):
    with CaptureQueriesContext(
        connection,
    ) as asked:
        stand_ins._look(now)
    return len(asked)


def test_a_look_asks_no_more_of_the_database_for_a_hundred_than_for_one(factory, settings, tmp_path):
    settings.VIPO_STATE_DIR = tmp_path
    simulate(1)
    stand_ins = StandIns(settings)
    few = statements(stand_ins, 100.0)
    Device.objects.filter(pk="many0").delete()
    simulate(100)
    many = statements(stand_ins, 200.0)
    assert len(stand_ins._playing) == 100
    assert many <= few
    assert statements(stand_ins, 202.0) == 2, "between it is asked who is simulated, and what lies on the floor"
    for playing in stand_ins._playing.values():
        playing.stand_in.close()

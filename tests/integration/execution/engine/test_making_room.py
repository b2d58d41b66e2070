"""Owners that have nothing to do make room for sites that wait for one."""

from datetime import timedelta

import pytest

from bench.hall import fill_hall
from execution import database
from execution.engine import lease
from execution.engine.lease_renewal import LeaseRenewal
from execution.models import Run, SiteLease
from tests.integration.execution.engine.hall import WAITS, start

pytestmark = pytest.mark.django_db(transaction=True)
SECOND, HOUR = timedelta(seconds=1), timedelta(hours=1)


@pytest.mark.parametrize(
    ("made_before", "planned_in", "is_owned", "makes_room"),
    [
        pytest.param(2 * SECOND, None, False, True, id="a run that was just started"),
        pytest.param(HOUR, -2 * SECOND, False, True, id="a planned run whose time has come"),
        pytest.param(HOUR, HOUR, False, False, id="a run that is planned for later"),
        pytest.param(0 * SECOND, None, False, False, id="a run that has waited for less than a second"),
        pytest.param(2 * SECOND, None, True, False, id="a run whose site has an owner"),
    ],
)
def test_owners_make_room_for_a_run_that_is_due_at_a_site_without_an_owner(
    made_before, planned_in, is_owned, makes_room
):
    fill_hall(6)
    start(WAITS)
    now = database.now()
    Run.objects.update(created_at=now - made_before, not_before=planned_in and now + planned_in)
    if is_owned:
        lease.take(Run.objects.get().site_id)
    assert (LeaseRenewal()._is_somebody_waiting(), SiteLease.objects.exists()) == (makes_room, is_owned)

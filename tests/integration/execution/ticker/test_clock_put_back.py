"""The database's clock was ahead and is put right: what counts on it goes on at once."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import pytest

from execution.engine import lease as leases
from execution.engine.lease_renewal import LeaseRenewal
from execution.job_lease import LEASE_S, JobLease
from execution.models import InboxEvent, SiteLease
from execution.ticker.ticker import Ticker
from registry.models import Device, Site
from tests.kit.sites import come, describe, make_hall

pytestmark = pytest.mark.django_db(transaction=True)
RIGHT = datetime.now(UTC)
WRONG = RIGHT + timedelta(minutes=30)


def later(seconds: float) -> datetime:
    return RIGHT + timedelta(seconds=seconds)


@pytest.fixture
def hall() -> None:
    make_hall()
    describe()
    Device.objects.update(lifecycle="approved")


def test_a_device_that_falls_silent_after_that_is_seen_to_be_away(hall: None) -> None:
    ticker = Ticker("a")
    ticker.tick(WRONG)
    come(at=RIGHT)
    for second in range(0, 300, 5):
        ticker.tick(later(second))
    assert Device.objects.get(pk="mixer1").online is False


def test_a_spare_leads_when_the_leader_has_died_at_that_moment(hall: None) -> None:
    first, spare = Ticker("a"), Ticker("b")
    assert first.tick(WRONG)
    assert spare.tick(RIGHT)
    assert not first.tick(later(0.1))


def test_a_leader_that_lives_keeps_its_job_and_one_alone_has_it(db: None) -> None:
    first, spare = JobLease("job", "a"), JobLease("job", "b")
    assert first.hold(WRONG)
    assert first.hold(RIGHT)
    assert not spare.hold(later(0.1))
    assert [first.hold(later(LEASE_S)), spare.hold(later(LEASE_S + 0.1))] == [True, False]


@pytest.mark.parametrize("owner", ["somebody who has died", ""])
def test_a_site_whose_owner_went_before_that_is_taken_by_another(hall: None, owner: str) -> None:
    site = Site.objects.get()
    assert leases.take(site.pk, owner or "somebody") is not None
    if not owner:
        leases.release(leases.Lease(site.pk, SiteLease.objects.get().epoch, "somebody"))
    SiteLease.objects.update(expires_at=datetime.now(UTC) + timedelta(minutes=30))
    assert leases.take(site.pk, "another") is not None


def test_owners_make_room_for_a_site_whose_owner_went_before_that(hall: None) -> None:
    site = Site.objects.get()
    leases.take(site.pk, "somebody who has died")
    SiteLease.objects.update(expires_at=datetime.now(UTC) + timedelta(minutes=30))
    at = datetime.now(UTC) - timedelta(seconds=5)
    InboxEvent.objects.create(site=site.slug, target=f"site:{site.slug}", key="x", payload={}, created_at=at)
    assert LeaseRenewal()._is_somebody_waiting()

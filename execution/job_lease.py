"""A job that only one of several processes may do at a time: whoever holds the lease on it."""

from __future__ import annotations

from datetime import datetime, timedelta

from django.db.models import Q

from execution.models import Lease, SiteLease

LEASE_S = 5.0
"""How long a lease stands that nobody renews, of a job as of a site."""


class JobLease:
    """One process's hold on a job, as far as it has it; a holder that dies loses it after `LEASE_S`.

    No lease stands for longer than that: one that ends later was taken before the clock was put back, and counts no
    more.
    """

    def __init__(self, job: str, holder: str) -> None:
        self._job, self._holder = job, holder
        self._until: datetime | None = None

    def hold(self, now: datetime) -> bool:
        """Take or renew the lease; it is renewed when half of it is over, so that asking often costs no write."""
        whole = timedelta(seconds=LEASE_S)
        if self._until is not None and whole / 2 < self._until - now <= whole:
            return True
        until = now + whole
        Lease.objects.get_or_create(name=self._job, defaults={"holder": self._holder, "until": until})
        mine = Lease.objects.filter(name=self._job, holder=self._holder).update(until=until)
        over = Q(until__lt=now) | Q(until__gt=now + 2 * whole)
        free = mine or Lease.objects.filter(over, name=self._job).update(holder=self._holder, until=until)
        self._until = until if free else None
        return bool(free)


def fence_of(site: int) -> int:
    """Return the epoch under which a site is carried out now, which its commands carry as their fence; 0 for none."""
    return SiteLease.objects.filter(site_id=site).values_list("epoch", flat=True).first() or 0

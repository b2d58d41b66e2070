"""A site's lease: whoever holds it carries the site's runs out; all its times are those of the database's clock."""

from __future__ import annotations

import os
import socket
from collections.abc import Collection
from dataclasses import dataclass, field
from datetime import timedelta
from typing import Any
from uuid import uuid4

from django.db import connection
from django.db.models import Case, DateTimeField, ExpressionWrapper, F, Q, QuerySet, Value, When
from django.db.models.functions import Now

from execution import database
from execution.frozen_sessions import end_frozen_holder
from execution.job_lease import LEASE_S
from execution.models import SiteLease


class _Process:
    """What this process is called as an owner; one that is started anew, or forked from it, is another one."""

    def __init__(self) -> None:
        self.take_name()
        os.register_at_fork(after_in_child=self.take_name)

    def take_name(self) -> None:
        self.name = f"{socket.gethostname()[:60]}:{os.getpid()}:{uuid4().hex[:8]}"


_process = _Process()


def this_owner() -> str:
    """Return what this process is called as an owner."""
    return _process.name


_HOLD = {
    vendor: f"UPDATE execution_sitelease SET expires_at = {later} "  # noqa: S608 - made of our own words only
    "WHERE site_id = %(site)s AND epoch = %(epoch)s AND owner = %(owner)s"
    for vendor, later in (
        ("postgresql", f"statement_timestamp() + interval '{LEASE_S} seconds'"),
        ("sqlite", f"strftime('%%Y-%%m-%%d %%H:%%M:%%f', 'now', '+{LEASE_S} seconds')"),
    )
}


class LeaseLost(Exception):
    """Another process owns the site by now: what this one has worked out is not written."""


@dataclass(frozen=True, slots=True)
class Lease:
    """A hold on a site; `epoch` tells it from every hold that another owner has or had."""

    site: int
    epoch: int
    owner: str = field(default_factory=this_owner)


def take(site: int, owner: str | None = None) -> Lease | None:
    """Take a site that nobody holds; None when another process holds it.

    Who held it last takes it again under the same epoch, so that what it remembers of the site is still true.
    """
    owner = owner or this_owner()
    row, _ = SiteLease.objects.get_or_create(site_id=site, defaults={"expires_at": Now()})
    if row.owner not in ("", owner):
        end_frozen_holder(site)
    free = SiteLease.objects.filter(Q(owner=owner) | Q(owner="") | ~holds(), site_id=site)
    epoch = Case(When(owner=owner, then=F("epoch")), default=F("epoch") + Value(1))
    if not free.update(owner=owner, epoch=epoch, expires_at=_later(LEASE_S)):
        return None
    return Lease(site, SiteLease.objects.values_list("epoch", flat=True).get(site_id=site, owner=owner), owner)


def holds() -> Q:
    """Return what leases fulfil that stand; one that ends too far ahead is from before a clock was put back."""
    return Q(expires_at__gte=Now(), expires_at__lte=_later(2 * LEASE_S))


def ask_to_hold(batch: database.Batch, lease: Lease) -> Any:
    """Renew a lease together with other statements; `check_held` says behind them whether it was this owner's.

    Within a transaction nobody else takes the site before that is over.
    """
    told = {"site": lease.site, "epoch": lease.epoch, "owner": lease.owner}
    return batch.ask(_HOLD[connection.vendor], told)


def check_held(answer: Any) -> None:
    """Raise LeaseLost where `ask_to_hold` found that another owner has the site."""
    if not answer.rowcount:
        raise LeaseLost


def hold(lease: Lease) -> None:
    """Renew a lease; within a transaction nobody else takes the site before that is over.

    Raises LeaseLost.
    """
    with database.sent_together() as batch:
        answer = ask_to_hold(batch, lease)
    check_held(answer)


def renew(leases: Collection[Lease]) -> None:
    """Renew several leases at once; one that is lost stays so."""
    if leases:
        _mine(leases).update(expires_at=_later(LEASE_S))


def release(lease: Lease) -> None:
    """Give a site up; another process may take it at once."""
    _mine([lease]).update(expires_at=_later(-1.0))


def _mine(leases: Collection[Lease]) -> QuerySet[SiteLease]:
    rows = Q()
    for lease in leases:
        rows |= Q(site_id=lease.site, epoch=lease.epoch, owner=lease.owner)
    return SiteLease.objects.filter(rows)


def _later(seconds: float) -> ExpressionWrapper[Any]:
    return ExpressionWrapper(Now() + timedelta(seconds=seconds), output_field=DateTimeField())

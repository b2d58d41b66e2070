"""Stop all: latched for a site, past all queues, reset only by an operator. Not an emergency stop of machine safety."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial
from uuid import uuid4

from django.db import transaction

from execution import mailbox
from execution.machine.messages import PauseAsked
from execution.models import ArmedProgram, Run, SiteStop
from execution.traffic.messages import StopPressed, StopReset
from registry import services as registry


@dataclass(frozen=True, slots=True)
class StopView:
    """The stop of a site."""

    site: str
    active: bool
    by: str
    at: datetime | None


def list_stops() -> tuple[StopView, ...]:
    """Return the stop of every site where it was ever pressed."""
    rows = SiteStop.objects.select_related("site").order_by("site_id")
    return tuple(StopView(row.site.slug, row.active, row.by, row.at) for row in rows)


def is_stopped(*, site: str) -> bool:
    """Tell whether the site's stop is latched."""
    return SiteStop.objects.filter(site__slug=site, active=True).exists()


def press_stop(*, site: str, by: str) -> StopView:
    """Stop every device of the site and pause every run; pressing it again changes nothing."""
    with transaction.atomic():
        row = _lock(site)
        if not row.active:
            _latch(row, site, active=True, by=by)
            _disarm_all(site)
            reason = f"{by} stopped all devices of the site"
            for run in Run.objects.filter(site__slug=site, status__in=Run.OPEN).values_list("id", flat=True):
                mailbox.post_to_run(site, run, [(f"stop:{run}:{uuid4()}", PauseAsked(reason))])
            mailbox.post_to_floor(site, [(f"stop:{uuid4()}", StopPressed())])
    return StopView(site, row.active, row.by, row.at)


def reset_stop(*, site: str, by: str) -> StopView:
    """Let the site's devices be used again; runs stay paused until somebody resumes them."""
    with transaction.atomic():
        row = _lock(site)
        if row.active:
            _latch(row, site, active=False, by=by)
            mailbox.post_to_floor(site, [(f"reset:{uuid4()}", StopReset())])
    return StopView(site, row.active, row.by, row.at)


def _disarm_all(site: str) -> None:
    """No program starts by itself after a stop until somebody arms it again."""
    if ArmedProgram.objects.filter(site__slug=site).delete()[0]:
        transaction.on_commit(lambda: registry.publish(site, {"type": "armed", "programs": []}))


def _lock(site: str) -> SiteStop:
    SiteStop.objects.get_or_create(site_id=registry.get_site_id(site=site))
    return SiteStop.objects.select_for_update().get(site_id=registry.get_site_id(site=site))


def _latch(row: SiteStop, site: str, *, active: bool, by: str) -> None:
    row.active, row.by, row.at = active, by, datetime.now(UTC)
    row.save()
    registry.set_site_stop(site=site, active=active, by=by, at=row.at)
    message = {"type": "stop", "active": active, "by": by, "at": row.at.isoformat()}
    transaction.on_commit(lambda: registry.publish(site, message))
    for channel in ("stops", "gateway"):  # what there is to look at, then the hint that ends the gateway's wait
        transaction.on_commit(partial(registry.wake, channel))

"""What waits, of one site or of all: as many questions to the database for one run as for ten thousand."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from celery import current_app
from django.db.models import Count, Min, Q
from django.db.models.query import QuerySet
from kombu.exceptions import ChannelError, OperationalError

from execution.engine.lease import holds
from execution.models import Command, DeadLetter, InboxEvent, Lease, Rehearsal, Run, SiteLease

log = logging.getLogger(__name__)
OVERDUE_AFTER = timedelta(seconds=10)
"""A device answers at once, if only that it has begun; one that has not by then is away or does not understand."""
MOST_OVERDUE = 20
MOST_OWNERS = 200
OF_SITE = "site:"
TASK_QUEUES = ("runs", "rehearsals", "upkeep")


@dataclass(frozen=True, slots=True)
class QueueView:
    """How many wait, and since when the first of them does (None for nobody)."""

    name: str
    waiting: int
    oldest_at: datetime | None


@dataclass(frozen=True, slots=True)
class OverdueView:
    """A command to which its device has said nothing for long; `run` is None for a person's call."""

    id: str
    device: str
    method: str
    status: str
    tries: int
    run: str | None
    number: int | None
    created_at: datetime


@dataclass(frozen=True, slots=True)
class LeaseView:
    """Who does a job that only one process may do, and until when."""

    job: str
    holder: str
    until: datetime


@dataclass(frozen=True, slots=True)
class Overview:
    """What waits at `now`, by the database's clock: queues, open runs and commands by status."""

    now: datetime
    queues: tuple[QueueView, ...]
    runs: Mapping[str, int]
    commands: Mapping[str, int]


def read_overview(*, site: str = "", now: datetime) -> Overview:
    """Return what waits at a site, or everywhere."""
    here = {"site__slug": site} if site else {}
    runs = _by_status(Run.objects.filter(status__in=Run.OPEN, **here))
    commands = _by_status(Command.objects.filter(status__in=Command.OPEN, **here))
    rehearsals = _by_status(Rehearsal.objects.filter(status__in=("queued", "running"), **here))
    queues = (
        QueueView("inbox", *_waiting_in_inboxes(site)),
        _queue("outbox", commands, ("pending",)),
        _queue("unanswered", commands, ("sent",)),
        _queue("under_way", commands, ("accepted", "running")),
        _queue("rehearsals", rehearsals, ("queued",)),
        _queue("rehearsing", rehearsals, ("running",)),
        QueueView("set_aside", *_waiting_for_admins(here)),
    )
    return Overview(now, queues, _counts(runs, Run.OPEN), _counts(commands, Command.OPEN))


def _by_status(rows: QuerySet[Any]) -> dict[str, tuple[int, datetime]]:
    told = rows.values_list("status").annotate(Count("id"), Min("created_at")).order_by("status")
    return {status: (count, oldest) for status, count, oldest in told}


def _counts(found: Mapping[str, tuple[int, datetime]], statuses: Iterable[str]) -> dict[str, int]:
    return {str(status): found[status][0] if status in found else 0 for status in statuses}


def _queue(name: str, found: Mapping[str, tuple[int, datetime]], statuses: Iterable[str]) -> QueueView:
    parts = [found[status] for status in statuses if status in found]
    return QueueView(name, sum(count for count, _ in parts), min((oldest for _, oldest in parts), default=None))


def _waiting_in_inboxes(site: str) -> tuple[int, datetime | None]:
    """Return how many events no run and no floor has taken in yet, and since when the first waits."""
    waiting = InboxEvent.objects.filter(taken_at=None)
    if site:
        waiting = waiting.filter(site=site)
    found = waiting.aggregate(count=Count("id"), oldest=Min("created_at"))
    return found["count"], found["oldest"]


def _waiting_for_admins(here: Mapping[str, str]) -> tuple[int, datetime | None]:
    """Return how much is set aside that nobody has retried or dropped, and since when the first of it."""
    found = DeadLetter.objects.filter(state=DeadLetter.State.OPEN, **here).aggregate(
        count=Count("id"), oldest=Min("at")
    )
    return found["count"], found["oldest"]


def list_overdue(*, site: str, now: datetime) -> tuple[int, tuple[OverdueView, ...]]:
    """Return how many commands of a site are overdue, and the 20 that have been so for longest."""
    limit = now - OVERDUE_AFTER
    rows = Command.objects.filter(Q(status="pending") | Q(status="sent"), site__slug=site, created_at__lt=limit)
    fields = ("id", "device", "method", "status", "tries", "run", "created_at")
    found = list(rows.order_by("created_at").values_list(*fields)[:MOST_OVERDUE])
    numbers = dict(Run.objects.filter(id__in={each[5] for each in found if each[5]}).values_list("id", "number"))
    views = tuple(
        OverdueView(str(key), device, method, status, tries, run and str(run), numbers.get(run), at)
        for key, device, method, status, tries, run, at in found
    )
    return rows.count() if len(found) == MOST_OVERDUE else len(found), views


def list_leases() -> tuple[LeaseView, ...]:
    """Return who does the jobs of which there is one each, and who carries out the runs of sites (`site:SLUG`)."""
    jobs = tuple(LeaseView(row.name, row.holder, row.until) for row in Lease.objects.order_by("name"))
    owned = SiteLease.objects.exclude(owner="").filter(holds()).order_by("site__slug")
    owners = owned.values_list("site__slug", "owner", "expires_at")[:MOST_OWNERS]
    return jobs + tuple(LeaseView(f"{OF_SITE}{site}", owner, until) for site, owner, until in owners)


def read_task_queues() -> dict[str, int]:
    """Return how many tasks wait for a worker, by queue; nothing while the tasks' broker does not answer."""
    with current_app.connection_or_acquire() as link:
        try:
            return {name: _length(link.default_channel, name) for name in TASK_QUEUES}
        except (*link.connection_errors, OperationalError, OSError) as error:
            log.warning("Nobody knows how many tasks wait: %s", error)
            return {}


def _length(channel: Any, queue: str) -> int:
    """Return how many messages wait; in Redis a queue without any does not exist."""
    try:
        return int(channel.queue_declare(queue, passive=True).message_count)
    except ChannelError:
        return 0

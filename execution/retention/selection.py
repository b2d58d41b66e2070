"""What may go into the archive: what has ended before a moment, and what nothing that is open needs any more."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime
from typing import Any
from uuid import UUID

from django.db.models import Exists, OuterRef, Q, QuerySet

from execution.mailbox import run_target
from execution.models import Command, InboxEvent, Question, Rehearsal, Run
from registry import services as registry

ABOUT_COMMANDS: frozenset[registry.AlertCode] = frozenset({"command_rejected", "command_failed", "command_timed_out"})


def old_rows(kind: str, site: int, before: datetime) -> QuerySet[Any]:
    """Return runs, rehearsals or calls of a site that may be archived, in the order in which they ended."""
    return {"runs": _old_runs, "rehearsals": _old_rehearsals, "calls": _old_calls}[kind](site, before)


def _old_runs(site: int, before: datetime) -> QuerySet[Run]:
    own = Command.objects.filter(run=OuterRef("pk"))
    asks = Question.objects.filter(run=OuterRef("pk"), state=Question.State.OPEN)
    rows = Run.objects.filter(site_id=site, archive=None, ended_at__lt=before).exclude(status__in=Run.OPEN)
    rows = rows.exclude(Exists(own.filter(status__in=Command.OPEN))).exclude(Exists(asks))
    if (needed := _needed_by_alerts()) is not None:
        rows = rows.exclude(Exists(own.filter(needed)))
    return rows.exclude(pk__in=list(_with_news())).order_by("ended_at", "pk")


def _old_rehearsals(site: int, before: datetime) -> QuerySet[Rehearsal]:
    rows = Rehearsal.objects.filter(site_id=site, archive=None, ended_at__lt=before)
    return rows.exclude(status__in=Rehearsal.OPEN).order_by("ended_at", "pk")


def _old_calls(site: int, before: datetime) -> QuerySet[Command]:
    """Return what people told devices by hand, and what the floor told robots for no run."""
    rows = Command.objects.filter(site_id=site, run=None, ended_at__lt=before).exclude(status__in=Command.OPEN)
    needed = _needed_by_alerts()
    return (rows if needed is None else rows.exclude(needed)).order_by("ended_at", "pk")


def _needed_by_alerts() -> Q | None:
    """Return which commands an open alert is about, or would be ended by."""
    needed: Q | None = None
    for alert in registry.list_open_alerts(codes=ABOUT_COMMANDS):
        each = Q(device=alert.device_id, ended_at__gte=alert.first_at)
        needed = each if needed is None else needed | each
    return needed


def _with_news() -> Iterator[UUID]:
    """Yield the runs for which something waits that they have not taken in."""
    waiting = InboxEvent.objects.filter(taken_at=None, target__startswith=run_target(""))
    for target in waiting.values_list("target", flat=True).distinct():
        yield UUID(target.removeprefix(run_target("")))

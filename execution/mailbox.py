"""The inbox between runs and floors: events with an identity, taken in exactly once, and hints that there are some.

A hint is a Celery message. Twice is harmless, lost is found by the ticker's sweep.
"""

from __future__ import annotations

import logging
import os
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from typing import Any
from uuid import UUID

from celery import current_app
from django.db import transaction
from kombu.exceptions import OperationalError

from execution.models import InboxEvent

log = logging.getLogger(__name__)
ADVANCE_RUN = "execution.tasks.advance_run"
ADVANCE_SITE = "execution.tasks.advance_site"
REHEARSE = "execution.tasks.rehearse"


def run_target(run: UUID | str) -> str:
    """Return the inbox of a run."""
    return f"run:{run}"


def site_target(slug: str) -> str:
    """Return the inbox of a site's floor."""
    return f"site:{slug}"


def post(target: str, events: Iterable[tuple[str, Mapping[str, Any]]]) -> None:
    """Put events (key, payload) into an inbox, and hint after commit; one that is known already changes nothing."""
    now = datetime.now(UTC)
    rows = [InboxEvent(target=target, key=key, payload=dict(payload), created_at=now) for key, payload in events]
    if rows:
        InboxEvent.objects.bulk_create(rows, ignore_conflicts=True)
        hint(target)


def waiting(target: str) -> list[InboxEvent]:
    """Return the events that are not taken in, oldest first."""
    return list(InboxEvent.objects.filter(target=target, taken_at=None).order_by("id")[:500])


def mark_taken(events: Iterable[InboxEvent]) -> None:
    """Say that these events are taken in; they are kept a while, so that a repetition is known as one."""
    InboxEvent.objects.filter(id__in=[event.id for event in events]).update(taken_at=datetime.now(UTC))


def hint(target: str) -> None:
    """Wake a worker for a run or a floor once the transaction is through."""
    kind, _, name = target.partition(":")
    task = ADVANCE_RUN if kind == "run" else ADVANCE_SITE
    transaction.on_commit(lambda: send_hint(task, name))


def send_hint(task: str, name: str) -> None:
    """Send a task's message; when the broker is away the ticker finds the work later."""
    try:
        current_app.send_task(task, args=[name], retry=False)
    except (OperationalError, OSError) as error:
        log.warning("A hint to %s was not sent; the ticker will find the work: %s", task, error)


def crash_point(name: str) -> None:
    """Die here when the tests ask for it (`VIPO_CRASH_AT`), as a power cut would."""
    if os.environ.get("VIPO_CRASH_AT") == name:
        os._exit(137)

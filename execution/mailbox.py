"""The inbox between runs and floors: messages with an identity, taken in exactly once, and hints that there are some.

A hint is a Celery message. Twice is harmless, lost is found by the ticker's sweep.
"""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any, Generic, TypeVar
from uuid import UUID

from celery import current_app
from django.db import transaction
from kombu.exceptions import OperationalError

from execution.floor_protocol import ToFloor, ToRun, floor_message_from_json, run_message_from_json, to_json
from execution.models import FloorState, InboxEvent, Run
from vipo_device.kit.log_ids import bound_ids

log = logging.getLogger(__name__)
ADVANCE_RUN = "execution.tasks.advance_run"
ADVANCE_SITE = "execution.tasks.advance_site"
REHEARSE = "execution.tasks.rehearse"
REQUEST_HEADER = "vipo_request"
"""Where a task's message carries the id of the HTTP request that it comes from, for the log."""
MOST_AT_ONCE = 500
Message = TypeVar("Message", ToFloor, ToRun)


@dataclass(frozen=True, slots=True)
class Delivery(Generic[Message]):
    """A message that waits in an inbox: the number of its row, and since when it waits."""

    row: int
    posted_at: datetime
    message: Message


def run_target(run: UUID | str) -> str:
    """Return the inbox of a run."""
    return f"run:{run}"


def site_target(slug: str) -> str:
    """Return the inbox of a site's floor."""
    return f"site:{slug}"


def post_to_run(run: UUID | str, messages: Iterable[tuple[str, ToRun]]) -> None:
    """Put messages, each with its key, into a run's inbox, and hint; one that is known already changes nothing."""
    _post(run_target(run), [(key, to_json(message)) for key, message in messages])


def post_to_floor(site: str, messages: Iterable[tuple[str, ToFloor]]) -> None:
    """Put messages, each with its key, into the inbox of a site's floor, as `post_to_run` does."""
    _post(site_target(site), [(key, to_json(message)) for key, message in messages])


def _post(target: str, payloads: Iterable[tuple[str, dict[str, Any]]]) -> None:
    now = datetime.now(UTC)
    rows = [InboxEvent(target=target, key=key, payload=payload, created_at=now) for key, payload in payloads]
    if rows:
        InboxEvent.objects.bulk_create(rows, ignore_conflicts=True)
        hint(target)


def waiting_for_run(run: UUID | str) -> list[Delivery[ToRun]]:
    """Return what waits for a run, oldest first; raises UnreadableMessage."""
    return _waiting(run_target(run), run_message_from_json)


def waiting_for_floor(site: str) -> list[Delivery[ToFloor]]:
    """Return what waits for the floor of a site, oldest first; raises UnreadableMessage."""
    return _waiting(site_target(site), floor_message_from_json)


def _waiting(target: str, read: Callable[[Mapping[str, Any]], Message]) -> list[Delivery[Message]]:
    rows = InboxEvent.objects.filter(target=target, taken_at=None).order_by("id")[:MOST_AT_ONCE]
    return [Delivery(row.id, row.created_at, read(row.payload)) for row in rows]


def find_told(key: str) -> ToFloor | None:
    """Return what a floor was told under this key, also if it was taken in; None when that is forgotten."""
    row = InboxEvent.objects.filter(key=key).first()
    return None if row is None else floor_message_from_json(row.payload)


def mark_taken(deliveries: Iterable[Delivery[Message]]) -> None:
    """Say that these messages are taken in; they are kept a while, so that a repetition is known as one."""
    rows = [delivery.row for delivery in deliveries]
    InboxEvent.objects.filter(id__in=rows).update(taken_at=datetime.now(UTC))


def forget_taken(before: datetime) -> None:
    """Delete what was taken in before then; a repetition of it would not be known any more."""
    InboxEvent.objects.filter(taken_at__lt=before).delete()


def hint(target: str) -> None:
    """Wake a worker for a run or a floor once the transaction is through."""
    transaction.on_commit(lambda: _hint_now(target))


def _hint_now(target: str) -> None:
    kind, _, name = target.partition(":")
    send_hint(ADVANCE_RUN if kind == "run" else ADVANCE_SITE, name)


def hint_left(before: datetime) -> None:
    """Wake those whose messages wait since before then: a hint was lost, or a worker has died."""
    left = InboxEvent.objects.filter(taken_at=None, created_at__lt=before)
    for target in left.values_list("target", flat=True).distinct():
        _hint_now(target)


def hint_watching(site: str = "") -> None:
    """Let floors look that have something under way, and runs that wait for a reading: of one site, or everywhere."""
    there = {"site__slug": site} if site else {}
    for slug in FloorState.objects.filter(active=True, **there).values_list("site__slug", flat=True):
        send_hint(ADVANCE_SITE, slug)
    watching = Run.objects.filter(watches=True, status=Run.Status.RUNNING, **there)
    for run in watching.values_list("id", flat=True):
        send_hint(ADVANCE_RUN, str(run))


def send_hint(task: str, name: str) -> None:
    """Send a task's message; when the broker is away the ticker finds the work later."""
    try:
        request = bound_ids().get("request", "")
        current_app.send_task(task, args=[name], retry=False, headers={REQUEST_HEADER: request} if request else None)
    except (OperationalError, OSError) as error:
        log.warning("A hint to %s was not sent; the ticker will find the work: %s", task, error)


def crash_point(name: str) -> None:
    """Die here when the tests ask for it (`VIPO_CRASH_AT`), as a power cut would."""
    if os.environ.get("VIPO_CRASH_AT") == name:
        os._exit(137)

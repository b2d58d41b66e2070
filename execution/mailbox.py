"""The inbox between runs and floors: messages with an identity, taken in exactly once, and hints that there are some.

A hint wakes the site's owner, and now and then asks the workers for one by a Celery message. Twice is harmless, a lost
one is found by the ticker's sweep.
"""

from __future__ import annotations

import json
import logging
import time
from collections.abc import Iterable, Sequence
from datetime import datetime
from uuid import UUID

from celery import current_app
from django.db import connection, transaction
from kombu.exceptions import OperationalError

from execution import database
from execution.floor_protocol import ToFloor, ToRun, floor_message_from_json, to_json
from execution.models import FloorState, InboxEvent, Run
from registry import services as registry
from vipo_device.kit.log_ids import bound_ids

log = logging.getLogger(__name__)
DRIVE_SITE = "execution.tasks.drive_site"
REHEARSE = "execution.tasks.rehearse"
SEND_MAIL = "execution.tasks.send_mail"
REQUEST_HEADER = "vipo_request"
"""Where a task's message carries the id of the HTTP request that it comes from, for the log."""
ASK_AGAIN_S = 0.5
"""An owner stays for two seconds after its last work: whoever is asked for within half a second is still there."""
_PUT = "INSERT INTO execution_inboxevent (site, target, key, payload, created_at)"
_asked_at: dict[str, float] = {}


def run_target(run: UUID | str) -> str:
    """Return the inbox of a run."""
    return f"run:{run}"


def site_target(slug: str) -> str:
    """Return the inbox of a site's floor."""
    return f"site:{slug}"


def post_to_run(site: str, run: UUID | str, messages: Iterable[tuple[str, ToRun]]) -> None:
    """Put messages, each with its key, into the inbox of a site's run, and hint; a known one changes nothing."""
    post(site, [(run_target(run), key, message) for key, message in messages])


def post_to_floor(site: str, messages: Iterable[tuple[str, ToFloor]]) -> None:
    """Put messages, each with its key, into the inbox of a site's floor, as `post_to_run` does."""
    post(site, [(site_target(site), key, message) for key, message in messages])


def post(site: str, messages: Sequence[tuple[str, str, ToFloor | ToRun]]) -> None:
    """Put messages, each with its inbox and its key, into the inboxes of a site, and hint."""
    if messages:
        with transaction.atomic(savepoint=False), database.sent_together() as batch:
            put(batch, site, messages)
        hint(site)


def put(batch: database.Batch, site: str, messages: Iterable[tuple[str, str, ToFloor | ToRun]]) -> None:
    """Put messages into the inboxes of a site together with other statements; `hint` is left to whoever does it."""
    now = connection.ops.adapt_datetimefield_value(database.now())
    rows = [(site, target, key, json.dumps(to_json(message)), now) for target, key, message in messages]
    batch.insert(_PUT, rows, "ON CONFLICT DO NOTHING")


def find_told(key: str) -> ToFloor | None:
    """Return what a floor was told under this key, also if it was taken in; None when that is forgotten."""
    row = InboxEvent.objects.filter(key=key).first()
    return None if row is None else floor_message_from_json(row.payload)


def forget_taken(before: datetime) -> None:
    """Delete what was taken in before then; a repetition of it would not be known any more."""
    InboxEvent.objects.filter(taken_at__lt=before).delete()


def hint(site: str) -> None:
    """Wake whoever carries out the runs of a site, or a worker that will, once the transaction is through."""
    transaction.on_commit(lambda: hint_now(site))


def hint_now(site: str) -> None:
    """Wake the owner of a site at once; a worker is asked for one only so often, since an owner stays a while."""
    registry.wake(site_target(site))
    now = time.monotonic()
    if now - _asked_at.get(site, -ASK_AGAIN_S) >= ASK_AGAIN_S:
        _asked_at[site] = now
        send_hint(DRIVE_SITE, site)


def hint_left(before: datetime) -> None:
    """Wake the owners of sites where something has waited since before then: a hint was lost, or a worker has died."""
    left = InboxEvent.objects.filter(taken_at=None, created_at__lt=before)
    for site in left.values_list("site", flat=True).distinct():
        if site:
            hint_now(site)
        else:
            _find_sites()


def _find_sites() -> None:
    """Say whose the messages are that a process of the version before has posted since the update."""
    unowned = InboxEvent.objects.filter(taken_at=None, site="")
    for target in unowned.values_list("target", flat=True).distinct():
        kind, _, name = target.partition(":")
        found = Run.objects.filter(id=name).values_list("site__slug", flat=True).first() if kind == "run" else name
        mine = unowned.filter(target=target)
        mine.update(site=found) if found else mine.update(taken_at=database.now())


def hint_watching() -> None:
    """Let those sites be looked at that have something under way, or runs that wait for a reading."""
    floors = FloorState.objects.filter(active=True).values_list("site__slug", flat=True)
    runs = Run.objects.filter(watches=True, status=Run.Status.RUNNING).values_list("site__slug", flat=True)
    for slug in {*floors, *runs.distinct()}:
        hint_now(slug)


def say_changed(site: str) -> None:
    """Tell the owner of a site, if it has one, that its devices say something new of themselves."""
    registry.wake(look_channel(site))
    registry.wake(site_target(site))


def look_channel(site: str) -> str:
    """Return where an owner hears that there is something to look at."""
    return f"look:{site}"


def send_hint(task: str, name: str) -> None:
    """Send a task's message; when the broker is away the ticker finds the work later."""
    try:
        request = bound_ids().get("request", "")
        current_app.send_task(task, args=[name], retry=False, headers={REQUEST_HEADER: request} if request else None)
    except (OperationalError, OSError) as error:
        log.warning("A hint to %s was not sent; the ticker will find the work: %s", task, error)

"""A message that the database does not take what comes of: set aside by itself, past runs and floor."""

from __future__ import annotations

from datetime import datetime

from django.db import transaction

from execution import database, mailbox
from execution.engine import lease as leases
from execution.engine.dead_letter_capture import pause_by_hand, pause_for, words_of
from execution.engine.inbox import Row, mark_taken
from execution.engine.lease import Lease
from execution.models import DeadLetter, Run, RunEvent


def set_row_aside(row: Row, lease: Lease, now: datetime, error: Exception) -> None:
    """Set one message aside and pause its run, in a transaction of its own; raises LeaseLost.

    The run's row alone keeps it paused whatever it is told next: its machine follows the row before it hears anything.
    Where nobody tells it anything its robots would drive on, so a pause is posted for its machine and the floor to
    take in at once. None follows a pause that was set aside, since it might be set aside like that, and so for ever.
    """
    kind, _, name = row.target.partition(":")
    words = words_of(error).replace("\x00", "")
    event = row.payload if isinstance(row.payload, dict) else {"type": "unreadable"}
    with transaction.atomic():
        leases.hold(lease)
        run = Run.objects.select_related("site").filter(id=name).first() if kind == "run" else None
        DeadLetter.objects.create(site_id=lease.site, run=run, target=row.target, event=event, error=words, at=now)
        journal = pause_by_hand(run, words, now) if run is not None and run.status in Run.OPEN else None
        if run is not None and journal is not None:
            RunEvent.objects.bulk_create(journal.close())
            run.save(update_fields=["status", "reason", "next_seq", "steps", "roles"])
            if event.get("type") != "pause":
                mailbox.post_to_run(run.site.slug, run.id, [(f"aside:{row.id}", pause_for(words))])
        with database.sent_together() as batch:
            mark_taken(batch, [row.id], now)

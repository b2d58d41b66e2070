"""Devices that know only a done flag, as in the VIPO paper: what comes of a command is read from its edges.

A command is at work once `done` was false after it had been sent, and done once it is true again after that; what
never shows these edges is given up by its time limit. A device that answers as docs/protocol.md says is judged by its
answers alone.
"""

from __future__ import annotations

from datetime import datetime, timedelta

from django.db import transaction
from django.db.models import Q

from execution.commands.claim import CONTROLS, NEVER_AGAIN_S
from execution.commands.outbox import record_ack
from execution.models import Command

NEVER_AGAIN = timedelta(seconds=NEVER_AGAIN_S)
AT_WORK = "Seen at work by its done flag."


def record_done_flag(*, device: str, done: bool, at: datetime) -> bool:
    """Take in what a device's done flag is at `at`; tell whether a command went on by it."""
    rows = Command.objects.filter(device=device).exclude(method__in=CONTROLS).order_by("position")
    if done:
        row = rows.filter(status=Command.Status.RUNNING, why=AT_WORK).first()
    else:
        # One that is just going out is not marked as sent yet; the device may be faster.
        going_out = Q(status=Command.Status.PENDING, tries__gt=0)
        row = rows.filter(going_out | Q(status=Command.Status.SENT, sent_at__lte=at)).first()
    if row is None:
        return False
    status, why = ("DONE", "") if done else ("RUNNING", AT_WORK)
    with transaction.atomic():
        is_news = record_ack(device=device, command_id=str(row.id), status=status, why=why, result={}, at=at)
        Command.objects.filter(id=row.id).update(send_after=at + NEVER_AGAIN)
    return is_news

"""The outbox: commands are sent until they are answered, with the same id each time; answers come back here.

A device that answers as docs/protocol.md says is judged by its answers alone, one that knows only a done flag by that.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping
from datetime import datetime, timedelta
from uuid import UUID

from django.db import transaction
from django.db.models import Q

from execution import database, mailbox
from execution.commands.claim import LAST_RETRY_S, NEVER_AGAIN_S, UNANSWERED
from execution.floor_protocol import CommandEnded, ToFloor, ToRun
from execution.models import Command
from execution.reasons import SENTENCES
from execution.traffic.messages import CONTROLS, CommandAnswered
from registry import services as registry
from vipo_device.kit.log_ids import LogId, bind_ids
from vipo_device.protocol.description import Scalar

log = logging.getLogger(__name__)
CONTROL_LIMIT_S = 60.0
STATUS = {
    "ACCEPTED": Command.Status.ACCEPTED,
    "RUNNING": Command.Status.RUNNING,
    "DONE": Command.Status.DONE,
    "FAILED": Command.Status.FAILED,
    "REJECTED": Command.Status.REJECTED,
    "CANCELED": Command.Status.CANCELLED,
}
OUT = SENTENCES["no_device"]
AT_WORK = "Seen at work by its done flag."
FINAL = frozenset({"DONE", "FAILED", "REJECTED", "CANCELED"})


def resend_commands(*, device: str) -> int:
    """Let all open commands of a device that has come in be sent at once and in their order; return how many.

    It may have been started anew and know none of them; one that it knows it only answers again.
    """
    open_rows = Command.objects.filter(device=device, status__in=Command.OPEN)
    return open_rows.update(send_after=database.now())


def record_ack(
    *, device: str, command_id: str, status: str, why: str, result: Mapping[str, Scalar], at: datetime
) -> bool:
    """Take in a device's answer; False if it is late, repeated, unknown, or about another device's command."""
    number = _uuid(command_id)
    if number is None or status not in STATUS:
        return False
    with transaction.atomic():
        row = Command.objects.select_for_update(of=("self",)).select_related("site").filter(id=number).first()
        if row is None or row.device != device or row.status not in Command.OPEN:
            return False
        if row.piece and row.status in UNANSWERED:
            transaction.on_commit(lambda: registry.wake("gateway"))
        row.status, row.why = STATUS[status], why[:500]
        row.sent_at = row.sent_at or at
        if status in FINAL:
            row.ended_at, row.result = at, dict(result)
        else:
            row.send_after = at + timedelta(seconds=LAST_RETRY_S)
        row.save(update_fields=["status", "why", "sent_at", "ended_at", "send_after", "result"])
        _note_answer(row)
        if status == "DONE" and row.piece:
            _close_pieces_before(row, at)
        if status in FINAL and row.method not in CONTROLS:
            _pass_on(row, status, why, result)
    return True


def _note_answer(row: Command) -> None:
    registry.count(name="command_answers", labels=(row.status,))
    if row.status in (Command.Status.FAILED, Command.Status.REJECTED):
        ids: dict[LogId, object] = {"site": row.site.slug, "run": row.run, "step": row.step, "command": row.id}
        with bind_ids(ids | {"device": row.device}):
            log.info("%s did not do %s (%s): %s", row.device, row.method, row.status, row.why or "it says no more")


def record_done_flag(*, device: str, done: bool, at: datetime) -> bool:
    """Take in what the done flag of a device is that knows nothing else, as in the VIPO paper; tell if that was news.

    A command is at work once `done` was false after it had been sent, and done once it is true again after that; what
    never shows these edges is given up by its time limit.
    """
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
        Command.objects.filter(id=row.id).update(send_after=at + timedelta(seconds=NEVER_AGAIN_S))
    return is_news


def _close_pieces_before(row: Command, at: datetime) -> None:
    """A robot drives its pieces in order: who has reached the end of one is past those before it, heard or not."""
    earlier = Command.objects.select_for_update(of=("self",)).select_related("site").filter(
        device=row.device, site=row.site, piece=True, position__lt=row.position, status__in=Command.OPEN
    )  # fmt: skip
    for piece in earlier.order_by("position"):
        piece.status, piece.ended_at = Command.Status.DONE, at
        piece.save(update_fields=["status", "ended_at"])
        _pass_on(piece, "DONE", "", {})


def _pass_on(row: Command, status: str, why: str, result: Mapping[str, Scalar]) -> None:
    """Tell the floor, and the run for its journal."""
    answer = CommandAnswered(str(row.id), status, why, result)
    told: list[tuple[str, str, ToFloor | ToRun]] = [(mailbox.site_target(row.site.slug), f"answer:{row.id}", answer)]
    if row.run is not None and not row.piece:
        ended = CommandEnded(row.device, row.method, row.step, status, why)
        told.insert(0, (mailbox.run_target(row.run), f"note:{row.id}", ended))
    mailbox.post(row.site.slug, told)


def end_commands_of_those_out(now: datetime) -> None:
    """End what devices were told that do not take part any more: another one may come in by such an id."""
    waiting = Command.objects.filter(status__in=Command.OPEN)
    out = registry.find_out(devices=set(waiting.values_list("device", flat=True)))
    for number in list(waiting.filter(device__in=out).order_by("position").values_list("id", flat=True)) if out else ():
        with transaction.atomic():
            row = waiting.select_for_update(of=("self",)).select_related("site").filter(id=number).first()
            if row is not None:
                _end(row, OUT.format(device=row.device), now)


def _end(row: Command, why: str, now: datetime) -> None:
    row.status, row.why, row.ended_at = Command.Status.FAILED, why, now
    row.save(update_fields=["status", "why", "ended_at"])
    if row.method not in CONTROLS:
        _pass_on(row, "FAILED", why, {})


def _uuid(text: str) -> UUID | None:
    try:
        return UUID(text)
    except ValueError:
        return None


def drop_stale_controls(now: datetime) -> None:
    """Give up on pause, resume and cancel commands that no device answers."""
    before = now - timedelta(seconds=CONTROL_LIMIT_S)
    stale = Command.objects.filter(status__in=Command.OPEN, method__in=CONTROLS, created_at__lt=before)
    stale.update(status=Command.Status.TIMED_OUT, ended_at=now)

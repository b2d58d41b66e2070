"""The outbox: commands are sent until they are answered, with the same id each time; answers come back here."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any
from uuid import UUID

from django.db import transaction
from django.db.models import Exists, OuterRef, Q, QuerySet, Subquery

from execution import inbox
from execution.models import Command
from registry import live, wire
from registry.capability import Scalar

FIRST_RETRY_S = 2.0
LAST_RETRY_S = 15.0
CONTROL_LIMIT_S = 60.0
CONTROLS = ("pause", "resume", "cancel")
STATUS = {
    "ACCEPTED": Command.Status.ACCEPTED,
    "RUNNING": Command.Status.RUNNING,
    "DONE": Command.Status.DONE,
    "FAILED": Command.Status.FAILED,
    "REJECTED": Command.Status.REJECTED,
    "CANCELED": Command.Status.CANCELLED,
}
UNANSWERED = (Command.Status.PENDING, Command.Status.SENT)
FINAL = frozenset({"DONE", "FAILED", "REJECTED", "CANCELED"})
WINDOW = 12
"""A device remembers its last 16 commands: nobody runs so far ahead of an open one that it would do that one again."""


@dataclass(frozen=True, slots=True)
class OutgoingCommand:
    """A command as it goes out over MQTT."""

    id: str
    device: str
    topic: str
    payload: bytes
    ttl_s: float


def claim_commands(*, limit: int) -> tuple[OutgoingCommand, ...]:
    """Return commands that are due to be sent, in their order; nobody else is given them for a while.

    One whose sending is not confirmed by `mark_commands_sent`, or that no device answers, is given out again. While a
    site is stopped only pause, resume and cancel go out. A piece of way waits until the robot has accepted the piece
    before it: with a gateway that died in between, it would otherwise cut the corner through a wall. Nothing new goes
    out while a command that is `WINDOW` older is open: asked again, the device might have forgotten it.
    """
    now = datetime.now(UTC)
    before = Command.objects.filter(
        device=OuterRef("device"),
        site_id=OuterRef("site_id"),
        piece=True,
        position__lt=OuterRef("position"),
        status__in=UNANSWERED,
    )
    with transaction.atomic():
        due = Command.objects.filter(status__in=Command.OPEN, send_after__lte=now)
        due = due.exclude(Exists(before), piece=True).annotate(horizon=Subquery(_horizon()))
        due = due.exclude(Exists(_far_behind()) & Q(tries=0) & ~Q(method__in=CONTROLS))
        held_back = due.filter(site__stop_latch__active=True).exclude(method__in=CONTROLS)
        rows = due.exclude(id__in=held_back.values("id")).order_by("site_id", "position")
        claimed = list(rows.select_for_update(skip_locked=True, of=("self",))[:limit])
        for row in claimed:
            under_way = row.status in {Command.Status.ACCEPTED, Command.Status.RUNNING}
            wait_s = LAST_RETRY_S if under_way else min(LAST_RETRY_S, FIRST_RETRY_S * 2**row.tries)
            row.tries += 1
            row.send_after = now + timedelta(seconds=wait_s)
        Command.objects.bulk_update(claimed, ["tries", "send_after"])
    return tuple(_outgoing(row) for row in claimed)


def _horizon() -> QuerySet[Command, Any]:
    """Return the position of the command that lies `WINDOW` commands of the same device back."""
    older = Command.objects.filter(
        device=OuterRef("device"), site_id=OuterRef("site_id"), position__lt=OuterRef("position")
    )
    return older.order_by("-position").values("position")[WINDOW - 1 : WINDOW]


def _far_behind() -> QuerySet[Command]:
    """Return the open commands of the same device that lie beyond the horizon."""
    return Command.objects.filter(
        device=OuterRef("device"),
        site_id=OuterRef("site_id"),
        position__lte=OuterRef("horizon"),
        status__in=Command.OPEN,
    )


def _outgoing(row: Command) -> OutgoingCommand:
    payload = wire.command_payload(str(row.id), row.arguments, row.ttl_s)
    return OutgoingCommand(str(row.id), row.device, wire.down_topic(row.device, row.method), payload, row.ttl_s)


def mark_commands_sent(*, ids: Iterable[str]) -> None:
    """Say that these commands have gone out."""
    sent = Command.objects.filter(id__in=list(ids), status=Command.Status.PENDING)
    sent.update(status=Command.Status.SENT, sent_at=datetime.now(UTC))


def resend_commands(*, device: str) -> int:
    """Let all open commands of a device that has come in be sent at once and in their order; return how many.

    It may have been started anew and know none of them; one that it knows it only answers again.
    """
    open_rows = Command.objects.filter(device=device, status__in=Command.OPEN)
    return open_rows.update(send_after=datetime.now(UTC))


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
            transaction.on_commit(lambda: live.wake("gateway"))
        row.status, row.why = STATUS[status], why[:500]
        row.sent_at = row.sent_at or at
        if status in FINAL:
            row.ended_at, row.result = at, dict(result)
        else:
            row.send_after = at + timedelta(seconds=LAST_RETRY_S)
        row.save(update_fields=["status", "why", "sent_at", "ended_at", "send_after", "result"])
        if status == "DONE" and row.piece:
            _close_pieces_before(row, at)
        if status in FINAL and row.method not in CONTROLS:
            _pass_on(row, status, why, result)
    return True


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
    answer = {"type": "answered", "command": str(row.id), "status": status, "why": why, "result": dict(result)}
    if row.run is not None and not row.piece:
        note = {"type": "answer", "device": row.device, "method": row.method, "step": row.step, "status": status,
                "why": why}  # fmt: skip
        inbox.post(inbox.run_target(row.run), [(f"note:{row.id}", note)])
    inbox.post(inbox.site_target(row.site.slug), [(f"answer:{row.id}", answer)])


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

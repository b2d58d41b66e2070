"""What a device says right behind its answer: a run that reads the device waits for it a moment before it goes on."""

from __future__ import annotations

from datetime import datetime, timedelta

from execution import mailbox
from execution.floor_protocol import TaskEnded, ToRun
from execution.machine.floor_task import TaskOrder
from execution.machine.needs import Needs
from execution.mailbox import Delivery
from execution.models import Command, Run, Timer
from execution.traffic.messages import TaskAsked
from registry import services as registry

AT_MOST = timedelta(milliseconds=300)
WAKE_NUMBERS_FROM = 1_000_000_000
"""Timers that only wake a run have numbers that no run gives to its own."""


def asking_key(task: int) -> str:
    """Return under which key, behind its own id, a run asks for a task of the floor."""
    return f"ask:{task}"


def split_early(
    run: Run, needs: Needs, deliveries: list[Delivery[ToRun]], now: datetime
) -> tuple[list[Delivery[ToRun]], list[Delivery[ToRun]]]:
    """Return what to take in now, and the ends of tasks whose device has not spoken since."""
    early = [delivery for delivery in deliveries if _is_early(run, needs, delivery, now)]
    return [delivery for delivery in deliveries if delivery not in early], early


def wake_later(run: Run, now: datetime) -> None:
    """See to it that a run looks again when it has waited long enough."""
    number = WAKE_NUMBERS_FROM + run.epoch
    Timer.objects.get_or_create(run=run, timer=number, defaults={"due_at": now + AT_MOST})


def _is_early(run: Run, needs: Needs, delivery: Delivery[ToRun], now: datetime) -> bool:
    message = delivery.message
    if not needs.properties or now - delivery.posted_at >= AT_MOST:
        return False
    if not isinstance(message, TaskEnded) or message.kind:
        return False
    asked = mailbox.find_told(f"{run.id}:{asking_key(message.task)}")
    return isinstance(asked, TaskAsked) and _has_not_spoken(run, needs, asked.order)


def _has_not_spoken(run: Run, needs: Needs, order: TaskOrder) -> bool:
    done = Command.objects.filter(run=run.id, step=order.step, piece=False, ended_at__isnull=False)
    command = done.order_by("-ended_at").first()
    if command is None or command.ended_at is None or order.kind == "move":
        return False
    concerned = {command.device, order.target.id}
    said = registry.get_readings(site=run.site.slug, ids=concerned).values()
    return any(needs.properties & set(one.values) and not _is_fresh(one, command) for one in said)


def _is_fresh(device: registry.ReadingsView, command: Command) -> bool:
    """Tell whether a device has said how it is since it was done: idle and after it was asked, or after its answer."""
    seen = device.last_seen_at
    if seen is None or command.ended_at is None:
        return False
    since_asked = command.sent_at is not None and seen >= command.sent_at
    return seen > command.ended_at or (device.done and since_asked)

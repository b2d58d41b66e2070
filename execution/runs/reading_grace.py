"""What a device says right behind its answer: a run that reads the device waits for it a moment before it goes on."""

from __future__ import annotations

from datetime import datetime, timedelta
from uuid import UUID

from execution import mailbox
from execution.floor_protocol import TaskEnded, ToRun
from execution.machine.floor_task import TaskOrder
from execution.machine.needs import Needs
from execution.models import Command, Run
from execution.traffic.messages import TaskAsked
from registry import services as registry

AT_MOST = timedelta(milliseconds=300)


def asking_key(run: UUID | str, task: int) -> str:
    """Return under which key runs of the version before have asked for a task of the floor."""
    return f"{run}:ask:{task}"


def is_early(
    run: Run, needs: Needs, message: ToRun, order: TaskOrder | None, waits_since: datetime, now: datetime
) -> bool:
    """Tell whether a message is the end of a task whose device has not spoken since; `order` None: not known."""
    if not needs.properties or now - waits_since >= AT_MOST:
        return False
    if not isinstance(message, TaskEnded) or message.kind:
        return False
    if order is None:
        asked = mailbox.find_told(asking_key(run.id, message.task))
        order = asked.order if isinstance(asked, TaskAsked) else None
    return order is None or _has_not_spoken(run, needs, order)


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

"""What a device says right behind its answer: a run that reads the device waits for it a moment before it goes on."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime, timedelta
from typing import Any

from execution.machine.needs import Needs
from execution.models import Command, InboxEvent, Run, Timer
from registry import services as registry

AT_MOST = timedelta(milliseconds=300)
WAKE_NUMBERS_FROM = 1_000_000_000
"""Timers that only wake a run have numbers that no run gives to its own."""


def split_early(
    run: Run, needs: Needs, events: list[InboxEvent], now: datetime
) -> tuple[list[InboxEvent], list[InboxEvent]]:
    """Return the events to take in now, and the answers whose device has not spoken since."""
    early = [event for event in events if _is_early(run, needs, event, now)]
    return [event for event in events if event not in early], early


def wake_later(run: Run, now: datetime) -> None:
    """See to it that a run looks again when it has waited long enough."""
    number = WAKE_NUMBERS_FROM + run.epoch
    Timer.objects.get_or_create(run=run, timer=number, defaults={"due_at": now + AT_MOST})


def _is_early(run: Run, needs: Needs, event: InboxEvent, now: datetime) -> bool:
    data = event.payload
    if not needs.properties or data["type"] != "mission_over" or data["kind"] or now - event.created_at >= AT_MOST:
        return False
    asked = InboxEvent.objects.filter(key=f"{run.id}:ask:{data['mission']}").first()
    return asked is not None and _has_not_spoken(run, needs, asked.payload["order"])


def _has_not_spoken(run: Run, needs: Needs, order: Mapping[str, Any]) -> bool:
    done = Command.objects.filter(run=run.id, step=order["step"], piece=False, ended_at__isnull=False)
    command = done.order_by("-ended_at").first()
    if command is None or command.ended_at is None or order["kind"] == "move":
        return False
    concerned = {command.device, order["target"]["id"]}
    said = registry.get_readings(site=run.site.slug, ids=concerned).values()
    return any(needs.properties & set(one.values) and not _is_fresh(one, command) for one in said)


def _is_fresh(device: registry.ReadingsView, command: Command) -> bool:
    """Tell whether a device has said how it is since it was done: idle and after it was asked, or after its answer."""
    seen = device.last_seen_at
    if seen is None or command.ended_at is None:
        return False
    since_asked = command.sent_at is not None and seen >= command.sent_at
    return seen > command.ended_at or (device.done and since_asked)

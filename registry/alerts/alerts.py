"""Alerts: what about a device people should know and deal with, until it is over.

At most one alert of a code is open at a device. Raised again it is counted up; raised again soon after it was over it
is the same one. Every function may run at the same time as itself in another process; of two that raise the same for
the first time at the same moment one is counted.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Any, cast

from django.db import transaction
from django.db.models import Q

from registry.alerts.causes import CAUSES, AlertCode
from registry.alerts.views import publish_alerts
from registry.models import Device, DeviceAlert

SAME_WITHIN = timedelta(minutes=5)


@dataclass(frozen=True, slots=True)
class Raised:
    """Something that gives cause for an alert, `count` times by `at`; `args` are what its words are made of."""

    device_id: str
    code: AlertCode
    at: datetime
    args: Mapping[str, Any] = field(default_factory=dict)
    count: int = 1


def raise_alert(
    *, device_id: str, code: AlertCode, at: datetime, args: Mapping[str, Any] | None = None, count: int = 1
) -> None:
    """Raise one alert; nothing happens for a device that is unknown or was taken out."""
    raise_alerts(raised=[Raised(device_id, code, at, args or {}, count)])


def raise_alerts(*, raised: Sequence[Raised]) -> None:
    """Raise alerts, at most one of a code at each device; what is not newer than the last time is known already."""
    if not raised:
        return
    with transaction.atomic():
        present = Device.objects.filter(pk__in={r.device_id for r in raised}).exclude(lifecycle="retired")
        here = set(present.values_list("pk", flat=True))
        wanted = {(r.device_id, r.code): r for r in raised if r.device_id in here}
        known = _lock_known(wanted)
        changed = [row.pk for key, row in known.items() if _raise_again(row, wanted[key])]
        publish_alerts(changed + _insert([r for key, r in wanted.items() if key not in known]))


def _lock_known(wanted: Mapping[tuple[str, AlertCode], Raised]) -> dict[tuple[str, AlertCode], DeviceAlert]:
    """Return the alerts that are open, or were over only just, by device and code."""
    if not wanted:
        return {}
    lately = min(r.at for r in wanted.values()) - SAME_WITHIN
    rows = DeviceAlert.objects.select_for_update().filter(Q(over_at=None) | Q(over_at__gt=lately))
    rows = rows.filter(device__in={d for d, _ in wanted}, code__in={c for _, c in wanted})
    found = {(row.device_id, cast(AlertCode, row.code)): row for row in rows.order_by("pk")}
    return {key: row for key, row in found.items() if key in wanted}


def _raise_again(row: DeviceAlert, raised: Raised) -> bool:
    if row.last_at >= raised.at:
        return False
    row.count += raised.count
    row.last_at, row.args, row.over_at = raised.at, dict(raised.args), None
    if row.seen_at and raised.at - row.seen_at >= CAUSES[raised.code].anew:
        row.seen_at = row.seen_by = None
    row.save(update_fields=["count", "last_at", "args", "over_at", "seen_at", "seen_by"])
    return True


def _insert(new: Sequence[Raised]) -> list[int]:
    if not new:
        return []
    rows = [
        DeviceAlert(device_id=r.device_id, code=r.code, args=dict(r.args), count=r.count, first_at=r.at, last_at=r.at)
        for r in new
    ]
    DeviceAlert.objects.bulk_create(rows, ignore_conflicts=True, batch_size=200)
    there = DeviceAlert.objects.filter(over_at=None, device__in={r.device_id for r in new})
    return list(
        there.filter(code__in={r.code for r in new}, first_at__gte=min(r.at for r in new)).values_list("pk", flat=True)
    )


def reword_alert(*, alert_id: int, args: Mapping[str, Any], at: datetime) -> None:
    """Say an open alert in other words; it is not counted as raised again."""
    with transaction.atomic():
        if DeviceAlert.objects.filter(pk=alert_id, over_at=None).update(args=dict(args), last_at=at):
            publish_alerts([alert_id])


def end_alert(*, device_id: str, code: AlertCode, at: datetime) -> None:
    """Say that the cause of an alert has ended; nothing happens when none is open."""
    found = DeviceAlert.objects.filter(device=device_id, code=code, over_at=None)
    end_alerts(ids=list(found.values_list("pk", flat=True)), at=at)


def end_alerts_before(*, times: Mapping[tuple[str, AlertCode], datetime], at: datetime) -> None:
    """Say that the causes of alerts, by device and code, had ended by a time; one that was raised later stays open."""
    rows = DeviceAlert.objects.filter(code__in={code for _, code in times}, over_at=None)
    found = rows.values_list("pk", "device_id", "code", "last_at")
    ended = [(pk, times.get((device, cast(AlertCode, code))), last_at) for pk, device, code, last_at in found]
    end_alerts(ids=[pk for pk, by, last_at in ended if by is not None and last_at <= by], at=at)


def end_alerts(*, ids: Collection[int], at: datetime) -> None:
    """Say that the causes of these alerts have ended."""
    if not ids:
        return
    with transaction.atomic():
        open_rows = DeviceAlert.objects.select_for_update().filter(pk__in=ids, over_at=None)
        still_open = list(open_rows.order_by("pk").values_list("pk", flat=True))
        DeviceAlert.objects.filter(pk__in=still_open).update(over_at=at)
        publish_alerts(still_open)

"""Reading what properties were: a series of at most so many points."""

from __future__ import annotations

import json
from dataclasses import dataclass
from datetime import UTC, datetime

from registry.devices.queries import get_device
from registry.devices.rows import BadDevice
from registry.devices.samples import KEPT_FOR
from registry.models import Sample
from vipo_device.protocol.description import Scalar

MOST_POINTS = 500


@dataclass(frozen=True, slots=True)
class PointView:
    """A property over one or more minutes from `at` on: its least, greatest and last value."""

    at: datetime
    minimum: float | None
    maximum: float | None
    value: Scalar


@dataclass(frozen=True, slots=True)
class SeriesView:
    """What a property was, oldest first; each point stands for `bucket_s` seconds in which it changed."""

    property: str
    unit: str
    since: datetime
    bucket_s: int
    points: tuple[PointView, ...]


def read_history(
    *, site: str, device_id: str, name: str, since: datetime | None, now: datetime, most: int = MOST_POINTS
) -> SeriesView:
    """Return what a property was since then, and the last value before. Raises NoSuchDevice, BadDevice."""
    device = get_device(site=site, device_id=device_id)
    spec = device.canonical.property(name)
    if spec is None:
        known = ", ".join(p.name for p in device.canonical.properties) or "none"
        raise BadDevice(f"{device.name} has no property {name[:64]!r}. It has: {known}.")
    begin = max(since or now - KEPT_FOR, now - KEPT_FOR)
    first, last = _minute(begin), _minute(now)
    width = max(1, -(-(last - first + 1) // max(1, min(most, MOST_POINTS))))
    rows = Sample.objects.filter(device=device_id, property=name)
    before = rows.filter(minute__lt=first).order_by("-minute")[:1]
    kept = [*before, *rows.filter(minute__gte=first, minute__lte=last).order_by("minute")]
    return SeriesView(name, spec.unit, begin, width * 60, _points(kept, first, width))


def _minute(at: datetime) -> int:
    return int(at.timestamp() // 60)


def _points(rows: list[Sample], first: int, width: int) -> tuple[PointView, ...]:
    """Join the rows of each `width` minutes."""
    groups: dict[int, list[Sample]] = {}
    for row in rows:
        groups.setdefault((row.minute - first) // width, []).append(row)
    return tuple(_point(group) for group in groups.values())


def _point(group: list[Sample]) -> PointView:
    least = [row.minimum for row in group if row.minimum is not None]
    greatest = [row.maximum for row in group if row.maximum is not None]
    at = datetime.fromtimestamp(group[-1].at_ms / 1000, UTC)
    return PointView(at, min(least, default=None), max(greatest, default=None), json.loads(group[-1].value))

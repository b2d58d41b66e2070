"""How devices were when an observation was made, from the readings that are kept."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import replace
from datetime import UTC, datetime

from django.db import connection

from registry.capability import Scalar
from registry.models import Sample
from registry.mtconnect import Observation, Situation
from registry.mtconnect_items import items_of
from registry.samples import DONE, ONLINE
from registry.views import DeviceView

AT_ONCE = 100
_ONE = (
    "SELECT * FROM (SELECT device_id, property, value, at_ms, seq FROM registry_sample "
    "WHERE device_id = %s AND property = %s AND seq <= %s AND minute <= %s ORDER BY minute DESC LIMIT 1) AS last"
)


def look_back(devices: Sequence[DeviceView], sequence: int) -> Situation:
    """Return how devices were at a sequence number; a reading of which nothing is kept until then has no value."""
    row = Sample.objects.filter(seq__lte=sequence).order_by("-seq").first()
    minute, at_ms = (row.minute, row.at_ms) if row else (0, 0)
    names = [(view.id, item.source) for view in devices for item in items_of(view) if item.source]
    seen = tuple(_last_rows(names, sequence, minute + 1))
    readings: dict[str, dict[str, Scalar]] = {view.id: {} for view in devices}
    for o in seen:
        readings[o.device][o.property] = json.loads(o.value)
    at = datetime.fromtimestamp(at_ms / 1000, UTC)
    return Situation(tuple(_as_it_was(view, readings[view.id], at) for view in devices), seen, placed=False)


def _as_it_was(view: DeviceView, told: dict[str, Scalar], at: datetime) -> DeviceView:
    online, done = told.pop(ONLINE, False), told.pop(DONE, True)
    return replace(view, online=bool(online), done=bool(done), readings=told, last_seen_at=at)


def _last_rows(names: Sequence[tuple[str, str]], sequence: int, minute: int) -> Iterator[Observation]:
    """Give the last observation of each reading; the index that each row is found by stands in the constraint."""
    with connection.cursor() as cursor:
        for begin in range(0, len(names), AT_ONCE):
            part = names[begin : begin + AT_ONCE]
            asked = [value for device, name in part for value in (device, name, sequence, minute)]
            cursor.execute(" UNION ALL ".join([_ONE] * len(part)), asked)
            for device, name, value, at_ms, seq in cursor.fetchall():
                yield Observation(device, name, value, at_ms, seq)

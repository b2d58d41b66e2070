"""What is told at the broker of a site's Things: each on topics of its own, and only what the registry takes for true.

So whoever hears these topics hears nothing that a device merely says: no command, no answer, nothing of a device that
waits for approval or belongs elsewhere.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from datetime import datetime

from registry.devices.views import DeviceView, view_of
from registry.models import Device
from registry.people.tokens import list_readers
from registry.thing_directory.property_values import read_values
from vipo_device.protocol.topics import property_topic, things_prefix


def list_heard_sites(*, now: datetime) -> frozenset[str]:
    """Return the sites of which a token may hear at the broker."""
    return frozenset(reader.site for reader in list_readers(now=now))


def read_told(*, site: str, ids: Collection[str] | None = None) -> dict[str, Mapping[str, bytes]]:
    """Return what is told of these devices (None: all) that are approved at a site: by id, each topic's message."""
    rows = Device.objects.filter(site__slug=site, lifecycle=Device.Lifecycle.APPROVED, description__isnull=False).defer(
        "source"
    )
    chosen = rows if ids is None else rows.filter(pk__in=ids)
    return {row.pk: _told_of(view_of(row, site)) for row in chosen}


def _told_of(view: DeviceView) -> dict[str, bytes]:
    pose = view.pose
    values = {property_topic(view.site, view.id, name): value for name, value in read_values(view).items()}
    below = f"{things_prefix(view.site)}{view.id}"
    said = {f"{below}/status": view.status, f"{below}/location": [pose.x, pose.y, pose.z, pose.theta], **values}
    return {topic: json.dumps(value, ensure_ascii=False).encode() for topic, value in said.items()}

"""What of a site tests are carried out on, named by digests, and what of it has changed since."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from hashlib import sha256
from typing import Any

from editor import services as editor
from execution.mirror.calibrations import find_paces
from registry import services as registry
from vipo_device.protocol.description import description_to_json

Digests = Mapping[str, Any]
MOST_NAMED = 10


def digests_of(site: str) -> dict[str, Any]:
    """Return which map a site has and the digests of its places, its zones and of each approved device.

    They are of what a test is carried out on: what devices show and where they stand at the moment is not in them.
    """
    devices, paces = registry.list_devices(site=site, lifecycle="approved"), find_paces(site=site)
    plan = registry.get_map(site=site)
    return {
        "map": plan.version,
        "map_tag": plan.tag,
        "places": _digest([asdict(place) for place in registry.list_places(site=site)]),
        "zones": _digest([asdict(zone) for zone in editor.find_zones(site=site)]),
        "devices": {device.id: _digest(_works(device, paces.get(device.id))) for device in devices},
    }


def _works(device: registry.DeviceView, paces: Mapping[str, float] | None) -> dict[str, Any]:
    """Return a device as a rehearsal meets it: what it is called makes no difference there, its measured paces do."""
    told = {name: value for name, value in description_to_json(device.at_home).items() if name != "name"}
    more: dict[str, Any] = {"paces": paces} if paces else {}
    return told | more | ({"idless": True} if device.is_of_paper else {})


def what_changed(then: Digests, now: Digests) -> dict[str, Any] | None:
    """Return what of the site is another one: `what`, and the ids of devices; None: nothing, or nobody knows."""
    if not then or not now:
        return None
    for what in ("map", "map_tag", "places", "zones"):
        # Of the map of an older result nothing but its number is known.
        if what in then and then[what] != now[what]:
            return {"what": what.removesuffix("_tag"), "devices": []}
    known, there = then["devices"], now["devices"]
    others = sorted(device for device in known.keys() | there.keys() if known.get(device) != there.get(device))
    return {"what": "devices", "devices": others[:MOST_NAMED]} if others else None


def _digest(data: Any) -> str:
    return sha256(json.dumps(data, sort_keys=True, default=str).encode()).hexdigest()[:16]

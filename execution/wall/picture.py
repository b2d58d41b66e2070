"""What a wall screen is told: a list of what may be said, field by field, so that nothing new gets there unseen; pure.

No name of a person is in it, nor any text that a person wrote to others (answers, reasons), nor a device's own words,
which nobody foresees. Names of devices, places, programs and the site are.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime
from typing import Any

from execution.views import RunView
from registry.services import AlertView, DeviceView, PlaceView, SiteView, alert_to_json, device_to_json

DEVICE_FIELDS = ("id", "name", "kind", "device_class", "icon", "status", "done", "stand_in")
STATE_FIELDS = frozenset({"status", "done", "stand_in", "location", "activity", "properties"})
"""What is told of a device while it stays the same one; of anything else the whole picture is made anew."""
QUIET_FIELDS = frozenset({"id", "doing", "last_seen_at", "carrying", "dropped"})
"""What changes often and is not shown."""
OWN_WORDS = "said"
"""The code of an activity that is a device's own words."""
ALERT_FIELDS = ("id", "device", "code", "severity", "count", "state", "first_at", "last_at")
WAIT_ARGS = ("device", "robot", "run", "others", "zone")
MOST_RUNS, MOST_ALERTS = 12, 12
_EVENT = re.compile(r"e\d")
"""Numbers of events, which are no part of a program's course."""


def device_to_wall(device: Mapping[str, Any]) -> dict[str, Any]:
    """Return what may be shown of a device, or of a change of it, as browsers are told."""
    told = {name: device[name] for name in DEVICE_FIELDS if name in device}
    if "location" in device:
        told["location"] = {axis: device["location"][axis] for axis in ("x", "y", "theta")}
    if "size" in device:
        told["size"] = {axis: device["size"][axis] for axis in ("x", "y")}
    if "activity" in device:
        activity = device["activity"]
        told["activity"] = activity if activity and activity["code"] != OWN_WORDS else None
    if "properties" in device:
        told["properties"] = [
            {"name": each["name"], "value": each["value"]}
            for each in device["properties"]
            if each["name"] == "jobStatus" and isinstance(each["value"], int | float)
        ]
    return told


def is_anew(change: Mapping[str, Any], known: frozenset[str]) -> bool:
    """Tell whether a change of a device asks for a new picture: one that is not on it, or more than its state."""
    return change["id"] not in known or not change.keys() <= STATE_FIELDS | QUIET_FIELDS


def progress_of(compiled: Mapping[str, Any], steps: Mapping[str, Mapping[str, Any]]) -> tuple[int, int]:
    """Return how many of a program's outer steps are done, and how many there are."""
    numbers, depth = compiled.get("numbers", {}), compiled.get("depth", {})
    order: Sequence[str] = compiled.get("order", ())
    outer = [step for step in order if not depth.get(step) and not _EVENT.match(numbers.get(step, ""))]
    return sum(steps.get(step, {}).get("status") == "done" for step in outer), len(outer)


def run_to_wall(run: RunView, compiled: Mapping[str, Any]) -> dict[str, Any]:
    """Return what may be shown of a run: not who started, paused or planned it, and no parameters."""
    done, total = progress_of(compiled, run.steps)
    return {
        "number": run.number,
        "program": run.program_name,
        "status": run.status,
        "started_at": _iso(run.started_at),
        "not_before": _iso(run.not_before),
        "done": done,
        "total": total,
        "wait": _wait_of(run.steps.values()),
    }


def _wait_of(steps: Iterable[Mapping[str, Any]]) -> dict[str, Any] | None:
    """Return what the step waits for that began last of those that wait."""
    waiting = [step for step in steps if step.get("status") in ("running", "waiting") and step.get("why")]
    if not waiting:
        return None
    why = max(waiting, key=lambda step: step.get("started_at") or "")["why"]
    return {"code": why["code"], "args": {name: why["args"][name] for name in WAIT_ARGS if name in why["args"]}}


def alert_to_wall(alert: AlertView) -> dict[str, Any]:
    """Return what may be shown of an alert: not who has seen it, and not the words that came with it."""
    told = alert_to_json(alert)
    return {name: told[name] for name in ALERT_FIELDS}


def picture_of(
    *,
    site: SiteView,
    stop: tuple[bool, datetime | None],
    devices: Iterable[DeviceView],
    runs: Iterable[dict[str, Any]],
    alerts: Sequence[AlertView],
) -> dict[str, Any]:
    """Return the whole of what a wall screen shows but its map, as a message."""
    is_stopped, since = stop
    return {
        "type": "picture",
        "site": site.name,
        "stop": {"active": is_stopped, "at": _iso(since)},
        "devices": [device_to_wall(device_to_json(device)) for device in devices],
        "runs": list(runs),
        "alerts": [alert_to_wall(alert) for alert in alerts[:MOST_ALERTS]],
        "more_alerts": max(0, len(alerts) - MOST_ALERTS),
    }


def place_to_wall(place: PlaceView) -> dict[str, Any]:
    """Return what may be shown of a place."""
    names = ("id", "name", "kind", "x", "y", "theta", "label")
    return {name: getattr(place, name) for name in names}


def _iso(at: datetime | None) -> str | None:
    return at.isoformat() if at else None

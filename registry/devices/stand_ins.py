"""Devices that are simulated in place of the real ones: a stand-in speaks and is told, the real one waits aside.

The row has the state of the one that counts; while that is the stand-in, `aside` has what the real device said last.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from registry.devices.history import history_text, note_decision, write_event
from registry.devices.rows import announce, lock_device
from registry.devices.samples import write_when_committed
from registry.devices.views import DeviceView, view_of
from registry.models import Device, User

STATE = ("online", "presence_boot", "boot", "seq", "done", "command", "pose", "properties", "last_seen_at")
"""What a row has of the one that speaks."""


@dataclass(frozen=True, slots=True)
class StandInView:
    """A device that is simulated at the moment, since a switch; `boot` is the highest start that its row knows of."""

    device: DeviceView
    boot: int
    since: str


def switch_stand_in(*, site: str, device_id: str, simulated: bool, by: User | None, at: datetime) -> DeviceView:
    """Let a stand-in speak for a device, or the device itself again; the caller has seen that nobody uses it.

    Raises NoSuchDevice. Call it within a transaction.
    """
    device = lock_device(site, device_id)
    before = view_of(device, site)
    if device.stand_in == simulated:
        return before
    if simulated:
        device.aside = {**_state_to_json(device), "since": at.isoformat()}
        device.online, device.done, device.command = False, True, ""
        device.presence_boot = device.boot = device.seq = -1
    else:
        _take_state(device, device.aside or {})
        device.aside = None
    device.stand_in = simulated
    device.save(update_fields=["stand_in", "aside", *STATE])
    code = "simulated" if simulated else "real_again"
    write_event(device, at, code, history_text(code), by)
    note_decision(device, f"device_{code}")
    after = view_of(device, site)
    announce(before, after)
    write_when_committed(before=before, after=after, at=at)
    return after


def list_stand_ins() -> tuple[StandInView, ...]:
    """Return the devices of all sites that are simulated now, by id."""
    rows = Device.objects.filter(stand_in=True, lifecycle=Device.Lifecycle.APPROVED, description__isnull=False)
    found = rows.select_related("site").defer("source").order_by("pk")
    return tuple(
        StandInView(view_of(row, row.site.slug), max(row.boot, row.presence_boot), (row.aside or {}).get("since", ""))
        for row in found
    )


def list_simulated_ids(*, site_id: int) -> frozenset[str]:
    """Return which devices of a site are simulated now."""
    return frozenset(Device.objects.filter(site_id=site_id, stand_in=True).values_list("pk", flat=True))


def real_of(device: Device) -> Device:
    """Return the row of a device that is simulated as if it were not: with what the real one said last."""
    real = copy(device)
    real.stand_in = False
    _take_state(real, device.aside or {})
    return real


def keep_aside(device: Device, real: Device) -> None:
    """Keep what a real device has said while its stand-in speaks; the row is locked."""
    before = view_of(device, device.site.slug) if device.description_hash else None
    device.aside = {**(device.aside or {}), **_state_to_json(real)}
    device.save(update_fields=["aside"])
    if before is not None:
        announce(before, view_of(device, device.site.slug))


def _state_to_json(device: Device) -> dict[str, Any]:
    state = {name: getattr(device, name) for name in STATE}
    return state | {"last_seen_at": device.last_seen_at.isoformat() if device.last_seen_at else None}


def _take_state(device: Device, state: dict[str, Any]) -> None:
    for name in STATE:
        if name in state:
            setattr(device, name, state[name])
    seen_at = state.get("last_seen_at")
    device.last_seen_at = datetime.fromisoformat(seen_at) if seen_at else None

"""A device's row under its lock, its history, and what browsers are told of it; shared by all who change devices."""

from __future__ import annotations

from dataclasses import asdict
from datetime import datetime

from django.db import transaction

from registry.differences import Change
from registry.errors import RegistryError
from registry.live import publish
from registry.models import Device, DeviceEvent, User
from registry.rdf_text import CONTENT_TYPES
from registry.thing_log import record_thing
from registry.views import DeviceView, changed_fields
from registry.wire import is_device_id

MOST_EVENTS = 200
MOST_CHARACTERS = 300
RESERVED_IDS = frozenset({"server"})
DONE_FLAG_ONLY_SQL = f"SELECT id FROM registry_device WHERE source_type = '{CONTENT_TYPES['paper']}'"  # noqa: S608 - a constant
"""A subquery of the devices that describe themselves by the paper's message, and may answer by `done` alone."""


class NoSuchDevice(RegistryError):
    """No device of that id at that site."""

    code = "no_such_device"
    status = 404


class BadDevice(RegistryError):
    """A device's id, name, key or place that cannot be."""

    code = "bad_device"
    status = 422


def check_id(device_id: str) -> None:
    """Raise BadDevice for an id that no device can have."""
    if not is_device_id(device_id) or device_id in RESERVED_IDS:
        raise BadDevice("A device's id must be 1 to 64 letters, digits, '_', '.' or '-', and not 'server'.")


def lock_device(site: str, device_id: str) -> Device:
    """Return the locked row of a described device; call it within a transaction. Raises NoSuchDevice."""
    rows = Device.objects.select_for_update(of=("self",)).select_related("site").filter(description__isnull=False)
    device = rows.filter(pk=device_id, site__slug=site).first() if is_device_id(device_id) else None
    if device is None:
        raise NoSuchDevice(f"This site has no device {device_id[:64]!r}.")
    return device


def write_event(
    device: Device, at: datetime, kind: str, text: str, by: User | None = None, *, changes: tuple[Change, ...] = ()
) -> None:
    """Add a line of history and forget the ones beyond the newest 200."""
    told = [asdict(change) for change in changes]
    DeviceEvent.objects.create(device=device, at=at, kind=kind, text=text[:MOST_CHARACTERS], by=by, changes=told)
    oldest = DeviceEvent.objects.filter(device=device).order_by("-pk").values_list("pk", flat=True)[MOST_EVENTS:][:1]
    for key in list(oldest):
        DeviceEvent.objects.filter(device=device, pk__lte=key).delete()


def announce(before: DeviceView | None, after: DeviceView) -> None:
    """Tell browsers and directories what is new, once the transaction holds."""
    record_thing(before, after)
    changes = changed_fields(before, after)
    if len(changes) > 1:
        transaction.on_commit(lambda: publish(after.site, {"type": "device", "device": changes}))

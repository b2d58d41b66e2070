"""A device's row under its lock, its history, and what browsers are told of it; shared by all who change devices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from datetime import datetime

from django.db import transaction
from django.db.models import Count

from registry.devices.history_texts import Said
from registry.devices.thing_events import record_things
from registry.devices.views import DeviceView, changed_fields
from registry.errors import RegistryError
from registry.live.fanout import publish_all
from registry.models import Device, DeviceEvent, RobotMapDraft, User
from vipo_device.descriptions.changes import Change
from vipo_device.descriptions.forms import CONTENT_TYPES
from vipo_device.protocol.faults import refusal_facts
from vipo_device.protocol.messages import is_device_id

STARTS = ("boot", "seq", "presence_boot")
MOST_EVENTS = 200
EVENTS_TO_SPARE = 20
"""How many more a history may have before it is cut, where many devices speak at once."""
MOST_CHARACTERS = 300
RESERVED_IDS = frozenset({"server", ".", ".."})
"""The server's own name, and those that are no part of an address: no page and no call would reach such a device."""
DONE_FLAG_ONLY_SQL = f"SELECT source_type = '{CONTENT_TYPES['paper']}' FROM registry_device WHERE id = {{device}}"  # noqa: S608 - a constant
"""Whether a device (a column's name) describes itself by the paper's message, and so may answer by `done` alone.

It asks about each device by its key: a look through all of them takes longer than all the rest of a claim.
"""

OUT_SQL = "SELECT lifecycle <> 'approved' FROM registry_device WHERE id = {device}"
"""Whether a device (a column's name) does not take part: it is told nothing. It asks about each by its key, too."""


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
        raise BadDevice(*refusal_facts("device_id"))


def lock_device(site: str, device_id: str) -> Device:
    """Return the locked row of a described device; call it within a transaction. Raises NoSuchDevice."""
    rows = Device.objects.select_for_update(of=("self",)).select_related("site").filter(description__isnull=False)
    device = rows.filter(pk=device_id, site__slug=site).first() if is_device_id(device_id) else None
    if device is None:
        raise NoSuchDevice(f"This site has no device {device_id[:64]!r}.")
    return device


def forget_starts(device: Device) -> None:
    """Let a device count its starts anew, in the fields STARTS: another board may come in by its id from now on."""
    device.boot = device.seq = device.presence_boot = -1
    RobotMapDraft.objects.filter(pk=device.pk).update(boot=-1, number=-1)


def line_of_history(
    device: Device,
    at: datetime,
    kind: str,
    words: Said | str,
    by: User | None = None,
    *,
    changes: tuple[Change, ...] = (),
) -> DeviceEvent:
    """Return a line of a device's history, which is not written yet; bare words have no code."""
    line = words if isinstance(words, Said) else Said(words)
    told = {"text": line.text[:MOST_CHARACTERS], "code": line.code, "args": dict(line.args)}
    differences = [asdict(change) for change in changes]
    return DeviceEvent(device=device, at=at, kind=kind, by=by, changes=differences, **told)


def write_event(
    device: Device,
    at: datetime,
    kind: str,
    words: Said | str,
    by: User | None = None,
    *,
    changes: tuple[Change, ...] = (),
) -> None:
    """Add a line of history and forget the ones beyond the newest 200."""
    line_of_history(device, at, kind, words, by, changes=changes).save(force_insert=True)
    _forget_old(device.pk)


def write_lines(lines: Sequence[DeviceEvent]) -> None:
    """Add lines of history of many devices, oldest first; who has 20 more than 200 keeps the newest 200."""
    if not lines:
        return
    DeviceEvent.objects.bulk_create(lines)
    kept = DeviceEvent.objects.filter(device__in={line.device_id for line in lines}).order_by()
    counts = kept.values_list("device").annotate(lines=Count("pk")).filter(lines__gt=MOST_EVENTS + EVENTS_TO_SPARE)
    for device_id, _ in counts:
        _forget_old(device_id)


def _forget_old(device_id: str) -> None:
    own = DeviceEvent.objects.filter(device=device_id)
    for key in list(own.order_by("-pk").values_list("pk", flat=True)[MOST_EVENTS:][:1]):
        own.filter(pk__lte=key).delete()


def announce(before: DeviceView | None, after: DeviceView) -> None:
    """Tell browsers and directories what is new, once the transaction holds."""
    announce_all([(before, after)])


def announce_all(changes: Sequence[tuple[DeviceView | None, DeviceView]]) -> None:
    """Tell browsers and directories what is new of several devices, once the transaction holds."""
    record_things(changes)
    told = [(after.site, changed_fields(before, after)) for before, after in changes]
    news = [(slug, {"type": "device", "device": fields}) for slug, fields in told if len(fields) > 1]
    transaction.on_commit(lambda: publish_all(news))

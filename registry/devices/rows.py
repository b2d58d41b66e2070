"""A device's row: whether its id can be, found and locked, and announced to browsers when it has changed."""

from __future__ import annotations

from collections.abc import Sequence

from django.db import transaction

from registry.devices.things import record_things
from registry.devices.views import DeviceView, changed_fields, device_news
from registry.errors import RegistryError
from registry.live.fanout import publish_all
from registry.models import Device, RobotMapDraft
from vipo_device.protocol.faults import refusal_facts
from vipo_device.protocol.messages import is_device_id

STARTS = ("boot", "seq", "presence_boot")
RESERVED_IDS = frozenset({"server", ".", ".."})
"""The server's own name, and those that are no part of an address: no page and no call would reach such a device."""


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
    if device.stand_in:
        device.aside = {**(device.aside or {}), **dict.fromkeys(STARTS, -1)}
    else:
        device.boot = device.seq = device.presence_boot = -1
    RobotMapDraft.objects.filter(pk=device.pk).update(boot=-1, number=-1)


def announce(before: DeviceView | None, after: DeviceView) -> None:
    """Tell browsers and directories what is new, once the transaction holds."""
    announce_all([(before, after)])


def announce_all(changes: Sequence[tuple[DeviceView | None, DeviceView]]) -> None:
    """Tell browsers and directories what is new of several devices, once the transaction holds."""
    record_things(changes)
    told = [(after.site, device_news(before, after, changed_fields(before, after))) for before, after in changes]
    news = [(slug, message) for slug, message in told if len(message["device"]) > 1 or "redescribed" in message]
    transaction.on_commit(lambda: publish_all(news))

"""Reading devices: all of a site, one by its id, their histories, and what decides how commands reach them."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

from django.db import connection

from registry.devices.rows import NoSuchDevice
from registry.devices.views import DeviceView, view_of
from registry.models import Device, DeviceEvent
from registry.sites.sites import find_site
from vipo_device.descriptions.changes import Change
from vipo_device.descriptions.forms import CONTENT_TYPES
from vipo_device.protocol.messages import is_device_id

_DELIVERY = "SELECT id, lifecycle, source_type, granted, stand_in FROM registry_device WHERE id IN ({})"


@dataclass(frozen=True, slots=True)
class DeviceEventView:
    """One line of a device's history; `changes` say field by field how a description differs from the last.

    `code` and `args` are what a screen says it from in another language; older lines have none.
    """

    at: datetime
    kind: str
    text: str
    by: str
    changes: tuple[Change, ...] = ()
    code: str = ""
    args: Mapping[str, Any] = field(default_factory=dict)


def list_devices(*, site: str, lifecycle: str | None = None) -> tuple[DeviceView, ...]:
    """Return the site's described devices by id; retired ones only when asked for by `lifecycle`."""
    rows = Device.objects.filter(site=find_site(site), description__isnull=False).order_by("id").defer("source")
    chosen = rows.filter(lifecycle=lifecycle) if lifecycle else rows.exclude(lifecycle=Device.Lifecycle.RETIRED)
    return tuple(view_of(device, site) for device in chosen)


def get_device(*, site: str, device_id: str) -> DeviceView:
    """Return one device. Raises NoSuchDevice."""
    rows = Device.objects.filter(pk=device_id, site__slug=site, description__isnull=False)
    device = rows.exclude(lifecycle=Device.Lifecycle.RETIRED).first() if is_device_id(device_id) else None
    if device is None:
        raise NoSuchDevice(f"This site has no device {device_id[:64]!r}.")
    return view_of(device, site)


def find_device(*, device_id: str) -> DeviceView | None:
    """Return a device by its id alone, whatever its site; None when nobody described it yet."""
    device = Device.objects.filter(pk=device_id, description__isnull=False).select_related("site").first()
    return view_of(device, device.site.slug) if device else None


def find_out(*, devices: Collection[str]) -> frozenset[str]:
    """Return which of these devices do not take part: those that wait for approval, or were taken out."""
    rows = Device.objects.filter(pk__in=devices).exclude(lifecycle=Device.Lifecycle.APPROVED)
    return frozenset(rows.values_list("pk", flat=True))


def list_device_events(*, site: str, device_id: str, limit: int = 50) -> tuple[DeviceEventView, ...]:
    """Return a device's history, newest first. Raises NoSuchDevice."""
    get_device(site=site, device_id=device_id)
    rows = DeviceEvent.objects.filter(device__pk=device_id, device__site__slug=site).select_related("by")
    return tuple(
        DeviceEventView(
            e.at,
            e.kind,
            e.text,
            e.by.display_name if e.by else "",
            tuple(Change(**change) for change in e.changes),
            e.code,
            e.args,
        )
        for e in rows.order_by("-pk")[:limit]
    )


@dataclass(frozen=True, slots=True)
class DeliveryFacts:
    """What decides how commands reach a device; `topics` are the confirmed legacy ones by method.

    One that `knows_no_ids` describes itself by the paper's message, answers by `done` alone, and would carry a command
    out anew each time that it hears it.
    """

    takes_part: bool
    knows_no_ids: bool
    topics: Mapping[str, str]


def list_delivery_facts(*, devices: Collection[str]) -> dict[str, DeliveryFacts]:
    """Return how commands reach these devices, by id; those that nobody knows are left out. One question."""
    if not devices:
        return {}
    with connection.cursor() as cursor:  # asked before each command goes out, so it is written by hand
        cursor.execute(_DELIVERY.format(", ".join(["%s"] * len(devices))), list(devices))
        rows = cursor.fetchall()
    return {
        pk: DeliveryFacts(
            lifecycle == Device.Lifecycle.APPROVED,
            form == CONTENT_TYPES["paper"] and not stand_in,
            json.loads(granted) if isinstance(granted, str) else granted,
        )
        for pk, lifecycle, form, granted, stand_in in rows
    }

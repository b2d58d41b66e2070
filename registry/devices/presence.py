"""Whether a device is there: that it came, left or fell silent, and what the gateway had to leave aside of it.

Every function may run at the same time as itself in another process: rows are locked or changed by conditional
updates, and what is older than what is known is ignored by (boot, seq).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from datetime import datetime, timedelta
from typing import Any

from django.conf import settings
from django.db import transaction
from django.utils import timezone

from registry.alerts.buffer import note_alert
from registry.devices.history import MOST_CHARACTERS, history_text, write_event
from registry.devices.rows import BadDevice, announce, check_id
from registry.devices.samples import note_samples, write_samples
from registry.devices.stand_ins import keep_aside, real_of
from registry.devices.views import DeviceView, view_of
from registry.models import Device, DeviceEvent, Site
from registry.sites.namespaces import OF_IDS, may_name
from vipo_device.protocol.faults import refusal_facts
from vipo_device.protocol.messages import Presence, parse_presence

STALE_AFTER = timedelta(seconds=45)
"""A device speaks at least every 30 s (docs/protocol.md); its last will usually tells long before this."""
MOST_CHANGES_A_MINUTE = 6
PROBLEM_EVERY = timedelta(seconds=10)


def _lock_or_make(device_id: str, at: datetime) -> Device:
    """Return the device's locked row; a new one stands at the default site, if that may give its id."""
    check_id(device_id)
    device = Device.objects.select_for_update(of=("self",)).select_related("site").filter(pk=device_id).first()
    if device is None:
        site = _default_site()
        if not may_name(site, device_id, OF_IDS):
            raise BadDevice(*refusal_facts("id_of_site", device=device_id, site=site.slug))
        Device.objects.get_or_create(pk=device_id, defaults={"site": site, "first_seen_at": at})
        device = Device.objects.select_for_update(of=("self",)).select_related("site").get(pk=device_id)
    return device


def _default_site() -> Site:
    site = Site.objects.filter(slug=settings.VIPO_DEFAULT_SITE).first()
    if site is None:
        raise BadDevice("The device has named no site that it could join, and there is no default site.")
    return site


def ingest_presence(*, device_id: str, payload: bytes, at: datetime, stand_in: bool = False) -> DeviceView | None:
    """Take in that a device, or its stand-in, came or went.

    None when it changed nothing (a stale will), nobody described the device yet, or it is only kept aside. Raises
    BadDevice when it comes as an older start than one that was heard.
    """
    said = parse_presence(payload)
    with transaction.atomic():
        if stand_in and not Device.objects.filter(pk=device_id, stand_in=True).exists():
            return None
        device = _lock_or_make(device_id, at)
        if stand_in != device.stand_in:
            _keep_aside(device, said, at, stand_in=stand_in)
            return None
        if said.online and device.is_locked_out:
            return None
        if said.boot < device.presence_boot:
            _refuse_old_start(said, device.presence_boot)
            return None
        before = view_of(device, device.site.slug) if device.description else None
        came_or_went = device.online != said.online
        device.online, device.presence_boot, device.last_seen_at = said.online, said.boot, at
        device.save(update_fields=["online", "presence_boot", "last_seen_at"])
        if came_or_went:
            _tell_coming_and_going(device, said.online, at)
        if before is None:
            return None
        after = view_of(device, device.site.slug)
        announce(before, after)
    note_samples(before=before, after=after, at=at)
    return after


def _refuse_old_start(said: Presence, known: int) -> None:
    """Raise BadDevice for who comes as an older start, and would never be heard; a late will may be older."""
    if said.online:
        raise BadDevice(*refusal_facts("old_start", said=said.boot, known=known))


def _keep_aside(device: Device, said: Presence, at: datetime, *, stand_in: bool) -> None:
    """Keep whether a real device is there while its stand-in speaks."""
    if stand_in:  # the device was switched back just now
        return
    real = real_of(device)
    if said.boot >= real.presence_boot and not (said.online and real.is_locked_out):
        real.online, real.presence_boot, real.last_seen_at = said.online, said.boot, at
        keep_aside(device, real)


def _tell_coming_and_going(device: Device, online: bool, at: datetime) -> None:
    """Write that a device came or left; one that does so all the time gets one line a minute."""
    lately = DeviceEvent.objects.filter(device=device, at__gt=at - timedelta(minutes=1))
    if lately.filter(kind__in=("online", "offline")).count() < MOST_CHANGES_A_MINUTE:
        kind = "online" if online else "offline"
        write_event(device, at, kind, history_text(kind))
    elif not lately.filter(kind="flapping").exists():
        note_alert(device_id=device.pk, code="flapping")
        write_event(device, at, "flapping", history_text("flapping"))


def mark_stale(*, now: datetime) -> tuple[DeviceView, ...]:
    """Mark as offline the devices that have said nothing for 45 s, and return them."""
    silent = Device.objects.filter(online=True, last_seen_at__lt=now - STALE_AFTER)
    changes = []
    for device in silent.select_related("site"):
        if silent.filter(pk=device.pk).update(online=False):
            write_event(device, now, "offline", history_text("silent", seconds=STALE_AFTER.seconds))
            before = view_of(device, device.site.slug) if device.description else None
            device.online = False
            if before:
                changes.append((before, view_of(device, device.site.slug)))
                announce(*changes[-1])
    write_samples(changes=changes, at=now)  # before whatever a gateway hears of them next
    return tuple(after for _, after in changes)


def count_dropped(*, dropped: Mapping[str, int]) -> None:
    """Add to what was not taken of devices' messages; unknown devices are left aside."""
    for device_id, count in dropped.items():
        with transaction.atomic():
            device = Device.objects.select_for_update(of=("self",)).select_related("site").filter(pk=device_id).first()
            if device is None:
                continue
            before = view_of(device, device.site.slug) if device.description else None
            device.dropped += count
            device.save(update_fields=["dropped"])
            if before:
                announce(before, replace(before, dropped=device.dropped))


def record_problem(
    *, device_id: str, text: str, facts: Mapping[str, Any] | None = None, at: datetime | None = None
) -> bool:
    """Note in a device's history that something of it was refused, the same at most every 10 s; tell whether it was."""
    at = at or timezone.now()
    device = Device.objects.filter(pk=device_id).first()
    words = history_text("problem", **{**(facts or {}), "text": text})
    noted = DeviceEvent.objects.filter(device=device, kind="problem", text=words.text[:MOST_CHARACTERS])
    if device is None or noted.filter(at__gt=at - PROBLEM_EVERY).exists():
        return False
    write_event(device, at, "problem", words)
    return True

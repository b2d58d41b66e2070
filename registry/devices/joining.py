"""How devices join and leave: what they say of themselves, and what people decide about them.

Every function may run at the same time as itself in another process: rows are locked or changed by conditional
updates, and what is older than what is known is ignored by (boot, seq).
"""

from __future__ import annotations

import hmac
from collections.abc import Collection, Mapping
from dataclasses import asdict, dataclass, replace
from datetime import datetime, timedelta
from typing import Any

from django.conf import settings
from django.db import transaction
from django.utils import timezone

from registry.alerts.buffer import note_alert
from registry.devices.enrolment import MOST_NEWCOMERS
from registry.devices.history_texts import Said, said
from registry.devices.rows import RESERVED_IDS, BadDevice, NoSuchDevice, announce, check_id, lock_device, write_event
from registry.devices.states import SaidState, ingest_states
from registry.devices.views import DeviceEventView, DeviceView, view_of
from registry.models import Device, DeviceEvent, Site, User
from registry.sites.sites import find_site
from vipo_device.descriptions.changes import Change
from vipo_device.protocol.credentials import secret_hash
from vipo_device.protocol.description import Pose
from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.messages import is_device_id, parse_presence

STALE_AFTER = timedelta(seconds=45)
"""A device speaks at least every 30 s (docs/protocol.md); its last will usually tells long before this."""
MOST_CHANGES_A_MINUTE = 6
PROBLEM_EVERY = timedelta(seconds=10)
DOOR = "join:"
"""Before a site's name: the user name with which newcomers knock (docs/protocol.md)."""


@dataclass(frozen=True, slots=True)
class Principal:
    """Who a connection is: `is_newcomer` when it came in with the site's join key only; `key` is its key's hash.

    `topics` are the legacy ones that an admin has confirmed for it.
    """

    device_id: str
    is_newcomer: bool
    key: str = ""
    topics: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Login:
    """A connection that was let in: the hash of the own key it had (empty with a join key), when, with which topics."""

    key: str
    at: datetime
    topics: frozenset[str] = frozenset()


def _lock_or_make(device_id: str, at: datetime) -> Device:
    """Return the device's locked row; a new one stands at the default site until it describes itself."""
    check_id(device_id)
    device = Device.objects.select_for_update(of=("self",)).select_related("site").filter(pk=device_id).first()
    if device is None:
        Device.objects.get_or_create(pk=device_id, defaults={"site": _default_site(), "first_seen_at": at})
        device = Device.objects.select_for_update(of=("self",)).select_related("site").get(pk=device_id)
    return device


def _default_site() -> Site:
    site = Site.objects.filter(slug=settings.VIPO_DEFAULT_SITE).first()
    if site is None:
        raise BadDevice("The device has named no site that it could join, and there is no default site.")
    return site


def ingest_presence(*, device_id: str, payload: bytes, at: datetime) -> DeviceView | None:
    """Take in that a device came or went; None when it changed nothing (a stale will) or nobody described it yet."""
    said = parse_presence(payload)
    with transaction.atomic():
        device = _lock_or_make(device_id, at)
        if said.boot < device.presence_boot or (said.online and device.is_locked_out):
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
    return after


def _tell_coming_and_going(device: Device, online: bool, at: datetime) -> None:
    """Write that a device came or left; one that does so all the time gets one line a minute."""
    lately = DeviceEvent.objects.filter(device=device, at__gt=at - timedelta(minutes=1))
    if lately.filter(kind__in=("online", "offline")).count() < MOST_CHANGES_A_MINUTE:
        kind = "online" if online else "offline"
        write_event(device, at, kind, said(kind))
    elif not lately.filter(kind="flapping").exists():
        note_alert(device_id=device.pk, code="flapping")
        write_event(device, at, "flapping", said("flapping"))


def ingest_state(*, device_id: str, payload: bytes, at: datetime, retained: bool = False) -> DeviceView | None:
    """Take in a device's state; None when it is old, a replay, or of a device that nobody knows.

    A retained message tells how the device was, not that it is there now.
    """
    (outcome,) = ingest_states(states=[SaidState(device_id, payload, at, retained)])
    if isinstance(outcome, VipoError):
        raise outcome
    return outcome


def mark_stale(*, now: datetime) -> tuple[DeviceView, ...]:
    """Mark as offline the devices that have said nothing for 45 s, and return them."""
    silent = Device.objects.filter(online=True, last_seen_at__lt=now - STALE_AFTER)
    found = []
    for device in silent.select_related("site"):
        if silent.filter(pk=device.pk).update(online=False):
            write_event(device, now, "offline", said("silent", seconds=STALE_AFTER.seconds))
            before = view_of(device, device.site.slug) if device.description else None
            device.online = False
            if before:
                found.append(view_of(device, device.site.slug))
                announce(before, found[-1])
    return tuple(found)


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
    """Note in a device's history that something of it was refused, at most every 10 s; tell whether it was noted."""
    at = at or timezone.now()
    device = Device.objects.filter(pk=device_id).first()
    if device is None or DeviceEvent.objects.filter(device=device, kind="problem", at__gt=at - PROBLEM_EVERY).exists():
        return False
    write_event(device, at, "problem", said("problem", **{**(facts or {}), "text": text}))
    return True


def check_device_password(*, username: str, password: str) -> Principal | None:
    """Return who may connect with this: a device by its own key, or a newcomer by a site's join key.

    The join key opens the site's door (`join:<site>`), where newcomers bring a key of their own; the embedded broker
    also takes it from a device whose id has no key yet.
    """
    offered = secret_hash(password)
    if username.startswith(DOOR):
        return _check_door(username, offered)
    if not is_device_id(username) or username in RESERVED_IDS:
        return None
    device = Device.objects.filter(pk=username).first()
    if device and device.lifecycle == Device.Lifecycle.RETIRED:
        return None
    if device and device.credential_hash:
        is_its_key = hmac.compare_digest(device.credential_hash, offered)
        if not is_its_key:
            note_alert(device_id=username, code="wrong_key")
        return Principal(username, False, offered, frozenset(device.granted.values())) if is_its_key else None
    if device and device.lifecycle != Device.Lifecycle.PENDING:
        return None
    is_let_in = Site.objects.filter(join_key_hash=offered).exists() and (device or _has_room())
    return Principal(username, True) if is_let_in else None


def _has_room() -> bool:
    """Tell whether one more newcomer may come that brings no key of its own."""
    return Device.objects.filter(lifecycle="pending", credential_hash="").count() < MOST_NEWCOMERS


def _check_door(username: str, offered: str) -> Principal | None:
    site = Site.objects.filter(slug=username.removeprefix(DOOR)).exclude(join_key_hash="").first()
    if site is None or not hmac.compare_digest(site.join_key_hash, offered):
        return None
    return Principal(username, True, offered)


def list_broker_hashes() -> dict[str, str]:
    """Return who has an account at the broker, with the hash that it keeps: devices by id, doors by `join:<site>`."""
    devices = Device.objects.exclude(broker_hash="").exclude(lifecycle=Device.Lifecycle.RETIRED)
    doors = Site.objects.exclude(join_broker_hash="").values_list("slug", "join_broker_hash")
    return {**{DOOR + slug: hashed for slug, hashed in doors}, **dict(devices.values_list("pk", "broker_hash"))}


def find_ended(*, logins: Mapping[str, Login]) -> frozenset[str]:
    """Return which of these connections, by user name, must end: taken out, with another key, or other topics."""
    facts = ("pk", "lifecycle", "credential_hash", "ends_before", "granted")
    rows = Device.objects.filter(pk__in=list(logins)).values_list(*facts)
    doors = Site.objects.filter(slug__in=[n.removeprefix(DOOR) for n in logins if n.startswith(DOOR)])
    keys = {DOOR + slug: key for slug, key in doors.values_list("slug", "join_key_hash")}
    ended = {name for name, login in logins.items() if name.startswith(DOOR) and keys.get(name) != login.key}
    for name, lifecycle, key, ends_before, granted in rows:
        login = logins[name]
        is_out = lifecycle == Device.Lifecycle.RETIRED or (lifecycle == Device.Lifecycle.APPROVED and not key)
        is_old = bool(login.key and login.key != key) or bool(ends_before and login.at < ends_before)
        if is_out or is_old or login.topics != frozenset(granted.values()):
            ended.add(name)
    return frozenset(ended)


def update_device(
    *, site: str, device_id: str, name: str | None = None, pose: Pose | None = None, by: User | None, at: datetime
) -> DeviceView:
    """Give a device another name (empty: its own again) or place. Raises NoSuchDevice, BadDevice."""
    if name is not None and (len(name.strip()) > 100 or not name.isprintable()):
        raise BadDevice("A device's name has at most 100 characters, all of which can be printed.")
    if pose is not None and not all(abs(v) <= 1e6 for v in (pose.x, pose.y, pose.z, pose.theta)):
        raise BadDevice("A device's place must lie within a million metres.")
    with transaction.atomic():
        device = lock_device(site, device_id)
        before = view_of(device, site)
        if name is not None:
            device.name_override = name.strip()
        if pose is not None:
            device.pose_override = asdict(pose)
        device.save(update_fields=["name_override", "pose_override"])
        after = view_of(device, site)
        for line in _edits(before, after):
            write_event(device, at, "edited", line, by)
        announce(before, after)
    return after


def _edits(before: DeviceView, after: DeviceView) -> list[Said]:
    edits = []
    if before.name != after.name:
        edits.append(said("renamed", before=before.name, after=after.name))
    if before.pose != after.pose:
        edits.append(said("moved", x=after.pose.x, y=after.pose.y))
    return edits


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

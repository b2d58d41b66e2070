"""Who may connect to the broker as a device: by its own key, or by the enrolment key of a site.

The embedded broker asks here with each connection; Mosquitto is given the same as accounts (registry/broker).
"""

from __future__ import annotations

import hmac
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime

from registry.alerts.buffer import note_alert
from registry.broker.mosquitto_file import ENROLMENT
from registry.devices.enrolment import MOST_PENDING
from registry.devices.rows import RESERVED_IDS
from registry.models import Device, Site
from vipo_device.protocol.credentials import secret_hash
from vipo_device.protocol.messages import is_device_id


@dataclass(frozen=True, slots=True)
class Principal:
    """Who a connection is: `is_enrolling` when it came in with a site's enrolment key only; `key` is its key's hash.

    `topics` are the legacy ones that an admin has confirmed for it.
    """

    device_id: str
    is_enrolling: bool
    key: str = ""
    topics: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Login:
    """A connection that was let in: the hash of its own key (empty with an enrolment key), when, with which topics."""

    key: str
    at: datetime
    topics: frozenset[str] = frozenset()


def check_device_password(*, username: str, password: str) -> Principal | None:
    """Return who may connect with this: a device by its own key, or one that enrols by a site's enrolment key.

    The enrolment key is for the user name `join:<site>`, under which devices bring a key of their own; the embedded
    broker also takes it from a device whose id has no key yet.
    """
    offered = secret_hash(password)
    if username.startswith(ENROLMENT):
        return _check_enrolment(username, offered)
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
    """Tell whether one more device may come that brings no key of its own."""
    return Device.objects.filter(lifecycle="pending", credential_hash="").count() < MOST_PENDING


def _check_enrolment(username: str, offered: str) -> Principal | None:
    site = Site.objects.filter(slug=username.removeprefix(ENROLMENT)).exclude(join_key_hash="").first()
    if site is None or not hmac.compare_digest(site.join_key_hash, offered):
        return None
    return Principal(username, True, offered)


def list_broker_hashes() -> dict[str, str]:
    """Return who has an account at the broker, with the hash that it keeps: devices by id, sites by `join:<site>`."""
    devices = Device.objects.exclude(broker_hash="").exclude(lifecycle=Device.Lifecycle.RETIRED)
    sites = Site.objects.exclude(join_broker_hash="").values_list("slug", "join_broker_hash")
    return {**{ENROLMENT + slug: hashed for slug, hashed in sites}, **dict(devices.values_list("pk", "broker_hash"))}


def find_ended(*, logins: Mapping[str, Login]) -> frozenset[str]:
    """Return which of these connections, by user name, must end: taken out, with another key, or other topics."""
    facts = ("pk", "lifecycle", "credential_hash", "ends_before", "granted")
    rows = Device.objects.filter(pk__in=list(logins)).values_list(*facts)
    sites = Site.objects.filter(slug__in=[n.removeprefix(ENROLMENT) for n in logins if n.startswith(ENROLMENT)])
    keys = {ENROLMENT + slug: key for slug, key in sites.values_list("slug", "join_key_hash")}
    ended = {name for name, login in logins.items() if name.startswith(ENROLMENT) and keys.get(name) != login.key}
    for name, lifecycle, key, ends_before, granted in rows:
        login = logins[name]
        is_out = lifecycle == Device.Lifecycle.RETIRED or (lifecycle == Device.Lifecycle.APPROVED and not key)
        is_old = bool(login.key and login.key != key) or bool(ends_before and login.at < ends_before)
        if is_out or is_old or login.topics != frozenset(granted.values()):
            ended.add(name)
    return frozenset(ended)

"""Who may connect to the broker: a device by its own key or the enrolment key of a site, a program by its token.

The embedded broker asks here with each connection; Mosquitto is given the same as accounts (registry/broker).
"""

from __future__ import annotations

import hmac
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime

from django.db import transaction
from django.utils import timezone

from registry.alerts.buffer import note_alert
from registry.broker.mosquitto_file import ENROLMENT
from registry.devices.enrolment import make_pending_device
from registry.devices.rows import RESERVED_IDS, BadDevice
from registry.models import Device, Site
from registry.people.tokens import find_reader, list_readers
from registry.sites.namespaces import OF_IDS, may_name
from vipo_device.protocol.credentials import secret_hash
from vipo_device.protocol.messages import is_device_id
from vipo_device.protocol.topics import is_reader


@dataclass(frozen=True, slots=True)
class Principal:
    """Who a connection is: `is_enrolling` when it came in with a site's enrolment key only; `key` is its key's hash.

    `topics` are the legacy ones that an admin has confirmed for it, `site` is the one whose stop it hears.
    """

    device_id: str
    is_enrolling: bool
    key: str = ""
    topics: frozenset[str] = frozenset()
    site: str = ""


@dataclass(frozen=True, slots=True)
class Login:
    """A connection that was let in: the hash of its own key (empty with an enrolment key), when, with which topics."""

    key: str
    at: datetime
    topics: frozenset[str] = frozenset()


def check_device_password(*, username: str, password: str) -> Principal | None:
    """Return who may connect with this: a device by its key, one that enrols by its site's, a program by its token.

    The enrolment key is for the user name `join:<site>`, under which devices bring a key of their own; the embedded
    broker also takes it from a device whose id has no key yet: one of that site, or a new one, which is that site's
    from then on, whatever it says of itself.
    """
    offered = secret_hash(password)
    if username.startswith(ENROLMENT):
        return _check_enrolment(username, offered)
    if is_reader(username):
        reader = find_reader(username=username, password=password, now=timezone.now())
        return Principal(username, False, offered, site=reader.site) if reader else None
    if not is_device_id(username) or username in RESERVED_IDS:
        return None
    device = Device.objects.filter(pk=username).select_related("site").first()
    if device and device.lifecycle == Device.Lifecycle.RETIRED:
        return None
    if device and device.credential_hash:
        is_its_key = hmac.compare_digest(device.credential_hash, offered)
        if not is_its_key:
            note_alert(device_id=username, code="wrong_key")
        topics = frozenset(device.granted.values())
        return Principal(username, False, offered, topics, device.site.slug) if is_its_key else None
    if device and device.lifecycle != Device.Lifecycle.PENDING:
        return None
    site = Site.objects.filter(join_key_hash=offered).first()
    if site is None or not (device.site_id == site.pk if device else _make_pending(site, username)):
        return None
    return Principal(username, True, site=site.slug)


def _make_pending(site: Site, device_id: str) -> bool:
    """Let a device that nobody knows belong to the site whose key it has; False where it cannot be its id, or is full.

    So nothing that it says later can bring it to another site.
    """
    if not may_name(site, device_id, OF_IDS):
        return False
    try:
        with transaction.atomic():
            return make_pending_device(device_id, site.pk, timezone.now()).site_id == site.pk
    except BadDevice:
        return False


def _check_enrolment(username: str, offered: str) -> Principal | None:
    site = Site.objects.filter(slug=username.removeprefix(ENROLMENT)).exclude(join_key_hash="").first()
    if site is None or not hmac.compare_digest(site.join_key_hash, offered):
        return None
    return Principal(username, True, offered)


def list_broker_hashes() -> dict[str, str]:
    """Return who has an account at the broker, with the hash that it keeps: by the accounts' names."""
    devices = Device.objects.exclude(broker_hash="").exclude(lifecycle=Device.Lifecycle.RETIRED)
    sites = Site.objects.exclude(join_broker_hash="").values_list("slug", "join_broker_hash")
    readers = {reader.name: reader.broker_hash for reader in list_readers(now=timezone.now())}
    joins = {ENROLMENT + slug: hashed for slug, hashed in sites}
    return {**readers, **joins, **dict(devices.values_list("pk", "broker_hash"))}


def list_account_sites() -> dict[str, str]:
    """Return the site of each device and of each token that opens the broker, by the names of their accounts."""
    readers = {reader.name: reader.site for reader in list_readers(now=timezone.now())}
    return {**readers, **dict(Device.objects.values_list("pk", "site__slug"))}


def find_ended(*, logins: Mapping[str, Login]) -> frozenset[str]:
    """Return which of these connections, by user name, must end.

    Those of devices that were taken out or forgotten, or have another key or other topics, and of keys and tokens that
    have ended.
    """
    facts = ("pk", "lifecycle", "credential_hash", "ends_before", "granted")
    rows = Device.objects.filter(pk__in=list(logins)).values_list(*facts)
    sites = Site.objects.filter(slug__in=[n.removeprefix(ENROLMENT) for n in logins if n.startswith(ENROLMENT)])
    keys = {ENROLMENT + slug: key for slug, key in sites.values_list("slug", "join_key_hash")}
    ended = {name for name, login in logins.items() if name.startswith(ENROLMENT) and keys.get(name) != login.key}
    if readers := {name for name in logins if is_reader(name)}:
        ended |= readers - {reader.name for reader in list_readers(now=timezone.now())}
    known = {name for name, *_ in rows}
    ended |= {name for name in logins if not (name in known or name in readers or name.startswith(ENROLMENT))}
    for name, lifecycle, key, ends_before, granted in rows:
        login = logins[name]
        is_out = lifecycle == Device.Lifecycle.RETIRED or (lifecycle == Device.Lifecycle.APPROVED and not key)
        is_old = bool(login.key and login.key != key) or bool(ends_before and login.at < ends_before)
        if is_out or is_old or login.topics != frozenset(granted.values()):
            ended.add(name)
    return frozenset(ended)

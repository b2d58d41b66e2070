"""How a device that nobody knows brings a key of its own: it knocks at a site's door with the site's join key.

Whoever has the join key can knock, and nothing else. A knock never changes a key that is known: so nobody can take an
id over, and a device that an admin has looked at is the one that knocked first.
"""

from __future__ import annotations

import hmac
from dataclasses import dataclass
from datetime import datetime, timedelta

from django.conf import settings
from django.db import transaction

from registry.alerts.buffer import note_alert
from registry.broker.accounts import Account, accounts
from registry.devices.history_texts import said
from registry.devices.rows import STARTS, BadDevice, check_id, forget_starts, write_event
from registry.models import Device, User
from registry.sites.sites import find_site
from vipo_device.protocol.credentials import (
    LEAST_CHARACTERS,
    MOST_CHARACTERS,
    broker_hash,
    is_strong,
    make_credential,
    secret_hash,
)
from vipo_device.protocol.faults import fault, refusal_facts
from vipo_device.protocol.messages import BadMessage, parse_json

MOST_NEWCOMERS = 200
FORGOTTEN_AFTER = timedelta(days=1)


def admit_newcomer(*, site: str, device_id: str, payload: bytes, at: datetime) -> bool:
    """Remember the key that a newcomer brings, and let it in as pending; False when it was known with this key.

    A device that was taken out may knock until it is let come back; nothing is made of that. Raises BadMessage,
    BadDevice, NotAMember, BrokerAway.
    """
    check_id(device_id)
    key = _read_key(payload)
    with transaction.atomic():
        row = find_site(site)
        device = Device.objects.select_for_update(of=("self",)).filter(pk=device_id).first()
        if device is not None and device.lifecycle == Device.Lifecycle.RETIRED:
            return False
        is_known = device is not None and hmac.compare_digest(device.credential_hash, secret_hash(key))
        if not is_known:
            device = device or make_row(device_id, row.pk, at)
            _require_keyless(device, row.pk)
            device.credential_hash, device.broker_hash = secret_hash(key), broker_hash(key)
            forget_starts(device)
            device.save(update_fields=["credential_hash", "broker_hash", *STARTS])
            write_event(device, at, "knocked", said("knocked"))
    accounts().put(Account(device_id, key))
    return not is_known


def make_row(device_id: str, site_id: int, at: datetime) -> Device:
    """Return a newcomer's locked row, made where there is room for it. Raises BadDevice, BrokerAway."""
    _make_room(site_id, at)
    device, _ = Device.objects.select_for_update(of=("self",)).get_or_create(
        pk=device_id, defaults={"site_id": site_id, "first_seen_at": at}
    )
    return device


def _read_key(payload: bytes) -> str:
    body = parse_json(payload)
    key = body.get("key") if isinstance(body, dict) else None
    if not isinstance(key, str) or not is_strong(key):
        raise BadMessage(fault("knock_key", least=LEAST_CHARACTERS, most=MOST_CHARACTERS))
    return key


def _make_room(site_id: int, at: datetime) -> None:
    """Forget who knocked long ago and never described itself; refuse more than 200 newcomers at a site."""
    waiting = Device.objects.filter(site_id=site_id, lifecycle=Device.Lifecycle.PENDING)
    gone = waiting.filter(description__isnull=True, last_seen_at__isnull=True, first_seen_at__lt=at - FORGOTTEN_AFTER)
    for device in gone:
        accounts().remove(device.pk)
        device.delete()
    if waiting.count() >= MOST_NEWCOMERS:
        raise BadDevice(*refusal_facts("newcomers", most=MOST_NEWCOMERS))


def _require_keyless(device: Device, site_id: int) -> None:
    if not device.credential_hash and device.lifecycle == Device.Lifecycle.APPROVED and device.site_id == site_id:
        raise BadDevice(*refusal_facts("knock_revoked", device=device.pk))
    if device.lifecycle != Device.Lifecycle.PENDING or device.credential_hash or device.site_id != site_id:
        note_alert(device_id=device.pk, code="foreign_knock")
        raise BadDevice(*refusal_facts("knock_foreign", device=device.pk))


@dataclass(frozen=True, slots=True)
class Expected:
    """What a device has to be set up with; `broker` is empty where VIPO_BROKER_URL does not say it."""

    id: str
    site: str
    credential: str
    broker: str


def expect_newcomer(*, site: str, device_id: str, by: User, at: datetime) -> Expected:
    """Reserve an id for a device that will come, and make its key, told this once.

    It still waits for approval once it has described itself; whoever does not come within a day is forgotten. A
    second call for a device that has not come yet makes a new key, and the one before ends.

    Raises:
        BadDevice: the id cannot be, belongs to a device that is known, or 200 newcomers wait already.
        NotAMember, BrokerAway.
    """
    check_id(device_id)
    credential = make_credential()
    with transaction.atomic():
        row = find_site(site)
        device = Device.objects.select_for_update(of=("self",)).filter(pk=device_id).first()
        device = device or make_row(device_id, row.pk, at)
        _require_unknown(device, row.pk)
        device.credential_hash, device.broker_hash = secret_hash(credential), broker_hash(credential)
        device.first_seen_at = at
        device.save(update_fields=["credential_hash", "broker_hash", "first_seen_at"])
        write_event(device, at, "expected", said("expected"), by)
        accounts().put(Account(device_id, credential))
    return Expected(device_id, site, credential, str(settings.VIPO_BROKER_URL))


def _require_unknown(device: Device, site_id: int) -> None:
    if device.site_id != site_id:
        raise BadDevice(f"The id {device.pk} is taken. Choose another one.")
    waits = device.lifecycle == Device.Lifecycle.PENDING
    if not waits or device.description is not None or device.last_seen_at is not None:
        raise BadDevice(f"{device.pk} is known at this site already. Choose another id, or give that device a new key.")

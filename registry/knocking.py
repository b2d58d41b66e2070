"""How a device that nobody knows brings a key of its own: it knocks at a site's door with the site's join key.

Whoever has the join key can knock, and nothing else. A knock never changes a key that is known: so nobody can take an
id over, and a device that an admin has looked at is the one that knocked first.
"""

from __future__ import annotations

import hmac
from datetime import datetime, timedelta

from django.db import transaction

from registry.alert_notes import note_alert
from registry.broker_accounts import Account, accounts
from registry.credentials import LEAST_CHARACTERS, MOST_CHARACTERS, broker_hash, is_strong, secret_hash
from registry.device_rows import STARTS, BadDevice, check_id, forget_starts, write_event
from registry.event_words import said
from registry.faults import fault, told
from registry.models import Device
from registry.sites import find_site
from registry.wire import BadMessage, parse_json

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
        raise BadDevice(*told("newcomers", most=MOST_NEWCOMERS))


def _require_keyless(device: Device, site_id: int) -> None:
    if not device.credential_hash and device.lifecycle == Device.Lifecycle.APPROVED and device.site_id == site_id:
        raise BadDevice(*told("knock_revoked", device=device.pk))
    if device.lifecycle != Device.Lifecycle.PENDING or device.credential_hash or device.site_id != site_id:
        note_alert(device_id=device.pk, code="foreign_knock")
        raise BadDevice(*told("knock_foreign", device=device.pk))

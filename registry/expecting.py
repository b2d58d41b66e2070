"""How an admin adds a device before it comes: its id is reserved, and its key told once."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from django.conf import settings
from django.db import transaction

from registry.broker_accounts import Account, accounts
from registry.credentials import broker_hash, make_credential, secret_hash
from registry.device_rows import BadDevice, check_id, write_event
from registry.event_words import said
from registry.knocking import make_row
from registry.models import Device, User
from registry.sites import find_site


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

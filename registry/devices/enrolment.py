"""How a device that nobody knows comes in: it brings a key of its own, sent with the enrolment key of a site.

Whoever has the enrolment key can ask to be enrolled, and nothing else. That never changes a key that is known: so
nobody can take an id over, and a device that an admin has looked at is the one that came first. People may also
reserve an id, and then hand the device its key themselves.
"""

from __future__ import annotations

import hmac
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

from django.conf import settings
from django.db import transaction
from django.db.models import Q

from registry.alerts.buffer import note_alert
from registry.audit.actor import VIPO
from registry.audit.record import device_acts, note_act
from registry.broker.accounts import Account, accounts
from registry.devices.history import history_text, write_event
from registry.devices.rows import STARTS, BadDevice, check_id, forget_starts
from registry.errors import RegistryError
from registry.models import AuditLine, Device, DeviceEvent, Site, User
from registry.sites.namespaces import may_have_device
from registry.sites.sites import find_site
from vipo_device.protocol.credentials import (
    LEAST_CHARACTERS,
    MOST_CHARACTERS,
    broker_hash,
    is_strong,
    make_credential,
    secret_hash,
)
from vipo_device.protocol.faults import fault, printable, refusal_facts
from vipo_device.protocol.messages import BadMessage, parse_json

MOST_PENDING = 200
FORGOTTEN_AFTER = timedelta(days=1)
TURNED_AWAY = "device_turned_away"
TOLD_AGAIN_AFTER = timedelta(days=1)
MOST_TOLD = 50
"""So many ids that were refused stand in a site's record of a day."""
JUST_NOW = timedelta(seconds=10)
"""So long after a key was given nobody else gives another: whoever was told the first would hold one that has ended."""


class AlreadyReserved(RegistryError):
    """An id that has a key already, which nobody ends unless they say so, and not within seconds."""

    code = "already_reserved"
    status = 409


class NotOfSite(BadDevice):
    """An id that is not the site's to give; whose it is, if anybody's, is not said."""


def enrol_device(*, site: str, device_id: str, payload: bytes, at: datetime) -> bool:
    """Remember the key that a device brings, and let it in as pending; False when it was known with this key.

    A device that was taken out may ask again until it is let come back; nothing is made of that. Nobody can answer who
    asks here, so a refusal is told to the site's admins, in its record.

    Raises BadMessage, BadDevice, NotAMember, BrokerAway.
    """
    try:
        return _enrol(site, device_id, payload, at)
    except (BadMessage, BadDevice) as error:
        _note_turned_away(site, device_id, error, at)
        raise


def _enrol(site: str, device_id: str, payload: bytes, at: datetime) -> bool:
    check_id(device_id)
    with transaction.atomic():
        row = find_site(site)
        device = _find_own(row, device_id)  # before the key: of another site's device nothing else is told
        key = _read_key(payload)
        if device is not None and device.lifecycle == Device.Lifecycle.RETIRED:
            return False
        is_news = device is None or not hmac.compare_digest(device.credential_hash, secret_hash(key))
        device = device or make_pending_device(device_id, row.pk, at)
        if is_news:
            _keep_key(device, key, at)
        # under the lock: whoever revokes the key meanwhile takes the account away after this
        accounts().put(Account(device_id, key, tuple(sorted(device.granted.values())), site))
    return is_news


def _keep_key(device: Device, key: str, at: datetime) -> None:
    """Write the key that a device has brought into its locked row. Raises BadDevice."""
    _require_keyless(device)
    device.credential_hash, device.broker_hash = secret_hash(key), broker_hash(key)
    forget_starts(device)
    device.save(update_fields=["credential_hash", "broker_hash", *STARTS])
    write_event(device, at, "knocked", history_text("knocked"))
    note_act(site_id=device.site_id, code="device_asked", actor=device_acts(device.pk))


def _note_turned_away(site: str, device_id: str, refusal: BadMessage | BadDevice, at: datetime) -> None:
    """Write into a site's record that somebody was refused, and why: of each id once a day, of so many ids at most.

    Devices ask again and again, and whoever has the enrolment key may name any id.
    """
    row = Site.objects.filter(slug=site).first()
    if row is None:
        return
    because = "knock_key" if isinstance(refusal, BadMessage) else refusal.facts["faults"][0]["code"]
    asked = printable(device_id)[:64]
    lines = AuditLine.objects.filter(site=row, kind="devices", code=TURNED_AWAY, at__gt=at - TOLD_AGAIN_AFTER)
    told = [facts["device"] for facts in lines.values_list("facts", flat=True)[:MOST_TOLD]]
    if len(told) < MOST_TOLD and asked not in told:
        note_act(site_id=row.pk, code=TURNED_AWAY, facts={"device": asked, "because": because}, actor=VIPO, at=at)


def _find_own(site: Site, device_id: str) -> Device | None:
    """Return the locked row of a site's own device, None where there is none and one of that id may come.

    Raises NotOfSite in the same words whether the id is another site's or could be.
    """
    device = Device.objects.select_for_update(of=("self",)).filter(pk=device_id).first()
    if not may_have_device(site, device_id, device.site_id if device else None):
        raise NotOfSite(*refusal_facts("id_of_site", device=device_id, site=site.slug))
    return device


def make_pending_device(device_id: str, site_id: int, at: datetime) -> Device:
    """Return a pending device's locked row, made where there is room for it. Raises BadDevice, BrokerAway."""
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
    """Forget who enrolled, never described itself so that it could be read, and has not been heard of for a day.

    Refuse more than 200 pending devices at a site.
    """
    waiting = Device.objects.filter(site_id=site_id, lifecycle=Device.Lifecycle.PENDING)
    long_ago = at - FORGOTTEN_AFTER
    gone = waiting.filter(description__isnull=True, first_seen_at__lt=long_ago)
    gone = gone.filter(Q(last_seen_at=None) | Q(last_seen_at__lt=long_ago))
    for device in gone.select_for_update(of=("self",)).order_by("pk"):  # who describes itself just now stays
        accounts().remove(device.pk)
        device.delete()
    if waiting.count() >= MOST_PENDING:
        raise BadDevice(*refusal_facts("newcomers", most=MOST_PENDING))


def _require_keyless(device: Device) -> None:
    if not device.credential_hash and device.lifecycle == Device.Lifecycle.APPROVED:
        raise BadDevice(*refusal_facts("knock_revoked", device=device.pk))
    if device.lifecycle != Device.Lifecycle.PENDING or device.credential_hash:
        note_alert(device_id=device.pk, code="foreign_knock")
        raise BadDevice(*refusal_facts("knock_foreign", device=device.pk))


@dataclass(frozen=True, slots=True)
class ReservedDevice:
    """What a device has to be set up with; `broker` is empty where VIPO_BROKER_URL does not say it."""

    id: str
    site: str
    credential: str
    broker: str


def reserve_device(*, site: str, device_id: str, by: User, at: datetime, again: bool = False) -> ReservedDevice:
    """Reserve an id for a device that will come, and make its key, told this once.

    It still waits for approval once it has described itself; whoever does not within a day is forgotten. With `again` a
    device that has not described itself yet gets another key, and the one before ends; not within seconds of that. It
    may then count its starts from any number: what of it was heard before is forgotten.

    Raises:
        AlreadyReserved: somebody else has added it, or it has brought a key of its own, and `again` does not hold.
        BadDevice: the id cannot be, is not the site's, belongs to a device that is known or just there, or 200 devices
            wait already.
        NotAMember, BrokerAway.
    """
    check_id(device_id)
    credential = make_credential()
    with transaction.atomic():
        row = find_site(site)
        device = _find_own(row, device_id)
        device = device or make_pending_device(device_id, row.pk, at)
        _require_unknown(device)
        _require_no_key_of_others(device, at, again=again)
        device.credential_hash, device.broker_hash = secret_hash(credential), broker_hash(credential)
        device.first_seen_at, device.last_seen_at = at, None
        forget_starts(device)
        device.save(update_fields=["credential_hash", "broker_hash", "first_seen_at", "last_seen_at", *STARTS])
        write_event(device, at, "expected", history_text("expected"), by)
        accounts().put(Account(device_id, credential, site=site))
    return ReservedDevice(device_id, site, credential, str(settings.VIPO_BROKER_URL))


def _require_unknown(device: Device) -> None:
    """Refuse to add what has described itself, and what is there: it may do so any moment."""
    if device.lifecycle != Device.Lifecycle.PENDING or device.description is not None:
        raise BadDevice(f"{device.pk} is known at this site already. Choose another id, or give that device a new key.")
    if device.online:
        raise BadDevice(
            f"{device.pk} is connected just now, but has not described itself. Mend its description, or disconnect it "
            "and wait a minute. You may also choose another id."
        )


def _require_no_key_of_others(device: Device, at: datetime, *, again: bool) -> None:
    """Refuse to end a key that somebody was told, in words that say who has it and since when."""
    if not device.credential_hash:
        return
    event = DeviceEvent.objects.filter(device=device, kind__in=_BRINGS_KEY).order_by("-pk").first()
    given_at = event.at if event else device.first_seen_at
    if again and (given_at is None or abs(at - given_at) >= JUST_NOW):
        return
    who = event.by.display_name if event and event.by else ""
    when = given_at.astimezone(UTC).strftime("%Y-%m-%d %H:%M") if given_at else "?"
    why = "reserved_just_now" if again else "reserved_before" if who else "knocked_before"
    raise AlreadyReserved(*refusal_facts(why, device=device.pk, by=who or device.pk, at=when))


_BRINGS_KEY = ("expected", "knocked")


def expect_device(*, site: str, device_id: str, credential: str, approved: bool = True) -> None:
    """Let a device that is not there yet come in with its own key, approved beforehand or still to be looked at.

    A key that people have replaced or revoked does not come back this way.
    """
    check_id(device_id)
    if len(credential) < 20:
        raise BadDevice("A device's key needs at least 20 characters; make it at random.")
    lifecycle = Device.Lifecycle.APPROVED if approved else Device.Lifecycle.PENDING
    with transaction.atomic():
        device, made = Device.objects.select_for_update(of=("self",)).get_or_create(
            pk=device_id, defaults={"site": find_site(site), "lifecycle": lifecycle}
        )
        if not made and device.site.slug != site:
            raise BadDevice(f"The device {device_id} belongs to another site.")
        if device.ends_before is None:
            _remember_key(device, credential)


def _remember_key(device: Device, credential: str) -> None:
    """Write a key's two hashes; one that is known already keeps its salt."""
    if device.credential_hash != secret_hash(credential) or not device.broker_hash:
        device.credential_hash, device.broker_hash = secret_hash(credential), broker_hash(credential)
        device.save(update_fields=["credential_hash", "broker_hash"])

"""What admins decide about a device: to let it in, to turn it away, to take it out, to let it come back.

Each decision is taken once: the row is locked, and the second of two admins is told what the first one decided. The
broker learns of it within the same transaction; when it does not answer, nothing is decided.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timedelta

from django.conf import settings
from django.db import transaction

from registry.broker.accounts import Account, accounts
from registry.devices.history_texts import said
from registry.devices.joining import DOOR, list_broker_hashes
from registry.devices.key_delivery import ANSWER_LIMIT_S, CONNECT_LIMIT_S, hand_over
from registry.devices.legacy_topics import claim_again, release_topics
from registry.devices.rows import STARTS, BadDevice, announce, check_id, forget_starts, lock_device, write_event
from registry.devices.thing_events import record_thing
from registry.devices.views import DeviceView, view_of
from registry.errors import RegistryError
from registry.live.fanout import publish
from registry.models import Device, User
from registry.sites.sites import find_site, set_join_key
from vipo_device.protocol.credentials import broker_hash, make_credential, secret_hash

Lifecycle = Device.Lifecycle
TELLING_LIMIT = timedelta(seconds=CONNECT_LIMIT_S + ANSWER_LIMIT_S + 5)
"""Whoever tells a device a key and has not come back after so long has died over it."""


class NotPending(RegistryError):
    """A decision about a device that does not wait for one."""

    code = "not_pending"
    status = 409


class NotApproved(RegistryError):
    """A decision about a device that does not take part, or not any more."""

    code = "not_approved"
    status = 409


class NotRetired(RegistryError):
    """A device that is let back in though it was not taken out."""

    code = "not_retired"
    status = 409


class KeyChanged(RegistryError):
    """A key that somebody else replaces, or has replaced or taken away while it was being replaced."""

    code = "key_changed"
    status = 409


@dataclass(frozen=True, slots=True)
class Decided:
    """A device after a decision; `credential` is its new key, told this once, `taken` whether it has it already."""

    device: DeviceView
    credential: str | None = None
    taken: bool = False


def approve_device(*, site: str, device_id: str, by: User | None, at: datetime) -> Decided:
    """Let a pending device take part, with a key of its own. Raises NoSuchDevice, NotPending, BrokerAway.

    One that came with the join key gets a key at once; one that came with its own keeps that unless it takes the new
    one over MQTT.
    """
    credential = make_credential()
    with transaction.atomic():
        device = lock_device(site, device_id)
        _require_pending(device)
        had_own_key = bool(device.credential_hash)
        before = view_of(device, site)
        device.lifecycle = Lifecycle.APPROVED
        if not had_own_key:
            _give_key(device, credential)
        device.key_told_at = at if device.online else None
        device.save(update_fields=["lifecycle", "credential_hash", "broker_hash", "key_told_at"])
        write_event(device, at, "approved", said("approved"), by)
        after = view_of(device, site)
        announce(before, after)
    taken = after.online and hand_over(device_id=device_id, credential=credential)
    if had_own_key and taken:
        after = _replace_key(site, device_id, credential, by, at, device.credential_hash)
    else:
        Device.objects.filter(pk=device_id, key_told_at=at).update(key_told_at=None)
    return Decided(after, None if had_own_key and not taken else credential, taken)


def reject_device(*, site: str, device_id: str, by: User | None, at: datetime) -> DeviceView:
    """Turn a pending device away; it may not connect again. Raises NoSuchDevice, NotPending, BrokerAway."""
    return _take_out(site, device_id, "rejected", by, at, _require_pending)


def retire_device(*, site: str, device_id: str, by: User | None, at: datetime) -> DeviceView:
    """Take an approved device out; its history stays. Raises NoSuchDevice, NotApproved, BrokerAway."""
    return _take_out(site, device_id, "retired", by, at, _require_approved)


def readmit_device(*, site: str, device_id: str, by: User | None, at: datetime) -> DeviceView:
    """Let a retired device's id come back, as a newcomer without a key. Raises NoSuchDevice, NotRetired."""
    with transaction.atomic():
        device = lock_device(site, device_id)
        if device.lifecycle != Lifecycle.RETIRED:
            raise NotRetired(f"{device_id} was not taken out; it is {device.lifecycle}.")
        device.lifecycle, device.ends_before = Lifecycle.PENDING, None
        forget_starts(device)
        device.save(update_fields=["lifecycle", "ends_before", *STARTS])
        write_event(device, at, "readmitted", said("readmitted"), by)
        claim_again(device, at)
        after = view_of(device, site)
        announce(None, after)
    return after


def rotate_credential(*, site: str, device_id: str, by: User | None, at: datetime) -> Decided:
    """Give an approved device a new key; the old one ends when the device has taken it, after 10 s at the latest.

    Of two admins at once one does so. Raises NoSuchDevice, NotApproved, KeyChanged, BrokerAway.
    """
    with transaction.atomic():
        device = lock_device(site, device_id)
        _require_approved(device)
        _begin_telling(device, at)
    credential = make_credential()
    taken = device.online and hand_over(device_id=device_id, credential=credential)
    return Decided(_replace_key(site, device_id, credential, by, at, device.credential_hash), credential, taken)


def revoke_credential(*, site: str, device_id: str, by: User | None, at: datetime) -> DeviceView:
    """Take an approved device's key away and end its connection. Raises NoSuchDevice, NotApproved, BrokerAway."""
    with transaction.atomic():
        device = lock_device(site, device_id)
        _require_approved(device)
        before = view_of(device, site)
        _lock_out(device, at)
        device.save(update_fields=["credential_hash", "broker_hash", "ends_before", "online"])
        write_event(device, at, "revoked", said("revoked"), by)
        after = view_of(device, site)
        announce(before, after)
    return after


def expect_device(*, site: str, device_id: str, credential: str, approved: bool = True) -> None:
    """Let a device that is not there yet come in with its own key, approved beforehand or still to be looked at.

    A key that people have replaced or revoked does not come back this way.
    """
    check_id(device_id)
    if len(credential) < 20:
        raise BadDevice("A device's key needs at least 20 characters; make it at random.")
    lifecycle = Lifecycle.APPROVED if approved else Lifecycle.PENDING
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


def renew_join_key(*, site: str) -> str:
    """Give a site's door a new key and return it this once; the old one ends. Raises NotAMember, BrokerAway."""
    key = make_credential()
    with transaction.atomic():
        set_join_key(site=site, join_key=key)
        accounts().put(Account(DOOR + site, key))
    return key


def reconcile_accounts() -> tuple[frozenset[str], frozenset[str]]:
    """Take accounts away from the broker that the registry does not know. Raises BrokerAway.

    Returns those, and the ones that the broker does not have though it should: it has to be given them by their
    hashes, in its file (`manage.py broker_accounts`).
    """
    there = accounts().names()
    if there is None:
        return frozenset(), frozenset()
    removed = {name for name in there - {str(settings.VIPO_MQTT["username"])} if _remove_unknown(name)}
    return frozenset(removed), frozenset(list_broker_hashes()) - there


def _remove_unknown(name: str) -> bool:
    """Remove an account unless it is known, also by a decision that is just being taken."""
    if name in list_broker_hashes():
        return False
    with transaction.atomic():
        Device.objects.select_for_update().filter(pk=name).first()
        if name in list_broker_hashes():
            return False
        accounts().remove(name)
    return True


def _begin_telling(device: Device, at: datetime) -> None:
    """Be the only one who gives the device a key: of two that it is told in turn it would keep the later one."""
    if device.key_told_at is not None and at - device.key_told_at < TELLING_LIMIT:
        raise KeyChanged(
            f"Somebody else is giving {device.id} a new key just now. Look at it again in half a minute, then decide."
        )
    device.key_told_at = at
    device.save(update_fields=["key_told_at"])


def _replace_key(
    site: str, device_id: str, credential: str, by: User | None, at: datetime, replaces: str
) -> DeviceView:
    """Put a key in the place of the one with the hash `replaces`. Raises NotApproved, KeyChanged, BrokerAway."""
    with transaction.atomic():
        device = lock_device(site, device_id)
        _require_approved(device)
        if device.credential_hash != replaces:
            raise KeyChanged(
                f"Somebody else has given {device_id} another key meanwhile, or has taken its key away. "
                "Look at it again, then decide."
            )
        before = view_of(device, site)
        _give_key(device, credential)
        device.ends_before, device.key_told_at = at, None
        if not device.online:
            forget_starts(device)
        device.save(update_fields=["credential_hash", "broker_hash", "ends_before", "key_told_at", *STARTS])
        write_event(device, at, "credential", said("credential"), by)
        after = view_of(device, site)
        announce(before, after)
    return after


def _give_key(device: Device, credential: str) -> None:
    device.credential_hash, device.broker_hash = secret_hash(credential), broker_hash(credential)
    accounts().put(Account(device.id, credential, tuple(sorted(device.granted.values()))))


def _lock_out(device: Device, at: datetime) -> None:
    device.credential_hash = device.broker_hash = ""
    device.ends_before, device.online = at, False
    accounts().remove(device.id)


def _take_out(
    site: str, device_id: str, word: str, by: User | None, at: datetime, allowed: Callable[[Device], None]
) -> DeviceView:
    with transaction.atomic():
        device = lock_device(site, device_id)
        allowed(device)
        before = view_of(device, site)
        device.lifecycle = Lifecycle.RETIRED
        _lock_out(device, at)
        device.save(update_fields=["lifecycle", "credential_hash", "broker_hash", "ends_before", "online"])
        release_topics(device, at)
        write_event(device, at, "retired", said(word), by)
        transaction.on_commit(lambda: publish(site, {"type": "device_removed", "id": device_id}))
        after = view_of(device, site)
        record_thing(before, after)
    return after


def _require_pending(device: Device) -> None:
    if device.lifecycle != Lifecycle.PENDING:
        raise NotPending(f"{device.id} does not wait for a decision; it is {device.lifecycle}.")


def _require_approved(device: Device) -> None:
    if device.lifecycle != Lifecycle.APPROVED:
        raise NotApproved(f"{device.id} does not take part; it is {device.lifecycle}.")

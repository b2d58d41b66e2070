"""Keys of devices: given, replaced, taken away, and delivered over the device's own connection.

A new key is said once on the device's own `down/credential`, never retained, and kept nowhere on the way; only the
connection that came in as this device may hear that topic.
"""

from __future__ import annotations

import json
import logging
import secrets
import threading
import uuid
from dataclasses import dataclass
from datetime import datetime, timedelta

from django.conf import settings
from django.db import transaction

from registry.audit.record import note_act
from registry.broker.accounts import Account, accounts
from registry.broker.mosquitto_file import ENROLMENT
from registry.devices.authentication import list_broker_hashes
from registry.devices.enrolment import JUST_NOW
from registry.devices.history import history_text, note_decision, write_event
from registry.devices.rows import STARTS, announce, forget_starts, lock_device
from registry.devices.samples import write_when_committed
from registry.devices.views import DeviceView, view_of
from registry.errors import RegistryError
from registry.models import Device, Site, User
from registry.sites.sites import find_site, get_enrolment_key, has_enrolment_key, replace_enrolment_key
from vipo_device.protocol.credentials import broker_hash, make_credential, own_key, secret_hash
from vipo_device.protocol.errors import MqttError
from vipo_device.protocol.messages import BadMessage, down_topic, is_device_id, parse_ack, up_topic
from vipo_device.protocol.mqtt_client import MqttClient
from vipo_device.protocol.topics import OWN_ACCOUNTS

log = logging.getLogger(__name__)
CONNECT_LIMIT_S = 10.0
ANSWER_LIMIT_S = 10.0
FINAL = frozenset({"DONE", "FAILED", "REJECTED", "CANCELED"})


def deliver_key(*, device_id: str, credential: str) -> bool:
    """Say a device its new key, and tell whether it answered within 10 s that it has taken it."""
    command = str(uuid.uuid4())
    answered = threading.Event()
    answers: list[str] = []

    def hear(_topic: str, payload: bytes, _retained: bool) -> None:
        try:
            ack = parse_ack(payload)
        except BadMessage:
            return
        if ack.command == command and ack.status in FINAL:
            answers.append(ack.status)
            answered.set()

    try:
        client = MqttClient.from_settings(settings.VIPO_MQTT, client_id=f"keys-{secrets.token_hex(6)}")
    except MqttError as error:
        log.warning("%s was not told its new key: %s", device_id, error.detail)
        return False
    client.subscribe(up_topic(device_id, "ack"), 1, hear)
    client.start()
    try:
        if client.wait_subscribed(CONNECT_LIMIT_S):
            body = {"id": command, "v": {"credential": credential}, "ttl_s": ANSWER_LIMIT_S}
            client.publish(down_topic(device_id, "credential"), json.dumps(body).encode(), expiry_s=ANSWER_LIMIT_S)
            answered.wait(ANSWER_LIMIT_S)
    finally:
        client.stop()
    return answers[:1] == ["DONE"]


DELIVERY_LIMIT = timedelta(seconds=CONNECT_LIMIT_S + ANSWER_LIMIT_S + 5)
"""Whoever tells a device a key and has not come back after so long has died over it."""


class KeyChanged(RegistryError):
    """A key that somebody else replaces, or has replaced or taken away while it was being replaced."""

    code = "key_changed"
    status = 409


class NotApproved(RegistryError):
    """A decision about a device that does not take part, or not any more."""

    code = "not_approved"
    status = 409


@dataclass(frozen=True, slots=True)
class Decided:
    """A device after a decision; `credential` is its new key, told this once, `taken` whether it has it already."""

    device: DeviceView
    credential: str | None = None
    taken: bool = False


def rotate_credential(*, site: str, device_id: str, by: User | None, at: datetime) -> Decided:
    """Give an approved device a new key; the old one ends when the device has taken it, after 10 s at the latest.

    Of two admins at once one does so. Raises NoSuchDevice, NotApproved, KeyChanged, BrokerAway.
    """
    with transaction.atomic():
        device = lock_device(site, device_id)
        require_approved(device)
        _begin_delivery(device, at)
    credential = make_credential()
    taken = device.is_connected and deliver_key(device_id=device_id, credential=credential)
    return Decided(replace_key(site, device_id, credential, by, at, device.credential_hash), credential, taken)


def revoke_credential(*, site: str, device_id: str, by: User | None, at: datetime) -> DeviceView:
    """Take an approved device's key away and end its connection. Raises NoSuchDevice, NotApproved, BrokerAway."""
    with transaction.atomic():
        device = lock_device(site, device_id)
        require_approved(device)
        before = view_of(device, site)
        lock_out(device, at)
        device.save(update_fields=["credential_hash", "broker_hash", "ends_before", "online", "aside"])
        write_event(device, at, "revoked", history_text("revoked"), by)
        note_decision(device, "device_key_revoked")
        after = view_of(device, site)
        announce(before, after)
        write_when_committed(before=before, after=after, at=at)
    return after


def renew_enrolment_key(*, site: str) -> str:
    """Give a site a new enrolment key and return it; the old one ends. Raises NotAMember, BrokerAway.

    People who do so within seconds of each other are told the same key.
    """
    with transaction.atomic():
        key = replace_enrolment_key(site=site, key=make_credential())
        note_act(site_id=find_site(site).pk, code="enrolment_key_renewed")
        accounts().put(Account(ENROLMENT + site, key))
    return key


def show_enrolment_key(*, site: str) -> str:
    """Return a site's enrolment key; a site that has none yet gets its first one.

    Raises NoEnrolmentKey where its hash alone is known, NotAMember, BrokerAway.
    """
    return get_enrolment_key(site=site) if has_enrolment_key(site=site) else renew_enrolment_key(site=site)


def reconcile_accounts() -> tuple[frozenset[str], frozenset[str]]:
    """Take accounts away from the broker that the registry does not know. Raises BrokerAway.

    Returns those, and the ones that the broker does not have though it should: it has to be given them by their
    hashes, in its file (`manage.py broker_accounts`).
    """
    there = accounts().names()
    if there is None:
        return frozenset(), frozenset()
    _allow_anew(accounts().find_outdated())
    for name in set(OWN_ACCOUNTS) - there:  # the broker's file is older than this process
        accounts().put(Account(name, own_key(name, str(settings.VIPO_MQTT["password"]))))
    own = {str(settings.VIPO_MQTT["username"]), *OWN_ACCOUNTS}
    removed = {name for name in there - own if _remove_unknown(name)}
    return frozenset(removed), frozenset(list_broker_hashes()) - there


def _allow_anew(outdated: frozenset[str]) -> None:
    """Let devices hear no more than they may today."""
    for device in Device.objects.filter(pk__in=outdated).select_related("site"):
        accounts().allow(device.pk, device.site.slug, tuple(sorted(device.granted.values())))


def _remove_unknown(name: str) -> bool:
    """Remove an account unless it is known, also by a decision that is just being taken."""
    if name in list_broker_hashes():
        return False
    with transaction.atomic():
        _wait_for_decisions(name)
        is_known = name in list_broker_hashes()
        if not is_known:
            accounts().remove(name)
        transaction.set_rollback(True)
    return not is_known


def _wait_for_decisions(name: str) -> None:
    """Let nobody decide about an account until the transaction ends, and wait for who is about to.

    A decision gives the broker the account before it is committed. The row of a device that is only being made cannot
    be locked, but who makes one of the same id waits for it; the caller takes that row, of no site, back.
    """
    if name.startswith(ENROLMENT):
        Site.objects.select_for_update().filter(slug=name.removeprefix(ENROLMENT)).first()
    elif is_device_id(name):
        Device.objects.bulk_create([Device(pk=name, site_id=0)], ignore_conflicts=True)
        Device.objects.select_for_update().filter(pk=name).first()


def _begin_delivery(device: Device, at: datetime) -> None:
    """Be the only one who gives the device a key: of two that it is told in turn it would keep the later one."""
    if device.key_told_at is not None and at - device.key_told_at < DELIVERY_LIMIT:
        raise KeyChanged(
            f"Somebody else is giving {device.id} a new key just now. Look at it again in half a minute, then decide."
        )
    is_new = device.ends_before is not None and timedelta(0) < at - device.ends_before < JUST_NOW
    if is_new and device.credential_hash:
        raise KeyChanged(f"Somebody else has just given {device.id} a new key. Ask them for it, or wait ten seconds.")
    device.key_told_at = at
    device.save(update_fields=["key_told_at"])


def replace_key(site: str, device_id: str, credential: str, by: User | None, at: datetime, replaces: str) -> DeviceView:
    """Put a key in the place of the one with the hash `replaces`. Raises NotApproved, KeyChanged, BrokerAway."""
    with transaction.atomic():
        device = lock_device(site, device_id)
        require_approved(device)
        if device.credential_hash != replaces:
            raise KeyChanged(
                f"Somebody else has given {device_id} another key meanwhile, or has taken its key away. "
                "Look at it again, then decide."
            )
        before = view_of(device, site)
        give_key(device, credential)
        device.ends_before, device.key_told_at = at, None
        if not device.is_connected:
            forget_starts(device)
        device.save(update_fields=["credential_hash", "broker_hash", "ends_before", "key_told_at", "aside", *STARTS])
        write_event(device, at, "credential", history_text("credential"), by)
        note_decision(device, "device_key_given")
        after = view_of(device, site)
        announce(before, after)
    return after


def give_key(device: Device, credential: str) -> None:
    """Put a key into a locked row and the broker's account; the caller saves the row. Raises BrokerAway."""
    device.credential_hash, device.broker_hash = secret_hash(credential), broker_hash(credential)
    accounts().put(Account(device.id, credential, tuple(sorted(device.granted.values())), device.site.slug))


def lock_out(device: Device, at: datetime) -> None:
    """Take the key out of a locked row and the account from the broker; the caller saves the row. Raises BrokerAway."""
    device.credential_hash = device.broker_hash = ""
    device.ends_before = at
    if device.stand_in:
        device.aside = {**(device.aside or {}), "online": False}
    else:
        device.online = False
    accounts().remove(device.id)


def require_approved(device: Device) -> None:
    """Raise NotApproved for a device that does not take part."""
    if device.lifecycle != Device.Lifecycle.APPROVED:
        raise NotApproved(f"{device.id} does not take part; it is {device.lifecycle}.")

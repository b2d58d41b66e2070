"""What admins decide about a device: to let it in, to turn it away, to take it out, to name and place it.

Each decision is taken once: the row is locked, and the second of two admins is told what the first one decided. The
broker learns of it within the same transaction; when it does not answer, nothing is decided.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from datetime import datetime

from django.db import transaction

from registry.devices.credentials import (
    Decided,
    NotApproved,
    deliver_key,
    give_key,
    lock_out,
    replace_key,
    require_approved,
)
from registry.devices.history import HistoryText, history_text, note_decision, write_event
from registry.devices.legacy_topics import claim_again, release_topics
from registry.devices.rows import STARTS, BadDevice, announce, forget_starts, lock_device
from registry.devices.samples import write_when_committed
from registry.devices.things import record_thing
from registry.devices.views import DeviceView, NewPlace, view_of
from registry.errors import RegistryError
from registry.live.fanout import publish
from registry.models import Device, Place, User
from vipo_device.protocol.credentials import make_credential
from vipo_device.protocol.description import Pose
from vipo_device.protocol.faults import refusal_facts
from vipo_device.protocol.texts import find_unfit, normal

Lifecycle = Device.Lifecycle


class NotPending(RegistryError):
    """A decision about a device that does not wait for one."""

    code = "not_pending"
    status = 409


class NotRetired(RegistryError):
    """A device that is let back in though it was not taken out."""

    code = "not_retired"
    status = 409


class IsSimulated(RegistryError):
    """A decision about a device for which a stand-in speaks."""

    code = "is_simulated"
    status = 409


def approve_device(*, site: str, device_id: str, by: User | None, at: datetime) -> Decided:
    """Let a pending device take part, with a key of its own.

    Raises NoSuchDevice, NotPending, BrokerAway, and BadDevice where a place of the site has its id.

    One that came with the enrolment key gets a key at once; one that came with its own keeps that unless it takes the
    new one over MQTT.
    """
    credential = make_credential()
    with transaction.atomic():
        device = lock_device(site, device_id)
        _require_pending(device)
        _require_no_place(device)
        had_own_key = bool(device.credential_hash)
        before = view_of(device, site)
        device.lifecycle = Lifecycle.APPROVED
        if not had_own_key:
            give_key(device, credential)
        device.key_told_at = at if device.online else None
        device.save(update_fields=["lifecycle", "credential_hash", "broker_hash", "key_told_at"])
        write_event(device, at, "approved", history_text("approved"), by)
        note_decision(device, "device_approved")
        after = view_of(device, site)
        announce(before, after)
        write_when_committed(before=before, after=after, at=at)
    taken = after.online and deliver_key(device_id=device_id, credential=credential)
    if had_own_key and taken:
        after = replace_key(site, device_id, credential, by, at, device.credential_hash)
    else:
        Device.objects.filter(pk=device_id, key_told_at=at).update(key_told_at=None)
    return Decided(after, None if had_own_key and not taken else credential, taken)


def reject_device(*, site: str, device_id: str, by: User | None, at: datetime) -> DeviceView:
    """Turn a pending device away; it may not connect again. Raises NoSuchDevice, NotPending, BrokerAway."""
    return _take_out(site, device_id, "rejected", by, at, _require_pending)


def retire_device(*, site: str, device_id: str, by: User | None, at: datetime) -> DeviceView:
    """Take an approved device out; its history stays. Raises NoSuchDevice, NotApproved, IsSimulated, BrokerAway."""
    return _take_out(site, device_id, "retired", by, at, require_approved)


def readmit_device(*, site: str, device_id: str, by: User | None, at: datetime) -> DeviceView:
    """Let a retired device's id come back, pending and without a key. Raises NoSuchDevice, NotRetired."""
    with transaction.atomic():
        device = lock_device(site, device_id)
        if device.lifecycle != Lifecycle.RETIRED:
            raise NotRetired(f"{device_id} was not taken out; it is {device.lifecycle}.")
        device.lifecycle, device.ends_before = Lifecycle.PENDING, None
        forget_starts(device)
        device.save(update_fields=["lifecycle", "ends_before", *STARTS])
        write_event(device, at, "readmitted", history_text("readmitted"), by)
        note_decision(device, "device_readmitted")
        claim_again(device, at)
        after = view_of(device, site)
        announce(None, after)
    return after


def _take_out(
    site: str, device_id: str, word: str, by: User | None, at: datetime, allowed: Callable[[Device], None]
) -> DeviceView:
    with transaction.atomic():
        device = lock_device(site, device_id)
        allowed(device)
        if device.stand_in:
            raise IsSimulated(f"{device_id} is simulated at the moment. Use the real device again first.")
        before = view_of(device, site)
        device.lifecycle = Lifecycle.RETIRED
        lock_out(device, at)
        device.save(update_fields=["lifecycle", "credential_hash", "broker_hash", "ends_before", "online"])
        release_topics(device, at)
        write_event(device, at, "retired", history_text(word), by)
        note_decision(device, f"device_{word}")
        transaction.on_commit(lambda: publish(site, {"type": "device_removed", "id": device_id}))
        after = view_of(device, site)
        record_thing(before, after)
        write_when_committed(before=before, after=after, at=at)
    return after


def _require_pending(device: Device) -> None:
    if device.lifecycle != Lifecycle.PENDING:
        raise NotPending(f"{device.id} does not wait for a decision; it is {device.lifecycle}.")


def _require_no_place(device: Device) -> None:
    """Refuse the id of a place, for robots are sent to either by its id; no new place gets a device's.

    Neither is missed by who looks at the same moment: the row of a new device refers to its site's, so that it is kept
    before a place looks for devices (`lock_site`), or once that place can be seen here.
    """
    place = Place.objects.filter(site_id=device.site_id, key=device.pk).first()
    if place is not None:
        raise BadDevice(*refusal_facts("id_of_place", device=device.pk, place=place.name))


def update_device(
    *,
    site: str,
    device_id: str,
    name: str | None = None,
    pose: NewPlace | None = None,
    by: User | None,
    at: datetime,
) -> DeviceView:
    """Give a device another name (empty: its own again) or place. Raises NoSuchDevice, BadDevice, NotApproved."""
    if name is not None and (len(name.strip()) > 100 or find_unfit(name, is_line=True)):
        raise BadDevice("A device's name has at most 100 characters, all of which can be printed.")
    if isinstance(pose, Pose) and not all(abs(v) <= 1e6 for v in (pose.x, pose.y, pose.z, pose.theta)):
        raise BadDevice("A device's place must lie within a million metres.")
    with transaction.atomic():
        device = lock_device(site, device_id)
        if device.lifecycle == Lifecycle.RETIRED:
            raise NotApproved(f"{device_id} was taken out; it is retired. Let it come back first.")
        before = view_of(device, site)
        if name is not None:
            device.name_override = normal(name.strip())
        if pose is not None:
            device.pose_override = asdict(pose) if isinstance(pose, Pose) else None
        device.save(update_fields=["name_override", "pose_override"])
        after = view_of(device, site)
        for line in _edits(before, after):
            write_event(device, at, "edited", line, by)
        announce(before, after)
    return after


def _edits(before: DeviceView, after: DeviceView) -> list[HistoryText]:
    edits = []
    if before.name != after.name:
        edits.append(history_text("renamed", before=before.name, after=after.name))
    if before.is_placed and not after.is_placed:
        edits.append(history_text("own_place", x=after.pose.x, y=after.pose.y))
    elif before.pose != after.pose:
        edits.append(history_text("moved", x=after.pose.x, y=after.pose.y))
    return edits

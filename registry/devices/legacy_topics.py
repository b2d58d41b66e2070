"""Legacy topics: what devices ask for, and what an admin confirms or withdraws.

A topic belongs to the first device that asks for it, at the site that may name it, until that device describes itself
without it or is taken out. Nothing is sent there before an admin has confirmed exactly this topic for exactly this
device. The broker learns of a decision within the same transaction; when it does not answer, nothing is decided.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from datetime import datetime

from django.db import transaction

from registry.broker.accounts import accounts
from registry.devices.history import history_text, write_event
from registry.devices.rows import announce, lock_device
from registry.devices.views import DeviceView, view_of
from registry.errors import RegistryError
from registry.models import Device, TopicClaim, User
from registry.sites.namespaces import OF_TOPICS, may_name
from vipo_device.protocol.description import Description, description_from_json
from vipo_device.protocol.faults import refusal_facts
from vipo_device.protocol.topics import list_legacy_methods


class TopicTaken(RegistryError):
    """A topic that another device asks for or has."""

    code = "topic_taken"
    status = 409


class TopicNotAsked(RegistryError):
    """A decision about a topic that the device does not ask for, or that was taken before."""

    code = "topic_not_asked"
    status = 409


def claim_topics(device: Device, before: Description | None, after: Description, at: datetime) -> None:
    """Let a device's claims be those of its new description; call it under the row's lock.

    What it no longer names, or names for another method, is gone with its confirmation. Raises TopicTaken, BrokerAway.
    """
    asked = {method.name: method.topic for method in list_legacy_methods(after)}
    if device.lifecycle == Device.Lifecycle.RETIRED or not (asked or (before and list_legacy_methods(before))):
        return
    held = dict(TopicClaim.objects.filter(device=device).values_list("method", "topic"))
    _give_up(device, {name: topic for name, topic in held.items() if asked.get(name) != topic}, at)
    for method, topic in sorted(asked.items(), key=lambda item: item[1]):
        if held.get(method) != topic:
            _ask(device, method, topic, at)


def _ask(device: Device, method: str, topic: str, at: datetime) -> None:
    if _claim(device, method, topic, at):
        write_event(device, at, "topic_asked", history_text("topic_asked", topic=topic, method=method))


def _claim(device: Device, method: str, topic: str, at: datetime) -> bool:
    """Let a topic be the device's and tell whether that is new.

    Raises TopicTaken, in the same words whether the topic is another site's or could be.
    """
    claim = TopicClaim.objects.filter(pk=topic).select_related("device").first()
    if claim.device.site_id != device.site_id if claim else not may_name(device.site, topic, OF_TOPICS):
        raise TopicTaken(*refusal_facts("topic_of_site", method=method, topic=topic, site=device.site.slug))
    claim, made = TopicClaim.objects.get_or_create(
        topic=topic, defaults={"device": device, "method": method, "asked_at": at}
    )
    if claim.device_id != device.pk:
        raise TopicTaken(*refusal_facts("topic_taken", method=method, topic=topic))
    return made


def _give_up(device: Device, gone: Mapping[str, str], at: datetime) -> None:
    TopicClaim.objects.filter(device=device, topic__in=list(gone.values())).delete()
    ended = {name: topic for name, topic in device.granted.items() if gone.get(name) == topic}
    if ended:
        _grant(device, {name: topic for name, topic in device.granted.items() if name not in ended})
    for method, topic in ended.items():
        write_event(device, at, "topic_withdrawn", history_text("topic_withdrawn", topic=topic, method=method))


def _grant(device: Device, granted: Mapping[str, str]) -> None:
    """Write what a device may hear besides its own topics, and tell the broker. Raises BrokerAway."""
    device.granted = dict(granted)
    device.save(update_fields=["granted"])
    if device.broker_hash:
        accounts().allow(device.pk, device.site.slug, tuple(sorted(granted.values())))


def release_topics(device: Device, at: datetime) -> None:
    """Give up all claims of a device that is taken out; its account at the broker has ended before."""
    TopicClaim.objects.filter(device=device).delete()
    ended, device.granted = device.granted, {}
    device.save(update_fields=["granted"])
    for method, topic in ended.items():
        write_event(device, at, "topic_withdrawn", history_text("topic_withdrawn", topic=topic, method=method))


def claim_again(device: Device, at: datetime) -> None:
    """Let a device that may come back ask for what its description names, save what others have taken meanwhile."""
    for method in list_legacy_methods(description_from_json(device.description or {})):
        with suppress(TopicTaken):
            _claim(device, method.name, method.topic, at)


def confirm_topic(*, site: str, device_id: str, topic: str, by: User | None, at: datetime) -> DeviceView:
    """Let the server tell an approved device a method on the legacy topic that it asks for.

    Raises NoSuchDevice, TopicNotAsked, TopicTaken, BrokerAway.
    """
    with transaction.atomic():
        device = lock_device(site, device_id)
        before = view_of(device, site)
        method = next((m for m in before.asks if m.topic == topic), None)
        if method is None or device.lifecycle != Device.Lifecycle.APPROVED:
            raise TopicNotAsked(_why_not(before, topic))
        _claim(device, method.name, topic, at)
        TopicClaim.objects.filter(pk=topic).update(confirmed_at=at, confirmed_by=by)
        write_event(device, at, "topic_confirmed", history_text("topic_confirmed", topic=topic, method=method.name), by)
        _grant(device, {**device.granted, method.name: topic})
        after = view_of(device, site)
        announce(before, after)
    return after


def _why_not(device: DeviceView, topic: str) -> str:
    if device.lifecycle != Device.Lifecycle.APPROVED:
        return f"{device.id} does not take part; it is {device.lifecycle}. Approve it first."
    if any(method.topic == topic for method in device.canonical.methods):
        return f"The topic {topic[:80]} needs no confirmation: {device.id} is told on it already."
    return f"{device.id} does not ask for the topic {topic[:80]!r}. Look at its page again; it may have changed."


def withdraw_topic(*, site: str, device_id: str, topic: str, by: User | None, at: datetime) -> DeviceView:
    """Take a confirmation back: nothing is sent on that topic any more, and the device asks for it again.

    Raises NoSuchDevice, TopicNotAsked, BrokerAway.
    """
    with transaction.atomic():
        device = lock_device(site, device_id)
        before = view_of(device, site)
        method = next((name for name, granted in device.granted.items() if granted == topic), None)
        if method is None:
            raise TopicNotAsked(f"The topic {topic[:80]!r} is not confirmed for {device_id}: nothing is to be done.")
        TopicClaim.objects.filter(pk=topic, device=device).update(confirmed_at=None, confirmed_by=None)
        write_event(device, at, "topic_withdrawn", history_text("topic_withdrawn", topic=topic, method=method), by)
        _grant(device, {name: granted for name, granted in device.granted.items() if name != method})
        after = view_of(device, site)
        announce(before, after)
    return after


def list_granted_topics() -> dict[str, tuple[str, ...]]:
    """Return the confirmed topics of each device that has some."""
    rows = Device.objects.exclude(granted={}).values_list("pk", "granted")
    return {device: tuple(sorted(granted.values())) for device, granted in rows}

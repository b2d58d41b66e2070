"""`vipo devices`, `vipo alerts`, `vipo approve`, `vipo enrolment-key`: devices for whoever may read the database."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from vipo_site.cli.terminal import CLEAN, Unusable, complain, set_up, write, write_json, write_table

if TYPE_CHECKING:
    from registry.services import DeviceView

DEVICES = "List the devices of a site, or of all sites, with their state."
ALERTS = "List the alerts of a site, or of all sites, that are not over."
APPROVE = "Let a pending device take part, and print its new key this once."
ENROLMENT_KEY = "Print the key with which unknown devices enrol at a site; with --new make another one."
ALERT_COLUMNS = ("severity", "site", "device", "state", "times", "since", "what")
COLUMNS = ("id", "name", "site", "kind", "life", "state", "last seen")


def add_devices_arguments(sub: argparse.ArgumentParser) -> None:
    """Describe what stands behind `vipo devices`."""
    _add_listing_arguments(sub)
    sub.set_defaults(run=list_devices)


def add_alerts_arguments(sub: argparse.ArgumentParser) -> None:
    """Describe what stands behind `vipo alerts`."""
    _add_listing_arguments(sub)
    sub.set_defaults(run=list_alerts)


def _add_listing_arguments(sub: argparse.ArgumentParser) -> None:
    sub.add_argument("--site", default="", help="one site only")
    sub.add_argument("--json", action="store_true", help="write JSON for machines")


def add_approve_arguments(sub: argparse.ArgumentParser) -> None:
    """Describe what stands behind `vipo approve`."""
    sub.add_argument("device", help="the device's id")
    topic = sub.add_mutually_exclusive_group()
    topic.add_argument("--topic", help="confirm this legacy topic, which an approved device asks for, and nothing else")
    topic.add_argument("--withdraw-topic", help="take the confirmation of this legacy topic back, and nothing else")
    sub.add_argument("--json", action="store_true", help="write JSON for machines")
    sub.set_defaults(run=approve)


def add_enrolment_key_arguments(sub: argparse.ArgumentParser) -> None:
    """Describe what stands behind `vipo enrolment-key`, which is also called `vipo enrolment-key`."""
    sub.add_argument("site", help="the site's short name")
    sub.add_argument("--new", action="store_true", help="make a new key; the old one ends")
    sub.set_defaults(run=tell_enrolment_key)


def list_devices(options: argparse.Namespace) -> int:
    """Print the devices. Raises VipoError when there is no such site."""
    set_up()
    from registry import services

    slugs = [options.site] if options.site else services.list_slugs()
    found = [device for slug in slugs for device in services.list_devices(site=slug)]
    if options.json:
        write_json([services.device_to_json(d) | {"site": d.site} for d in found])
        return CLEAN
    rows = [
        (
            *(d.id, d.name, d.site, d.kind, d.lifecycle, d.status),
            d.last_seen_at.isoformat(timespec="seconds") if d.last_seen_at else "never",
        )
        for d in found
    ]
    write_table([COLUMNS, *rows])
    return CLEAN


def list_alerts(options: argparse.Namespace) -> int:
    """Print the alerts, the latest first. Raises VipoError when there is no such site."""
    set_up()
    from registry import services

    slugs = [options.site] if options.site else services.list_slugs()
    found = [(slug, services.alert_to_json(a)) for slug in slugs for a in services.list_alerts(site=slug)]
    found.sort(key=lambda each: each[1]["last_at"], reverse=True)
    if options.json:
        write_json([alert | {"site": slug} for slug, alert in found])
        return CLEAN
    rows = [
        (a["severity"], slug, a["device"], _state_of(a), str(a["count"]), a["first_at"][:19] + "Z", a["text"])
        for slug, a in found
    ]
    write_table([ALERT_COLUMNS, *rows])
    return CLEAN


def _state_of(alert: Mapping[str, Any]) -> str:
    return f"seen by {alert['seen_by']}" if alert["seen_by"] else str(alert["state"])


def approve(options: argparse.Namespace) -> int:
    """Approve a device and print its key. Raises Unusable or VipoError when that cannot be."""
    set_up()
    from django.utils import timezone

    from registry import services

    device = services.find_device(device_id=options.device)
    if device is None:
        raise Unusable(f"No device {options.device!r} has described itself. Try: vipo devices", "not_found")
    if options.topic or options.withdraw_topic:
        return _decide_topic(device, options)
    decided = services.approve_device(site=device.site, device_id=device.id, by=None, at=timezone.now())
    if options.json:
        write(json.dumps({"device": device.id, "credential": decided.credential, "taken": decided.taken}))
        return CLEAN
    write(f"{device.name} ({device.id}) takes part at {device.site} from now on.")
    if decided.credential is None:
        write("It keeps the key that it came with.")
        return CLEAN
    write(f"Its key, shown this once: {decided.credential}")
    write("The device has taken it by itself." if decided.taken else "Type it into the device, as its password.")
    return CLEAN


def _decide_topic(device: DeviceView, options: argparse.Namespace) -> int:
    """Confirm a legacy topic, or take that back. Raises VipoError."""
    from django.utils import timezone

    from registry import services

    topic: str = options.topic or options.withdraw_topic
    decide = services.confirm_topic if options.topic else services.withdraw_topic
    decide(site=device.site, device_id=device.id, topic=topic, by=None, at=timezone.now())
    if options.json:
        write(json.dumps({"device": device.id, "topic": topic, "confirmed": bool(options.topic)}))
    else:
        write(f"{device.name} ({device.id}) is {'' if options.topic else 'not '}told on {topic} from now on.")
    return CLEAN


def tell_enrolment_key(options: argparse.Namespace) -> int:
    """Print a site's enrolment key, a new one if asked for or there is none; return 0, or 2 when that cannot be."""
    set_up()
    from registry import services
    from vipo_device.protocol.errors import VipoError

    try:
        tell = services.renew_enrolment_key if options.new else services.show_enrolment_key
        write(tell(site=options.site))
    except VipoError as error:
        return complain(error.detail)
    return CLEAN

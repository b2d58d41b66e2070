"""What a Thing's properties are now, one by one and as its Thing Description says; who waits is told of the next value.

A value that does not fit is never told as one that does: the device is at fault, and the refusal says so.
"""

from __future__ import annotations

import json
import threading
import time
from collections.abc import AsyncIterator, Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass

from asgiref.sync import sync_to_async

from registry.devices.queries import get_device
from registry.devices.rows import NoSuchDevice
from registry.devices.views import DeviceView
from registry.errors import RegistryError
from registry.live.fanout import Message, listen
from registry.people.access import NotAMember
from registry.people.sessions import Session, Standing, read_standings
from registry.people.watch import seated
from registry.thing_directory.event_stream import (
    HEARTBEAT_S,
    MOST_SECONDS,
    RETRY_MS,
    RIGHTS,
    TooManyStreams,
    bell,
    counted,
    wait_for,
)
from vipo_device.protocol.arguments import is_number
from vipo_device.protocol.description import PropertySpec, Scalar

MOST_POLL_S = 10.0
"""Who asks again and again may miss a change between two questions; after so long they hear how it is."""


class NoSuchProperty(RegistryError):
    """The Thing does not say that it has this property."""

    code = "no_such_property"
    status = 404


class NoValue(RegistryError):
    """The Thing has not said any value of this property yet."""

    code = "no_value"
    status = 404


class UnfitValue(RegistryError):
    """What the Thing says is not what its own description says that it would say."""

    code = "unfit_value"
    status = 409


@dataclass(frozen=True, slots=True)
class Observer:
    """Who looks at which property of which Thing."""

    session: Session
    site: str
    device_id: str
    name: str


def get_thing(site: str, device_id: str) -> DeviceView:
    """Return an approved device. Raises NoSuchDevice."""
    view = get_device(site=site, device_id=device_id)
    if view.lifecycle != "approved":
        raise NoSuchDevice(f"This site has no device {device_id[:64]!r}.")
    return view


def read_value(view: DeviceView, name: str) -> Scalar:
    """Return what a property is, as the device said it last. Raises NoSuchProperty, NoValue, UnfitValue."""
    spec = next((spec for spec in view.canonical.properties if spec.name == name), None)
    if spec is None:
        known = ", ".join(spec.name for spec in view.canonical.properties) or "none"
        raise NoSuchProperty(f"{view.name} has no property {name[:64]!r}. It has: {known}.")
    value = view.readings.get(name)
    if value is None:
        raise NoValue(f"{view.name} has not said yet what {name} is. Look whether it is switched on and connected.")
    if not _is_fit(spec, value):
        raise UnfitValue(
            f"{view.name} says that {name} is {json.dumps(value)[:80]}, which is not what its description says. "
            "Mend the device or its description."
        )
    return value


def read_values(view: DeviceView) -> dict[str, Scalar]:
    """Return what all properties are of which a value is known that fits."""
    found = {}
    for spec in view.canonical.properties:
        with suppress(NoValue, UnfitValue):
            found[spec.name] = read_value(view, spec.name)
    return found


def _is_fit(spec: PropertySpec, value: Scalar) -> bool:
    if spec.type == "number":
        least, most = spec.minimum, spec.maximum
        return is_number(value) and (least is None or value >= least) and (most is None or value <= most)
    if spec.type == "boolean":
        return isinstance(value, bool)
    return isinstance(value, str) and (not spec.options or value in spec.options)


async def stream_values(observer: Observer) -> AsyncIterator[bytes]:
    """Give a property's value and each that follows as server-sent events, until the observer may see no more."""
    until = time.monotonic() + MOST_SECONDS
    with suppress(TooManyStreams, NoSuchDevice, NoSuchProperty, NotAMember), counted(observer.session.person):
        async with bell(_hears(observer)) as rung, seated(observer.session, rung.set) as seat:
            yield f"retry: {RETRY_MS}\n\n".encode()
            told, told_at = None, time.monotonic()
            while time.monotonic() < until:
                value = await sync_to_async(_look)(observer, seat.standing)
                if value is not None and value != told:
                    told, told_at = value, time.monotonic()
                    yield f"data: {json.dumps(value, ensure_ascii=False)}\n\n".encode()
                elif time.monotonic() - told_at >= HEARTBEAT_S:
                    told_at = time.monotonic()
                    yield b":\n\n"
                await wait_for(rung, until - time.monotonic())


def await_value(observer: Observer) -> Scalar:
    """Return the next value of a property, or after a while the one that it still is; it blocks meanwhile.

    Raises TooManyStreams, and what `read_value` raises.
    """
    until = time.monotonic() + MOST_POLL_S
    with counted(observer.session.person), _rung(observer) as rung:
        first = value = _look(observer, _standing(observer))
        while (value is None or value == first) and (left := until - time.monotonic()) > 0:
            rung.wait(left)
            rung.clear()
            value = _look(observer, _standing(observer))
    return value if value is not None else read_value(get_thing(observer.site, observer.device_id), observer.name)


def _standing(observer: Observer) -> Standing | None:
    return read_standings([observer.session]).get(observer.session)


def _look(observer: Observer, standing: Standing | None) -> Scalar:
    """Return the value as the observer may see it now; None when none is known that fits.

    Raises NotAMember, NoSuchDevice and NoSuchProperty when there is nothing left to see.
    """
    if standing is None or not standing.allows(observer.site, "viewer"):
        raise NotAMember("You are signed out, or no member of this site any more. Sign in again, or use another token.")
    with suppress(NoValue, UnfitValue):
        return read_value(get_thing(observer.site, observer.device_id), observer.name)
    return None


def _hears(observer: Observer) -> Callable[[str, Message], bool]:
    """Return what tells whether a message may be about the observer's Thing, or its right to see it."""

    def is_wanted(slug: str, message: Message) -> bool:
        if message["type"] in RIGHTS:
            return True
        if slug != observer.site:
            return False
        if message["type"] == "device_removed":
            return bool(message["id"] == observer.device_id)
        told = message.get("device")
        return isinstance(told, Mapping) and told.get("id") == observer.device_id

    return is_wanted


@contextmanager
def _rung(observer: Observer) -> Iterator[threading.Event]:
    rung = threading.Event()
    wants = _hears(observer)
    stop = listen(lambda slug, message: rung.set() if wants(slug, message) else None)
    try:
        yield rung
    finally:
        stop()

"""A dashboard that nobody of VIPO has written: it comes in to the broker with somebody's token, and hears."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any

import paho.mqtt.client as paho
from paho.mqtt.enums import CallbackAPIVersion

from registry import services
from registry.models import Device, User
from tests.integration.wire.bus import SITE, Bus
from tests.kit.files import MIXER_TEXT
from tests.kit.waiting import wait_for


@dataclass
class Dashboard:
    """A program of somebody else's, by MQTT 3.1.1: what it heard, which filters it was granted, whether it is in."""

    heard: dict[str, Any] = field(default_factory=dict)
    count: int = 0
    granted: list[bool] = field(default_factory=list)
    is_in: bool = False
    refused: str = ""
    ended_at: float = 0.0
    client: paho.Client = field(default_factory=lambda: paho.Client(CallbackAPIVersion.VERSION2))


@contextmanager
def dashboard(
    bus: Bus, name: str, key: str, *filters: str, will: str = "", keep_alive_s: int = 60
) -> Iterator[Dashboard]:
    """Come in under a client id of one's own choice, as such programs do, and ask for filters."""
    made = Dashboard()

    def connected(client: paho.Client, _data: Any, _flags: Any, reason: Any, _properties: Any) -> None:
        made.is_in, made.refused = not reason.is_failure, str(reason) if reason.is_failure else ""
        for topic in filters if made.is_in else ():
            client.subscribe(topic, 1)

    def disconnected(*_: object) -> None:
        made.is_in, made.ended_at = False, time.monotonic()

    def subscribed(_client: paho.Client, _data: Any, _mid: int, reasons: Any, _properties: Any) -> None:
        made.granted += [not reason.is_failure for reason in reasons]

    def hear(_client: paho.Client, _data: Any, message: paho.MQTTMessage) -> None:
        made.count += 1
        made.heard[message.topic] = json.loads(message.payload) if message.payload else None

    made.client.username_pw_set(name, key)
    if will:
        made.client.will_set(will, b"boo", 1, retain=True)
    made.client.on_connect, made.client.on_disconnect = connected, disconnected
    made.client.on_subscribe, made.client.on_message = subscribed, hear
    made.client.connect("127.0.0.1", bus.device_port, keep_alive_s)
    made.client.loop_start()
    try:
        wait_for("an answer", lambda: made.is_in or made.refused)
        wait_for("the filters", lambda: made.refused or len(made.granted) >= len(filters))
        yield made
    finally:
        made.client.disconnect()
        made.client.loop_stop()
        # what it calls knows it: without these it goes with its sockets at once, not at some collection
        made.client.on_connect = made.client.on_disconnect = None
        made.client.on_subscribe = made.client.on_message = None


def make_person(email: str, site: str = SITE) -> User:
    person = services.create_user(email=email, password="a long password", display_name="Ada Meyer")
    services.set_member(site=site, email=email, role="viewer")
    return person


def make_token(person: User, site: str = SITE, **more: Any) -> tuple[str, str]:
    """Return the user name and the password of a new token for the broker."""
    asked = {"name": "Line display", "scopes": ["broker"], "days": 1, "now": datetime.now(UTC), **more}
    view, text = services.create_token(user=person, site=site, **asked)
    way = services.broker_of(view=view)
    assert way is not None
    return way["username"], text


def make_device(device: str, site: str = SITE) -> None:
    """Put an approved mixer on the site that has said how it is."""
    text = MIXER_TEXT.replace("paintMixer03", device).replace("painting-factory", site).encode()
    services.expect_device(site=site, device_id=device, credential="k" * 32)
    services.ingest_description(device_id=device, payload=text, at=datetime.now(UTC))
    say(device, jobStatus=10)


def say(device: str, **values: Any) -> None:
    seq = Device.objects.get(pk=device).seq + 1
    body = {"boot": 1, "seq": seq, "done": True, "props": values}
    services.ingest_state(device_id=device, payload=json.dumps(body).encode(), at=datetime.now(UTC))


def topic(device: str, site: str = SITE) -> str:
    return f"vipo/v1/site/{site}/things/{device}/properties/jobStatus"


EVERYTHING = f"vipo/v1/site/{SITE}/things/#"

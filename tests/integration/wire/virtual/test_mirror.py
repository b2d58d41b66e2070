"""The mirror beside a device that somebody else might have written, on both brokers: it measures, and says nothing."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from datetime import UTC, datetime

import pytest
from django.conf import LazySettings

from execution.commands.outbox import record_ack
from execution.gateway.gateway import Gateway
from execution.mirror.mirror import Mirror
from execution.models import Measurement
from tests.integration.wire.bus import SERVER_WORD, SITE, Bus
from tests.integration.wire.virtual.mixer import A_MINUTE_S, MIXER, Mixer, is_over, tell
from tests.kit.waiting import wait_for
from vipo_device.protocol.credentials import own_key
from vipo_device.protocol.mqtt_client import MqttClient
from vipo_device.protocol.topics import MIRROR, MIRROR_FILTERS

pytestmark = pytest.mark.servers


def hears(mirror: Mirror) -> bool:
    """Tell whether it is connected, and has been for long enough to measure."""
    return mirror._client.connected and not mirror._new_line.is_set() and mirror._attention.hears(time.monotonic())


@pytest.fixture
def mirror(bus: Bus, gateway: Gateway, settings: LazySettings) -> Iterator[Mirror]:
    """A mirror that lets a minute pass in a second, as the mixer of these tests does."""
    wait_for("the mirror's account", lambda: bus.lets_in(MIRROR, own_key(MIRROR, SERVER_WORD)))
    made, stopping = Mirror(settings, speed=60 / A_MINUTE_S), threading.Event()
    thread = threading.Thread(target=made.run_forever, args=(stopping,))
    thread.start()
    wait_for("the mirror", lambda: hears(made))
    yield made
    stopping.set()
    thread.join(20)


def test_what_the_device_takes_is_kept_beside_what_its_copy_takes(mixer: Mixer, mirror: Mirror) -> None:
    mixer.pace = 3
    command = tell(time=1)
    wait_for("the measurement", Measurement.objects.first)
    wait_for("the end", lambda: is_over(command))
    found = Measurement.objects.get()
    assert (found.command, found.device, found.method, found.step) == (command, MIXER, "mixPaint", "mix")
    assert found.predicted_s == pytest.approx(A_MINUTE_S, abs=0.05)
    assert 1.4 < found.real_s / found.predicted_s < 60, "a busy machine adds to it; a wrong unit is a factor of 60"


def test_two_mirrors_keep_a_command_once(mixer: Mixer, mirror: Mirror, settings: LazySettings) -> None:
    second, stopping = Mirror(settings, speed=60 / A_MINUTE_S), threading.Event()
    thread = threading.Thread(target=second.run_forever, args=(stopping,))
    thread.start()
    try:
        wait_for("the second mirror", lambda: hears(second))
        for _ in range(2):
            command = tell(time=1)
            wait_for("the end", lambda command=command: is_over(command))
        wait_for("both", lambda: Measurement.objects.count() == 2)
        time.sleep(1)
        assert Measurement.objects.count() == 2
    finally:
        stopping.set()
        thread.join(20)


def test_what_is_not_its_business_or_not_a_message_leaves_the_mirror_working(
    bus: Bus, mixer: Mixer, mirror: Mirror
) -> None:
    server = MqttClient(
        host="127.0.0.1", port=bus.server_port, username="server", password=SERVER_WORD, client_id="somebody"
    )
    server.start()
    wait_for("the server", lambda: server.connected)
    try:
        for payload in (b"", b"{", b"[]", b'{"id": 7}', b'{"id": "x", "v": 5}', b"\xff" * 300, b"[" * 5000):
            for topic in (
                f"vipo/v1/dev/{MIXER}/down/dispense",
                f"vipo/v1/dev/{MIXER}/up/ack",
                "vipo/v1/dev/n/up/state",
            ):
                server.publish(topic, payload)
        server.publish("vipo/v1/dev/nobody/down/mixPaint", b'{"id": "c", "v": {"time": 1}}')
    finally:
        server.stop()
    command = tell(time=1)
    wait_for("the end", lambda: is_over(command))
    wait_for("the measurement", Measurement.objects.first)


def test_the_mirrors_account_hears_and_says_nothing(bus: Bus, mixer: Mixer, mirror: Mirror) -> None:
    heard: list[str] = []
    account = bus.client(MIRROR, own_key(MIRROR, SERVER_WORD))
    for topic in (*MIRROR_FILTERS, "vipo/v1/dev/+/up/map", "vipo/v1/join/+/+", "$CONTROL/#"):
        account.subscribe(topic, 1, lambda topic, *_: heard.append(topic))
    account.start()
    assert account.wait_subscribed(20)
    mixer.heard = 0
    account.publish(f"vipo/v1/dev/{MIXER}/down/mixPaint", b'{"id": "forged", "v": {"time": 1}, "ttl_s": 60}')
    account.publish(f"vipo/v1/dev/{MIXER}/up/ack", b'{"id": "forged", "st": "DONE"}')
    account.publish(f"vipo/v1/site/{SITE}/stop", b'{"active": true}', retain=True)
    mixer.client.publish(f"vipo/v1/dev/{MIXER}/up/map", b"not for it")
    command = tell(time=1)
    wait_for("the end", lambda: is_over(command))
    wait_for("what it hears", lambda: any(topic.endswith("/down/mixPaint") for topic in heard))
    account.stop()
    assert mixer.heard == 1
    assert {topic.rsplit("/", 1)[1] for topic in heard} <= {"mixPaint", "ack", "state", "stop", "credential"}
    assert not record_ack(device=MIXER, command_id="forged", status="DONE", why="", result={}, at=datetime.now(UTC))
    assert not bus.lets_in(MIRROR, SERVER_WORD)
    assert not bus.lets_in(MIRROR, own_key(MIRROR, "another word"))

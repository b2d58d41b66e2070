"""Clients of a process with very many open files: sockets above those that select() takes, and none left behind."""

from __future__ import annotations

import gc
import resource
import socket
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.integration.wire.bus import SERVER_WORD, Bus
from tests.kit.mqtt import Ear
from tests.kit.waiting import wait_for
from vipo_device.protocol.mqtt_client import MqttClient

pytestmark = pytest.mark.servers
MOST_OF_SELECT = 1024
TOPIC = "vipo/v1/dev/mixer01/down/mark"


@pytest.fixture
def crowded() -> Iterator[None]:
    """Leave no descriptor free that select() would take, as a server with a thousand browsers has none."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(max(soft, 4096), hard), hard))
    with ExitStack() as stack:
        while stack.enter_context(socket.socket()).fileno() < MOST_OF_SELECT:
            pass
        yield
    resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


def client_of(bus: Bus, name: str) -> MqttClient:
    return MqttClient(host="127.0.0.1", port=bus.server_port, username="server", password=SERVER_WORD, client_id=name)


def test_who_has_a_thousand_open_files_connects_hears_and_says(bus: Bus, crowded: None) -> None:
    speaker = client_of(bus, "speaker")
    with Ear(bus.server_port, SERVER_WORD, TOPIC) as ear:
        assert ear.client.wait_subscribed(20)
        speaker.start()
        try:
            assert speaker.wait_connected(20)
            speaker.publish(TOPIC, b"heard")
            ear.wait(lambda heard: heard.payload == b"heard", 20)
        finally:
            speaker.stop()


def open_files() -> int:
    return len(list(Path("/proc/self/fd").iterdir()))


def test_who_has_stopped_holds_no_socket(bus: Bus) -> None:
    def come_and_go(number: int) -> None:
        client = client_of(bus, f"guest{number}")
        client.start()
        assert client.wait_connected(20)
        client.stop()

    come_and_go(0)
    gc.collect()
    gc.disable()  # nothing is to be left to it
    try:
        before = open_files()
        for number in range(1, 11):
            come_and_go(number)
        wait_for("the broker's ends to close", lambda: open_files() <= before + 2, 20)
    finally:
        gc.enable()


def test_what_was_not_sent_when_it_stopped_is_sent_when_it_starts_again(bus: Bus) -> None:
    client = client_of(bus, "forgetful")
    client.start()
    assert client.wait_connected(20)
    client.stop()
    client.publish(TOPIC, b"later")
    with Ear(bus.server_port, SERVER_WORD, TOPIC) as ear:
        assert ear.client.wait_subscribed(20)
        client.start()
        try:
            ear.wait(lambda heard: heard.payload == b"later", 20)
        finally:
            client.stop()

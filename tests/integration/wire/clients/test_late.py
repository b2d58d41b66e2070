"""What waited too long for a line to the broker is not sent over the next one."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator

import paho.mqtt.client as paho
import pytest
from paho.mqtt.enums import CallbackAPIVersion, MQTTProtocolVersion

from execution.floor import stop_publisher
from tests.integration.wire.bus import SERVER_WORD, Bus
from tests.integration.wire.clients.line import Line
from tests.kit.mqtt import Ear
from tests.kit.waiting import wait_for
from vipo_device.protocol.clock import steady_s
from vipo_device.protocol.mqtt_client import MqttClient

pytestmark = pytest.mark.servers
TOPIC = "vipo/v1/dev/mixer01/down/mark"
ACCEPTED = b"\x20\x03\x00\x00\x00"
NO_PACKET = b"\x00\x00"


@pytest.fixture
def line(bus: Bus) -> Iterator[Line]:
    made = Line(bus.server_port)
    yield made
    made.cut()


def client_at(port: int) -> MqttClient:
    return MqttClient(host="127.0.0.1", port=port, username="server", password=SERVER_WORD, client_id="speaker")


@pytest.fixture
def speaker(line: Line) -> Iterator[MqttClient]:
    made = client_at(line.port)
    made.start()
    assert made.wait_connected(20)
    yield made
    made.stop()


def read_all(connection: socket.socket) -> None:
    while connection.recv(65_536):
        pass


def test_what_was_not_confirmed_in_time_is_not_sent_again(bus: Bus, line: Line, speaker: MqttClient) -> None:
    with Ear(bus.server_port, SERVER_WORD, TOPIC) as ear:
        assert ear.client.wait_subscribed(20)
        speaker.publish(TOPIC, b"first", expiry_s=0.2)
        ear.wait(lambda heard: heard.payload == b"first")
        wait_for("the broker's word", lambda: not speaker._limits)
        line.lose()
        speaker.publish(TOPIC, b"late", expiry_s=0.2)
        speaker.publish(TOPIC, b"late as well", expiry_s=60, wait_s=0.2)
        speaker.publish(TOPIC, b"in time", expiry_s=60)
        speaker.publish(TOPIC, b"kept")
        line.cut()
        wait_for("the end of the line", lambda: not speaker.connected)
        speaker.publish(TOPIC, b"late, too", expiry_s=0.2)
        speaker.publish(TOPIC, b"last")
        line.mend()  # a client comes again after a second
        ear.wait(lambda heard: heard.payload == b"last")
        assert [heard.payload for heard in ear.heard] == [b"first", b"in time", b"kept", b"last"]


@pytest.mark.parametrize("bus", ["mosquitto"], indirect=True)
def test_the_broker_is_told_what_is_left_of_the_time(bus: Bus, line: Line, speaker: MqttClient) -> None:
    heard: list[int] = []
    ear = paho.Client(CallbackAPIVersion.VERSION2, "ear", protocol=MQTTProtocolVersion.MQTTv5)
    ear.username_pw_set("server", SERVER_WORD)
    ear.on_connect = lambda *_: ear.subscribe(TOPIC, 1)
    subscribed = threading.Event()
    ear.on_subscribe = lambda *_: subscribed.set()
    ear.on_message = lambda _client, _data, message: heard.append(message.properties.MessageExpiryInterval)
    ear.connect("127.0.0.1", bus.server_port)
    ear.loop_start()
    assert subscribed.wait(20)
    line.lose()
    speaker.publish(TOPIC, b"in time", expiry_s=60)
    line.cut()
    wait_for("the end of the line", lambda: not speaker.connected)
    line.mend()
    wait_for("the message", lambda: heard)
    ear.disconnect()
    ear.loop_stop()
    assert 30 < heard[0] < 60


def test_what_the_system_has_not_sent_of_a_lost_connection_is_dropped() -> None:
    with socket.create_server(("127.0.0.1", 0)) as entrance:
        speaker = client_at(entrance.getsockname()[1])
        speaker.start()
        try:
            connection, _ = entrance.accept()
            with connection:
                connection.recv(1000)
                connection.sendall(ACCEPTED)
                assert speaker.wait_connected(20)
                for _ in range(200):
                    speaker.publish(TOPIC, bytes(65_536))
                connection.sendall(NO_PACKET)
                wait_for("the end of the line", lambda: not speaker.connected)
                with pytest.raises(ConnectionResetError):
                    read_all(connection)
        finally:
            speaker.stop()


def test_a_stop_that_no_broker_has_confirmed_at_once_is_left_to_the_gateways(bus: Bus, line: Line) -> None:
    stop_publisher.open_publisher(
        mqtt={"host": "127.0.0.1", "port": line.port, "username": "server", "password": SERVER_WORD}
    )
    client = stop_publisher._client
    assert client is not None
    try:
        assert client.wait_connected(20)
        with Ear(bus.server_port, SERVER_WORD, "vipo/#") as ear:
            line.lose()
            pressed_s = steady_s()
            assert stop_publisher.publish_stop("hall", b"{}", pressed_s)
            line.cut()
            wait_for("the end of its time", lambda: steady_s() - pressed_s > stop_publisher.FRESH_S)
            line.mend()
            wait_for("the next line", lambda: client.connected)
            client.publish(TOPIC, b"mark")
            ear.wait(lambda heard: heard.payload == b"mark")
            assert [heard.topic for heard in ear.heard] == [TOPIC]
    finally:
        stop_publisher.close_publisher()

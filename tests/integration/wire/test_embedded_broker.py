"""The embedded broker's rules, tried with real clients over real sockets."""

from __future__ import annotations

import contextlib
import os
import socket
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest

from tests.integration.wire.raw import Raw, connect
from tests.kit.mqtt import Ear
from tests.kit.waiting import wait_for
from vipo_device.protocol.mqtt_client import MqttClient
from vipo_site.demo import broker as demo
from vipo_site.embedded_broker.server import EmbeddedBroker, PortInUse, start_broker

WORDS = {"robot01": "one", "mixer01": "two"}


@pytest.fixture
def broker() -> Iterator[EmbeddedBroker]:
    running = start_broker(port=0, server_password="secret", check_password=lambda name, word: WORDS.get(name) == word)
    yield running
    running.stop()
    assert not running.running


@pytest.fixture
def ear(broker: EmbeddedBroker) -> Iterator[Ear]:
    with Ear(broker.port, "secret") as listening:
        yield listening


def device(broker: EmbeddedBroker, name: str, **more: object) -> MqttClient:
    options = {"username": name, "password": WORDS[name], "client_id": name, **more}
    return MqttClient(host="127.0.0.1", port=broker.port, **options)  # type: ignore[arg-type]


def refused(client: MqttClient) -> str:
    """Return why the broker does not let a client in, in the version that it speaks."""
    told: list[str] = []
    client.on_refused(lambda: told.append(client.refusal))
    client.start()
    try:
        wait_for("the refusal", lambda: told, hopeless=lambda: "it was let in" if client.connected else "")
        assert not client.connected
        return told[0]
    finally:
        client.stop()


def test_a_client_that_prefers_mqtt_5_settles_on_3_1_1_at_once(
    broker: EmbeddedBroker, monkeypatch: pytest.MonkeyPatch
) -> None:
    connect, made = socket.create_connection, []
    monkeypatch.setattr(socket, "create_connection", lambda *a, **k: made.append(a[0]) or connect(*a, **k))
    with Ear(broker.port, "secret") as ear:
        assert ear.client.protocol == "3.1.1"
    assert made == [("127.0.0.1", broker.port)] * 2, "one in each version"


def test_what_was_published_before_the_first_connection_arrives(broker: EmbeddedBroker, ear: Ear) -> None:
    robot = device(broker, "robot01")
    robot.publish("vipo/v1/dev/robot01/up/state", b"early")
    robot.start()
    assert ear.wait(lambda h: h.payload == b"early").topic == "vipo/v1/dev/robot01/up/state"
    robot.stop()


def test_of_connections_by_one_name_that_come_at_once_the_last_alone_is_served(broker: EmbeddedBroker) -> None:
    hello = connect("robot01", WORDS["robot01"])
    many = [Raw(broker, hello)]
    assert many[0].read() == (0x20, b"\x00\x00")
    many += [Raw(broker, hello) for _ in range(4)]
    wait_for("one that is served alone", lambda: served(many) == 1)
    time.sleep(1)
    assert served(many) == 1
    for each in many:
        each.socket.close()


def served(clients: list[Raw]) -> int:
    return [is_served(each) for each in clients].count(True)


def is_served(client: Raw) -> bool:
    """Tell whether the broker answers a ping, maybe after it has taken the client in."""
    try:
        client.send(b"\xc0\x00")
        while client.read()[0] != 0xD0:
            pass
    except (OSError, AssertionError):
        return False
    return True


def test_a_device_writes_only_under_its_own_name(broker: EmbeddedBroker, ear: Ear) -> None:
    robot = device(broker, "robot01")
    robot.start()
    for topic in ("vipo/v1/dev/mixer01/up/state", "vipo/v1/dev/robot01/down/move", "vipo/v1/site/hall/stop"):
        robot.publish(topic, b"evil", retain=True)
    robot.publish("vipo/v1/dev/robot01/up/state", b"good")
    ear.wait(lambda h: h.payload == b"good")
    assert [h.payload for h in ear.heard] == [b"good"]
    robot.stop()
    with Ear(broker.port, "secret", "vipo/#") as all_topics:
        time.sleep(0.2)  # what the broker keeps comes upon the subscription
        assert all_topics.heard == []


def test_a_device_hears_only_its_own_commands_and_its_sites_stop(broker: EmbeddedBroker, ear: Ear) -> None:
    heard: list[tuple[str, bytes]] = []
    robot = device(broker, "robot01")
    for topic in ("vipo/v1/dev/+/down/#", "vipo/v1/dev/mixer01/down/#", "vipo/#", "vipo/v1/dev/robot01/down/#"):
        robot.subscribe(topic, 1, lambda t, p, _r: heard.append((t, p)))
    robot.subscribe("vipo/v1/site/hall/stop", 1, lambda t, p, _r: heard.append((t, p)))
    robot.start()
    assert robot.wait_subscribed(20)
    ear.say("vipo/v1/dev/mixer01/down/mixPaint", b"not yours")
    ear.say("vipo/v1/dev/robot01/down/move", b"yours")
    ear.say("vipo/v1/site/hall/stop", b"stop", retain=True)
    wait_for("both messages", lambda: len(heard) >= 2)
    time.sleep(0.2)
    assert heard == [("vipo/v1/dev/robot01/down/move", b"yours"), ("vipo/v1/site/hall/stop", b"stop")]
    robot.stop()


def test_a_new_device_is_not_given_what_others_asked_for(broker: EmbeddedBroker, ear: Ear) -> None:
    ear.say("vipo/v1/dev/mixer01/up/desc", b"private", retain=True)
    ear.wait(lambda h: h.payload == b"private")
    with socket.create_connection(("127.0.0.1", broker.port)) as raw:
        raw.settimeout(20)
        raw.sendall(connect_packet("robot01", "robot01", "one"))
        assert raw.recv(4) == b"\x20\x02\x00\x00"
        raw.settimeout(1)
        with pytest.raises(TimeoutError):
            raw.recv(1)


def test_a_wrong_password_is_refused_and_throws_nobody_out(broker: EmbeddedBroker, ear: Ear) -> None:
    robot = device(broker, "robot01", will=("vipo/v1/dev/robot01/up/presence", b"gone", 1, True))
    robot.start()
    assert robot.wait_connected(20)
    assert refused(device(broker, "robot01", password="wrong")) == "Not authorized"
    assert refused(device(broker, "mixer01", client_id="robot01")) == "Not authorized"
    assert refused(device(broker, "robot01", username="")) == "Not authorized"
    assert robot.connected
    assert ear.heard == []
    robot.stop()


def test_a_will_on_somebody_elses_topic_is_refused(broker: EmbeddedBroker) -> None:
    foreign = ("vipo/v1/dev/mixer01/up/presence", b"x", 1, True)
    assert refused(device(broker, "robot01", will=foreign)) == "Not authorized"


def test_a_second_connection_of_a_device_ends_the_first_before_it_speaks(broker: EmbeddedBroker, ear: Ear) -> None:
    topic = "vipo/v1/dev/robot01/up/presence"
    first = device(broker, "robot01", will=(topic, b"first is gone", 1, True))
    first.start()
    assert first.wait_connected(20)
    second = device(broker, "robot01", will=(topic, b"second is gone", 1, True))
    second.on_connected(lambda: second.publish(topic, b"second is here", retain=True))
    second.start()
    ear.wait(lambda h: h.payload == b"second is here")
    first.stop()
    second.stop()
    assert [h.payload for h in ear.heard][:2] == [b"first is gone", b"second is here"]


def test_a_device_that_falls_silent_is_declared_gone_by_its_will(broker: EmbeddedBroker, ear: Ear) -> None:
    with socket.create_connection(("127.0.0.1", broker.port), timeout=20) as raw:
        will = ("vipo/v1/dev/robot01/up/presence", b"gone")
        raw.sendall(connect_packet("robot01", "robot01", "one", keepalive_s=1, will=will))
        assert raw.recv(4) == b"\x20\x02\x00\x00"
        gone = ear.wait(lambda h: h.payload == b"gone", 60)  # one that may be silent for a minute is so for 90 s
        assert gone.topic == "vipo/v1/dev/robot01/up/presence"


def test_nonsense_instead_of_a_connect_harms_nobody(broker: EmbeddedBroker, ear: Ear) -> None:
    for nonsense in (
        b"GET / HTTP/1.1\r\n\r\n",
        b"\x10\xff\xff\xff\xff\xff",
        b"\x10\x04\x00\x04MQ",
        b"\x10\x00",
        b"\xff" * 64,
    ):
        with socket.create_connection(("127.0.0.1", broker.port)) as raw:
            raw.sendall(nonsense)
            raw.shutdown(socket.SHUT_WR)
            raw.settimeout(20)
            with contextlib.suppress(ConnectionResetError):  # closed before all of it was read
                assert raw.recv(16) in (b"", b"\x20\x02\x00\x01")
    ear.say("vipo/v1/dev/robot01/up/state", b"still here")
    ear.wait(lambda h: h.payload == b"still here")


def test_a_port_in_use_is_said_with_the_remedy(broker: EmbeddedBroker) -> None:
    with pytest.raises(PortInUse) as refusal:
        start_broker(port=broker.port, server_password="x", check_password=lambda _n, _w: False)
    assert refusal.value.detail == (
        f"The MQTT port {broker.port} is in use by another program. "
        "Stop that program, or set VIPO_MQTT_PORT to a free port."
    )


def test_no_message_is_lost_while_others_subscribe(broker: EmbeddedBroker, ear: Ear) -> None:
    robot = device(broker, "robot01")
    robot.start()
    assert robot.wait_connected(20)
    restless = device(broker, "mixer01")
    restless.start()
    for number in range(300):
        robot.publish("vipo/v1/dev/robot01/up/ack", b"%d" % number)
        restless.subscribe(f"vipo/v1/dev/mixer01/down/m{number}", 1, lambda *_: None)
    ear.wait(lambda h: h.payload == b"299")
    assert [h.payload for h in ear.heard] == [b"%d" % number for number in range(300)]
    robot.stop()
    restless.stop()


def connect_packet(
    client: str, user: str, password: str, *, keepalive_s: int = 60, will: tuple[str, bytes] | None = None
) -> bytes:
    """A CONNECT of MQTT 3.1.1 as bytes."""

    def field(data: bytes) -> bytes:
        return len(data).to_bytes(2, "big") + data

    flags = 0xC2 | (0x2C if will else 0)
    body = field(b"MQTT") + bytes((4, flags)) + keepalive_s.to_bytes(2, "big") + field(client.encode())
    if will:
        body += field(will[0].encode()) + field(will[1])
    body += field(user.encode()) + field(password.encode())
    return bytes((0x10, len(body))) + body


def test_a_client_that_never_stops_speaking_is_ended_by_the_next_one_of_its_name(broker: EmbeddedBroker) -> None:
    for _ in range(15):
        with socket.create_connection(("127.0.0.1", broker.port), timeout=60) as talker:
            talker.sendall(connect_packet("robot01", "robot01", "one"))
            assert talker.recv(4)[0] == 0x20
            talker.settimeout(None)  # only its end ends the talk
            thread = threading.Thread(target=talk_until_closed, args=(talker,))
            thread.start()
            time.sleep(0.05)
            successor = device(broker, "robot01")
            successor.start()
            assert successor.wait_connected(60)
            thread.join(60)
            assert not thread.is_alive(), "the first connection is still open"
            successor.stop()


def talk_until_closed(talker: socket.socket) -> None:
    """Publish without a pause until the broker closes the connection."""
    topic = b"vipo/v1/dev/robot01/up/state"
    body = len(topic).to_bytes(2, "big") + topic + b"{}"
    try:
        while True:
            talker.sendall(bytes([0x30, len(body)]) + body)
    except OSError:
        return


def test_the_demo_takes_another_port_if_somebody_has_taken_its_own_meanwhile(
    broker: EmbeddedBroker, monkeypatch: pytest.MonkeyPatch, settings: Any
) -> None:
    """Unless it was said which one."""
    settings.VIPO_MQTT = {**settings.VIPO_MQTT, "port": broker.port}
    settings.VIPO_BROKER_URL = ""
    monkeypatch.setenv("VIPO_MQTT_PORT", str(broker.port))
    monkeypatch.delenv("VIPO_BROKER_URL", raising=False)
    with pytest.raises(PortInUse):
        demo.start_broker(any_port=False)
    part = demo.start_broker(any_port=True)
    try:
        port = int(os.environ["VIPO_MQTT_PORT"])
        assert port != broker.port
        assert (settings.VIPO_MQTT["port"], settings.VIPO_BROKER_URL) == (port, f"mqtt://127.0.0.1:{port}/")
        assert not demo.port_is_free(port)
    finally:
        part.stop()

"""What a device says over its connection, when, and what it hears."""

from __future__ import annotations

import json
from typing import Any

from vipo_device.kit.connection import (
    CommandReceived,
    ConnectionEvent,
    DeviceConnection,
    IntroductionDue,
    StopChanged,
    broker_client,
    leave,
)
from vipo_device.protocol.description import DeviceState, Pose, Scalar
from vipo_device.protocol.messages import AckMessage, DeviceCommand
from vipo_device.protocol.mqtt_client import MqttClient, Will

BROKER = {"host": "127.0.0.1", "port": 9, "tls": False, "ca": ""}


class Bench:
    """A device's connection to a broker that is not there, and what was said and heard over it."""

    def __init__(self) -> None:
        self.heard: list[ConnectionEvent] = []
        self.clients: list[tuple[MqttClient, Will]] = []
        self.connection = DeviceConnection("oven", "hall", 7, self.heard.append)
        self.connection.connect(self._connect)

    def _connect(self, device: str, will: Will) -> MqttClient:
        client = broker_client(BROKER, device, "its key", will)
        self.clients.append((client, will))
        return client

    def hear(self, topic: str, payload: Any, *, retained: bool = False) -> list[ConnectionEvent]:
        """Let the device hear a message, and return what it passed on."""
        client, _ = self.clients[0]
        filters = {s.topic.removesuffix("#"): s.plain for s in client._subscriptions}
        hear = next(hear for begins, hear in filters.items() if topic.startswith(begins))
        assert hear is not None
        hear(topic, payload if isinstance(payload, bytes) else json.dumps(payload).encode(), retained)
        found, self.heard[:] = list(self.heard), []
        return found

    def said(self) -> list[tuple[str, Any]]:
        """Return what the device has said since this was last asked: kind and message."""
        client = self.clients[0][0]
        said = [*client._early, *client._paho.drop_out_messages()]
        client._early.clear()
        return [(message.topic.rsplit("/", 1)[1], json.loads(message.payload)) for message in said]


def state(**readings: Scalar) -> Any:
    return lambda boot, seq: DeviceState(boot, seq, done=True, pose=Pose(1, 2), properties=readings)


def test_commands_and_stops_are_passed_on_and_nothing_else() -> None:
    bench = Bench()
    assert bench.hear("vipo/v1/dev/oven/down/cure", {"id": "c1", "v": {"time": 3}}) == [
        CommandReceived("oven", DeviceCommand("c1", "cure", {"time": 3}))
    ]
    assert bench.hear("vipo/v1/dev/oven/down/cure", {"id": "c1"}, retained=True) == []
    assert bench.hear("vipo/v1/dev/oven/down/cure", {"id": ""}) == []
    assert bench.hear("vipo/v1/site/hall/stop", b"?") == [StopChanged("oven", active=True)]
    assert bench.hear("vipo/v1/site/hall/stop", {"active": False}) == [StopChanged("oven", active=False)]
    bench.connection.disconnect()


def test_what_a_stop_has_overtaken_is_not_passed_on() -> None:
    bench = Bench()
    stop, cure = "vipo/v1/site/hall/stop", "vipo/v1/dev/oven/down/cure"
    assert bench.hear(stop, {"active": True, "fence": 7}) == [StopChanged("oven", active=True)]
    assert bench.hear(stop, {"active": False, "fence": 6}) == []
    assert bench.hear(cure, {"id": "c1", "v": {}, "fence": 6}) == []
    assert bench.hear(stop, {"active": False, "fence": 8}) == [StopChanged("oven", active=False)]
    assert bench.hear(cure, {"id": "c1", "v": {}, "fence": 6}) == []
    assert bench.hear(cure, {"id": "c2", "v": {}, "fence": 8}) == [
        CommandReceived("oven", DeviceCommand("c2", "cure", {}, 8))
    ]
    bench.connection.disconnect()


def test_a_device_introduces_itself_to_a_server_that_was_started_anew() -> None:
    bench = Bench()
    status, due = "vipo/v1/srv/status", [IntroductionDue("oven")]
    assert bench.hear(status, b"born 1", retained=True) == []
    assert bench.hear(status, b"born 1", retained=True) == []
    assert bench.hear(status, b"born 2", retained=True) == due
    assert bench.hear(status, b"born 2") == due
    bench.connection.disconnect()


def test_what_a_device_says_bears_the_number_of_its_start() -> None:
    bench = Bench()
    (_, will) = bench.clients[0]
    assert (will[0], json.loads(will[1]), will[2:]) == (
        "vipo/v1/dev/oven/up/presence",
        {"s": "offline", "boot": 7},
        (1, True),
    )
    bench.connection.introduce(b'"who"', online=True)
    bench.connection.answer(AckMessage("c1", "DONE"))
    assert bench.said() == [
        ("desc", "who"),
        ("presence", {"s": "online", "boot": 7}),
        ("ack", {"id": "c1", "st": "DONE", "why": "", "result": {}}),
    ]
    leave([bench.connection])
    assert bench.said() == [("presence", {"s": "offline", "boot": 7})]


def test_a_state_is_said_when_it_has_changed_or_nothing_was_said_for_long() -> None:
    bench = Bench()
    bench.connection.report(state(), 0.0)
    assert (bench.said(), bench.connection.is_introduced) == ([], False)
    bench.clients[0][0]._online.set()  # as if the broker had accepted the connection
    for now_s, temperature in [(0.0, 20), (0.1, 21), (0.6, 21), (10.0, 21), (25.7, 21)]:
        bench.connection.report(state(temperature=temperature), now_s)
    assert [(said["seq"], said["props"]) for _, said in bench.said()] == [
        (1, {"temperature": 20}),
        (2, {"temperature": 21}),
        (3, {"temperature": 21}),
    ]
    bench.connection.report(state(temperature=22), 25.8)
    bench.connection.report(state(temperature=22), 25.8, at_once=True)
    assert [said["seq"] for _, said in bench.said()] == [4]
    assert bench.connection.is_introduced
    bench.clients[0][0]._online.clear()
    bench.connection.disconnect()

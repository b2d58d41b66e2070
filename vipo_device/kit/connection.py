"""A device's connection to VIPO: one MQTT client that speaks the protocol for a simulated or a foreign device."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any, Protocol

from vipo_device.kit.fence import Fence
from vipo_device.protocol.description import DeviceState
from vipo_device.protocol.messages import (
    AckMessage,
    DeviceCommand,
    Presence,
    Voice,
    ack_payload,
    down_topic,
    presence_payload,
    read_command,
    read_stop,
    state_payload,
    up_topic,
)
from vipo_device.protocol.mqtt_client import MqttClient, Will
from vipo_device.protocol.sockets import tls_context

log = logging.getLogger(__name__)
SERVER_STATUS = "vipo/v1/srv/status"
SILENT_S = 25.0
MOVING_S = 0.1
CHANGING_S = 0.5
Handler = Callable[[str, bytes, bool], None]


class Client(Protocol):
    """What a device's connection needs of an MQTT client (`MqttClient`)."""

    @property
    def connected(self) -> bool:
        """Tell whether the connection stands."""

    def subscribe(self, topic: str, qos: int, callback: Handler, /) -> None:
        """Hear a filter from the next connection on."""

    def on_connected(self, callback: Callable[[], None]) -> None:
        """Call back each time that the connection stands."""

    def publish(self, topic: str, payload: bytes, *, qos: int = 1, retain: bool = False) -> None:
        """Send a message."""

    def start(self) -> None:
        """Begin to connect."""

    def stop(self) -> None:
        """End the connection; what was said is sent before."""


ConnectionMaker = Callable[[str, Will], Client]


@dataclass(frozen=True, slots=True)
class CommandReceived:
    """The server gave a device a command."""

    device: str
    command: DeviceCommand


@dataclass(frozen=True, slots=True)
class IntroductionDue:
    """A device has to say who it is: its connection stands, or the server was started anew."""

    device: str


@dataclass(frozen=True, slots=True)
class StopChanged:
    """A site's stop was pressed or reset."""

    device: str
    active: bool


ConnectionEvent = CommandReceived | IntroductionDue | StopChanged


def broker_client(broker: Mapping[str, Any], name: str, key: str, will: Will | None = None) -> MqttClient:
    """Return a connection to VIPO's broker; `broker` has host, port, tls and ca, as the setting VIPO_MQTT."""
    return MqttClient(
        host=broker["host"],
        port=broker["port"],
        username=name,
        password=key,
        client_id=name,
        tls=tls_context(broker["ca"]) if broker["tls"] else None,
        will=will,
    )


class DeviceConnection:
    """What a device says to VIPO. What it hears it passes on at once, on the network's thread.

    With the voice `sim` it is the device's stand-in that speaks and is told.
    """

    def __init__(
        self, device: str, site: str, boot: int, hear: Callable[[ConnectionEvent], None], voice: Voice = "dev"
    ) -> None:
        self.id, self._voice = device, voice
        self._site, self._boot, self._hear = site, boot, hear
        self._client: Client | None = None
        self._server = b""
        self._fence = Fence()
        self._seq = 0
        self._reported: DeviceState | None = None
        self._reported_s = 0.0

    def connect(self, make: ConnectionMaker) -> None:
        """Begin to connect; the will says offline with this start's number."""
        will: Will = (up_topic(self.id, "presence", self._voice), self._presence(online=False), 1, True)
        self._client = make(self.id, will)
        self._client.subscribe(down_topic(self.id, "#", self._voice), 1, self._hear_command)
        self._client.subscribe(f"vipo/v1/site/{self._site}/stop", 1, self._hear_stop)
        self._client.subscribe(SERVER_STATUS, 1, self._hear_server)
        self._client.on_connected(lambda: self._hear(IntroductionDue(self.id)))
        self._client.start()

    def disconnect(self) -> None:
        """End the connection; what was said is sent before."""
        if self._client is not None:
            self._client.stop()

    def introduce(self, description: bytes, *, online: bool) -> None:
        """Say who the device is and whether it is there; its state follows with the next report."""
        self._say("desc", description, retain=True)
        self.say_presence(online=online)

    def say_presence(self, *, online: bool) -> None:
        """Say whether the device is there; the state is said anew after it."""
        self._say("presence", self._presence(online=online), retain=True)
        self._reported = None

    @property
    def is_introduced(self) -> bool:
        """True while the device is connected and has said how it is."""
        return self._client is not None and self._client.connected and self._reported is not None

    def say_map(self, part: bytes) -> None:
        """Send a part of a robot's map."""
        self._say("map", part)

    def answer(self, ack: AckMessage) -> None:
        """Answer a command."""
        self._say("ack", ack_payload(ack))

    def report(self, look: Callable[[int, int], DeviceState], now_s: float, *, at_once: bool = False) -> None:
        """Say the state if it changed and enough time has passed, or if nothing was said for long."""
        state = look(self._boot, self._seq + 1)
        if self._client is None or not self._client.connected or not self._is_due(state, now_s, at_once=at_once):
            return
        self._seq += 1
        self._reported, self._reported_s = state, now_s
        self._say("state", state_payload(state), retain=True)

    def _is_due(self, state: DeviceState, now_s: float, *, at_once: bool) -> bool:
        last, silent_s = self._reported, now_s - self._reported_s
        if last is None or silent_s >= SILENT_S:
            return True
        if replace(state, seq=last.seq) == last:
            return False
        if at_once or state.done != last.done:
            return True
        return silent_s >= (MOVING_S if state.pose != last.pose else CHANGING_S)

    def _presence(self, *, online: bool) -> bytes:
        return presence_payload(Presence(online, self._boot))

    def _say(self, kind: str, payload: bytes, *, retain: bool = False) -> None:
        if self._client is not None:
            self._client.publish(up_topic(self.id, kind, self._voice), payload, qos=1, retain=retain)

    def _hear_command(self, topic: str, payload: bytes, retained: bool) -> None:
        command = read_command(topic.removeprefix(down_topic(self.id, "", self._voice)), payload)
        if retained or command is None:
            log.warning("%s: a message on %s is not a command; it was ignored.", self.id, topic)
            return
        if not self._fence.takes_command(command):
            log.warning("%s: %s (%s) came too late, after a stop; it was ignored.", self.id, command.method, command.id)
            return
        self._hear(CommandReceived(self.id, command))

    def _hear_stop(self, _topic: str, payload: bytes, _retained: bool) -> None:
        stop = read_stop(payload)
        if self._fence.takes_stop(stop):
            self._hear(StopChanged(self.id, stop.active))

    def _hear_server(self, _topic: str, payload: bytes, retained: bool) -> None:
        """A server that was started anew may not know this device; the one that was there when it came in does."""
        if not retained or (self._server and payload != self._server):
            self._hear(IntroductionDue(self.id))
        self._server = payload


def leave(connections: Iterable[DeviceConnection]) -> None:
    """Say of all these devices that they go offline, then end their connections side by side."""
    leaving = list(connections)
    for connection in leaving:
        connection.say_presence(online=False)
    with ThreadPoolExecutor(max_workers=max(1, len(leaving))) as pool:
        list(pool.map(DeviceConnection.disconnect, leaving))

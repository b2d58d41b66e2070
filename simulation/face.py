"""How a pretend device looks from outside: one MQTT connection that speaks as a real device does."""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from queue import SimpleQueue

from registry.capability import DeviceState, Pose, Scalar
from registry.errors import RegistryError
from registry.mqtt import MqttClient, Will
from registry.wire import (
    AckMessage,
    Presence,
    ack_payload,
    down_topic,
    is_device_id,
    parse_json,
    presence_payload,
    state_payload,
    up_topic,
)
from simulation.site_facts import VirtualDevice
from simulation.world import Ack

log = logging.getLogger(__name__)
SILENT_S = 25.0
MOVING_S = 0.1
CHANGING_S = 0.5
SERVER_STATUS = "vipo/v1/srv/status"
ConnectionMaker = Callable[[str, Will], MqttClient]


@dataclass(frozen=True, slots=True)
class Told:
    """A command that came in."""

    device: str
    method: str
    arguments: Mapping[str, object]
    command: str


@dataclass(frozen=True, slots=True)
class CameIn:
    """A device is connected and has to introduce itself."""

    device: str


@dataclass(frozen=True, slots=True)
class Stopped:
    """The site's stop was pressed or reset."""

    active: bool


Incoming = Told | CameIn | Stopped


@dataclass(frozen=True, slots=True)
class Look:
    """A device's state as others may see it."""

    done: bool
    pose: Pose
    readings: Mapping[str, Scalar]


class Face:
    """A device's connection. Callbacks come on the network's thread and only put into the inbox."""

    def __init__(self, device: VirtualDevice, site: str, boot: int, inbox: SimpleQueue[Incoming]) -> None:
        self.id = device.description.id
        self._device, self._site, self._boot, self._inbox = device, site, boot, inbox
        self._seq = 0
        self._command = ""
        self._look: Look | None = None
        self._said_s = 0.0
        self._server = b""
        self._client: MqttClient | None = None

    def connect(self, make: ConnectionMaker) -> None:
        """Begin to connect; the will says offline with this start's number."""
        will: Will = (up_topic(self.id, "presence"), self._presence(online=False), 1, True)
        self._client = make(self.id, will)
        self._client.subscribe(down_topic(self.id, "#"), 1, self._hear_command)
        self._client.subscribe(f"vipo/v1/site/{self._site}/stop", 1, self._hear_stop)
        self._client.subscribe(SERVER_STATUS, 1, self._hear_server)
        self._client.on_connected(lambda: self._inbox.put(CameIn(self.id)))
        self._client.start()

    def say_goodbye(self) -> None:
        """Say that the device goes offline."""
        self._say("presence", self._presence(online=False), retain=True)

    def disconnect(self) -> None:
        """End the connection; what was said is sent before."""
        if self._client is not None:
            self._client.stop()

    def introduce(self) -> None:
        """Say who the device is and that it is here; its state follows with the next report."""
        self._say("desc", self._device.source, retain=True)
        self._say("presence", self._presence(online=True), retain=True)
        self._look = None

    def answer(self, ack: Ack) -> None:
        """Answer a command."""
        if ack.status == "RUNNING":
            self._command = ack.command
        self._say("ack", ack_payload(AckMessage(ack.command, ack.status, ack.why[:256], ack.result)))

    def report(self, look: Look, now_s: float, *, at_once: bool = False) -> None:
        """Say the state if it changed and enough time has passed, or if nothing was said for long."""
        if self._client is None or not self._client.connected:
            return
        if self._look is not None and not self._is_due(self._look, look, now_s - self._said_s, at_once=at_once):
            return
        self._seq += 1
        self._look, self._said_s = look, now_s
        state = DeviceState(self._boot, self._seq, look.done, look.pose, self._command, look.readings)
        self._say("state", state_payload(state), retain=True)

    def _is_due(self, before: Look, now: Look, silent_s: float, *, at_once: bool) -> bool:
        if now == before:
            return silent_s >= SILENT_S
        if at_once or now.done != before.done:
            return True
        return silent_s >= (MOVING_S if now.pose != before.pose else CHANGING_S)

    def _presence(self, *, online: bool) -> bytes:
        return presence_payload(Presence(online, self._boot))

    def _say(self, kind: str, payload: bytes, *, retain: bool = False) -> None:
        assert self._client is not None
        self._client.publish(up_topic(self.id, kind), payload, qos=1, retain=retain)

    def _hear_command(self, topic: str, payload: bytes, retained: bool) -> None:
        method = topic.removeprefix(down_topic(self.id, ""))
        told = read_command(self.id, method, payload)
        if retained or told is None:
            log.warning("%s: a message on %s is not a command; it was ignored.", self.id, topic)
            return
        self._inbox.put(told)

    def _hear_stop(self, _topic: str, payload: bytes, _retained: bool) -> None:
        self._inbox.put(Stopped(read_stop(payload)))

    def _hear_server(self, _topic: str, payload: bytes, _retained: bool) -> None:
        """A server that was born anew may not know this device; the one that was there when it came in does."""
        if self._server and payload != self._server:
            self._inbox.put(CameIn(self.id))
        self._server = payload


def read_command(device: str, method: str, payload: bytes) -> Told | None:
    """Read `{"id", "v", "ttl_s"}`; None when it is no command."""
    try:
        body = parse_json(payload)
    except RegistryError:
        return None
    command, arguments = (body.get("id"), body.get("v", {})) if isinstance(body, dict) else (None, None)
    is_named = isinstance(command, str) and 0 < len(command) <= 64 and is_device_id(method)
    if not is_named or not isinstance(arguments, dict):
        return None
    return Told(device, method, arguments, str(command))


def read_stop(payload: bytes) -> bool:
    """Read the stop's message; what cannot be read stops, what is empty does not."""
    if not payload:
        return False
    try:
        body = json.loads(payload)
    except ValueError:
        return True
    return not (isinstance(body, dict) and body.get("active") is False)

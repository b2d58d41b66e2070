"""The connector: it listens to all vehicles of one interface, and has one device for each that it hears of."""

from __future__ import annotations

import logging
import re
import time
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass
from queue import Empty, SimpleQueue
from threading import Event, Lock

from connectors.vda5050.messages import VehicleName, read_connection, read_state
from connectors.vda5050.vehicle_device import Setting, VehicleDevice
from connectors.vda5050.vehicle_memory import memory_path
from vipo_device.kit.connection import CommandReceived, ConnectionEvent, IntroductionDue, StopChanged, leave
from vipo_device.protocol.messages import BadMessage
from vipo_device.protocol.mqtt_client import MqttClient

log = logging.getLogger(__name__)
SUBTOPICS = ("connection", "factsheet", "state", "visualization")
MAJOR = "v2"
TICK_S = 0.25
MOST_VEHICLES = 200
MOST_WAITING = 10_000
MOST_WAITING_EACH = 200
STRANGERS = "strangers"
COMPLAIN_EVERY_S = 60.0
_LEVEL = re.compile(r"[^/+#$\x00-\x1f]{1,64}")


@dataclass(frozen=True, slots=True)
class VehicleMessage:
    """A vehicle said something."""

    name: VehicleName
    subtopic: str
    payload: bytes


class InboxQuota:
    """How many messages of each vehicle wait, so that one that says too much is not heard at the others' expense."""

    def __init__(self) -> None:
        self._counts: Counter[VehicleName] = Counter()
        self._guard = Lock()

    def enter(self, name: VehicleName) -> bool:
        """Count one more; False when too many of this vehicle wait already."""
        with self._guard:
            if self._counts[name] >= MOST_WAITING_EACH:
                return False
            self._counts[name] += 1
            return True

    def leave(self, name: VehicleName) -> None:
        """Count one less."""
        with self._guard:
            self._counts[name] -= 1
            if not self._counts[name]:
                del self._counts[name]


class Fleet:
    """Network threads only put into the inbox; everything else happens on the thread of `run`.

    `refused` counts the messages that could not be read, by device.
    """

    def __init__(self, client: MqttClient, interface: str, setting: Setting) -> None:
        self.refused: Counter[str] = Counter()
        self._client, self._interface = client, interface
        self._setting = setting
        self._inbox: SimpleQueue[VehicleMessage | ConnectionEvent] = SimpleQueue()
        self._devices: dict[str, VehicleDevice] = {}
        self._by_name: dict[VehicleName, VehicleDevice] = {}
        self._quota = InboxQuota()
        self._complained_s: dict[str, float] = {}

    def run(self, stopping: Event) -> None:
        """Serve until `stopping` is set; then tell VIPO that they go offline; the vehicles finish their orders."""
        for subtopic in SUBTOPICS:
            qos = 1 if subtopic == "connection" else 0
            self._client.subscribe(f"{self._interface}/{MAJOR}/+/+/{subtopic}", qos, self._hear)
        self._client.start()
        try:
            self._serve(stopping)
        finally:
            self._client.stop()
            leave(device.connection for device in self._devices.values() if device.connection)

    def _serve(self, stopping: Event) -> None:
        ticked_s = 0.0
        while not stopping.is_set():
            with suppress(Empty):
                self._take(self._inbox.get(timeout=TICK_S), time.monotonic())
            if (now := time.monotonic()) - ticked_s >= TICK_S:
                ticked_s = now
                is_reached = self._client.connected
                for device in self._devices.values():
                    device.tick(now, is_reached=is_reached)

    def _take(self, event: VehicleMessage | ConnectionEvent, now_s: float) -> None:
        if isinstance(event, VehicleMessage):
            self._hear_vehicle(event, now_s)
            return
        device = self._devices[event.device]
        match event:
            case CommandReceived(command=command):
                device.command(command, now_s)
            case StopChanged(active=active):
                device.hold(now_s, active=active)
            case IntroductionDue():
                device.introduce()

    def _hear_vehicle(self, said: VehicleMessage, now_s: float) -> None:
        """Let a device hear; what cannot be read is counted, told once a minute, and harms nobody else."""
        self._quota.leave(said.name)
        device = self._by_name.get(said.name)
        try:
            if device is None:
                device = self._admit(said)
            if device is not None:
                device.hear(said.subtopic, said.payload, now_s)
        except BadMessage as error:
            who = device.id if device else STRANGERS
            self.refused[who] += 1
            if now_s - self._complained_s.get(who, -COMPLAIN_EVERY_S) >= COMPLAIN_EVERY_S:
                self._complained_s[who] = now_s
                named = who if device else f"{who}, here {'/'.join(said.name)!r}"
                log.warning("%s: %s (%d refused so far)", named, error.detail, self.refused[who])

    def _admit(self, said: VehicleMessage) -> VehicleDevice | None:
        """Make a device of a vehicle that says that it is connected; nothing else of a stranger is listened to.

        Who has been a device before is known also by its state: a broker that was started anew may have forgotten the
        rest. Raises BadMessage.
        """
        if said.subtopic == "connection":
            read_connection(said.payload, said.name)
        elif said.subtopic == "state" and memory_path(self._setting.folder, said.name).exists():
            read_state(said.payload, said.name)
        else:
            return None
        if len(self._devices) >= MOST_VEHICLES:
            raise BadMessage(f"{'/'.join(said.name)} is one vehicle too many: a connector serves {MOST_VEHICLES}.")
        device = VehicleDevice(said.name, self._setting, self._publish, self._inbox.put)
        self._devices[device.id] = self._by_name[said.name] = device
        return device

    def _hear(self, topic: str, payload: bytes, _retained: bool) -> None:
        _, _, manufacturer, serial, subtopic = topic.rsplit("/", 4)
        name = VehicleName(manufacturer, serial)
        fits = payload and all(_LEVEL.fullmatch(level) for level in name)
        if fits and self._inbox.qsize() < MOST_WAITING and self._quota.enter(name):
            self._inbox.put(VehicleMessage(name, subtopic, payload))

    def _publish(self, name: VehicleName, subtopic: str, payload: bytes) -> None:
        self._client.publish(f"{self._interface}/{MAJOR}/{'/'.join(name)}/{subtopic}", payload, qos=0)

"""The connector: it listens to all vehicles of one interface, and has one member for each that it hears of."""

from __future__ import annotations

import logging
import re
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, replace
from queue import Empty, SimpleQueue
from threading import Event

from connectors.device_line import CameIn, Commanded, LineEvent, Stopped
from connectors.vda5050.member import Member, Setting
from connectors.vda5050.messages import VehicleName
from registry.mqtt import MqttClient
from registry.wire import BadMessage

log = logging.getLogger(__name__)
SUBTOPICS = ("connection", "factsheet", "state", "visualization")
MAJOR = "v2"
TICK_S = 0.25
MOST_VEHICLES = 200
MOST_WAITING = 10_000
COMPLAIN_EVERY_S = 60.0
_LEVEL = re.compile(r"[^/+#$\x00-\x1f]{1,64}")


@dataclass(frozen=True, slots=True)
class Said:
    """A vehicle said something."""

    name: VehicleName
    subtopic: str
    payload: bytes


class Fleet:
    """Network threads only put into the inbox; everything else happens on the thread of `run`.

    `refused` counts the messages that could not be read, by device.
    """

    def __init__(self, client: MqttClient, interface: str, setting: Setting) -> None:
        self.refused: Counter[str] = Counter()
        self._client, self._interface = client, interface
        self._setting = replace(setting, publish=self._publish)
        self._inbox: SimpleQueue[Said | LineEvent] = SimpleQueue()
        self._members: dict[str, Member] = {}
        self._complained_s: dict[str, float] = {}

    def run(self, stopping: Event) -> None:
        """Serve until `stopping` is set; then say goodbye to VIPO, not to the vehicles: they finish their orders."""
        for subtopic in SUBTOPICS:
            qos = 1 if subtopic == "connection" else 0
            self._client.subscribe(f"{self._interface}/{MAJOR}/+/+/{subtopic}", qos, self._hear)
        self._client.start()
        try:
            self._serve(stopping)
        finally:
            self._client.stop()
            with ThreadPoolExecutor(max_workers=max(1, len(self._members))) as pool:
                list(pool.map(Member.leave, self._members.values()))

    def _serve(self, stopping: Event) -> None:
        ticked_s = 0.0
        while not stopping.is_set():
            with suppress(Empty):
                self._take(self._inbox.get(timeout=TICK_S), time.monotonic())
            if (now := time.monotonic()) - ticked_s >= TICK_S:
                ticked_s = now
                for member in self._members.values():
                    member.tick(now)

    def _take(self, event: Said | LineEvent, now_s: float) -> None:
        if isinstance(event, Said):
            self._hear_vehicle(event, now_s)
            return
        member = self._members[event.device]
        match event:
            case Commanded(told=told):
                member.command(told, now_s)
            case Stopped(active=active):
                member.hold(now_s, active=active)
            case CameIn():
                member.introduce()

    def _hear_vehicle(self, said: Said, now_s: float) -> None:
        """Let a member hear; what cannot be read is counted, told once a minute, and harms nobody else."""
        member = self._member(said.name)
        if member is None:
            return
        try:
            member.hear(said.subtopic, said.payload, now_s)
        except BadMessage as error:
            self.refused[member.id] += 1
            if now_s - self._complained_s.get(member.id, -COMPLAIN_EVERY_S) >= COMPLAIN_EVERY_S:
                self._complained_s[member.id] = now_s
                log.warning("%s: %s (%d refused so far)", member.id, error.detail, self.refused[member.id])

    def _member(self, name: VehicleName) -> Member | None:
        found = next((m for m in self._members.values() if m.name == name), None)
        if found is not None:
            return found
        if len(self._members) >= MOST_VEHICLES:
            self.refused["further vehicles"] += 1
            return None
        member = Member(name, self._setting, self._inbox.put)
        self._members[member.id] = member
        return member

    def _hear(self, topic: str, payload: bytes, _retained: bool) -> None:
        _, _, manufacturer, serial, subtopic = topic.rsplit("/", 4)
        fits = _LEVEL.fullmatch(manufacturer) and _LEVEL.fullmatch(serial)
        if fits and payload and self._inbox.qsize() < MOST_WAITING:
            self._inbox.put(Said(VehicleName(manufacturer, serial), subtopic, payload))

    def _publish(self, name: VehicleName, subtopic: str, payload: bytes) -> None:
        self._client.publish(f"{self._interface}/{MAJOR}/{'/'.join(name)}/{subtopic}", payload, qos=0)

"""One vehicle as a device of VIPO: what it says on its own broker on one side, its device's connection on the other."""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from connectors.vda5050.connection_state import ConnectionState
from connectors.vda5050.control import Send, VehicleControl
from connectors.vda5050.coordinates import Frame
from connectors.vda5050.factsheet import Factsheet, describe, device_id, read_factsheet
from connectors.vda5050.messages import (
    Header,
    Located,
    VehicleName,
    VehicleState,
    read_connection,
    read_state,
    read_visualization,
)
from connectors.vda5050.orders import action, instant_actions
from connectors.vda5050.tasks import Vehicle
from connectors.vda5050.vehicle_memory import VehicleMemory, memory_path, read_memory, write_memory
from vipo_device.descriptions.reader import write_description
from vipo_device.kit.connection import ConnectionEvent, ConnectionMaker, DeviceConnection
from vipo_device.protocol.messages import AckMessage, BadMessage, DeviceCommand

log = logging.getLogger(__name__)
Publish = Callable[[VehicleName, str, bytes], None]
"""Sends a message's body to a vehicle, on a subtopic."""


@dataclass(frozen=True, slots=True)
class Setting:
    """What all vehicles of a connector share; `name_device` gives one its id by the one that its names make."""

    site: str
    frame: Frame
    station_type: str
    folder: Path
    connect: ConnectionMaker
    name_device: Callable[[str], str]
    new_id: Callable[[], str]
    clock: Callable[[], datetime]


class VehicleDevice:
    """A vehicle that was heard of. It becomes a device when its connection, factsheet and state are known."""

    def __init__(
        self, name: VehicleName, setting: Setting, publish: Publish, inbox: Callable[[ConnectionEvent], None]
    ) -> None:
        self.name, self.id = name, setting.name_device(device_id(name))
        self._publish = publish
        self.control: VehicleControl | None = None
        self._setting, self._inbox = setting, inbox
        self._path = memory_path(setting.folder, name)
        self._memory: VehicleMemory = read_memory(self._path, int(setting.clock().timestamp()))
        self.connection: DeviceConnection | None = None
        self._sheet: Factsheet | None = None
        self._sheet_said = b""
        self._sheet_fault = self._unfit = ""
        self._description = b""
        self._version = "2.0.0"
        self._described_facts = (b"", "")
        self._connection_state = ConnectionState()
        self._newest: dict[str, Header] = {}
        self._state: VehicleState | None = None
        self._located: Located | None = None
        self._missed = ""

    def hear(self, subtopic: str, payload: bytes, now_s: float) -> None:
        """Take in a message of the vehicle. Raises BadMessage."""
        match subtopic:
            case "connection":
                self._hear_connection(payload, now_s)
            case "factsheet" if payload != self._sheet_said:
                self._hear_factsheet(payload)
            case "state":
                state = read_state(payload, self.name)
                if self._is_news("state", state.header):
                    self._state, self._version = state, state.header.version
                    self._connection_state.hear_state(now_s)
                    self._locate(state.located)
            case "visualization":
                header, located = read_visualization(payload, self.name)
                if self._is_news("visualization", header):
                    self._locate(located)
        self._become_device()
        if subtopic == "state" and self.control is not None and self._state is not None:
            self._follow_presence(now_s)
            self.control.hear_state(self._state, now_s)
        self.speak(now_s)

    def command(self, command: DeviceCommand, now_s: float) -> None:
        """Take in a command of the server; one that cannot be carried out for a fault of ours is rejected."""
        if self.control is None:
            return
        try:
            self.control.command(command, now_s)
        except Exception:  # the edge of one vehicle: it takes no other along, nor is the command sent again
            log.exception("%s: the call of %s failed in the connector.", self.id, command.method)
            self.control.reject(command.id, "The connector could not read this call; its log says why.")
        self.speak(now_s)

    def hold(self, now_s: float, *, active: bool) -> None:
        """Take in the site's stop."""
        if self.control is not None and active != self.control.held:
            self.control.hold(now_s, active=active)
            self.speak(now_s)

    def introduce(self) -> None:
        """Say to the server who the vehicle is."""
        if self.connection is not None and self.control is not None:
            self.connection.introduce(self._description, online=self.control.online)

    def tick(self, now_s: float, *, is_reached: bool = True) -> None:
        """Let time pass: ask the vehicle for what is missing, send again what it did not answer.

        While the vehicles' broker is not reached, nothing is known of any vehicle, and its next state is waited for.
        """
        if is_reached:
            self._ask(now_s)
        else:
            self._connection_state.lose_sight(now_s)
        self._say_what_is_missing(now_s)
        if self.control is not None:
            self._follow_presence(now_s)
            self.control.settle(now_s)
        self.speak(now_s)

    def speak(self, now_s: float) -> None:
        """Keep what is to be known after a crash, then send: orders, what has begun, the state, what is over."""
        control, connection = self.control, self.connection
        if control is None or connection is None:
            return
        out, control.out = control.out, []
        numbered = [(item, self._count(item.topic) if isinstance(item, Send) else 0) for item in out]
        self._save(control.to_json())
        over = [item for item in out if isinstance(item, AckMessage) and item.is_final]
        for item, number in numbered:
            if isinstance(item, Send):
                self._send(item.topic, item.body, number)
            elif item not in over:
                connection.answer(item)
        if control.online or over:
            connection.report(control.look, now_s, at_once=bool(over))
        for ack in over:
            connection.answer(ack)

    def _hear_connection(self, payload: bytes, now_s: float) -> None:
        """Take in that the vehicle came or went; a will is older than what it ends, so its number says nothing.

        A vehicle that comes may count from 0 again, with a clock that is not set yet.
        """
        header, said = read_connection(payload, self.name)
        self._version = header.version
        self._connection_state.hear_connection(said, now_s)
        if self._connection_state.is_connected:
            self._newest.clear()
        self._follow_presence(now_s)

    def _hear_factsheet(self, payload: bytes) -> None:
        """Take in what the vehicle is; why one is refused is told again when it is missed. Raises BadMessage."""
        try:
            self._sheet = read_factsheet(payload, self.name)
        except BadMessage as error:
            self._sheet_fault = error.detail.rstrip(".")
            raise
        self._sheet_said = payload

    def _is_news(self, subtopic: str, header: Header) -> bool:
        if header.is_stale(self._newest.get(subtopic)):
            return False
        self._newest[subtopic] = header
        return True

    def _locate(self, located: Located | None) -> None:
        self._located = located or self._located
        if self.control is not None:
            self.control.located = self._located

    def _become_device(self) -> None:
        """Make the device, or describe it anew when the factsheet has changed. Raises BadMessage."""
        facts = (self._sheet_said, self._version)
        if not self._connection_state.is_connected or facts == self._described_facts:
            return
        if self._sheet is None or self._state is None or self._located is None:
            return
        self._described_facts, self._unfit = facts, ""
        home = self._memory.home or self._setting.frame.to_site(self._located.pose)
        try:
            description = describe(self.name, self._sheet, home, self._setting.site, self.id)
        except BadMessage as error:
            self._unfit = error.detail.rstrip(".")
            raise
        vehicle = Vehicle(description, self._sheet, self._setting.frame, self._version, self._setting.station_type)
        self._memory.home, self._description = home, write_description(description).encode()
        if self.control is not None:
            self.control.vehicle = vehicle
            self.introduce()
            return
        self.control = VehicleControl(vehicle, self._setting.new_id)
        self.control.located = self._located
        self._recall(self.control)
        self.connection = DeviceConnection(self.id, self._setting.site, self._memory.boot, self._inbox)
        self.connection.connect(self._setting.connect)

    def _recall(self, control: VehicleControl) -> None:
        """Take up what was open when the connector ended, and count this start."""
        if self._memory.control:
            try:
                control.recall(self._memory.control)
            except (KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
                log.warning("%s: what was open could not be read (%s).", self.id, error)
        write_memory(self._path, self._memory)

    def _follow_presence(self, now_s: float) -> None:
        """Follow whether the vehicle is there."""
        online = self._connection_state.is_online(now_s)
        if self.control is not None and self.connection is not None and online != self.control.online:
            self.control.online = online
            self.connection.say_presence(online=online)

    def _ask(self, now_s: float) -> None:
        """Ask for a state or factsheet that does not come by itself. Who never was a device has no memory."""
        questions = self._connection_state.take_questions(now_s, has_sheet=self._sheet is not None)
        numbered = [(what, self._count("instantActions")) for what in questions]
        if numbered and self._path.exists():
            write_memory(self._path, self._memory)
        for what, number in numbered:
            self._send("instantActions", action(self._setting.new_id(), what, {}), number)

    def _say_what_is_missing(self, now_s: float) -> None:
        """Tell in the log, once, why a vehicle that is connected is not on the map."""
        if self.control is not None or not self._connection_state.is_long_here(now_s):
            return
        fault = self._unfit or self._sheet_fault
        refused = f"its factsheet was refused ({fault})"
        known = {
            refused if fault else "it has not told its factsheet": self._sheet is not None and not self._unfit,
            "it has not told its state": self._state is not None,
            "it does not know where it is": self._located is not None,
        }
        missing = next((what for what, is_there in known.items() if not is_there), "")
        if missing and missing != self._missed:
            self._missed = missing
            log.warning("%s is connected, but not on the map yet: %s.", self.id, missing)

    def _save(self, control: Mapping[str, Any]) -> None:
        if control != self._memory.control:
            self._memory.control = control
            write_memory(self._path, self._memory)

    def _count(self, subtopic: str) -> int:
        """Return the number of the next message on a topic, no two of which may have the same."""
        number = self._memory.headers[subtopic] = self._memory.headers.get(subtopic, -1) + 1
        return number

    def _send(self, subtopic: str, body: Mapping[str, Any], number: int) -> None:
        header = {
            "headerId": number,
            "timestamp": self._setting.clock().strftime("%Y-%m-%dT%H:%M:%S.%f")[:-3] + "Z",
            "version": self._version,
            "manufacturer": self.name.manufacturer,
            "serialNumber": self.name.serial_number,
        }
        rest = body if subtopic == "order" else instant_actions([body], self._version)
        self._publish(self.name, subtopic, json.dumps({**header, **rest}, separators=(",", ":")).encode())

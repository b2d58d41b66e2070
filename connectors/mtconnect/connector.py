"""The connector: an agent's machines, each a device of VIPO's that says how it is."""

from __future__ import annotations

import logging
from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from queue import Empty, Full, Queue
from threading import Event, Thread
from time import monotonic

from connectors.mtconnect.agent import Agent
from connectors.mtconnect.condition import MachineCondition
from connectors.mtconnect.description import DescribedMachine, Stand, describe_machine, device_id
from connectors.mtconnect.documents import BadDocument, Machine, Observation
from connectors.mtconnect.follower import AgentEvent, AgentLost, Follower, MachinesListed, Observed
from vipo_device.kit.connection import (
    CommandReceived,
    ConnectionEvent,
    ConnectionMaker,
    DeviceConnection,
    IntroductionDue,
    leave,
)
from vipo_device.protocol.messages import AckMessage, DeviceCommand

log = logging.getLogger(__name__)
TICK_S = 0.25
PATIENCE_S = 5.0
MOST_WAITING = 1_000
MOST_DEVICES = 200
GAP_M = 1.0
ONLY_READ = "This machine is only read over MTConnect; it cannot be told anything."


@dataclass(frozen=True, slots=True)
class Setting:
    """What all machines of a connector share; the first one stands at `stand`, the others in a row beside it.

    `name_device` gives one its id by the one that its uuid makes, `boot` is the number of this start.
    """

    site: str
    stand: Stand
    interval_s: float
    connect: ConnectionMaker
    name_device: Callable[[str], str]
    boot: int


class FollowerEnded(RuntimeError):
    """The thread that asks the agent has ended by a fault: better no connector than one that tells old values."""


class MachineDevice:
    """One machine: its device's connection, and what is known of it."""

    def __init__(
        self, described: DescribedMachine, setting: Setting, boot: int, hear: Callable[[ConnectionEvent], None]
    ) -> None:
        self.id = described.description.id
        self._described, self._condition = described, MachineCondition(described)
        self.connection = DeviceConnection(self.id, setting.site, boot, hear)
        self._is_known = self._online = False
        self.connection.connect(setting.connect)

    def describe(self, described: DescribedMachine) -> None:
        """Take in what the machine tells from now on; how it is follows."""
        if described != self._described:
            self._described, self._condition = described, MachineCondition(described)
            self.introduce()

    def take(self, said: list[Observation], now_s: float, *, is_whole: bool) -> None:
        """Take in what the agent said of the machine; what is not whole is of no use before that was."""
        if is_whole:
            self._condition.forget()
            self._is_known = True
        self._condition.take(said)
        self.speak(now_s)

    def lose(self) -> None:
        """Know nothing of the machine any more: its agent is away, or does not name it."""
        self._condition.forget()
        self._is_known = False
        self._be_present()

    def introduce(self) -> None:
        """Say to the server who the machine is."""
        self.connection.introduce(self._described.turtle, online=self._online)

    def refuse(self, command: DeviceCommand) -> None:
        """Refuse a command: the machine is only read."""
        self.connection.answer(AckMessage(command.id, "REJECTED", ONLY_READ))

    def speak(self, now_s: float) -> None:
        """Say how the machine is, if that is due."""
        self._be_present()
        if self._online:
            self.connection.report(self._condition.look, now_s)

    def _be_present(self) -> None:
        online = self._is_known and self._condition.is_available
        if online != self._online:
            self._online = online
            self.connection.say_presence(online=online)


class Connector:
    """Threads that listen only put into the inbox; everything else happens on the thread of `run`."""

    def __init__(self, agent: Agent, setting: Setting) -> None:
        self._agent, self._setting = agent, setting
        self._inbox: Queue[AgentEvent | ConnectionEvent] = Queue(MOST_WAITING)
        self._devices: dict[str, MachineDevice] = {}
        self._by_id: dict[str, MachineDevice] = {}

    def run(self, stopping: Event) -> None:
        """Serve until `stopping` is set; then say that the machines are not to be seen any more."""
        follower = Follower(self._agent, self._setting.interval_s, self._inbox.put)
        thread = Thread(target=follower.run, args=(stopping,), name="follower", daemon=True)
        thread.start()
        try:
            self._serve(stopping, thread)
        finally:
            leave(device.connection for device in self._devices.values())

    def _serve(self, stopping: Event, follower: Thread) -> None:
        ticked_s = 0.0
        while not stopping.is_set():
            if not follower.is_alive():
                raise FollowerEnded("Nothing follows the agent any more; why stands above. Start the connector anew.")
            with suppress(Empty):
                self._take(self._inbox.get(timeout=TICK_S))
            if (now := monotonic()) - ticked_s >= TICK_S:
                ticked_s = now
                for device in self._devices.values():
                    device.speak(now)

    def _take(self, event: AgentEvent | ConnectionEvent) -> None:
        match event:
            case MachinesListed(machines=machines):
                self._take_machines(machines)
            case Observed():
                self._distribute(event)
            case AgentLost():
                for device in self._devices.values():
                    device.lose()
            case IntroductionDue(device=name):
                self._by_id[name].introduce()
            case CommandReceived(device=name, command=command):
                self._by_id[name].refuse(command)

    def _take_machines(self, machines: tuple[Machine, ...]) -> None:
        """Make devices of machines that are new, describe the others anew; who is not named any more goes offline."""
        named = {machine.uuid: machine for machine in machines}
        for uuid, device in self._devices.items():
            if uuid not in named:
                device.lose()
        for place, (uuid, machine) in enumerate(named.items()):
            name = self._setting.name_device(device_id(uuid))
            try:
                described = describe_machine(machine, self._setting.site, self._stand(place), name)
            except BadDocument as error:
                log.warning("%s", error)
                continue
            self._add_or_update(uuid, described)

    def _add_or_update(self, uuid: str, described: DescribedMachine) -> None:
        if described.left_out:
            name, most = described.description.id, len(described.readings)
            log.warning("%s tells more than a device can: %d shown, %d not.", name, most, described.left_out)
        if uuid in self._devices:
            self._devices[uuid].describe(described)
            return
        if len(self._devices) >= MOST_DEVICES:
            log.warning("%s is one machine too many: a connector serves %d.", described.description.id, MOST_DEVICES)
            return
        device = MachineDevice(described, self._setting, self._setting.boot, self._hear_connection)
        self._devices[uuid] = self._by_id[device.id] = device

    def _stand(self, place: int) -> Stand:
        stand = self._setting.stand
        pose = replace(stand.pose, x=stand.pose.x + place * (stand.size.x + GAP_M))
        return Stand(pose, stand.size)

    def _distribute(self, said: Observed) -> None:
        by_machine: defaultdict[str, list[Observation]] = defaultdict(list)
        for observation in said.observations:
            by_machine[observation.machine].append(observation)
        now = monotonic()
        for uuid, device in self._devices.items():
            if said.is_whole or uuid in by_machine:
                device.take(by_machine[uuid], now, is_whole=said.is_whole)

    def _hear_connection(self, event: ConnectionEvent) -> None:
        with suppress(Full):
            self._inbox.put(event, timeout=PATIENCE_S)

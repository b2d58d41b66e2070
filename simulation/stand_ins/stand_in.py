"""A device's stand-in: it does in a simulated world of its own what the device is told, and answers in its place.

It begins where the real device was. What is handed over between a robot and a machine is told to both from outside,
since the other one may be a real one or play in a world of its own. Not thread-safe.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from simulation.site_facts import DescribedDevice
from simulation.stand_ins.hand_overs import HandOver, HandOvers
from simulation.stand_ins.shared_connection import SharedConnection
from simulation.twin_memory import TwinMemory, read_memory, snapshot, write_memory
from simulation.virtual_device import VirtualDevice, look_at
from simulation.world import DELIVERY_S, Ack, Obstacle, Scene, World, open_floor
from vipo_device.kit.connection import CommandReceived, ConnectionEvent, IntroductionDue, StopChanged
from vipo_device.protocol.description import Description, Pose, Scalar
from vipo_device.protocol.loads import read_load
from vipo_device.protocol.messages import AckMessage

SLICE_S = 0.25
PATIENCE_S = 3.0
MakeWorld = Callable[[Scene], World]


@dataclass(frozen=True, slots=True)
class StandInFacts:
    """A device as its stand-in begins: what it shows, and the machines that a robot may serve.

    `description` says where a robot is at home, `stands` where it is (None: at home). `boot` is the highest start that
    VIPO knows of the stand-in, -1 for none; the new one has the number `begins`.
    """

    site: str
    description: Description
    machines: Sequence[Description] = ()
    readings: Mapping[str, Scalar] = field(default_factory=dict)
    boot: int = -1
    begins: int = 0
    stands: Pose | None = None

    def is_like(self, other: StandInFacts) -> bool:
        """Tell whether both are the same device among the same machines, wherever a robot is by now."""
        return self._made_of() == other._made_of()

    def _made_of(self) -> tuple[Description, Sequence[Description]]:
        own = self.description
        return (replace(own, pose=Pose(0, 0)) if own.kind == "robot" else own), self.machines


class StandIn:
    """Plays one device over a connection that it may share with others."""

    def __init__(
        self, facts: StandInFacts, connection: SharedConnection, make_world: MakeWorld, memory: Path, speed: float
    ) -> None:
        self.facts, self._connection, self._make_world, self._memory, self._speed = (
            facts,
            connection,
            make_world,
            memory,
            speed,
        )
        described = DescribedDevice(facts.description, b"")  # it describes nothing: its device has
        self._device = VirtualDevice(described, facts.site, facts.begins, self._take, "sim")
        self._lag_s, self._now = 0.0, 0.0
        self._hand_overs = HandOvers()
        self._held = False
        self._obstacles: tuple[Obstacle, ...] = ()
        self._world = self._begin()

    @property
    def id(self) -> str:
        """The device's id."""
        return self.facts.description.id

    @property
    def is_busy(self) -> bool:
        """True while it carries something out."""
        return self._world.busy()[self.id]

    @property
    def stock(self) -> Mapping[str, int] | None:
        """What a machine holds; None for a robot."""
        return self._world.stocks().get(self.id) if self.facts.description.kind == "machine" else None

    def connect(self, now: float) -> None:
        """Begin to speak."""
        self._now = now
        self._device.connect(lambda _device, _will: self._connection)

    def leave(self) -> None:
        """Say that it goes, which the device's row no longer hears where it was switched back, and end its world."""
        self._device.connection.say_presence(online=False)
        self.close()

    def close(self) -> None:
        """End its world without a word: another process plays it by now."""
        self._connection.cut()
        self._world.close()

    def change(self, facts: StandInFacts) -> None:
        """Play a device that describes itself anew, or has other machines around; it is not busy."""
        memory = self._snapshot()
        self._world.close()
        self.facts = replace(facts, begins=self.facts.begins)
        self._world = self._make_world(memory.put_into(self._scene()))
        self._world.hold(active=self._held)
        self._world.put_in_the_way(self._obstacles)

    def put_in_the_way(self, obstacles: Sequence[Obstacle]) -> None:
        """Learn what people have put on the floor for simulated robots to meet."""
        self._obstacles = tuple(obstacles)
        self._world.put_in_the_way(self._obstacles)

    def see_stock(self, machine: str, stock: Mapping[str, int]) -> None:
        """Learn what a machine holds that the robot may serve."""
        if any(each.id == machine for each in self.facts.machines):
            self._world.set_stock(machine, stock)

    def take_over(self, goods: HandOver) -> None:
        """Learn what a robot has fetched here or brought."""
        held = dict(self.stock or {})
        held[goods.object] = max(0, held.get(goods.object, 0) + goods.count)
        self._world.set_stock(self.id, {name: count for name, count in held.items() if count})
        write_memory(self._memory, self._snapshot())

    def advance(self, now: float) -> list[HandOver]:
        """Let time pass, say what came of it, and return what has changed hands; `now` in seconds that only rise."""
        self._lag_s += max(0.0, now - self._now) * self._speed
        self._now = max(now, self._now)
        step = min(self._lag_s, SLICE_S * max(1.0, self._speed))
        acks = [event for event in self._world.advance(step) if isinstance(event, Ack) and event.device == self.id]
        self._lag_s = 0.0 if self._lag_s - step > PATIENCE_S * max(1.0, self._speed) else self._lag_s - step
        return self._speak(acks)

    def _take(self, event: ConnectionEvent) -> None:
        match event:
            case CommandReceived(command=command):
                self._hand_overs.note(self.id, command)
                self._world.command(self.id, command.method, command.arguments, command.id)
            case IntroductionDue():
                self._device.connection.say_presence(online=True)
            case StopChanged(active=active):
                self._held = active
                self._world.hold(active=active)

    def _speak(self, acks: Sequence[Ack]) -> list[HandOver]:
        """Say the state, then the final answers: who hears that it is done must already know what came of it."""
        over = [ack for ack in acks if ack.is_final]
        if over:
            write_memory(self._memory, self._snapshot())  # what was answered is never done again after a crash
        for ack in acks:
            if not ack.is_final:
                self._device.answer(ack)
        seen = look_at(self._world, [self.facts.description])[self.id]
        self._device.report(seen, self._now, at_once=bool(over))
        for ack in over:
            self._device.answer(ack)
        handed = [self._hand_overs.take(self.id, AckMessage(ack.command, ack.status)) for ack in over]
        return [goods for goods in handed if goods is not None]

    def _begin(self) -> World:
        """Return the world as this stand-in left it, or as the device's row says it is."""
        scene, kept = self._scene(), read_memory(self._memory)
        is_own = self.facts.boot >= 0 and kept.boots.get(self.id) == self.facts.boot
        return self._make_world(kept.put_into(scene) if is_own else scene)

    def _scene(self) -> Scene:
        own = self.facts.description
        is_robot, here = own.kind == "robot", self.facts.stands or own.pose
        return Scene(
            grid=open_floor(here),
            devices=[own, *(self.facts.machines if is_robot else ())],
            poses={own.id: here} if is_robot else {},
            readings={own.id: self.facts.readings},
            carrying={own.id: read_load(self.facts.readings.get("load"))} if is_robot else {},
            bodiless=frozenset(machine.id for machine in self.facts.machines),
            delivery_s=None if is_robot else DELIVERY_S,
        )

    def _snapshot(self) -> TwinMemory:
        return snapshot(self._world, {self.id: self.facts.begins})

"""How a pretend device looks from outside: it speaks as a real one does."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from simulation.site_facts import VirtualDevice
from simulation.world import Ack
from vipo_device.kit.connection import ConnectionMaker, DeviceLine, LineEvent
from vipo_device.protocol.description import DeviceState, Pose, Scalar
from vipo_device.protocol.messages import AckMessage


@dataclass(frozen=True, slots=True)
class Look:
    """A device's state as others may see it."""

    done: bool
    pose: Pose
    readings: Mapping[str, Scalar]


class Face:
    """A device's connection. What it hears it passes on at once, on the network's thread."""

    def __init__(self, device: VirtualDevice, site: str, boot: int, hear: Callable[[LineEvent], None]) -> None:
        self._device = device
        self._line = DeviceLine(device.description.id, site, boot, hear)
        self._command = ""

    def connect(self, make: ConnectionMaker) -> None:
        """Begin to connect; the will says offline with this start's number."""
        self._line.connect(make)

    def say_goodbye(self) -> None:
        """Say that the device goes offline."""
        self._line.say_presence(online=False)

    def disconnect(self) -> None:
        """End the connection; what was said is sent before."""
        self._line.disconnect()

    def introduce(self) -> None:
        """Say who the device is and that it is here; its state follows with the next report."""
        self._line.introduce(self._device.source, online=True)

    @property
    def is_introduced(self) -> bool:
        """True while the device is connected and has said how it is."""
        return self._line.is_introduced

    def send_map(self, messages: Iterable[bytes]) -> None:
        """Send the parts of the robot's map."""
        for message in messages:
            self._line.say_map(message)

    def answer(self, ack: Ack) -> None:
        """Answer a command."""
        if ack.status == "RUNNING":
            self._command = ack.command
        self._line.answer(AckMessage(ack.command, ack.status, ack.why[:256], ack.result))

    def report(self, look: Look, now_s: float, *, at_once: bool = False) -> None:
        """Say the state if it changed and enough time has passed, or if nothing was said for long."""

        def state(boot: int, seq: int) -> DeviceState:
            return DeviceState(boot, seq, look.done, look.pose, self._command, look.readings)

        self._line.report(state, now_s, at_once=at_once)

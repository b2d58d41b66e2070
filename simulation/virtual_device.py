"""A simulated device as others see it: it speaks to VIPO as a real one does."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace

from simulation.site_facts import DescribedDevice
from simulation.world import Ack, World
from vipo_device.kit.connection import ConnectionEvent, ConnectionMaker, DeviceConnection
from vipo_device.protocol.description import Description, DeviceState, Pose, Scalar
from vipo_device.protocol.messages import AckMessage, Voice


@dataclass(frozen=True, slots=True)
class Appearance:
    """A device's state as others may see it."""

    done: bool
    pose: Pose
    readings: Mapping[str, Scalar]


def look_at(world: World, devices: Iterable[Description]) -> dict[str, Appearance]:
    """Return how these devices of a world are, by id; a machine stands where it is described."""
    robots, readings, busy = world.robots(), world.readings(), world.busy()
    return {
        device.id: Appearance(
            not busy[device.id],
            _rounded(robots[device.id].pose) if device.id in robots else device.pose,
            readings[device.id],
        )
        for device in devices
    }


def _rounded(pose: Pose) -> Pose:
    return replace(pose, x=round(pose.x, 3), y=round(pose.y, 3), theta=round(pose.theta, 3))


class VirtualDevice:
    """A device's connection. What it hears it passes on at once, on the network's thread."""

    def __init__(
        self,
        device: DescribedDevice,
        site: str,
        boot: int,
        hear: Callable[[ConnectionEvent], None],
        voice: Voice = "dev",
    ) -> None:
        self._device = device
        self.connection = DeviceConnection(device.description.id, site, boot, hear, voice)
        self._command = ""

    def connect(self, make: ConnectionMaker) -> None:
        """Begin to connect; the will says offline with this start's number."""
        self.connection.connect(make)

    def introduce(self) -> None:
        """Say who the device is and that it is here; its state follows with the next report."""
        self.connection.introduce(self._device.source, online=True)

    @property
    def is_introduced(self) -> bool:
        """True while the device is connected and has said how it is."""
        return self.connection.is_introduced

    def send_map(self, messages: Iterable[bytes]) -> None:
        """Send the parts of the robot's map."""
        for message in messages:
            self.connection.say_map(message)

    def answer(self, ack: Ack) -> None:
        """Answer a command."""
        if ack.status == "RUNNING":
            self._command = ack.command
        self.connection.answer(AckMessage(ack.command, ack.status, ack.why[:256], ack.result))

    def report(self, seen: Appearance, now_s: float, *, at_once: bool = False) -> None:
        """Say the state if it changed and enough time has passed, or if nothing was said for long."""

        def state(boot: int, seq: int) -> DeviceState:
            return DeviceState(boot, seq, seen.done, seen.pose, self._command, seen.readings)

        self.connection.report(state, now_s, at_once=at_once)

"""One device and its copy: both hear the same commands, and what each takes for them is measured.

A copy lives while its device is at work: it begins where the device last said that it is, so that no error is carried
from one job to the next, and what it has not done by the time that its device has, it does at once, in virtual time.
Times are seconds of one clock, the mirror's own; no device's clock is asked.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import hypot

from simulation.world import Ack, Scene, World, open_floor
from vipo_device.protocol.description import Description, DeviceState, Pose, Scalar
from vipo_device.protocol.loads import read_load
from vipo_device.protocol.messages import CONTROLS, AckMessage, DeviceCommand, is_final

MOST_COMMANDS = 400
"""So many of one job are followed; a device that is told more at once is not measured in it."""
LONGEST_S = 4 * 3600.0
LOST_S = 3600.0
"""A copy that needs so much longer than its device (virtual seconds) has lost its way."""
AHEAD_S = 1.0
MakeWorld = Callable[[Scene], World]


@dataclass(frozen=True, slots=True)
class Measured:
    """What one command took: the device, and its copy (seconds)."""

    device: str
    command: str
    method: str
    real_s: float
    predicted_s: float


@dataclass(frozen=True, slots=True)
class Job:
    """What came of one job: each command that both have done, and how far apart a robot and its copy were at most.

    `apart_m` is None for what stands still.
    """

    measured: tuple[Measured, ...]
    apart_m: float | None


@dataclass(slots=True)
class _Order:
    """A command under way; of the device's answers and of its copy's the moments at which they began and ended."""

    method: str
    real_began: float | None = None
    real_ended: float | None = None
    copy_began: float | None = None
    copy_ended: float | None = None
    void: bool = False


class DeviceCopy:
    """A device as the mirror sees it, and its copy while there is one. Not thread-safe; `now` only ever rises."""

    def __init__(
        self, description: Description, machines: Sequence[Description], make_world: MakeWorld, speed: float = 1.0
    ) -> None:
        self.description = description
        self._machines = [m for m in machines if m.id != description.id]
        self._make_world, self._speed = make_world, speed
        self._state: DeviceState | None = None
        self._world: World | None = None
        self._orders: dict[str, _Order] = {}
        self._began_at = self._now = 0.0
        self._jobs: list[Job] = []
        self._apart_m: float | None = None
        self._held = False

    @property
    def is_at_work(self) -> bool:
        """True while there is a copy."""
        return self._world is not None

    @property
    def pose(self) -> Pose | None:
        """Return where the copy of a robot is; None for a machine's, and while there is none."""
        if self._world is None or self.description.kind != "robot":
            return None
        return self._world.robots()[self.description.id].pose

    def is_of(self, description: Description, machines: Sequence[Description]) -> bool:
        """Tell whether this is the copy of such a device among such machines."""
        return self.description == description and self._machines == [m for m in machines if m.id != description.id]

    def begin_with(self, readings: Mapping[str, Scalar]) -> None:
        """Take in what is known of the device's readings before it is first heard."""
        if self._state is None:
            self._state = DeviceState(-1, -1, True, self.description.pose, "", readings)

    def learn_from(self, before: DeviceCopy) -> None:
        """Take over what another copy of the same device has heard of its state."""
        self._state = before._state

    def hear_command(self, now: float, command: DeviceCommand) -> None:
        """Take in what the device was told; what it was told before it is only asked again."""
        self.advance(now)
        if command.id in self._orders:
            return
        if self._is_over:
            self._finish()
        if self._world is None:
            if command.method in CONTROLS:
                return
            self._begin(now)
        assert self._world is not None
        if command.method not in CONTROLS:
            self._orders[command.id] = _Order(command.method)
        self._world.command(self.description.id, command.method, command.arguments, command.id)

    def hear_answer(self, now: float, answer: AckMessage) -> None:
        """Take in what the device says of a command."""
        self.advance(now)
        order = self._orders.get(answer.command)
        if order is None or order.real_ended is not None:
            return
        if answer.status == "RUNNING":
            order.real_began = now if order.real_began is None else order.real_began
        elif is_final(answer.status):
            self._end(now, answer, order)

    def hear_state(self, now: float, state: DeviceState) -> None:
        """Take in how the device is."""
        self.advance(now)
        self._state = state
        copy = self.pose
        if copy is not None and state.pose is not None:
            apart_m = hypot(copy.x - state.pose.x, copy.y - state.pose.y)
            self._apart_m = max(self._apart_m or 0.0, apart_m)

    def hold(self, now: float, *, active: bool) -> None:
        """Let the copy stand still with its device, or go on."""
        self.advance(now)
        self._held = active
        if self._world is not None:
            self._world.hold(active=active)

    def forget(self) -> None:
        """Give the copy up: the device is another one, or gone."""
        if self._world is not None:
            self._world.close()
        self._world, self._orders, self._apart_m = None, {}, None

    def advance(self, now: float) -> None:
        """Let time pass for the copy."""
        before, self._now = self._now, max(now, self._now)
        if self._world is not None and now > before:
            self._let_pass(before, (now - before) * self._speed)

    def take_job(self) -> Job | None:
        """Return what came of a job that is over; None while there is none."""
        if self._is_over:
            self._finish()
        elif self._now - self._began_at > LONGEST_S or len(self._orders) > MOST_COMMANDS:
            self.forget()
        return self._jobs.pop(0) if self._jobs else None

    @property
    def _is_over(self) -> bool:
        """True once the device has done, or given up, all that it was told."""
        return bool(self._orders) and all(order.real_ended is not None for order in self._orders.values())

    def _finish(self) -> None:
        """Let the copy do what is left, keep what came of the job, and end the copy."""
        assert self._world is not None
        at, limit = self._now, self._world.time_s + LOST_S
        while self._world.time_s < limit and any(not o.void and o.copy_ended is None for o in self._orders.values()):
            self._let_pass(at, AHEAD_S)
            at += AHEAD_S / self._speed
        measured = tuple(self._measure())
        self._jobs.append(Job(measured, self._apart_m))
        self.forget()

    def _measure(self) -> Iterator[Measured]:
        """Tell what each command took: from its beginning, or the end of the one before, which some begin in."""
        real_free = copy_free = float("-inf")
        for name, order in self._orders.items():
            real, copy = (order.real_began, order.real_ended), (order.copy_began, order.copy_ended)
            if real[0] is not None and real[1] is not None and copy[0] is not None and copy[1] is not None:
                real_s, copy_s = real[1] - max(real[0], real_free), copy[1] - max(copy[0], copy_free)
                if not order.void and real_s > 0 and copy_s > 0:
                    yield Measured(self.description.id, name, order.method, real_s, copy_s)
            real_free, copy_free = max(real_free, real[1] or real_free), max(copy_free, copy[1] or copy_free)

    def _let_pass(self, at: float, virtual_s: float) -> None:
        """Let virtual time pass in the copy's world, from the moment `at` on, and note what it does."""
        assert self._world is not None
        began = self._world.time_s
        for event in self._world.advance(virtual_s):
            if isinstance(event, Ack) and event.device == self.description.id:
                self._note(at + (event.t_s - began) / self._speed, event)

    def _begin(self, now: float) -> None:
        """Put a copy where the device is, beside copies of the machines, with what they said that they hold."""
        name, state = self.description.id, self._state
        pose = self.description.pose if state is None or state.pose is None else state.pose
        scene = Scene(
            grid=open_floor(pose),
            devices=[self.description, *self._machines],
            poses={name: pose} if self.description.kind == "robot" else {},
            readings={} if state is None else {name: state.properties},
            carrying={} if state is None else {name: read_load(state.properties.get("load"))},
            bodiless=frozenset(machine.id for machine in self._machines),
        )
        self._world = self._make_world(scene)
        self._world.hold(active=self._held)
        self._began_at = self._now = now

    def _end(self, now: float, answer: AckMessage, order: _Order) -> None:
        order.real_ended = now
        order.void = order.void or answer.status != "DONE" or order.real_began is None
        if answer.status == "DONE":
            self._close_moves_before(answer.command, now)
        elif self._world is not None and order.copy_ended is None:
            cancel = {"command": answer.command}
            self._world.command(self.description.id, "cancel", cancel, f"mirror {answer.command}")

    def _close_moves_before(self, last: str, now: float) -> None:
        """Who has reached the end of one piece is past those before it, whether their answers were heard or not."""
        if self._orders[last].method != "move":
            return
        for name, order in self._orders.items():
            if name == last:
                return
            if order.method == "move" and order.real_ended is None:
                order.real_ended, order.void = now, True

    def _note(self, at: float, ack: Ack) -> None:
        order = self._orders.get(ack.command)
        if order is None:
            return
        if ack.status == "RUNNING":
            order.copy_began = at
        elif ack.is_final:
            order.copy_ended = at
            order.void = order.void or ack.status != "DONE" or order.copy_began is None

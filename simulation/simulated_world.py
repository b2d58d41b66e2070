"""The simulated world itself: actors decide, a driver moves the robots, time goes in equal ticks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import floor
from typing import Protocol

from simulation.actors import Motion
from simulation.near_misses import NearnessWatch
from simulation.obstacles import Obstacles
from simulation.scene import Layout, make_actors, make_layout
from simulation.world import Ack, Obstacle, RobotSnapshot, Scene, WorldEvent
from vipo_device.protocol.description import Pose, Scalar

Drive = tuple[float, float]
SLOW_TICK_S = 1.0


class Driver(Protocol):
    """What moves robots: mathematics or physics."""

    tick_s: float

    def motions(self) -> Mapping[str, Motion]:
        """Return where each robot is; the objects stay the same and change as time passes."""

    def drive(self, targets: Mapping[str, Drive], touching: Mapping[str, Sequence[Drive]]) -> None:
        """Let one tick pass; `targets` are speed and turn, robots that are not named stand.

        `touching` holds, for each robot that touches something, the directions that lead away from what it touches.
        """

    def close(self) -> None:
        """Give back what the driver holds."""


class DriverFactory(Protocol):
    """Makes a driver for what stands on a floor."""

    def __call__(self, layout: Layout) -> Driver:
        """Return the driver."""


class SimulatedWorld:
    """A world in virtual time (see `World`)."""

    def __init__(self, scene: Scene, make_driver: DriverFactory) -> None:
        self._events: list[WorldEvent] = []
        self._obstacles = Obstacles(scene.faults, self._events.append)
        self._entered: dict[str, int] = {}
        self._by_kind = make_actors(scene, self._events.append)
        layout = make_layout(scene, self._by_kind)
        self._driver = make_driver(layout)
        self._motions = self._driver.motions()
        self._nearness = NearnessWatch(layout, self._motions)
        self._actors = {**self._by_kind.machines, **self._by_kind.robots}
        self._delivery_s = scene.delivery_s
        here = frozenset(self._actors)
        self._delivered = here if scene.delivered is None else scene.delivered & here
        self._due_s: dict[str, float] = {}
        self._asked_s = 0.0
        self._ticks = 0
        self._slow_ticks = 0
        self._begin_faults()

    @property
    def time_s(self) -> float:
        """Return the virtual time."""
        return self._asked_s

    def command(self, device: str, method: str, arguments: Mapping[str, object], command: str) -> None:
        """Give a device a command; a device that is not here stays silent, as on the network."""
        actor = self._actors.get(device)
        if actor is not None:
            actor.command(self._asked_s, method, arguments, command)

    def reach(self, step: str) -> None:
        """Say that a step of the program is entered, with which faults may begin."""
        count = self._entered[step] = self._entered.get(step, 0) + 1
        self._obstacles.reach(self._asked_s, step, count)
        for actor in self._actors.values():
            actor.reach(self._asked_s, step, count)

    def put_in_the_way(self, obstacles: Sequence[Obstacle]) -> None:
        """Say what stands on the floor that is on no map, besides faults; what stood there before is gone."""
        if self._obstacles.put(obstacles):
            for robot in self._by_kind.robots.values():
                robot.stands_before = ""

    def advance(self, seconds: float) -> list[WorldEvent]:
        """Let time pass and return what happened, oldest first."""
        self._asked_s = round(self._asked_s + max(0.0, seconds), 9)
        last = floor(self._asked_s / self._driver.tick_s + 1e-6)
        while self._ticks < last:
            self._ticks += 1
            self._tick(round(self._ticks * self._driver.tick_s, 9))
        happened, self._events[:] = list(self._events), []
        return happened

    def hold(self, *, active: bool) -> None:
        """Stop everything where it is, or let it go on."""
        for actor in self._actors.values():
            actor.held = active

    def robots(self) -> dict[str, RobotSnapshot]:
        """Return every robot's state."""
        return {
            name: RobotSnapshot(
                Pose(motion.x, motion.y, 0.0, motion.theta), motion.speed, dict(robot.carrying), robot.battery
            )
            for name, robot in self._by_kind.robots.items()
            for motion in (self._motions[name],)
        }

    def readings(self) -> dict[str, dict[str, Scalar]]:
        """Return every device's properties."""
        return {name: dict(actor.readings) for name, actor in self._actors.items()}

    def busy(self) -> dict[str, bool]:
        """Return, for each device, whether it is doing something."""
        return {name: actor.busy for name, actor in self._actors.items()}

    def stocks(self) -> dict[str, dict[str, int]]:
        """Return what each machine holds."""
        return {name: dict(machine.stock) for name, machine in self._by_kind.machines.items()}

    def set_stock(self, machine: str, stock: Mapping[str, int]) -> None:
        """Say what a machine holds by now, as after a delivery."""
        self._by_kind.machines[machine].set_stock(self._asked_s, stock)

    def remembered(self) -> dict[str, list[Ack]]:
        """Return the final answers that each device would give again, oldest first."""
        now = self._asked_s
        return {
            name: [Ack(now, name, a.command, a.status, a.why, a.result) for a in actor.ledger.over()]
            for name, actor in self._actors.items()
        }

    def under_way(self) -> dict[str, tuple[str, ...]]:
        """Return the commands that each device has begun or queued."""
        return {name: tuple(ack.command for ack in actor.ledger.under_way()) for name, actor in self._actors.items()}

    def close(self) -> None:
        """Give back what the driver holds."""
        self._driver.close()

    def _begin_faults(self) -> None:
        """Let the faults begin that are there from the first moment on, before anybody looks."""
        self._obstacles.pass_time(0.0)
        for actor in self._actors.values():
            actor.notice_faults(0.0)

    def _tick(self, t_s: float) -> None:
        dt_s = self._driver.tick_s
        for machine in self._by_kind.machines.values():
            if not machine.resting:
                machine.advance(t_s, dt_s)
        targets = {
            name: robot.control(self._motions[name], t_s, dt_s)
            for name, robot in self._by_kind.robots.items()
            if not robot.resting
        }
        if self._obstacles.pass_time(t_s):
            targets = {name: self._kept_back(name, target) for name, target in targets.items()}
        self._driver.drive(targets, self._nearness.touching)
        self._events.extend(self._nearness.look(t_s, targets))
        for name in targets:
            self._by_kind.robots[name].touches = self._nearness.touched_by(name)
        if t_s >= (self._slow_ticks + 1) * SLOW_TICK_S:
            self._slow_ticks += 1
            self._tick_slowly(t_s, targets)

    def _kept_back(self, name: str, target: Drive) -> Drive:
        """Let a robot stand that would drive into a thing that is not on the map: it sees it."""
        robot, (speed, turn) = self._by_kind.robots[name], target
        robot.stands_before = self._obstacles.ahead_of(self._motions[name], robot.radius_m) if speed > 0 else ""
        return (0.0, turn) if robot.stands_before else target

    def _tick_slowly(self, t_s: float, targets: Mapping[str, Drive]) -> None:
        """Do once a second what need not be done more often."""
        for name, robot in self._by_kind.robots.items():
            robot.notice_faults(t_s)
            robot.use_battery(t_s, SLOW_TICK_S, driving=any(targets.get(name, (0.0, 0.0))))
        if self._delivery_s is not None:
            self._deliver(t_s, self._delivery_s)

    def _deliver(self, t_s: float, after_s: float) -> None:
        for name, machine in self._by_kind.machines.items():
            if name not in self._delivered:
                continue
            goods = machine.wanted_stock()
            if goods is None:
                self._due_s.pop(name, None)
            elif t_s >= self._due_s.setdefault(name, t_s + after_s):
                del self._due_s[name]
                machine.set_stock(t_s, goods)
        for name, robot in self._by_kind.robots.items():
            if name not in self._delivered or not robot.is_flat:
                self._due_s.pop(name, None)
            elif t_s >= self._due_s.setdefault(name, t_s + after_s):
                robot.change_battery(t_s)

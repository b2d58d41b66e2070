"""How soon the mirror finds a planted slowdown, how often it is wrong, and what it costs to copy devices."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from random import Random

from bench.figures import figure
from execution.mirror.paces import find_change
from registry import services as registry
from simulation.mirror.device_copy import DeviceCopy
from simulation.services import DriverName, make_world
from simulation.world import Ack, Scene, World
from vipo_device.descriptions.reader import read_description
from vipo_device.protocol.description import Description, DeviceState
from vipo_device.protocol.messages import AckMessage, DeviceCommand

KNOWN, NEW = 30, 10
SLOWER = 1.2
TICK_S = 0.05
BACK_AND_FORTH = (((20.6, -4.6), (18.0, -6.0)), ((18.0, -6.0), (20.6, -4.6)))
CALM_DEVICES, CALM_MEASUREMENTS = 100, 1000


def measure() -> Iterator[dict[str, object]]:
    devices = [read_description(source) for source in registry.read_demo_descriptions().values()]
    for driver in ("kinematic", "physics"):
        yield from _planted(devices, driver)
    yield from _calm()


def _planted(devices: list[Description], driver: DriverName) -> Iterator[dict[str, object]]:
    """A robot drives to and fro, then a fifth slower: its world is `driver`'s, its copy's the kinematic one."""
    robot = next(device for device in devices if device.kind == "robot")
    usual = _Bed(devices, robot, driver, {})
    paces = usual.drive(KNOWN)
    slowed = _Bed(devices, robot, driver, {robot.id: {"move": SLOWER}})
    found = None
    for count in range(1, NEW + 1):
        paces += slowed.drive(1)
        change = find_change(paces)
        if change is not None:
            found = count
            break
    facts = {"driver": driver, "planted_percent": 20, "known": KNOWN}
    yield figure("moves until a planted slowdown is found", found or NEW + 1, "moves", **facts, limit=NEW)
    yield figure("found change of a robot's moves", change.percent if change else 0, "%", **facts)
    yield figure("usual pace of its moves before", sum(paces[:KNOWN]) / KNOWN, "times its copy", **facts)
    yield figure("processor time of a copy", usual.copy_cpu_s / usual.virtual_s, "s for a second at work", **facts)


class _Bed:
    """A robot in a world of its own, and its copy; both are told the same moves."""

    def __init__(
        self, devices: list[Description], robot: Description, driver: DriverName, paces: dict[str, dict[str, float]]
    ) -> None:
        start = replace(robot.pose, x=BACK_AND_FORTH[0][0][0], y=BACK_AND_FORTH[0][0][1])
        scene = Scene(registry.get_demo_grid(), devices, poses={robot.id: start}, paces=paces)
        self._robot = robot.id
        self._real = make_world(scene=scene, driver=driver)
        machines = [device for device in devices if device.kind == "machine"]
        self._copy = DeviceCopy(robot, machines, _kinematic)
        self._now = 0.0
        self._moves = 0
        self.copy_cpu_s = self.virtual_s = 0.0
        self._tell_state()

    def drive(self, count: int) -> list[float]:
        """Return the paces of so many moves."""
        return [self._move() for _ in range(count)]

    def _move(self) -> float:
        path = BACK_AND_FORTH[self._moves % 2]
        self._moves += 1
        command, arguments = f"c{self._moves}", {"path": [list(point) for point in path]}
        self._real.command(self._robot, "move", arguments, command)
        self._copy.hear_command(self._now, DeviceCommand(command, "move", arguments))
        for _ in range(20_000):
            self._now += TICK_S
            self.virtual_s += TICK_S
            for event in self._real.advance(TICK_S):
                if isinstance(event, Ack) and event.device == self._robot:
                    assert event.status not in ("FAILED", "REJECTED"), event.why
                    self._copy.hear_answer(self._now, AckMessage(event.command, event.status, event.why))
            began = time.process_time()
            self._copy.advance(self._now)
            job = self._copy.take_job()
            self.copy_cpu_s += time.process_time() - began
            if job is not None:
                self._tell_state()
                return sum(m.real_s for m in job.measured) / sum(m.predicted_s for m in job.measured)
        raise AssertionError("The robot did not arrive.")

    def _tell_state(self) -> None:
        pose = self._real.robots()[self._robot].pose
        self._copy.hear_state(self._now, DeviceState(1, 1, True, pose, "", self._real.readings()[self._robot]))


def _kinematic(scene: Scene) -> World:
    return make_world(scene=scene, driver="kinematic")


def _calm() -> Iterator[dict[str, object]]:
    """Devices that do not change, whose times vary by a tenth, and widely (log-normal)."""
    for spread in ("a tenth either way", "log-normal, sigma 0.25"):
        wrong = 0
        for seed in range(CALM_DEVICES):
            chance, paces, said = Random(f"{spread}:{seed}"), [], False
            for _ in range(CALM_MEASUREMENTS):
                even = 1 + 0.1 * (2 * chance.random() - 1)
                paces.append(even if spread.startswith("a tenth") else chance.lognormvariate(0, 0.25))
                paces = paces[-300:]
                said = said or find_change(paces) is not None
            wrong += said
        yield figure("devices that do not change and have an alert", wrong, "devices", of=CALM_DEVICES,
                     measurements_each=CALM_MEASUREMENTS, spread=spread)  # fmt: skip

"""Robots in PyBullet: wheels on a floor, walls and machines to bump into. The only module that imports pybullet.

One world per process and one thread: the library is not safe with more. 240 steps a second; speeds of the wheels are
set every sixth step. While nobody moves, no step is made.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from math import atan2, cos, sin
from pathlib import Path
from typing import Any

from simulation.actors import Motion
from simulation.proximity import Body
from simulation.scene import WALL_HEIGHT_M, Layout, RobotStart

STANDARD_ERROR = 2


@contextmanager
def _without_native_output() -> Iterator[None]:
    """Throw away what C code writes to standard error within the block."""
    sys.stderr.flush()
    kept, nowhere = os.dup(STANDARD_ERROR), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, STANDARD_ERROR)
        yield
    finally:
        os.dup2(kept, STANDARD_ERROR)
        os.close(kept)
        os.close(nowhere)


with _without_native_output():  # the library greets everybody who loads it
    import pybullet

MODEL = Path(__file__).resolve().parent / "models" / "turtlebot.urdf"
STEPS_PER_S = 240
STEPS_PER_TICK = 6
MODEL_RADIUS_M = 0.18
WHEEL_RADIUS_M = 0.05
WHEEL_DISTANCE_M = 0.28
WHEEL_FORCE_N_M = 2.0
LEFT, RIGHT, CASTER = 0, 1, 2
MASS_AHEAD_M = 0.04
STILL_M_S = 0.02
STILL_TICKS = 6
SETTLING_STEPS = 60


@dataclass(frozen=True, slots=True)
class Wheels:
    """A robot's body in the physics, and its measures."""

    body: int
    radius_m: float
    distance_m: float
    mass_ahead_m: float


class PhysicsDriver:
    """Differential drive with masses, slip and contacts."""

    tick_s = STEPS_PER_TICK / STEPS_PER_S

    def __init__(self, layout: Layout) -> None:
        self._client: int = pybullet.connect(pybullet.DIRECT)
        self._here: dict[str, Any] = {"physicsClientId": self._client}
        self._shapes: dict[tuple[float, float, float], int] = {}
        self._set_up()
        for body in (*layout.walls, *layout.machines):
            self._add_box(body)
        self._wheels = {r.id: self._add_robot(r) for r in layout.robots}
        self._motions = {r.id: Motion(r.pose.x, r.pose.y, r.pose.theta) for r in layout.robots}
        self._still_ticks = dict.fromkeys(self._wheels, 0)
        self._awake = set(self._wheels)
        for _ in range(SETTLING_STEPS if layout.robots else 0):
            pybullet.stepSimulation(**self._here)
        self._measure()

    def motions(self) -> Mapping[str, Motion]:
        """Return where each robot is, as measured after the last step."""
        return self._motions

    def drive(
        self, targets: Mapping[str, tuple[float, float]], touching: Mapping[str, Sequence[tuple[float, float]]]
    ) -> None:
        """Let one tick pass."""
        for name in self._awake - targets.keys():
            self._spin(self._wheels[name], 0.0, 0.0)
        for name, (speed, turn) in targets.items():
            if speed or turn:
                self._wake(name)
            self._spin(self._wheels[name], speed, turn)
        if not self._awake:
            return
        for _ in range(STEPS_PER_TICK):
            pybullet.stepSimulation(**self._here)
        self._measure()
        self._put_to_sleep({name for name, target in targets.items() if any(target)})

    def _wake(self, name: str) -> None:
        if name not in self._awake:
            self._awake.add(name)
            self._activate(name, pybullet.ACTIVATION_STATE_WAKE_UP | pybullet.ACTIVATION_STATE_DISABLE_SLEEPING)

    def _put_to_sleep(self, driven: set[str]) -> None:
        """Robots that stand cost as much as those that drive, until they sleep; one that is pushed wakes by itself."""
        for name, motion in self._motions.items():
            still = name not in driven and abs(motion.speed) + abs(motion.turn) < STILL_M_S
            self._still_ticks[name] = self._still_ticks[name] + 1 if still else 0
            if name in self._awake and self._still_ticks[name] >= STILL_TICKS:
                self._awake.discard(name)
                self._activate(name, pybullet.ACTIVATION_STATE_SLEEP | pybullet.ACTIVATION_STATE_ENABLE_SLEEPING)

    def _activate(self, name: str, state: int) -> None:
        pybullet.changeDynamics(self._wheels[name].body, -1, activationState=state, **self._here)

    def close(self) -> None:
        """End the physics; harmless when it has ended."""
        if self._client >= 0:
            pybullet.disconnect(**self._here)
            self._client = -1

    def _set_up(self) -> None:
        pybullet.setGravity(0, 0, -9.81, **self._here)
        pybullet.setTimeStep(1 / STEPS_PER_S, **self._here)
        pybullet.setPhysicsEngineParameter(
            deterministicOverlappingPairs=1, numSolverIterations=20, solverResidualThreshold=1e-4, **self._here
        )
        floor = pybullet.createCollisionShape(pybullet.GEOM_PLANE, **self._here)
        body = pybullet.createMultiBody(0, floor, **self._here)
        pybullet.changeDynamics(body, -1, lateralFriction=1.0, **self._here)

    def _add_box(self, body: Body) -> None:
        """Put a wall or machine on the floor; boxes of one size share a shape, for shapes are never given back."""
        half = (round(body.half_x, 4), round(body.half_y, 4), WALL_HEIGHT_M / 2)
        if half not in self._shapes:
            self._shapes[half] = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half, **self._here)
        theta = atan2(body.sin_theta, body.cos_theta)
        pybullet.createMultiBody(0, self._shapes[half], -1, (body.x, body.y, half[2]), _upright(theta), **self._here)

    def _add_robot(self, robot: RobotStart) -> Wheels:
        scale = robot.radius_m / MODEL_RADIUS_M
        body: int = pybullet.loadURDF(
            str(MODEL),
            (robot.pose.x, robot.pose.y, 0.0),
            _upright(robot.pose.theta),
            globalScaling=scale,
            flags=pybullet.URDF_USE_INERTIA_FROM_FILE,
            **self._here,
        )
        pybullet.changeDynamics(body, CASTER, lateralFriction=0.0, **self._here)
        pybullet.changeDynamics(body, -1, lateralFriction=0.2, **self._here)
        wheels = Wheels(body, WHEEL_RADIUS_M * scale, WHEEL_DISTANCE_M * scale, MASS_AHEAD_M * scale)
        self._spin(wheels, 0.0, 0.0)
        return wheels

    def _spin(self, wheels: Wheels, speed: float, turn: float) -> None:
        side = turn * wheels.distance_m / 2
        pybullet.setJointMotorControlArray(
            wheels.body,
            (LEFT, RIGHT),
            pybullet.VELOCITY_CONTROL,
            targetVelocities=((speed - side) / wheels.radius_m, (speed + side) / wheels.radius_m),
            forces=(WHEEL_FORCE_N_M, WHEEL_FORCE_N_M),
            **self._here,
        )

    def _measure(self) -> None:
        for name, wheels in self._wheels.items():
            motion = self._motions[name]
            (x, y, _), (qx, qy, qz, qw) = pybullet.getBasePositionAndOrientation(wheels.body, **self._here)
            (vx, vy, _), (_, _, turn) = pybullet.getBaseVelocity(wheels.body, **self._here)
            theta = atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
            ahead_x, ahead_y = cos(theta), sin(theta)
            # The engine tells where the middle of the mass is, which lies ahead of the middle between the wheels.
            motion.x, motion.y = x - ahead_x * wheels.mass_ahead_m, y - ahead_y * wheels.mass_ahead_m
            motion.theta = theta
            motion.speed, motion.turn = vx * ahead_x + vy * ahead_y, turn


def _upright(theta: float) -> tuple[float, float, float, float]:
    return 0.0, 0.0, sin(theta / 2), cos(theta / 2)

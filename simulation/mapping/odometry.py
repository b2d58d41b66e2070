"""Odometry: what the wheels of a differential drive say of a motion, with slip."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, exp, sin, sqrt

import numpy as np

from simulation.actors.follower import wrapped
from vipo_device.protocol.description import Pose


@dataclass(frozen=True, slots=True)
class OdometrySpec:
    """Wheels `base_m` apart that are wrong by `noise` of the way (one standard deviation) over stretches of `memory_m`.

    Besides, about once in `slip_every_m` a wheel spins, and counts up to `slip_m` that the robot has not driven.
    """

    noise: float = 0.05
    base_m: float = 0.16
    memory_m: float = 0.5
    slip_every_m: float = 5.0
    slip_m: float = 0.03


class Odometry:
    """Two wheels, each with an error of its own that changes slowly."""

    def __init__(self, spec: OdometrySpec, chance: np.random.Generator) -> None:
        self._spec, self._chance = spec, chance
        self._errors = chance.normal(0.0, 1.0, 2) * spec.noise

    def measure(self, ahead_m: float, turned_rad: float) -> tuple[float, float]:
        """Return what the wheels say of a motion that really went so far ahead and turned so much."""
        spec, half = self._spec, turned_rad * self._spec.base_m / 2
        wheels = ahead_m - half, ahead_m + half
        said = [way + self._error(side, way) for side, way in enumerate(wheels)]
        return (said[0] + said[1]) / 2, (said[1] - said[0]) / spec.base_m

    def _error(self, side: int, way_m: float) -> float:
        spec = self._spec
        if spec.noise == 0.0 or way_m == 0.0:
            return 0.0
        kept = exp(-abs(way_m) / spec.memory_m)
        fresh = float(self._chance.normal(0.0, 1.0)) * spec.noise * sqrt(1.0 - kept * kept)
        self._errors[side] = self._errors[side] * kept + fresh
        slips = self._chance.random() < abs(way_m) / spec.slip_every_m
        slipped = float(self._chance.random()) * spec.slip_m if slips else 0.0
        return float(self._errors[side]) * way_m + (slipped if way_m > 0 else -slipped)


def moved(pose: Pose, ahead_m: float, turned_rad: float) -> Pose:
    """Return where a motion leads: an arc, taken as its chord."""
    half_way = pose.theta + turned_rad / 2
    return Pose(
        pose.x + ahead_m * cos(half_way), pose.y + ahead_m * sin(half_way), 0.0, wrapped(pose.theta + turned_rad)
    )

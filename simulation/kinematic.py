"""Robots as points that turn and drive exactly as they are steered: fast, and without slip, bumps or weight."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import cos, sin

from simulation.actors import Motion
from simulation.actors.follower import wrapped
from simulation.scene import Layout


class KinematicDriver:
    """Differential drive without masses: speed and turn are what was asked for; nothing is driven through."""

    tick_s = 0.05

    def __init__(self, layout: Layout) -> None:
        self._motions = {r.id: Motion(r.pose.x, r.pose.y, wrapped(r.pose.theta)) for r in layout.robots}

    def motions(self) -> Mapping[str, Motion]:
        """Return where each robot is."""
        return self._motions

    def drive(
        self, targets: Mapping[str, tuple[float, float]], touching: Mapping[str, Sequence[tuple[float, float]]]
    ) -> None:
        """Let one tick pass."""
        for name, (speed, turn) in targets.items():
            motion = self._motions[name]
            half_way = motion.theta + turn * self.tick_s / 2
            step_x, step_y = cos(half_way) * speed * self.tick_s, sin(half_way) * speed * self.tick_s
            blocked = any(step_x * x + step_y * y < 0 for x, y in touching.get(name, ()))
            if not blocked:
                motion.x += step_x
                motion.y += step_y
            motion.theta = wrapped(motion.theta + turn * self.tick_s)
            motion.speed, motion.turn = (0.0 if blocked else speed), turn

    def close(self) -> None:
        """Nothing is held."""

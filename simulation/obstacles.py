"""Obstacles on the floor that are on no map, which robots see and before which they stop.

Faults on purpose put them down and take them away again, and people on the floor of a site whose robots are simulated.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import cos, sin

from simulation.actors import Emit, Motion
from simulation.actors.troubles import Troubles
from simulation.world import Fault, FaultBegan, Obstacle

SEEN_M = 0.4
"""How near to a obstacle a robot stops."""
BESIDE_M = 0.02


class Obstacles:
    """Round obstacles, put on the floor and taken away as the faults say, and as people do."""

    def __init__(self, faults: Iterable[Fault], emit: Emit) -> None:
        self._troubles = Troubles(f for f in faults if f.kind == "obstacle")
        self._here: list[Fault] = []
        self._put_by_people: tuple[Obstacle, ...] = ()
        self._emit = emit

    def put(self, obstacles: Sequence[Obstacle]) -> bool:
        """Say what people have put on the floor, in place of what stood there; return whether that is another."""
        before, self._put_by_people = self._put_by_people, tuple(obstacles)
        return before != self._put_by_people

    def reach(self, t_s: float, step: str, count: int) -> None:
        """Put down the obstacles that come with this step of the program."""
        self._begin(t_s, self._troubles.reach(t_s, step, count))

    def pass_time(self, t_s: float) -> bool:
        """Put obstacles down and take them away; True while one lies on the floor."""
        begun, over = self._troubles.pass_time(t_s)
        self._begin(t_s, begun)
        self._here = [obstacle for obstacle in self._here if obstacle not in over]
        return bool(self._here or self._put_by_people)

    def ahead_of(self, motion: Motion, radius_m: float) -> str:
        """Return what a robot that drives on meets, in words; an empty text when its way is free."""
        c, s = cos(motion.theta), sin(motion.theta)
        obstacles: tuple[Fault | Obstacle, ...] = (*self._here, *self._put_by_people)
        for obstacle in obstacles:
            dx, dy = obstacle.x - motion.x, obstacle.y - motion.y
            along, beside = dx * c + dy * s, abs(dy * c - dx * s)
            reach_m = radius_m + obstacle.size_m / 2
            if 0 < along < reach_m + SEEN_M and beside < reach_m + BESIDE_M:
                return f"something that is not on the map is in its way at ({obstacle.x:g}, {obstacle.y:g})"
        return ""

    def _begin(self, t_s: float, obstacles: list[Fault]) -> None:
        for obstacle in obstacles:
            self._here.append(obstacle)
            self._emit(FaultBegan(t_s, obstacle))

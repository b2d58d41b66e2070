"""Things on the floor that are on no map: faults on purpose, which robots see and before which they stop."""

from __future__ import annotations

from collections.abc import Iterable
from math import cos, sin

from simulation.actors import Emit, Motion
from simulation.actors.troubles import Troubles
from simulation.world import Fault, FaultBegan

SEEN_M = 0.4
"""How near to a thing a robot stops."""
BESIDE_M = 0.02


class ThingsInTheWay:
    """Round things, put on the floor and taken away as the faults say."""

    def __init__(self, faults: Iterable[Fault], emit: Emit) -> None:
        self._troubles = Troubles(f for f in faults if f.kind == "obstacle")
        self._here: list[Fault] = []
        self._emit = emit

    def reach(self, t_s: float, step: str, count: int) -> None:
        """Put down the things that come with this step of the program."""
        self._put(t_s, self._troubles.reach(t_s, step, count))

    def pass_time(self, t_s: float) -> bool:
        """Put things down and take them away; True while one lies on the floor."""
        begun, over = self._troubles.pass_time(t_s)
        self._put(t_s, begun)
        self._here = [thing for thing in self._here if thing not in over]
        return bool(self._here)

    def ahead_of(self, motion: Motion, radius_m: float) -> str:
        """Return what a robot that drives on meets, in words; an empty text when its way is free."""
        c, s = cos(motion.theta), sin(motion.theta)
        for thing in self._here:
            dx, dy = thing.x - motion.x, thing.y - motion.y
            along, beside = dx * c + dy * s, abs(dy * c - dx * s)
            reach_m = radius_m + thing.size_m / 2
            if 0 < along < reach_m + SEEN_M and beside < reach_m + BESIDE_M:
                return f"something that is not on the map is in its way at ({thing.x:g}, {thing.y:g})"
        return ""

    def _put(self, t_s: float, things: list[Fault]) -> None:
        for thing in things:
            self._here.append(thing)
            self._emit(FaultBegan(t_s, thing))

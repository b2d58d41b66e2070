"""An independent look at robots' footprints: how near they come to each other, in continuous geometry; pure.

It shares no code with traffic on purpose: it knows neither cells nor reservations.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from math import hypot
from typing import Any

NEAR_MISS_M = 0.1
Position = tuple[float, float]


class FootprintMonitor:
    """Fed with all robots' positions at each instant, it keeps the encounters that were too near."""

    def __init__(self, radii_m: Mapping[str, float]) -> None:
        self._radii_m = dict(radii_m)
        self._before: dict[str, Position] = {}
        self._open: dict[tuple[str, str], dict[str, Any]] = {}
        self.encounters: list[dict[str, Any]] = []

    def look(self, t_s: float, positions: Mapping[str, Position]) -> None:
        """Take in where every robot is; between two looks they are taken to move straight and evenly."""
        if self._before:
            for a, b in combinations(sorted(positions), 2):
                self._look_at(t_s, a, b, positions)
        self._before = dict(positions)

    def _look_at(self, t_s: float, a: str, b: str, positions: Mapping[str, Position]) -> None:
        then = _between(self._before.get(a, positions[a]), self._before.get(b, positions[b]))
        now = _between(positions[a], positions[b])
        gap_m = _nearest(then, now) - self._radii_m[a] - self._radii_m[b]
        if gap_m >= NEAR_MISS_M:
            self._open.pop((a, b), None)
            return
        x, y = positions[a]
        encounter = {
            "t": round(t_s, 2),
            "a": a,
            "b": b,
            "distance_m": round(gap_m, 3),
            "x": round(x, 2),
            "y": round(y, 2),
        }
        known = self._open.get((a, b))
        if known is None:
            self._open[a, b] = encounter
            self.encounters.append(encounter)
        elif gap_m < known["distance_m"]:
            known.update(encounter)


def _between(a: Position, b: Position) -> Position:
    return (b[0] - a[0], b[1] - a[1])


def _nearest(start: Position, end: Position) -> float:
    """Return the least distance from the origin to the straight line between two points."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    span = dx * dx + dy * dy
    share = 0.0 if span == 0 else min(1.0, max(0.0, -(start[0] * dx + start[1] * dy) / span))
    return hypot(start[0] + share * dx, start[1] + share * dy)

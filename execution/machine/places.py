"""Where things are, as expressions ask for it: positions from facts, distances, and whether a zone holds a point."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot
from types import MappingProxyType

from vipo_device.protocol.description import Scalar

Facts = Mapping[tuple[str, str], Scalar]
Point = tuple[float, float]
Zones = Mapping[str, tuple[Point, ...]]
"""The outline of each zone, in metres, by its id."""
NO_ZONES: Zones = MappingProxyType({})
ROLE, CLOCK = "$role", "$clock"
X, Y = "$x", "$y"


def position_of(thing: str, facts: Facts) -> Point | None:
    """Return where a device or a place is, in metres; None while that is not known."""
    x, y = facts.get((thing, X)), facts.get((thing, Y))
    if isinstance(x, bool) or isinstance(y, bool) or not isinstance(x, int | float) or not isinstance(y, int | float):
        return None
    return (x, y)


def distance_m(a: Point, b: Point) -> float:
    """Return the distance of two points, to the millimetre."""
    return round(hypot(a[0] - b[0], a[1] - b[1]), 3)


def lies_in(point: Point, outline: tuple[Point, ...]) -> bool:
    """Tell whether a point lies in a polygon or on its edge (even-odd rule)."""
    inside = False
    for start, end in zip(outline, (*outline[1:], *outline[:1]), strict=True):
        if _on_edge(point, start, end):
            return True
        if (start[1] > point[1]) != (end[1] > point[1]):
            crossing = start[0] + (point[1] - start[1]) / (end[1] - start[1]) * (end[0] - start[0])
            inside ^= point[0] < crossing
    return inside


def _on_edge(point: Point, start: Point, end: Point) -> bool:
    (x, y), (x1, y1), (x2, y2) = point, start, end
    aside = (x2 - x1) * (y - y1) - (y2 - y1) * (x - x1)
    along = (x - x1) * (x - x2) + (y - y1) * (y - y2)
    return abs(aside) <= 1e-9 and along <= 0

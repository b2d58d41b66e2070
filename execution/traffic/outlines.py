"""How near points and straight ways come to an outline on the floor; metres."""

from __future__ import annotations

from math import hypot

from execution.machine.places import lies_in
from registry.floorplan.lattice import Point

Outline = tuple[Point, ...]


def touches(outline: Outline, point: Point, reach_m: float) -> bool:
    """Tell whether a point lies in an outline or nearer to its edge than `reach_m`."""
    edges = zip(outline, (*outline[1:], *outline[:1]), strict=True)
    return lies_in(point, outline) or any(_distance_m(point, start, end) < reach_m for start, end in edges)


def touches_way(outline: Outline, start: Point, end: Point, reach_m: float) -> bool:
    """Tell whether a straight way passes through an outline or nearer to its edge than `reach_m`."""
    if touches(outline, start, reach_m) or touches(outline, end, reach_m):
        return True
    edges = zip(outline, (*outline[1:], *outline[:1]), strict=True)
    return any(_cross(start, end, *edge) or _distance_m(edge[0], start, end) < reach_m for edge in edges)


def _distance_m(point: Point, start: Point, end: Point) -> float:
    dx, dy = end[0] - start[0], end[1] - start[1]
    span = dx * dx + dy * dy
    share = 0.0 if span == 0 else ((point[0] - start[0]) * dx + (point[1] - start[1]) * dy) / span
    share = min(1.0, max(0.0, share))
    return hypot(start[0] + share * dx - point[0], start[1] + share * dy - point[1])


def _cross(a: Point, b: Point, c: Point, d: Point) -> bool:
    """Tell whether the lines from a to b and from c to d cross between their ends."""
    return _side(a, b, c) * _side(a, b, d) < 0 and _side(c, d, a) * _side(c, d, b) < 0


def _side(start: Point, end: Point, point: Point) -> float:
    return (end[0] - start[0]) * (point[1] - start[1]) - (end[1] - start[1]) * (point[0] - start[0])

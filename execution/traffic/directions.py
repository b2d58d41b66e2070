"""What zones of the floor say of which way robots drive: against a one-way zone never, over preferred floor rather."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import cos, hypot, radians, sin

from execution.machine.places import lies_in
from execution.traffic.messages import FloorZone
from execution.traffic.outlines import touches_way
from registry.floorplan.lattice import Lattice, Point

ACROSS = 0.1
"""An edge whose angle to a zone's direction has a cosine nearer to 0 than this leads across it, not against it: up to
5 degrees from a right angle."""
Edge = tuple[int, int]
"""Of the lattice: from a cell to its neighbour."""


def _is_against(zone: FloorZone, start: Point, end: Point) -> bool:
    """Tell whether a straight edge leads over a one-way zone against its direction; across it one may drive."""
    if zone.rule != "one_way" or zone.heading_deg is None:
        return False
    heading, x, y = radians(zone.heading_deg), end[0] - start[0], end[1] - start[1]
    along = x * cos(heading) + y * sin(heading)
    return along < -ACROSS * hypot(x, y) and touches_way(zone.points, start, end, 0.0)


def edges_against(lattice: Lattice, zones: Iterable[FloorZone]) -> frozenset[Edge]:
    """Return the edges, from cells to their neighbours, that one-way zones shut."""
    return frozenset(
        (cell, neighbour)
        for zone in zones
        if zone.rule == "one_way"
        for cell in _cells_near(lattice, zone)
        for neighbour in lattice.links[cell]
        if _is_against(zone, lattice.centre(cell), lattice.centre(neighbour))
    )


def preferred_cells(lattice: Lattice, zones: Iterable[FloorZone]) -> frozenset[int]:
    """Return the cells whose middle lies in a preferred zone."""
    return frozenset(
        cell
        for zone in zones
        if zone.rule == "preferred"
        for cell in _cells_near(lattice, zone)
        if lies_in(lattice.centre(cell), zone.points)
    )


def _cells_near(lattice: Lattice, zone: FloorZone) -> Iterator[int]:
    """Go through the cells in a zone's bounding box, and those beside it."""
    (left, right), (bottom, top) = ((min(axis), max(axis)) for axis in zip(*zone.points, strict=True))
    near_m = lattice.gap_m * 1.001
    return lattice.cells_in_box(left - near_m, bottom - near_m, right + near_m, top + near_m)

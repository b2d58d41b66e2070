"""Planning cells: a square lattice over the map on which robots stand and drive."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from math import ceil, floor, hypot
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

SIDE_M = 0.5
MARGIN_M = 0.1
PASSING_MARGIN_M = 0.05
STANDING_MARGIN_M = 0.02
"""The room that a robot needs beside its body to stand somewhere off the lattice, and to drive there."""
REACH_M = 1.2
"""How far off the lattice a robot may stand."""
Point = tuple[float, float]


class Raster(Protocol):
    """How a map's cells lie, as the grid of the floor plan says: metres, rows from the bottom up."""

    @property
    def width(self) -> int:
        """Return how many cells in a row."""

    @property
    def height(self) -> int:
        """Return how many rows."""

    @property
    def resolution_m(self) -> float:
        """Return the side of a cell in metres."""

    @property
    def origin_x_m(self) -> float:
        """Return where the left edge is, in metres."""

    @property
    def origin_y_m(self) -> float:
        """Return where the bottom edge is, in metres."""

    def cell_of(self, x_m: float, y_m: float) -> tuple[int, int] | None:
        """Return (row, column) of the cell that holds the point, or None off the map."""


@dataclass(frozen=True)
class Lattice:
    """Cells by number: row * columns + column, row 0 at the bottom. `links` says where one can drive from each."""

    side_m: float
    origin: Point
    columns: int
    rows: int
    links: Mapping[int, tuple[int, ...]]
    roomy: frozenset[int] = field(default_factory=frozenset)
    """Cells with room to spare, where routes are drawn by preference."""

    def centre(self, cell: int) -> Point:
        """Return the middle of a cell in metres."""
        row, column = divmod(cell, self.columns)
        return (self.origin[0] + (column + 0.5) * self.side_m, self.origin[1] + (row + 0.5) * self.side_m)

    def cells_within(self, point: Point, radius_m: float) -> list[int]:
        """Return all cell numbers, free or not, whose middle is that near, the nearest first."""
        reach = ceil(radius_m / self.side_m) + 1
        column = int((point[0] - self.origin[0]) // self.side_m)
        row = int((point[1] - self.origin[1]) // self.side_m)
        found = []
        for r in range(max(0, row - reach), min(self.rows, row + reach + 1)):
            for c in range(max(0, column - reach), min(self.columns, column + reach + 1)):
                x, y = self.centre(r * self.columns + c)
                distance = hypot(x - point[0], y - point[1])
                if distance <= radius_m:
                    found.append((round(distance, 9), r * self.columns + c))
        return [cell for _, cell in sorted(found)]

    def cells_in_box(self, left: float, bottom: float, right: float, top: float) -> Iterator[int]:
        """Go through the cells that one can stand on and whose middle lies between these metres, edges included."""
        (x, y), side = self.origin, self.side_m
        columns = range(max(0, ceil((left - x) / side - 0.5)), min(self.columns, floor((right - x) / side - 0.5) + 1))
        for row in range(max(0, ceil((bottom - y) / side - 0.5)), min(self.rows, floor((top - y) / side - 0.5) + 1)):
            for cell in range(row * self.columns + columns.start, row * self.columns + columns.stop):
                if cell in self.links:
                    yield cell

    def distances(
        self, start: int, closed: Iterable[int] = (), closed_links: Collection[tuple[int, int]] = ()
    ) -> dict[int, int]:
        """Return the number of links from a cell to every cell that can be reached without the closed ones."""
        shut, open_links = set(closed), not closed_links
        found, queue = {start: 0}, deque([start])
        while queue:
            cell = queue.popleft()
            for neighbour in self.links.get(cell, ()):
                if neighbour in found or neighbour in shut:
                    continue
                if open_links or (cell, neighbour) not in closed_links:
                    found[neighbour] = found[cell] + 1
                    queue.append(neighbour)
        return found


class Ground:
    """What the map and the machines leave free for a robot of one radius; `clearance_m` is the floor plan's."""

    def __init__(self, grid: Raster, clearance_m: NDArray[np.float64], radius_m: float) -> None:
        self.grid = grid
        self.radius_m = radius_m
        self.clearance_m = clearance_m

    def room_m(self, point: Point) -> float:
        """Return the clearance at a point; none off the map."""
        cell = self.grid.cell_of(*point)
        return float(self.clearance_m[cell]) if cell is not None else 0.0

    def is_passable(self, start: Point, end: Point, room_m: float) -> bool:
        """Tell whether a robot can drive straight from point to point with that room around its middle."""
        steps = max(1, ceil(hypot(end[0] - start[0], end[1] - start[1]) / 0.05))
        points = ((start[0] + (end[0] - start[0]) * i / steps, start[1] + (end[1] - start[1]) * i / steps)
                  for i in range(steps + 1))  # fmt: skip
        return all(self.room_m(point) >= room_m for point in points)


def attach(ground: Ground, lattice: Lattice, point: Point) -> int | None:
    """Return the nearest cell from which one can drive straight to a point; None where no robot can stand or come."""
    room_m = ground.radius_m + STANDING_MARGIN_M
    if ground.room_m(point) < room_m:
        return None
    for cell in lattice.cells_within(point, REACH_M):
        if cell in lattice.links and ground.is_passable(lattice.centre(cell), point, room_m):
            return cell
    return None


def make_lattice(ground: Ground) -> Lattice:
    """Lay the lattice over the ground; only the largest connected part of the floor is kept."""
    grid = ground.grid
    side_m = max(SIDE_M, 2 * ground.radius_m + 0.14)
    columns = max(1, int(grid.width * grid.resolution_m / side_m))
    rows = max(1, int(grid.height * grid.resolution_m / side_m))
    bare = Lattice(side_m, (grid.origin_x_m, grid.origin_y_m), columns, rows, {})
    rooms = [ground.room_m(bare.centre(cell)) for cell in range(columns * rows)]
    free = [room >= ground.radius_m + MARGIN_M for room in rooms]
    links: dict[int, tuple[int, ...]] = {}
    for cell in range(columns * rows):
        if free[cell]:
            near = [n for n in _around(cell, columns, rows) if free[n]]
            room_m = ground.radius_m + PASSING_MARGIN_M
            links[cell] = tuple(n for n in near if ground.is_passable(bare.centre(cell), bare.centre(n), room_m))
    roomy = frozenset(cell for cell in links if rooms[cell] >= ground.radius_m + side_m / 2)
    whole = Lattice(side_m, bare.origin, columns, rows, links, roomy)
    kept = _largest_part(whole)
    return Lattice(side_m, bare.origin, columns, rows, {c: links[c] for c in sorted(kept)}, roomy & kept)


def _around(cell: int, columns: int, rows: int) -> list[int]:
    row, column = divmod(cell, columns)
    around = ((row, column + 1), (row + 1, column), (row, column - 1), (row - 1, column))
    return [r * columns + c for r, c in around if 0 <= r < rows and 0 <= c < columns]


def _largest_part(lattice: Lattice) -> frozenset[int]:
    left, best = set(lattice.links), frozenset[int]()
    while left:
        part = frozenset(lattice.distances(min(left)))
        left -= part
        best = max(best, part, key=len)
    return best

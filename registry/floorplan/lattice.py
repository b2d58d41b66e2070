"""Planning cells: a square lattice over the map on which robots stand and drive."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import ceil, floor, hypot
from typing import Any, Protocol

import numpy as np
import scipy
from numpy.typing import NDArray

SIDE_M = 0.5
MARGIN_M = 0.1
PASSING_MARGIN_M = 0.05
STANDING_MARGIN_M = 0.02
"""The room that a robot needs beside its body to stand somewhere off the lattice, and to drive there."""
REACH_M = 1.2
"""How far off the lattice a robot may stand."""
STEP_M = 0.05
"""A straight way is looked at point by point, so far apart."""
SHIFTS = 4
"""By so many parts of a side the lattice may be shifted, to the right and up."""
GOOD_SHARE = 0.85
"""Where robots come to so much of the cells that they fit on, or would over the best shift, the lattice is not shifted.
"""
_AROUND = ((0, 1), (1, 0), (0, -1), (-1, 0))
"""Rows up and columns to the right of a cell to each of its neighbours, in the order of its links."""
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

    @cached_property
    def mark(self) -> str:
        """What tells by which lattice cells are numbered."""
        return f"{self.side_m:.6f} {self.origin[0]:.6f} {self.origin[1]:.6f} {self.columns} {self.rows}"

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
        steps = max(1, ceil(hypot(end[0] - start[0], end[1] - start[1]) / STEP_M))
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
    """Lay the lattice over the ground; only the largest connected part of the floor is kept.

    It begins at the corner of the map, unless it falls apart there and robots come to much more of the floor over one
    that is shifted: how the middles of cells lie to doors decides whether one leads through.
    """
    laid = _lay(ground, 0, 0)
    if laid.size >= GOOD_SHARE * laid.free:
        return laid.lattice(ground)
    others = (_lay(ground, up, right) for up in range(SHIFTS) for right in range(SHIFTS) if up or right)
    best = max(others, key=lambda each: each.size)
    return (laid if laid.size >= GOOD_SHARE * best.size else best).lattice(ground)


@dataclass(frozen=True)
class _Laid:
    """Cells [row, column] laid over a ground: their clearance in metres, how many robots fit on, those of the largest
    part that robots drive about on, and whether one can drive from each to the next one on the right, and above.
    """

    side_m: float
    origin: Point
    rooms: NDArray[np.float64]
    free: int
    kept: NDArray[np.bool_]
    right: NDArray[np.bool_]
    above: NDArray[np.bool_]

    @property
    def size(self) -> int:
        """How many cells robots drive about on."""
        return int(self.kept.sum())

    def lattice(self, ground: Ground) -> Lattice:
        rows, columns = self.kept.shape
        cells = np.flatnonzero(self.kept)
        around = zip(*(self._open(up, right)[self.kept].tolist() for up, right in _AROUND), strict=True)
        steps = [up * columns + right for up, right in _AROUND]
        links = {
            cell: tuple(cell + step for step, is_open in zip(steps, opened, strict=True) if is_open)
            for cell, opened in zip(cells.tolist(), around, strict=True)
        }
        roomy = np.flatnonzero(self.kept & (self.rooms >= ground.radius_m + self.side_m / 2))
        return Lattice(self.side_m, self.origin, columns, rows, links, frozenset(roomy.tolist()))

    def _open(self, up: int, right: int) -> NDArray[np.bool_]:
        """Return from which cells one can drive to the next one in a direction."""
        found = np.zeros(self.kept.shape, dtype=np.bool_)
        if right:
            found[:, slice(0, -1) if right > 0 else slice(1, None)] = self.right
        else:
            found[slice(0, -1) if up > 0 else slice(1, None)] = self.above
        return found


def _lay(ground: Ground, up: int, right: int) -> _Laid:
    """Lay cells over the ground, shifted by so many of `SHIFTS` parts of a side; the map's corner lies in the first."""
    grid = ground.grid
    side_m = max(SIDE_M, 2 * ground.radius_m + 0.14)
    part_m = side_m / SHIFTS
    left_m, below_m = ((SHIFTS - shift) % SHIFTS * part_m for shift in (right, up))
    columns = max(1, int((grid.width * grid.resolution_m + left_m) / side_m))
    rows = max(1, int((grid.height * grid.resolution_m + below_m) / side_m))
    origin = (grid.origin_x_m - left_m, grid.origin_y_m - below_m)
    x = origin[0] + (np.arange(columns) + 0.5) * side_m
    y = origin[1] + (np.arange(rows) + 0.5) * side_m
    rooms = _rooms(ground, x, y)
    free = rooms >= ground.radius_m + MARGIN_M
    room_m = ground.radius_m + PASSING_MARGIN_M
    to_right, to_above = np.ones((rows, columns - 1), np.bool_), np.ones((rows - 1, columns), np.bool_)
    steps = max(1, ceil(round(side_m / STEP_M, 9)))
    for step in range(steps + 1):
        to_right &= _rooms(ground, x[:-1] + (x[1:] - x[:-1]) * step / steps, y) >= room_m
        to_above &= _rooms(ground, x, y[:-1] + (y[1:] - y[:-1]) * step / steps) >= room_m
    to_right &= free[:, :-1] & free[:, 1:]
    to_above &= free[:-1] & free[1:]
    return _Laid(side_m, origin, rooms, int(free.sum()), _largest_part(free, to_right, to_above), to_right, to_above)


def _rooms(ground: Ground, x: NDArray[np.floating[Any]], y: NDArray[np.floating[Any]]) -> NDArray[np.float64]:
    """Return the clearance [row, column] where rows and columns of points cross; none off the map."""
    grid = ground.grid
    columns = np.floor_divide(x - grid.origin_x_m, grid.resolution_m).astype(np.int64)
    rows = np.floor_divide(y - grid.origin_y_m, grid.resolution_m).astype(np.int64)
    on_map = np.outer((rows >= 0) & (rows < grid.height), (columns >= 0) & (columns < grid.width))
    there = np.ix_(np.clip(rows, 0, grid.height - 1), np.clip(columns, 0, grid.width - 1))
    return np.where(on_map, ground.clearance_m[there], 0.0)


def _largest_part(
    free: NDArray[np.bool_], to_right: NDArray[np.bool_], to_above: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Return the cells of the largest part that is joined by open links; of equal ones the one that begins first."""
    rows, columns = free.shape
    joined = np.zeros((2 * rows - 1, 2 * columns - 1), dtype=np.bool_)
    joined[::2, ::2], joined[::2, 1::2], joined[1::2, ::2] = free, to_right, to_above
    labels, _ = scipy.ndimage.label(joined)
    parts = labels[::2, ::2]
    sizes = np.bincount(parts.ravel())
    sizes[0] = 0
    return np.asarray((parts == int(np.argmax(sizes))) & free)

"""Planning cells: a square lattice over the map on which robots stand and drive."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import deque
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain, pairwise, product
from math import ceil, hypot
from typing import Any, Protocol
from zlib import crc32

import numpy as np
import scipy
from numpy.typing import NDArray

from registry.floorplan.extent import require_extent
from registry.floorplan.narrow_ways import NarrowWays

SIDE_M = 0.5
MARGIN_M = 0.1
PASSING_MARGIN_M = 0.05
STANDING_MARGIN_M = 0.02
"""The room that a robot needs beside its body to stand somewhere off the lattice, and to drive there."""
REACH_M = 1.2
"""How far off the lattice a robot may stand."""
STEP_M = 0.05
"""A straight way is looked at point by point, so far apart."""
WHOLE_SHARE = 0.995
"""Where robots come to so much of the cells that they fit on, or would over other lines, lines are evenly spaced."""
TRIES = 3
"""So often lines through narrow ways are tried."""
SHIFTS = 4
"""By so many parts of a side evenly spaced lines are shifted then, each way."""
MOST_SHIFTED = 40_000
"""So many cells are shifted at most; larger floors have lines through narrow ways alone."""
_HAIR_M = 1e-9
AROUND = ((0, 1), (1, 0), (0, -1), (-1, 0))
"""Rows up and columns to the right of a cell to each of its neighbours, in the order of its links."""
Point = tuple[float, float]
Metres = NDArray[np.floating[Any]]
_Ways = tuple[NarrowWays, NarrowWays]
"""Along columns, and along rows."""


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

    def centre_of(self, row: int, column: int) -> Point:
        """Return the middle of a cell in metres."""


@dataclass(frozen=True)
class Lattice:
    """Cells by number: row * columns + column, row 0 at the bottom. `links` says where one can drive from each.

    A cell's middle is where a column's line `xs` and a row's line `ys` cross, in metres; lines are `side_m` apart, or
    somewhat more where they are laid through doors.
    """

    side_m: float
    xs: tuple[float, ...]
    ys: tuple[float, ...]
    links: Mapping[int, tuple[int, ...]]
    roomy: frozenset[int] = field(default_factory=frozenset)
    """Cells with room to spare, where routes are drawn by preference."""

    @cached_property
    def columns(self) -> int:
        """Return how many cells are in a row."""
        return len(self.xs)

    @cached_property
    def rows(self) -> int:
        """Return how many rows there are."""
        return len(self.ys)

    @cached_property
    def gap_m(self) -> float:
        """Return how far two neighbouring lines are apart at most, in metres."""
        gaps = (after - before for lines in (self.xs, self.ys) for before, after in pairwise(lines))
        return max(gaps, default=self.side_m)

    @cached_property
    def mark(self) -> str:
        """What tells by which lattice cells are numbered."""
        lines = ";".join(",".join(f"{line:.4f}" for line in lines) for lines in (self.xs, self.ys))
        return f"{len(self.xs)} {len(self.ys)} {crc32(lines.encode()):08x}"

    def centre(self, cell: int) -> Point:
        """Return the middle of a cell in metres."""
        row, column = divmod(cell, self.columns)
        return (self.xs[column], self.ys[row])

    def cells_within(self, point: Point, radius_m: float) -> list[int]:
        """Return all cell numbers, free or not, whose middle is that near, the nearest first."""
        columns = _between(self.xs, point[0] - radius_m, point[0] + radius_m)
        found = []
        for row in _between(self.ys, point[1] - radius_m, point[1] + radius_m):
            for column in columns:
                distance = hypot(self.xs[column] - point[0], self.ys[row] - point[1])
                if distance <= radius_m:
                    found.append((round(distance, 9), row * self.columns + column))
        return [cell for _, cell in sorted(found)]

    def cells_in_box(self, left: float, bottom: float, right: float, top: float) -> Iterator[int]:
        """Go through the cells that one can stand on and whose middle lies between these metres, edges included."""
        columns = _between(self.xs, left, right)
        for row in _between(self.ys, bottom, top):
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


def _between(lines: Sequence[float], low: float, high: float) -> range:
    """Return the numbers of the lines between two values, edges included; a hair beyond counts as on the edge."""
    return range(bisect_left(lines, low - _HAIR_M), bisect_right(lines, high + _HAIR_M))


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

    Its lines begin at the corner of the map and are evenly spaced, unless it falls apart so and robots come to much
    more of the floor over lines that are laid through narrow ways. Raises FloorTooLarge.
    """
    grid, even = ground.grid, _lay_even(ground)
    side_m = even.side_m
    if even.size >= WHOLE_SHARE * even.free:
        return even.lattice(ground)
    fits = ground.clearance_m >= ground.radius_m + MARGIN_M
    ways = (NarrowWays(fits, side_m / grid.resolution_m), NarrowWays(fits.T, side_m / grid.resolution_m))
    shifted = _lay_shifted(ground, side_m) if even.kept.size <= MOST_SHIFTED else ()
    others = chain(_lay_through(ways, ground, side_m), shifted)
    laid = max(others, key=lambda each: (_reached(ways, ground, each), each.size))
    is_enough = _reached(ways, ground, even) >= WHOLE_SHARE * _reached(ways, ground, laid)
    return (even if is_enough else laid).lattice(ground)


def make_even_lattice(ground: Ground) -> Lattice:
    """Lay a lattice of even lines over the ground, whatever it comes to: what others are measured against."""
    return _lay_even(ground).lattice(ground)


def _lay_even(ground: Ground) -> _Laid:
    require_extent(ground.grid, lambda: int(np.count_nonzero(ground.clearance_m > 0)))
    grid, side_m = ground.grid, max(SIDE_M, 2 * ground.radius_m + 0.14)
    columns, rows = (max(1, int(cells * grid.resolution_m / side_m)) for cells in (grid.width, grid.height))
    return _lay(ground, side_m, _even(grid.origin_x_m, columns, side_m), _even(grid.origin_y_m, rows, side_m))


def _even(begin_m: float, count: int, side_m: float) -> Metres:
    return begin_m + (np.arange(count) + 0.5) * side_m


def _lay_through(ways: _Ways, ground: Ground, side_m: float) -> Iterator[_Laid]:
    """Lay cells along lines through narrow ways, each time rather through those that nobody came through before."""
    grid, (down, across) = ground.grid, ways
    for _ in range(TRIES):
        x = grid.origin_x_m + (down.lines() + 0.5) * grid.resolution_m
        y = grid.origin_y_m + (across.lines() + 0.5) * grid.resolution_m
        laid = _lay(ground, side_m, x, y)
        yield laid
        if laid.size >= WHOLE_SHARE * laid.free:
            return
        for each, (parts, _) in zip(ways, _parts_of(ways, ground, laid), strict=True):
            each.want_missed(parts)


def _reached(ways: _Ways, ground: Ground, laid: _Laid) -> int:
    """Return how much of the floor robots come to, in cells of the map: of the wide parts that narrow ways join."""
    return sum(area for _, area in _parts_of(ways, ground, laid))


def _parts_of(ways: _Ways, ground: Ground, laid: _Laid) -> Iterator[tuple[NDArray[np.int32], int]]:
    """Return of the ways down and across which wide parts robots come to, and how large these are together."""
    grid = ground.grid
    rows, columns = _cells_at(laid.ys, grid.origin_y_m, grid), _cells_at(laid.xs, grid.origin_x_m, grid)
    rows, columns = np.clip(rows, 0, grid.height - 1), np.clip(columns, 0, grid.width - 1)
    for each, axes, kept in zip(ways, ((rows, columns), (columns, rows)), (laid.kept, laid.kept.T), strict=True):
        parts = np.unique(each.wide[np.ix_(*axes)][kept])
        yield parts, int(each.sizes[parts].sum())


def _lay_shifted(ground: Ground, side_m: float) -> Iterator[_Laid]:
    """Lay evenly spaced cells, shifted by quarters of a side to the right and up."""
    grid = ground.grid
    for up, right in product(range(SHIFTS), range(SHIFTS)):
        left_m, below_m = ((SHIFTS - shift) % SHIFTS / SHIFTS * side_m for shift in (right, up))
        columns = max(1, int((grid.width * grid.resolution_m + left_m) / side_m))
        rows = max(1, int((grid.height * grid.resolution_m + below_m) / side_m))
        x, y = grid.origin_x_m - left_m, grid.origin_y_m - below_m
        yield _lay(ground, side_m, _even(x, columns, side_m), _even(y, rows, side_m))


def _cells_at(points: Metres, begin_m: float, grid: Raster) -> NDArray[np.int64]:
    return np.asarray(np.floor_divide(points - begin_m, grid.resolution_m), dtype=np.int64)


@dataclass(frozen=True)
class _Laid:
    """Cells [row, column] laid over a ground: their clearance in metres, how many robots fit on, those of the largest
    part that robots drive about on, and whether one can drive from each to the next one on the right, and above.
    """

    side_m: float
    xs: Metres
    ys: Metres
    rooms: Metres
    free: int
    kept: NDArray[np.bool_]
    right: NDArray[np.bool_]
    above: NDArray[np.bool_]

    @property
    def size(self) -> int:
        """How many cells robots drive about on."""
        return int(self.kept.sum())

    def lattice(self, ground: Ground) -> Lattice:
        columns = self.kept.shape[1]
        cells = np.flatnonzero(self.kept)
        around = zip(*(self._open(up, right)[self.kept].tolist() for up, right in AROUND), strict=True)
        steps = [up * columns + right for up, right in AROUND]
        links = {
            cell: tuple(cell + step for step, is_open in zip(steps, opened, strict=True) if is_open)
            for cell, opened in zip(cells.tolist(), around, strict=True)
        }
        roomy = np.flatnonzero(self.kept & (self.rooms >= ground.radius_m + self.side_m / 2))
        return Lattice(self.side_m, tuple(self.xs.tolist()), tuple(self.ys.tolist()), links, frozenset(roomy.tolist()))

    def _open(self, up: int, right: int) -> NDArray[np.bool_]:
        """Return from which cells one can drive to the next one in a direction."""
        found = np.zeros(self.kept.shape, dtype=np.bool_)
        if right:
            found[:, slice(0, -1) if right > 0 else slice(1, None)] = self.right
        else:
            found[slice(0, -1) if up > 0 else slice(1, None)] = self.above
        return found


def _lay(ground: Ground, side_m: float, x: Metres, y: Metres) -> _Laid:
    """Lay cells over the ground, whose middles are where these columns' and rows' lines cross."""
    columns, rows = x.size, y.size
    rooms = _rooms(ground, x, y)
    free = rooms >= ground.radius_m + MARGIN_M
    room_m = ground.radius_m + PASSING_MARGIN_M
    to_right, to_above = np.ones((rows, columns - 1), np.bool_), np.ones((rows - 1, columns), np.bool_)
    gap_m = max(np.diff(x).max(initial=side_m), np.diff(y).max(initial=side_m))
    steps = max(1, ceil(round(float(gap_m) / STEP_M, 9)))
    for step in range(steps + 1):
        to_right &= _rooms(ground, x[:-1] + (x[1:] - x[:-1]) * step / steps, y) >= room_m
        to_above &= _rooms(ground, x, y[:-1] + (y[1:] - y[:-1]) * step / steps) >= room_m
    to_right &= free[:, :-1] & free[:, 1:]
    to_above &= free[:-1] & free[1:]
    return _Laid(side_m, x, y, rooms, int(free.sum()), _largest_part(free, to_right, to_above), to_right, to_above)


def _rooms(ground: Ground, x: NDArray[np.floating[Any]], y: NDArray[np.floating[Any]]) -> NDArray[np.float64]:
    """Return the clearance [row, column] where rows and columns of points cross; none off the map."""
    grid = ground.grid
    columns, rows = _cells_at(x, grid.origin_x_m, grid), _cells_at(y, grid.origin_y_m, grid)
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

"""The robot's own map: log-odds of each cell, and where in each cell beams have ended.

Cells lie on a raster that is fixed in the map frame; the map grows as far as the robot sees. A beam ends on a surface,
and what stops it lies behind: so its end counts for the cell half a cell's side further in, across the surface.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from registry.floorplan.plan import FREE, OCCUPIED, UNKNOWN, Grid
from vipo_device.protocol.description import Pose

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
HIT, PASS = 0.9, -0.35
LOWEST, HIGHEST = -4.0, 6.0
SURE_FREE, SURE_WALL = -0.3, 0.3
GROW_M = 4.0
ROOM_M = 0.5
PASS_CELLS = 0.7
FIELD_M, SURFACE_M = 0.05, 0.1
FACINGS = 4
"""Both sides of a thin wall lie close together; told apart by the way they face, each stays where it is."""


@dataclass(frozen=True, slots=True)
class Sight:
    """What a scan says, in the robot's frame, metres.

    `ends` [n, 2] are where beams ended, `inward` [n, 2] of length 1 leads from there across the surface; `bearings`
    (rad) and `open_m` are of all beams that say how far the floor is free.
    """

    ends: Floats
    inward: Floats
    bearings: Floats
    open_m: Floats


def read_scan(ranges: Floats, range_m: float) -> Sight:
    """Take a scan apart: one range per beam from -pi on; infinite is free as far as `range_m`, NaN says nothing."""
    bearings = np.linspace(-np.pi, np.pi, ranges.size, endpoint=False)
    directions = np.stack((np.cos(bearings), np.sin(bearings)), axis=1)
    seen = np.isfinite(ranges)
    points = np.where(seen, ranges, np.nan)[:, None] * directions
    along = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    length = np.hypot(along[:, 0], along[:, 1])
    step = 4 * np.pi / ranges.size
    with np.errstate(invalid="ignore", divide="ignore"):
        # on a surface that a beam meets at 15 degrees or less its neighbours may lie far off; then it is another one
        is_surface = length < 4 * step * ranges + 0.05
        inward = np.stack((-along[:, 1], along[:, 0]), axis=1) / length[:, None]
    inward *= np.where(np.sum(inward * directions, axis=1) < 0, -1.0, 1.0)[:, None]
    inward = np.where((is_surface & (length > 1e-9))[:, None], inward, directions)
    says = seen | np.isinf(ranges)
    return Sight(
        points[seen],
        inward[seen],
        bearings[says],
        np.where(seen, ranges, range_m)[says],
    )


def place(points: Floats, pose: Pose) -> Floats:
    """Return points of the robot's frame in the map frame."""
    turn_x, turn_y = cos(pose.theta), sin(pose.theta)
    x, y = points[:, 0], points[:, 1]
    return np.stack((pose.x + x * turn_x - y * turn_y, pose.y + x * turn_y + y * turn_x), axis=1)


def turned(directions: Floats, pose: Pose) -> Floats:
    """Return directions of the robot's frame in the map frame."""
    return place(directions, Pose(0.0, 0.0, 0.0, pose.theta))


class OccupancyMap:
    """A map that grows, in three layers. `anchor` is a corner of some cell in the map frame.

    `odds` has the map's own cells. `field` and `sums` are for scan matching, in cells of about 5 and 10 cm.
    """

    def __init__(self, side_m: float, anchor: tuple[float, float], range_m: float) -> None:
        self.side_m, self._anchor, self._range_m = side_m, anchor, range_m
        self.first = (0, 0)
        """Row and column of the raster at which the arrays begin."""
        self._per_field, self._per_surface = (max(1, round(side / side_m)) for side in (FIELD_M, SURFACE_M))
        self.field_m, self.surface_m = self._per_field * side_m, self._per_surface * side_m
        self.odds = np.zeros((0, 0), dtype=np.float32)
        self.field = np.zeros((0, 0), dtype=np.uint8)
        """2 where beams ended, 1 beside that."""
        self.sums = np.zeros((0, 0, FACINGS, 6), dtype=np.float64)
        """Of the ends in each cell, on surfaces that face each way: how many, x, y, xx, xy, yy from its middle."""

    def cells_of(self, points: Floats, side_m: float = 0.0) -> tuple[Indices, Indices]:
        """Return row and column, in the layer with such cells, of points [n, 2] in metres; they may lie off it."""
        side = side_m or self.side_m
        x = self._anchor[0] + self.first[1] * self.side_m
        y = self._anchor[1] + self.first[0] * self.side_m
        columns = np.floor((points[:, 0] - x) / side).astype(np.int64)
        return np.floor((points[:, 1] - y) / side).astype(np.int64), columns

    def centre_of(self, rows: Indices, columns: Indices, side_m: float = 0.0) -> Floats:
        """Return the middles [n, 2] of cells of a layer in metres."""
        side = side_m or self.side_m
        x = self._anchor[0] + self.first[1] * self.side_m + (columns + 0.5) * side
        y = self._anchor[1] + self.first[0] * self.side_m + (rows + 0.5) * side
        return np.stack((x, y), axis=1)

    def make_room(self, pose: Pose) -> None:
        """Grow so that all that the robot can see from there lies on the map."""
        reach = self._range_m + ROOM_M
        corners = np.array(((pose.x - reach, pose.y - reach), (pose.x + reach, pose.y + reach)))
        rows, columns = self.cells_of(corners)
        height, width = self.odds.shape
        if not height:
            self.first = (int(rows[0]), int(columns[0]))
            rows, columns = rows - rows[0], columns - columns[0]
        low, high = (rows[0], columns[0]), (rows[1] + 1 - height, columns[1] + 1 - width)
        pads = [(self._whole(-int(below)), self._whole(int(above))) for below, above in zip(low, high, strict=True)]
        if not any(map(sum, pads)):
            return
        self.odds = np.pad(self.odds, pads)
        self.field = np.pad(self.field, _in_cells(pads, self._per_field))
        self.sums = np.pad(self.sums, (*_in_cells(pads, self._per_surface), (0, 0), (0, 0)))
        self.first = (self.first[0] - pads[0][0], self.first[1] - pads[1][0])

    def _whole(self, lacking: int) -> int:
        """Return how many cells to add where so many are lacking: some to spare, and whole cells of each layer."""
        if lacking <= 0:
            return 0
        step = self._per_field * self._per_surface
        return -(-(lacking + int(GROW_M / self.side_m)) // step) * step

    def add(self, sight: Sight, pose: Pose) -> None:
        """Take in what is seen from a place."""
        self.make_room(pose)
        ends, inward = place(sight.ends, pose), turned(sight.inward, pose)
        rows, columns = self.cells_of(ends + inward * (self.side_m / 2))
        walls = np.unique(rows * self.odds.shape[1] + columns)
        passed = np.zeros(self.odds.size, dtype=np.bool_)
        passed[self._passed(sight, pose)] = True
        passed[walls] = False
        odds, free = self.odds.ravel(), np.flatnonzero(passed)
        before = odds[free]
        odds[free] = np.maximum(before + np.float32(PASS), np.float32(LOWEST))
        odds[walls] = np.minimum(odds[walls] + np.float32(HIT), np.float32(HIGHEST))
        self._forget(free[(before > 0) & (odds[free] <= 0)])
        self._remember(ends, inward)

    def _passed(self, sight: Sight, pose: Pose) -> Indices:
        """Return the cells that beams went through, numbered row by row; the last half cell is left out."""
        far = np.arange(0.0, self._range_m, PASS_CELLS * self.side_m)
        angles = sight.bearings + pose.theta
        is_open = far[None, :] < (sight.open_m - self.side_m / 2)[:, None]
        x = pose.x + np.outer(np.cos(angles), far)[is_open]
        y = pose.y + np.outer(np.sin(angles), far)[is_open]
        rows, columns = self.cells_of(np.stack((x, y), axis=1))
        return rows * self.odds.shape[1] + columns

    def _forget(self, cells: Indices) -> None:
        """What was a wall and is none any more is nothing to match scans with."""
        rows, columns = np.divmod(cells, self.odds.shape[1])
        self.field[rows // self._per_field, columns // self._per_field] = 0
        self.sums[rows // self._per_surface, columns // self._per_surface] = 0.0

    def _remember(self, ends: Floats, inward: Floats) -> None:
        rows, columns = self.cells_of(ends, self.surface_m)
        off = ends - self.centre_of(rows, columns, self.surface_m)
        x, y = off[:, 0], off[:, 1]
        values = np.stack((np.ones_like(x), x, y, x * x, x * y, y * y), axis=1)
        np.add.at(self.sums, (rows, columns, facing(inward)), values)
        rows, columns = self.cells_of(ends + inward * (self.field_m / 2), self.field_m)
        field, width = self.field.ravel(), self.field.shape[1]
        cells = rows * width + columns
        for beside in (-width - 1, -width, -width + 1, -1, 1, width - 1, width, width + 1):
            field[cells + beside] = np.maximum(field[cells + beside], 1)
        field[cells] = 2

    def grid(self) -> Grid:
        """Return what is known so far, cut to it with one unknown cell around; a map that knows nothing is one cell."""
        cells = np.full(self.odds.shape, UNKNOWN, dtype=np.uint8)
        cells[self.odds < SURE_FREE] = FREE
        cells[self.odds > SURE_WALL] = OCCUPIED
        known = cells != UNKNOWN
        rows, columns = np.flatnonzero(known.any(axis=1)), np.flatnonzero(known.any(axis=0))
        if not rows.size:
            return Grid(1, 1, self.side_m, *self._anchor, bytes([UNKNOWN]))
        top, left = int(rows[0]), int(columns[0])
        cut = np.pad(cells[top : rows[-1] + 1, left : columns[-1] + 1], 1, constant_values=UNKNOWN)
        x = self._anchor[0] + (self.first[1] + left - 1) * self.side_m
        y = self._anchor[1] + (self.first[0] + top - 1) * self.side_m
        return Grid(cut.shape[1], cut.shape[0], self.side_m, x, y, cut.tobytes())


def facing(inward: Floats) -> Indices:
    """Return which way surfaces face: right, up, left, down."""
    angle = np.arctan2(inward[:, 1], inward[:, 0])
    return np.floor((angle + np.pi / 4) / (np.pi / 2)).astype(np.int64) % FACINGS


def _in_cells(pads: list[tuple[int, int]], per: int) -> list[tuple[int, int]]:
    return [(below // per, above // per) for below, above in pads]

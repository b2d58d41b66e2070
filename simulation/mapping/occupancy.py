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


@dataclass(frozen=True, slots=True)
class Sight:
    """What a scan says, in the robot's frame, metres.

    `ends` [n, 2] are where beams ended, `inner` [n, 2] the same half a cell further in; `bearings` (rad) and `open_m`
    are of all beams that say how far the floor is free.
    """

    ends: Floats
    inner: Floats
    bearings: Floats
    open_m: Floats


def read_scan(ranges: Floats, range_m: float, side_m: float) -> Sight:
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
        points[seen] + inward[seen] * side_m / 2,
        bearings[says],
        np.where(seen, ranges, range_m)[says],
    )


def place(points: Floats, pose: Pose) -> Floats:
    """Return points of the robot's frame in the map frame."""
    turn_x, turn_y = cos(pose.theta), sin(pose.theta)
    x, y = points[:, 0], points[:, 1]
    return np.stack((pose.x + x * turn_x - y * turn_y, pose.y + x * turn_y + y * turn_x), axis=1)


class OccupancyMap:
    """A map that grows. `anchor` is a corner of some cell in the map frame."""

    def __init__(self, side_m: float, anchor: tuple[float, float], range_m: float) -> None:
        self.side_m, self._anchor, self._range_m = side_m, anchor, range_m
        self.first = (0, 0)
        """Row and column of the raster at which the arrays begin."""
        self.odds = np.zeros((0, 0), dtype=np.float32)
        self.field = np.zeros((0, 0), dtype=np.uint8)
        """For scan matching: 2 where beams ended, 1 beside that."""
        self.sums = np.zeros((0, 0, 6), dtype=np.float64)
        """Of the ends in each cell, from its middle: how many, x, y, xx, xy, yy."""

    def cells_of(self, points: Floats) -> tuple[Indices, Indices]:
        """Return row and column in the arrays of points [n, 2] in metres; they may lie off the arrays."""
        columns = np.floor((points[:, 0] - self._anchor[0]) / self.side_m).astype(np.int64) - self.first[1]
        rows = np.floor((points[:, 1] - self._anchor[1]) / self.side_m).astype(np.int64) - self.first[0]
        return rows, columns

    def centre_of(self, rows: Indices, columns: Indices) -> Floats:
        """Return the middles [n, 2] of cells in metres."""
        x = self._anchor[0] + (columns + self.first[1] + 0.5) * self.side_m
        y = self._anchor[1] + (rows + self.first[0] + 0.5) * self.side_m
        return np.stack((x, y), axis=1)

    def make_room(self, pose: Pose) -> None:
        """Grow so that all that the robot can see from there lies on the map."""
        reach = self._range_m + ROOM_M
        corners = np.array(((pose.x - reach, pose.y - reach), (pose.x + reach, pose.y + reach)))
        rows, columns = self.cells_of(corners)
        height, width = self.odds.shape
        spare = int(GROW_M / self.side_m)
        if not height:
            self.first = (int(rows[0]), int(columns[0]))
            rows, columns = rows - rows[0], columns - columns[0]
        below, left = (max(0, -int(low[0])) for low in (rows, columns))
        above, right = max(0, int(rows[1]) + 1 - height), max(0, int(columns[1]) + 1 - width)
        if not below + left + above + right:
            return
        pads = [(pad + spare if pad else 0) for pad in (below, above, left, right)]
        sides = ((pads[0], pads[1]), (pads[2], pads[3]))
        self.odds, self.field = np.pad(self.odds, sides), np.pad(self.field, sides)
        self.sums = np.pad(self.sums, (*sides, (0, 0)))
        self.first = (self.first[0] - pads[0], self.first[1] - pads[2])

    def add(self, sight: Sight, pose: Pose) -> None:
        """Take in what is seen from a place."""
        self.make_room(pose)
        width = self.odds.shape[1]
        ends = place(sight.ends, pose)
        rows, columns = self.cells_of(place(sight.inner, pose))
        walls = np.unique(rows * width + columns)
        passed = np.zeros(self.odds.size, dtype=np.bool_)
        passed[self._passed(sight, pose)] = True
        passed[walls] = False
        odds = self.odds.ravel()
        free = np.flatnonzero(passed)
        odds[free] = np.maximum(odds[free] + np.float32(PASS), np.float32(LOWEST))
        odds[walls] = np.minimum(odds[walls] + np.float32(HIT), np.float32(HIGHEST))
        self._remember_ends(ends, rows, columns)

    def _passed(self, sight: Sight, pose: Pose) -> Indices:
        """Return the cells that beams went through, numbered row by row; the last half cell is left out."""
        count = int((self._range_m) / (0.7 * self.side_m)) + 1
        far = np.arange(count) * 0.7 * self.side_m
        angles = sight.bearings + pose.theta
        is_open = far[None, :] < (sight.open_m - self.side_m / 2)[:, None]
        x = pose.x - self._anchor[0] + np.outer(np.cos(angles), far)[is_open]
        y = pose.y - self._anchor[1] + np.outer(np.sin(angles), far)[is_open]
        columns = np.floor(x / self.side_m).astype(np.int64) - self.first[1]
        rows = np.floor(y / self.side_m).astype(np.int64) - self.first[0]
        return rows * self.odds.shape[1] + columns

    def _remember_ends(self, ends: Floats, rows: Indices, columns: Indices) -> None:
        off = ends - self.centre_of(rows, columns)
        x, y = off[:, 0], off[:, 1]
        cells = rows * self.odds.shape[1] + columns
        np.add.at(self.sums.reshape(-1, 6), cells, np.stack((np.ones_like(x), x, y, x * x, x * y, y * y), axis=1))
        field, width = self.field.ravel(), self.odds.shape[1]
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

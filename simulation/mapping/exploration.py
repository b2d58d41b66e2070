"""Where to look next: the edges of what is known (frontiers, Yamauchi 1997), and how to drive there.

It is planned on coarser cells than the map's: a cell is wall if any of its cells is, and unknown if half of them are.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import hypot

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from simulation.mapping.occupancy import SURE_FREE, SURE_WALL, OccupancyMap
from vipo_device.protocol.description import Pose

Point = tuple[float, float]
COARSE_M = 0.1
MARGIN_M = 0.05
COMFORT_M = 0.15
LOOK_M = 0.6
"""From how far, beyond its own radius, a robot may look at a frontier."""
LEAST_M = 0.25
"""Shorter frontiers are not worth a way."""
GIVEN_UP_M = 0.25
START_M = 0.6
NEAR_WALL = 3.0
_EVERYWHERE = np.ones((3, 3), dtype=np.bool_)


@dataclass(frozen=True, slots=True)
class Goal:
    """A way to a frontier: points to drive through (m), and the points that are to be seen from its end."""

    path: tuple[Point, ...]
    frontier: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Ground:
    """The map in coarse cells [row, column]: where the robot's middle may be, and what lies at the edge of the known.

    `origin` is the corner of the first cell in metres, `room_m` how far a wall is, `known` what is free or wall.
    """

    side_m: float
    origin: Point
    room_m: NDArray[np.float64]
    drivable: NDArray[np.bool_]
    frontier: NDArray[np.bool_]
    known: NDArray[np.bool_]

    def centres(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the middles [n, 2] of cells in metres."""
        return np.stack(((columns + 0.5) * self.side_m, (rows + 0.5) * self.side_m), axis=1) + self.origin


def survey_ground(occupancy: OccupancyMap, radius_m: float, given_up: Iterable[Point]) -> Ground:
    """Return the map as a robot of that radius sees it; frontiers near to what was given up are left out."""
    factor = max(1, round(COARSE_M / occupancy.side_m))
    height, width = (side // factor for side in occupancy.odds.shape)
    blocks = occupancy.odds[: height * factor, : width * factor].reshape(height, factor, width, factor)
    wall = blocks.max(axis=(1, 3)) > SURE_WALL
    free = ((blocks < SURE_FREE).sum(axis=(1, 3)) * 2 > factor * factor) & ~wall
    side_m = factor * occupancy.side_m
    corner = occupancy.centre_of(np.zeros(1, dtype=np.int64), np.zeros(1, dtype=np.int64))[0] - occupancy.side_m / 2
    unknown = ~free & ~wall
    room = np.maximum(ndimage.distance_transform_edt(~wall) - 0.5, 0.0) * side_m
    known_room = np.maximum(ndimage.distance_transform_edt(free) - 0.5, 0.0) * side_m
    drivable = (room >= radius_m + MARGIN_M) & (known_room >= radius_m)
    frontier = free & ndimage.binary_dilation(unknown, _EVERYWHERE)
    ground = Ground(side_m, (float(corner[0]), float(corner[1])), room, drivable, frontier, ~unknown)
    for point in given_up:
        _leave_out(ground, point)
    return ground


def _leave_out(ground: Ground, point: Point) -> None:
    rows, columns = np.nonzero(ground.frontier)
    centres = ground.centres(rows, columns)
    near = np.hypot(centres[:, 0] - point[0], centres[:, 1] - point[1]) < GIVEN_UP_M
    ground.frontier[rows[near], columns[near]] = False


@dataclass(frozen=True, slots=True)
class Frontiers:
    """The frontiers that are worth a way: each cell's [row, column] number, the cells of each number, and the cells."""

    labels: NDArray[np.int32]
    sizes: NDArray[np.int64]
    seen: NDArray[np.bool_]


def find_frontiers(ground: Ground) -> Frontiers | None:
    """Return the frontiers that are long enough to be worth a way; None when there is none."""
    labels, count = ndimage.label(ground.frontier, _EVERYWHERE)
    sizes = np.bincount(labels.ravel(), minlength=count + 1)
    large = sizes * ground.side_m >= LEAST_M
    large[0] = False
    seen = large[labels]
    return Frontiers(labels, sizes, seen) if seen.any() else None


class Paths:
    """The cheapest paths from one place to all others: metres, a metre close to walls counting more."""

    def __init__(self, ground: Ground, start: Point) -> None:
        self.ground = ground
        self._numbers: NDArray[np.int64] = np.full(ground.drivable.shape, -1, dtype=np.int64)
        self._rows, self._columns = np.nonzero(ground.drivable)
        self._numbers[self._rows, self._columns] = np.arange(self._rows.size)
        self.cost = np.full(ground.drivable.shape, np.inf)
        self._before = np.zeros(0, dtype=np.int32)
        first = self._nearest(start)
        if first is not None:
            cost, self._before = dijkstra(self._graph(), directed=False, indices=first, return_predecessors=True)
            self.cost[self._rows, self._columns] = cost

    def _nearest(self, start: Point) -> int | None:
        """Return the number of the drivable cell next to a point, if there is one not far off."""
        if not self._rows.size:
            return None
        centres = self.ground.centres(self._rows, self._columns)
        away = np.hypot(centres[:, 0] - start[0], centres[:, 1] - start[1])
        nearest = int(np.argmin(away))
        return nearest if away[nearest] <= START_M else None

    def _graph(self) -> coo_array:
        numbers: NDArray[np.int64] = self._numbers
        ground = self.ground
        tight = np.where(
            ground.room_m[self._rows, self._columns] < ground.side_m + COMFORT_M + MARGIN_M, NEAR_WALL, 1.0
        )
        froms, tos = [], []
        for up, right in ((0, 1), (1, 0), (1, 1), (1, -1)):
            here = numbers[: numbers.shape[0] - up, max(0, -right) : numbers.shape[1] - max(0, right)]
            there = numbers[up:, max(0, right) : numbers.shape[1] + min(0, right)]
            both = (here >= 0) & (there >= 0)
            froms.append(here[both])
            tos.append(there[both])
        begin, end = np.concatenate(froms), np.concatenate(tos)
        way = np.hypot(self._rows[begin] - self._rows[end], self._columns[begin] - self._columns[end])
        cost = way * ground.side_m * (tight[begin] + tight[end]) / 2
        return coo_array((cost, (begin, end)), shape=(self._rows.size, self._rows.size)).tocsr()

    def path_to(self, row: int, column: int) -> tuple[Point, ...]:
        """Return the way to a cell that can be reached, as points in metres."""
        numbers = []
        number = int(self._numbers[row, column])
        while number >= 0:
            numbers.append(number)
            number = int(self._before[number])
        numbers.reverse()
        return tuple((float(x), float(y)) for x, y in self.ground.centres(self._rows[numbers], self._columns[numbers]))

    def path_home(self, home: Point) -> tuple[Point, ...]:
        """Return the way to the reachable cell that is nearest to a point; nothing when there is none near it."""
        number = self._nearest(home)
        if number is None:
            return ()
        row, column = int(self._rows[number]), int(self._columns[number])
        return self.path_to(row, column) if np.isfinite(self.cost[row, column]) else ()


def choose_goal(paths: Paths, radius_m: float) -> Goal | None:
    """Return the frontier that is worth its way most, long ones counting for less way; None when no way leads there."""
    ground, frontiers = paths.ground, find_frontiers(paths.ground)
    if frontiers is None:
        return None
    labels, sizes, seen = frontiers.labels, frontiers.sizes, frontiers.seen
    away, (rows, columns) = ndimage.distance_transform_edt(~seen, return_indices=True)
    stands = np.isfinite(paths.cost) & (away * ground.side_m <= radius_m + LOOK_M)
    at_rows, at_columns = np.nonzero(stands)
    if not at_rows.size:
        return None
    label = labels[rows[stands], columns[stands]]
    gain = np.minimum(sizes[label] * ground.side_m, 3.0)
    price = paths.cost[stands] + away[stands] * ground.side_m - 0.5 * gain
    best = int(np.argmin(price))
    path = paths.path_to(int(at_rows[best]), int(at_columns[best]))
    frontier = ground.centres(*np.nonzero(labels == label[best]))
    near = np.hypot(frontier[:, 0] - path[-1][0], frontier[:, 1] - path[-1][1]) < radius_m + LOOK_M + 1.0
    return Goal(path, frontier[near])


def is_near(pose: Pose, point: Point, reach_m: float) -> bool:
    """Tell whether a place lies within `reach_m` of a point."""
    return hypot(pose.x - point[0], pose.y - point[1]) <= reach_m

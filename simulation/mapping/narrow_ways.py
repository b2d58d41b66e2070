"""Ways through places that are as narrow as the robot itself, for where no other way leads on.

Ordinary ways keep a margin to walls and are planned on coarse cells (`exploration.py`), in which a parking bay or a
narrow door is shut. These are planned on the map's own cells, thinned to about 5 cm: a robot can reach what is joined
to its place by known floor with at least its radius of room.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from simulation.mapping.exploration import Goal, Ground, Point, find_frontiers
from simulation.mapping.occupancy import SURE_WALL, OccupancyMap

PITCH_M = 0.05
NEAR_M = 0.15
"""A goal's frontier is what lies so near to the way's end, beyond the robot's radius."""
_EVERYWHERE = np.ones((3, 3), dtype=np.bool_)


class NarrowWays:
    """The floor that a robot can reach, and the ways there, those in the middle between walls being the cheapest."""

    def __init__(self, occupancy: OccupancyMap, ground: Ground, start: Point, radius_m: float) -> None:
        self._occupancy, self._ground, self._radius_m = occupancy, ground, radius_m
        self._factor = round(ground.side_m / occupancy.side_m)
        room, rows, columns = self._thinned()
        row, column = self._nearest_of(rows, columns, start)
        labels, _ = ndimage.label(self._passable(room, rows, columns, start), _EVERYWHERE)
        self._own: NDArray[np.bool_] = (labels == labels[row, column]) & (labels > 0)
        self._room, self._rows, self._columns = room[self._own], rows[self._own], columns[self._own]
        self._points = occupancy.centre_of(self._rows, self._columns)
        self._start = start

    @property
    def fits(self) -> bool:
        """False where by its map the robot fits nowhere: then it cannot tell what it can reach."""
        return bool((self._room >= self._radius_m).any())

    def _thinned(self) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
        """Return of each block of cells the most room to a wall (m), and row and column of the cell that has it."""
        side = self._occupancy.side_m
        walls = self._occupancy.odds > SURE_WALL
        room = np.maximum(ndimage.distance_transform_edt(~walls) - 0.5, 0.0) * side
        pitch = max(1, round(PITCH_M / side))
        height, width = (length // pitch for length in room.shape)
        blocks = room[: height * pitch, : width * pitch].reshape(height, pitch, width, pitch).swapaxes(1, 2)
        flat = blocks.reshape(height, width, pitch * pitch)
        best = flat.argmax(axis=2)
        rows, columns = np.indices((height, width)) * pitch
        return flat.max(axis=2), rows + best // pitch, columns + best % pitch

    def _passable(
        self, room: NDArray[np.float64], rows: NDArray[np.int64], columns: NDArray[np.int64], start: Point
    ) -> NDArray[np.bool_]:
        """Return where the robot fits; it does where it stands, whatever the map says of that."""
        fits = self._lies_in(self._ground.known, rows, columns) & (room >= self._radius_m)
        stands: NDArray[np.bool_] = (room > 0) & (self._away(rows, columns, start) < self._radius_m)
        return fits | stands

    def _lies_in(
        self, mask: NDArray[np.bool_], rows: NDArray[np.int64], columns: NDArray[np.int64]
    ) -> NDArray[np.bool_]:
        """Return which of the map's cells lie in coarse cells that are true; none does beyond the last coarse one."""
        up, right = rows // self._factor, columns // self._factor
        inside = (up < mask.shape[0]) & (right < mask.shape[1])
        lies: NDArray[np.bool_] = inside & mask[np.where(inside, up, 0), np.where(inside, right, 0)]
        return lies

    def _away(self, rows: NDArray[np.int64], columns: NDArray[np.int64], point: Point) -> NDArray[np.float64]:
        x, y = self._occupancy.centre_of(np.zeros(1, np.int64), np.zeros(1, np.int64))[0]
        side = self._occupancy.side_m
        away: NDArray[np.float64] = np.hypot(x + columns * side - point[0], y + rows * side - point[1])
        return away

    def _nearest_of(self, rows: NDArray[np.int64], columns: NDArray[np.int64], point: Point) -> tuple[int, int]:
        row, column = np.unravel_index(int(np.argmin(self._away(rows, columns, point))), rows.shape)
        return int(row), int(column)

    def goal(self) -> Goal | None:
        """Return the frontier that is reached at the least cost; None when the robot cannot reach any."""
        frontiers = find_frontiers(self._ground)
        if frontiers is None or not self._rows.size:
            return None
        edge = self._lies_in(frontiers.seen, self._rows, self._columns)
        if not edge.any():
            return None
        path = self._path_to(np.flatnonzero(edge))
        frontier = self._ground.centres(*np.nonzero(frontiers.seen))
        away = np.hypot(frontier[:, 0] - path[-1][0], frontier[:, 1] - path[-1][1])
        return Goal(path, frontier[away <= max(self._radius_m + NEAR_M, float(away.min()))])

    def path_home(self, home: Point) -> tuple[Point, ...]:
        """Return the way to where the robot began; nothing when it cannot come there."""
        if not self._rows.size:
            return ()
        away = np.hypot(self._points[:, 0] - home[0], self._points[:, 1] - home[1])
        nearest = int(np.argmin(away))
        return self._path_to(np.array([nearest])) if away[nearest] <= self._radius_m else ()

    def _path_to(self, ends: NDArray[np.int64]) -> tuple[Point, ...]:
        """Return the cheapest way to one of these cells, as points in metres."""
        first = int(np.argmin(np.hypot(self._points[:, 0] - self._start[0], self._points[:, 1] - self._start[1])))
        cost, before = dijkstra(self._graph(), directed=False, indices=first, return_predecessors=True)
        number, numbers = int(ends[np.argmin(cost[ends])]), []
        while number >= 0:
            numbers.append(number)
            number = int(before[number])
        return tuple((float(x), float(y)) for x, y in self._points[numbers[::-1]])

    def _graph(self) -> csr_array:
        """Return what it costs to go from each cell to its neighbours: metres, the dearer the less room there is."""
        numbers = np.full(self._own.shape, -1, dtype=np.int64)
        numbers[self._own] = np.arange(self._rows.size)
        padded = np.pad(numbers, 1, constant_values=-1)
        begin, end = [], []
        for up, right in ((0, 1), (1, 0), (1, 1), (1, -1)):
            there = padded[1 + up : padded.shape[0] - 1 + up, 1 + right : padded.shape[1] - 1 + right]
            both = (numbers >= 0) & (there >= 0)
            begin.append(numbers[both])
            end.append(there[both])
        froms, tos = np.concatenate(begin), np.concatenate(end)
        way = np.hypot(*(self._points[froms] - self._points[tos]).T)
        price = self._radius_m / np.minimum(np.maximum(self._room, PITCH_M / 2), 3 * self._radius_m)
        cost = way * (price[froms] + price[tos]) ** 2
        return csr_array((cost, (froms, tos)), shape=(self._rows.size, self._rows.size))

"""The true floor: where beams end and where a robot fits. Everything that is not free is solid, unknown cells too."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from registry.floorplan.plan import FREE, Grid, cells_array
from simulation.world import Obstacle
from vipo_device.protocol.description import Pose

Floats = NDArray[np.float64]
_BEYOND_EDGE = 1e-6
"""Cells: how far a beam goes past the edge between two cells, to be in the next one."""
_ALONG_AXIS = 1e-5
"""A beam that is so little askew counts as along the axis: the longest range is off by a fiftieth of a cell."""
_SURE_CELLS = 1.5
"""A beam may go as far as the nearest solid cell's middle is away, less the two halves of cells in between."""


class TrueFloor:
    """A floor made from a map; whatever leaves the map meets a wall."""

    def __init__(self, grid: Grid) -> None:
        self.grid = grid
        self._solid = np.pad(cells_array(grid) != FREE, 1, constant_values=True)
        self.put(())

    def put(self, obstacles: Iterable[Obstacle]) -> None:
        """Let round things stand on the floor, in place of those that stood there; robots see and touch them."""
        self.solid = self._solid.copy()
        for thing in obstacles:
            column, row = self._cells(thing.x, thing.y)
            radius = thing.size_m / 2 / self.grid.resolution_m
            left, low = (max(0, int(middle - radius) - 1) for middle in (column, row))
            part = self.solid[low : int(row + radius) + 2, left : int(column + radius) + 2]
            rows, columns = np.indices(part.shape) + 0.5
            part |= (rows + low - row) ** 2 + (columns + left - column) ** 2 <= radius**2
        distance: Floats = ndimage.distance_transform_edt(~self.solid)
        self._distance = distance
        self._leap = np.maximum(distance - _SURE_CELLS, 0.0).ravel()
        self._flat = self.solid.ravel()

    def clearance_m(self, x_m: float, y_m: float) -> float:
        """Return how far the nearest solid cell's edge is at least; 0 inside of one and off the map."""
        column, row = (int(np.floor(value)) for value in self._cells(x_m, y_m))
        if not (0 <= row < self.solid.shape[0] and 0 <= column < self.solid.shape[1]):
            return 0.0
        return max(0.0, (float(self._distance[row, column]) - 0.5) * self.grid.resolution_m)

    def roomiest(self) -> Pose:
        """Return the place with the most room around it, looking along x."""
        row, column = np.unravel_index(int(np.argmax(self._distance)), self._distance.shape)
        x, y = self.grid.centre_of(int(row) - 1, int(column) - 1)
        return Pose(x, y, 0.0, 0.0)

    def region_of(self, pose: Pose) -> NDArray[np.bool_]:
        """Return which cells [row, column] of the grid are free and joined to that place by free cells."""
        labels, _ = ndimage.label(~self.solid)
        column, row = (int(np.floor(value)) for value in self._cells(pose.x, pose.y))
        region: NDArray[np.bool_] = (labels == labels[row, column]) & ~self.solid
        return region[1:-1, 1:-1]

    def _cells(self, x_m: float, y_m: float) -> tuple[float, float]:
        """Return column and row, in cells, on the floor with its rim."""
        grid = self.grid
        return (x_m - grid.origin_x_m) / grid.resolution_m + 1.0, (y_m - grid.origin_y_m) / grid.resolution_m + 1.0

    def cast(self, x_m: float, y_m: float, angles_rad: Floats, range_m: float) -> Floats:
        """Return how far each beam goes until it meets something solid, in metres; infinite beyond the range.

        Exact: a beam leaps over what is known to be free (sphere tracing on the distance transform) and goes from one
        cell's edge to the next one's near to walls (Amanatides and Woo, 1987).
        """
        column, row = self._cells(x_m, y_m)
        far, width = range_m / self.grid.resolution_m, self.solid.shape[1]
        beams = np.stack((np.cos(angles_rad), np.sin(angles_rad)))
        beams[np.abs(beams) < _ALONG_AXIS] = 0.0
        slow = 1.0 / np.maximum(np.abs(beams), 1e-12)
        gone, ends = np.zeros_like(angles_rad), np.full_like(angles_rad, np.inf)
        under_way = np.arange(angles_rad.size)
        begin = np.array(((column,), (row,)))
        while under_way.size:
            at = begin + gone * beams
            corner = np.floor(at)
            cell = corner[1].astype(np.int64) * width + corner[0].astype(np.int64)
            hit = self._flat[cell]
            ends[under_way[hit]] = gone[hit]
            inside = at - corner
            left = np.where(beams < 0, inside, 1.0 - inside)
            edge = (left * slow).min(axis=0) + _BEYOND_EDGE
            leap = self._leap[cell]
            gone = gone + np.maximum(edge, leap)
            goes_on = np.flatnonzero(~hit & (gone <= far))
            if goes_on.size < under_way.size:
                under_way, gone = under_way[goes_on], gone[goes_on]
                beams, slow = beams[:, goes_on], slow[:, goes_on]
        return ends * self.grid.resolution_m


@dataclass(frozen=True, slots=True)
class LidarSpec:
    """A lidar that looks all round: `rays` beams up to `range_m`.

    A range is off by `noise_m` and a share of itself (one standard deviation), a beam's angle by `noise_rad`; of
    `lost` beams nothing comes back.
    """

    range_m: float = 8.0
    rays: int = 360
    noise_m: float = 0.01
    noise_share: float = 0.002
    noise_rad: float = 0.001
    lost: float = 0.005


class Lidar:
    """A lidar on a floor. Chance comes from the generator that it is given."""

    def __init__(self, floor: TrueFloor, spec: LidarSpec, chance: np.random.Generator) -> None:
        self._floor, self._spec, self._chance = floor, spec, chance
        self._bearings = np.linspace(-np.pi, np.pi, spec.rays, endpoint=False)

    def scan(self, pose: Pose) -> Floats:
        """Return one range per beam from -pi on, in metres: infinite where nothing is near, NaN where it is lost."""
        spec, chance = self._spec, self._chance
        angles = pose.theta + self._bearings + chance.normal(0.0, spec.noise_rad, spec.rays)
        ranges = self._floor.cast(pose.x, pose.y, angles, spec.range_m)
        off = chance.normal(0.0, 1.0, spec.rays)
        lost = chance.random(spec.rays) < spec.lost
        seen = np.isfinite(ranges)
        ranges[seen] += off[seen] * (spec.noise_m + spec.noise_share * ranges[seen])
        ranges = np.maximum(ranges, 0.0)
        ranges[lost] = np.nan
        return ranges

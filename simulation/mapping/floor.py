"""The true floor: where beams end and where a robot fits. Everything that is not free is solid, unknown cells too."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from registry.floorplan.plan import FREE, Grid, cells_array
from vipo_device.protocol.description import Pose

Floats = NDArray[np.float64]
_BEYOND_EDGE = 1e-7
"""Cells: how far a beam goes past the edge between two cells, to be in the next one."""
_SURE_CELLS = 1.5
"""A beam may go as far as the nearest solid cell's middle is away, less the two halves of cells in between."""


class TrueFloor:
    """A floor made from a map; whatever leaves the map meets a wall."""

    def __init__(self, grid: Grid) -> None:
        self.grid = grid
        solid = cells_array(grid) != FREE
        self.solid = np.pad(solid, 1, constant_values=True)
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
        far = range_m / self.grid.resolution_m
        ahead = np.cos(angles_rad), np.sin(angles_rad)
        gone = np.zeros_like(angles_rad)
        ends = np.full_like(angles_rad, np.inf)
        under_way = np.arange(angles_rad.size)
        along, up = ahead
        while under_way.size:
            at_column, at_row = column + gone * along, row + gone * up
            cell = at_row.astype(np.int64) * self.solid.shape[1] + at_column.astype(np.int64)
            hit = self._flat[cell]
            ends[under_way[hit]] = gone[hit]
            goes_on = ~hit
            leap = self._leap[cell]
            step = np.where(leap > 1.0, leap, _to_edge(at_column, along, at_row, up))
            gone = gone + step
            goes_on &= gone <= far
            under_way, gone, along, up = under_way[goes_on], gone[goes_on], along[goes_on], up[goes_on]
        return ends * self.grid.resolution_m


def _to_edge(at_column: Floats, along: Floats, at_row: Floats, up: Floats) -> Floats:
    """Return how far it is, in cells along each beam, into the next cell."""
    with np.errstate(divide="ignore", invalid="ignore"):
        right = np.where(along > 0, np.floor(at_column) + 1 - at_column, at_column - np.floor(at_column))
        above = np.where(up > 0, np.floor(at_row) + 1 - at_row, at_row - np.floor(at_row))
        across = np.where(along == 0, np.inf, right / np.abs(along))
        upward = np.where(up == 0, np.inf, above / np.abs(up))
    nearest: Floats = np.minimum(across, upward) + _BEYOND_EDGE
    return nearest


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
        """Return one range per beam from -pi on, in metres: infinite where nothing is in range, NaN where it is lost."""
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

"""How good a map is: held against the floor of which it was made."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from registry.floorplan.plan import FREE, OCCUPIED, UNKNOWN, Grid, cells_array
from simulation.mapping.floor import TrueFloor
from vipo_device.protocol.description import Pose

_AROUND = np.ones((3, 3), dtype=np.bool_)
Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Scores:
    """Shares from 0 to 1: F1 of occupied cells at one cell's tolerance, IoU of free cells."""

    precision: float
    recall: float
    f1: float
    iou: float


def score(made: Grid, floor: TrueFloor, start: Pose) -> Scores:
    """Hold a map, on the same raster, against the floor that can be seen from `start` on.

    True walls are the solid cells that border on free ones that are joined to the start, which is all that a lidar can
    ever see. A cell counts as found when there is one of the other map in it or beside it.
    """
    cells = on_raster(made, floor.grid)
    free = floor.region_of(start)
    # one cell more on each side, since what bounds a floor may lie just off the map
    free = np.pad(free, 1)
    wall = ndimage.binary_dilation(free, _AROUND) & np.pad(floor.solid[1:-1, 1:-1], 1, constant_values=True)
    found = cells == OCCUPIED
    precision = _share(found, ndimage.binary_dilation(wall, _AROUND))
    recall = _share(wall, ndimage.binary_dilation(found, _AROUND))
    both = precision + recall
    made_free = cells == FREE
    union = np.count_nonzero(made_free | free)
    iou = np.count_nonzero(made_free & free) / union if union else 0.0
    return Scores(precision, recall, 2 * precision * recall / both if both else 0.0, float(iou))


def on_raster(made: Grid, truth: Grid) -> NDArray[np.uint8]:
    """Return a map's cells on the truth's raster with one cell more on each side; what lies beyond is left out."""
    cells = np.full((truth.height + 2, truth.width + 2), UNKNOWN, dtype=np.uint8)
    down = round((made.origin_y_m - truth.origin_y_m) / truth.resolution_m) + 1
    left = round((made.origin_x_m - truth.origin_x_m) / truth.resolution_m) + 1
    rows = slice(max(0, down), max(0, min(cells.shape[0], down + made.height)))
    columns = slice(max(0, left), max(0, min(cells.shape[1], left + made.width)))
    part = cells_array(made)[rows.start - down : rows.stop - down, columns.start - left : columns.stop - left]
    cells[rows, columns] = part
    return cells


def _share(cells: Mask, among: Mask) -> float:
    count = np.count_nonzero(cells)
    return float(np.count_nonzero(cells & among) / count) if count else 0.0

"""Halls to map: made by chance from a seed, so that tests and measurements need no files."""

from __future__ import annotations

import numpy as np

from registry.floorplan.plan import FREE, OCCUPIED, UNKNOWN, Grid
from vipo_device.protocol.description import Pose


def generated_hall(seed: int, width_m: float = 30.0, height_m: float = 15.0, side_m: float = 0.05) -> Grid:
    """Return a hall with walls around, racks in rows, pillars and boxes that stand askew; its corner is at (0, 0)."""
    chance = np.random.default_rng(seed)
    columns, rows = round(width_m / side_m), round(height_m / side_m)
    cells = np.full((rows, columns), FREE, dtype=np.uint8)
    edge = round(0.15 / side_m)
    for side in (cells[:edge], cells[-edge:], cells[:, :edge], cells[:, -edge:]):
        side[:] = OCCUPIED
    for x in np.arange(5.0, width_m - 4.0, 5.0):
        top = float(chance.uniform(0.55, 0.7)) * height_m
        _rack(cells, side_m, (x, 2.5, x + 1.2, top - 1.0))
    for _ in range(12):
        at = chance.uniform((1.5, 0.72 * height_m), (width_m - 1.5, height_m - 1.2))
        _box(cells, side_m, (float(at[0]), float(at[1])), chance.uniform(0.2, 0.8, 2), float(chance.uniform(0, np.pi)))
    return Grid(columns, rows, side_m, 0.0, 0.0, cells.tobytes())


def bare_hall(width_m: float, height_m: float, side_m: float = 0.05) -> Grid:
    """Return an empty rectangle with walls around."""
    columns, rows = round(width_m / side_m), round(height_m / side_m)
    cells = np.full((rows, columns), OCCUPIED, dtype=np.uint8)
    cells[2:-2, 2:-2] = FREE
    return Grid(columns, rows, side_m, 0.0, 0.0, cells.tobytes())


def hall_with_a_bay(wide_m: float) -> tuple[Grid, Pose]:
    """Return a hall of 6 by 3 m with a pillar and, below it, a parking bay 1.1 m deep; and a place in the bay."""
    side_m, wide = 0.05, round(wide_m / 0.05)
    cells = np.full((86, 124), OCCUPIED, dtype=np.uint8)
    cells[24:84, 2:122] = FREE
    cells[50:56, 84:90] = OCCUPIED
    cells[2:24, 50 : 50 + wide] = FREE
    return Grid(124, 86, side_m, 0.0, 0.0, cells.tobytes()), Pose((50 + wide / 2) * side_m, 0.45, 0.0, 1.57)


def _rack(cells: np.ndarray[tuple[int, int], np.dtype[np.uint8]], side_m: float, box: tuple[float, ...]) -> None:
    """A rack: what is inside of it nobody sees."""
    left, bottom, right, top = (round(value / side_m) for value in box)
    cells[bottom:top, left:right] = OCCUPIED
    cells[bottom + 2 : top - 2, left + 2 : right - 2] = UNKNOWN


def _box(
    cells: np.ndarray[tuple[int, int], np.dtype[np.uint8]],
    side_m: float,
    middle: tuple[float, float],
    size: np.ndarray[tuple[int], np.dtype[np.float64]],
    turned: float,
) -> None:
    rows, columns = np.indices(cells.shape)
    x, y = (columns + 0.5) * side_m - middle[0], (rows + 0.5) * side_m - middle[1]
    along, across = x * np.cos(turned) + y * np.sin(turned), y * np.cos(turned) - x * np.sin(turned)
    cells[(np.abs(along) <= size[0] / 2) & (np.abs(across) <= size[1] / 2)] = OCCUPIED

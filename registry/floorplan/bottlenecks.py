"""Where the way between two parts of a floor is narrowest, how wide it is there, and what stands on either side."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import hypot

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from registry.floorplan.lattice import Ground, Point, Raster
from registry.floorplan.plan import Grid
from registry.floorplan.polygons import Outline
from registry.floorplan.zone_masks import cells_touched

Cell = tuple[int, int]
Cells = NDArray[np.bool_]
Labels = NDArray[np.int32]
MOST_LEVELS = 64
"""Into so many widths the ones that are too narrow are told apart at most; else by half a cell."""
SIDE_REACH_M = 3.0
"""Farther from its middle nobody looks for what makes a passage narrow."""
MOST_OPENINGS = 32
_OPEN = 1e-9
_AROUND = ((0, 1), (1, 0), (0, -1), (-1, 0))


@dataclass(frozen=True, slots=True)
class Bottleneck:
    """The narrowest point of the widest way: where it is and how wide the way is there, in metres.

    `sides` are the nearest points of what stands on either side; one or none where nothing is near. No way at all is
    0 wide, and the point is the place from which there is none.
    """

    x: float
    y: float
    width_m: float
    sides: tuple[Point, ...] = ()


def find_bottlenecks(ground: Ground, places: Sequence[Point], rest: Point, width_m: float) -> list[Bottleneck | None]:
    """Return for each place what keeps a way so wide from leading to `rest`; None where there is such a way.

    Widths are those that the clearance of the floor tells: by up to a cell less than what is there.
    """
    goal = ground.grid.cell_of(*rest)
    cells = {number: cell for number, place in enumerate(places) if (cell := ground.grid.cell_of(*place))}
    found: list[Bottleneck | None] = [Bottleneck(*place, 0.0) for place in places]
    wider: Labels | None = None
    for level in _levels(width_m / 2, ground.grid.resolution_m):
        if goal is None or not cells:
            break
        labels, _ = ndimage.label(ground.clearance_m >= level)
        for number, start in list(cells.items()):
            if labels[start] and labels[start] == labels[goal]:
                joined = labels == labels[start]
                found[number] = None if wider is None else _narrowest(ground, joined, wider, start, goal)
                del cells[number]
        wider = labels
    return found


def _levels(widest_m: float, cell_m: float) -> list[float]:
    """Return clearances from the one that is needed down to hardly any."""
    step = max(cell_m / 2, widest_m / MOST_LEVELS)
    levels = (widest_m - step * number for number in range(int(widest_m / step) + 1))
    return [level for level in levels if level > _OPEN] + [_OPEN]


def _narrowest(ground: Ground, joined: Cells, wider: Labels, start: Cell, goal: Cell) -> Bottleneck:
    """Return the narrowest cell of a way over as few narrow cells as can be: those between what is wider."""
    narrow = joined & (wider == 0)
    path = _way_between(narrow, wider, start, goal)
    return bottleneck_at(ground, min(path, key=lambda cell: float(ground.clearance_m[cell]), default=start))


def _way_between(narrow: Cells, wider: Labels, start: Cell, goal: Cell) -> list[Cell]:
    """Return the narrow cells of such a way; over what is wider one comes for nothing, from its rim to its rim."""
    came: dict[Cell, Cell | None] = dict.fromkeys(_rim(narrow, wider, start))
    crossed, queue = {int(wider[start])}, deque(came)
    while queue:
        cell = queue.popleft()
        for near in _neighbours(cell, narrow.shape):
            part = int(wider[near])
            if near == goal or (part and part == wider[goal]):
                return _back(came, cell)
            ahead = [near] if narrow[near] else []
            if part and part not in crossed:
                crossed.add(part)
                ahead = _rim(narrow, wider, near)
            for each in ahead:
                if each not in came:
                    came[each] = cell
                    queue.append(each)
    return []


def _rim(narrow: Cells, wider: Labels, end: Cell) -> list[Cell]:
    """Return the narrow cells beside the wider part in which a cell is, or the cell itself where it is in none."""
    if not wider[end]:
        return [end]
    rows, columns = np.nonzero(ndimage.binary_dilation(wider == wider[end]) & narrow)
    return list(zip(rows.tolist(), columns.tolist(), strict=True))


def _neighbours(cell: Cell, shape: tuple[int, ...]) -> Iterator[Cell]:
    for up, right in _AROUND:
        row, column = cell[0] + up, cell[1] + right
        if 0 <= row < shape[0] and 0 <= column < shape[1]:
            yield row, column


def _back(came: dict[Cell, Cell | None], end: Cell) -> list[Cell]:
    path, cell = [end], came[end]
    while cell is not None:
        path.append(cell)
        cell = came[cell]
    return path


def bottleneck_at(ground: Ground, cell: Cell) -> Bottleneck:
    """Return how wide the floor is at a cell, and what is on either side."""
    x, y = _centre(ground.grid, cell)
    width_m = 2 * float(ground.clearance_m[cell])
    return Bottleneck(round(x, 3), round(y, 3), round(width_m, 3), _sides(ground, cell))


def _centre(grid: Raster, cell: Cell) -> Point:
    return (
        grid.origin_x_m + (cell[1] + 0.5) * grid.resolution_m,
        grid.origin_y_m + (cell[0] + 0.5) * grid.resolution_m,
    )


def _sides(ground: Ground, cell: Cell) -> tuple[Point, ...]:
    """Return the nearest cell that is not free, and the nearest of those on the other side of the cell."""
    reach = int(SIDE_REACH_M / ground.grid.resolution_m) + 1
    low, left = max(0, cell[0] - reach), max(0, cell[1] - reach)
    window = ground.clearance_m[low : cell[0] + reach + 1, left : cell[1] + reach + 1]
    rows, columns = np.nonzero(window <= 0.0)
    if not rows.size:
        return ()
    up, right = rows + low - cell[0], columns + left - cell[1]
    far = np.hypot(up, right)
    first = int(np.argmin(far))
    nearest = (int(up[first]), int(right[first]))
    across = up * nearest[0] + right * nearest[1] < -0.7 * far * max(hypot(*nearest), _OPEN)
    offsets = [nearest]
    if across.any():
        second = int(np.argmin(np.where(across, far, np.inf)))
        offsets.append((int(up[second]), int(right[second])))
    points = (_centre(ground.grid, (cell[0] + each[0], cell[1] + each[1])) for each in offsets)
    return tuple((round(x, 3), round(y, 3)) for x, y in points)


def width_through(grid: Grid, ground: Ground, outline: Outline) -> float | None:
    """Return how wide the way through a polygon is at its narrowest, between all openings by which one comes into it.

    None where it has no two openings, or no way through that a robot of the ground's radius fits on. Metres.
    """
    inside = cells_touched(grid, outline)
    fits = inside & (ground.clearance_m >= ground.radius_m)
    beyond = ~inside & (ground.clearance_m >= ground.radius_m)
    openings, count = ndimage.label(fits & ndimage.binary_dilation(beyond))
    rims = [np.nonzero(openings == number) for number in range(1, min(count, MOST_OPENINGS) + 1)]
    if len(rims) < 2 or not _joins_all(fits, rims):
        return None
    low, high = ground.radius_m, float(ground.clearance_m[fits].max())
    while high - low > grid.resolution_m / 8:
        middle = (low + high) / 2
        low, high = (middle, high) if _joins_all(fits & (ground.clearance_m >= middle), rims) else (low, middle)
    return round(2 * low, 3)


def _joins_all(cells: Cells, rims: Sequence[tuple[NDArray[np.int64], ...]]) -> bool:
    """Tell whether one connected part of the cells touches each of the openings."""
    labels, _ = ndimage.label(cells)
    common: set[int] | None = None
    for rim in rims:
        here = set(labels[rim].tolist()) - {0}
        common = here if common is None else common & here
        if not common:
            return False
    return True

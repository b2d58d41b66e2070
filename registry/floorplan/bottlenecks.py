"""Where the way between two parts of a floor is narrowest, how wide it is there, and what stands on either side."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import hypot

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from registry.floorplan.lattice import AROUND, Ground, Point
from registry.floorplan.plan import Grid
from registry.floorplan.polygons import Outline
from registry.floorplan.zone_masks import cells_touched

Cell = tuple[int, int]
Cells = NDArray[np.bool_]
Labels = NDArray[np.int32]
MOST_SEARCHED = 20
"""So many narrow ways are looked for; of others it is told how wide they are, but not where."""
MOST_LEVELS = 24
"""Into so many widths the ones that are too narrow are told apart at most; else by half a cell."""
SIDE_REACH_M = 3.0
"""Farther from its middle nobody looks for what makes a passage narrow."""
MOST_OPENINGS = 32
_OPEN = 1e-9


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

    Widths are those that the clearance of the floor tells: by up to a cell less than what is there. Places that are
    joined by ways that are wide enough have the same.
    """
    goal = ground.grid.cell_of(*rest)
    cells = {number: cell for number, place in enumerate(places) if (cell := ground.grid.cell_of(*place))}
    found: list[Bottleneck | None] = [Bottleneck(*place, 0.0) for place in places]
    wider: Labels | None = None
    searched = 0
    for level in _levels(width_m / 2, ground.grid.resolution_m):
        if goal is None or not cells:
            break
        labels, _ = ndimage.label(ground.clearance_m >= level)
        search = None if wider is None else _Search(labels, wider)
        known: dict[object, Bottleneck] = {}
        for number, start in list(cells.items()):
            if not labels[start] or labels[start] != labels[goal]:
                continue
            del cells[number]
            if search is None:
                found[number] = None
                continue
            part: object = int(search.wider[start]) or start
            if part not in known and searched < MOST_SEARCHED:
                searched += 1
                path = search.way_between(start, goal)
                narrowest = min(path, key=lambda cell: float(ground.clearance_m[cell]), default=start)
                known[part] = bottleneck_at(ground, narrowest)
            found[number] = known.get(part, Bottleneck(*places[number], round(2 * level, 3)))
        wider = labels
    return found


def _levels(widest_m: float, cell_m: float) -> list[float]:
    """Return clearances from the one that is needed down to hardly any."""
    step = max(cell_m / 2, widest_m / MOST_LEVELS)
    levels = (widest_m - step * number for number in range(int(widest_m / step) + 1))
    return [level for level in levels if level > _OPEN] + [_OPEN]


class _Search:
    """Ways over the narrow cells that join what is wider, by the connected parts of both: 0 is no part."""

    def __init__(self, joined: Labels, wider: Labels) -> None:
        self._joined, self.wider = joined, wider
        self._boxes = ndimage.find_objects(wider)

    def way_between(self, start: Cell, goal: Cell) -> list[Cell]:
        """Return the narrow cells of a way over as few of them as can be; where it is wider, it comes for nothing."""
        whole, end = int(self._joined[start]), int(self.wider[goal])
        came: dict[Cell, Cell | None] = dict.fromkeys(self._rim(start))
        crossed, queue = {int(self.wider[start])}, deque(came)
        while queue:
            cell = queue.popleft()
            for near in _neighbours(cell, self.wider.shape):
                part = int(self.wider[near])
                if near == goal or (part and part == end):
                    return _back(came, cell)
                ahead = [near] if not part and self._joined[near] == whole else []
                if part and part not in crossed:
                    crossed.add(part)
                    ahead = self._rim(near)
                for each in ahead:
                    if each not in came:
                        came[each] = cell
                        queue.append(each)
        return []

    def _rim(self, end: Cell) -> list[Cell]:
        """Return the narrow cells beside the wider part in which a cell is, or the cell itself where it is in none."""
        part = int(self.wider[end])
        if not part:
            return [end]
        box = tuple(slice(max(0, side.start - 1), side.stop + 1) for side in self._boxes[part - 1])
        near = ndimage.binary_dilation(self.wider[box] == part)
        rows, columns = np.nonzero(near & (self.wider[box] == 0) & (self._joined[box] == self._joined[end]))
        low, left = box[0].start, box[1].start
        return [(row + low, column + left) for row, column in zip(rows.tolist(), columns.tolist(), strict=True)]


def _neighbours(cell: Cell, shape: tuple[int, ...]) -> Iterator[Cell]:
    for up, right in AROUND:
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
    x, y = ground.grid.centre_of(*cell)
    width_m = 2 * float(ground.clearance_m[cell])
    return Bottleneck(round(x, 3), round(y, 3), round(width_m, 3), _sides(ground, cell))


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
    points = (ground.grid.centre_of(cell[0] + up, cell[1] + right) for up, right in offsets)
    return tuple((round(x, 3), round(y, 3)) for x, y in points)


def width_through(grid: Grid, ground: Ground, outline: Outline) -> float | None:
    """Return how wide the way through a polygon is at its narrowest, between all openings by which one comes into it.

    None where it has no two openings, or no way through that a robot of the ground's radius fits on. Metres.
    """
    touched = cells_touched(grid, outline)
    box = _box_around(touched)
    inside, clearance_m = touched[box], ground.clearance_m[box]
    fits = inside & (clearance_m >= ground.radius_m)
    beyond = ~inside & (clearance_m >= ground.radius_m)
    openings, count = ndimage.label(fits & ndimage.binary_dilation(beyond))
    rims = [np.nonzero(openings == number) for number in range(1, min(count, MOST_OPENINGS) + 1)]
    if len(rims) < 2 or not _joins_all(fits, rims):
        return None
    low, high = ground.radius_m, float(clearance_m[fits].max())
    while high - low > grid.resolution_m / 8:
        middle = (low + high) / 2
        low, high = (middle, high) if _joins_all(fits & (clearance_m >= middle), rims) else (low, middle)
    return round(2 * low, 3)


def _box_around(cells: Cells) -> tuple[slice, slice]:
    """Return the box of the cells that hold, with one more on each side."""
    rows, columns = np.flatnonzero(cells.any(axis=1)), np.flatnonzero(cells.any(axis=0))
    if not rows.size:
        return slice(0), slice(0)
    return slice(max(0, rows[0] - 1), rows[-1] + 2), slice(max(0, columns[0] - 1), columns[-1] + 2)


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

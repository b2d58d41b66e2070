"""Narrow ways of a floor, and lines that go through as many of them as can be: of columns here, of rows if turned."""

from __future__ import annotations

from math import ceil

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

Cells = NDArray[np.bool_]
Numbers = NDArray[np.int64]
Metres = NDArray[np.float64]
NARROW_SIDES = 1.5
"""A way is narrow where a row has less room than so many sides: lines that are evenly spaced might miss it."""
MOST_APART = 1.25
"""Lines are a side to so many sides apart."""
_NOOK = 0.1
"""What a narrow way is worth that joins nothing: one that joins two wide parts is worth 1."""
_MORE = 3.0
"""By so much more a way is worth that robots were not let through though they come to one of its ends."""
_EACH_LINE = 0.2
"""What one line more is worth, beside the ways that it goes through."""


class NarrowWays:
    """The narrow ways along columns of a floor on which a robot's middle `fits` [row, column]; a side in cells."""

    def __init__(self, fits: Cells, side: float) -> None:
        self._side, self._columns = side, fits.shape[1]
        narrow = _narrow(fits, NARROW_SIDES * side)
        self._ways, count = ndimage.label(narrow)
        self.wide, _ = ndimage.label(fits & ~narrow)
        """The wide parts that these ways join, by number; 0 is in none."""
        self.sizes: Numbers = np.bincount(self.wide.ravel())
        """How many cells each wide part has; none of 0."""
        self.sizes[0] = 0
        self._ends = _ends(self._ways, self.wide)
        joins = np.bincount(self._ends[0], minlength=count + 1) > 1
        self._worth = np.where(joins, 1.0, _NOOK)
        self._way, self._column, self._share = _shares(self._ways, count)

    def lines(self) -> Numbers:
        """Return the columns on which lines go, a side to a quarter more apart: those that are worth most."""
        worth = np.bincount(self._column, self._worth[self._way] * self._share**2, self._columns) + _EACH_LINE
        nearest, farthest = ceil(self._side - 1e-9), ceil(MOST_APART * self._side)
        best, before = worth.copy(), np.full(worth.size, -1)
        for column in range(nearest, worth.size):
            first = max(0, column - farthest)
            at = int(best[first : column - nearest + 1].argmax()) + first
            best[column] += best[at]
            before[column] = at
        column, lines = int(best.argmax()), []
        while column >= 0:
            lines.append(column)
            column = int(before[column])
        return np.array(lines[::-1])

    def want_missed(self, reached: NDArray[np.int32]) -> None:
        """Make ways worth more of which robots come to one end and not to another; `reached` are wide parts."""
        there = np.zeros(self.sizes.size, dtype=np.bool_)
        there[reached] = True
        way, part = self._ends
        some, all_ = np.zeros(self._worth.size, np.bool_), np.ones(self._worth.size, np.bool_)
        some[way[there[part]]] = True
        all_[way[~there[part]]] = False
        self._worth[some & ~all_] *= _MORE


def _narrow(fits: Cells, widest: float) -> Cells:
    """Return the cells of those runs in rows that are shorter than so many cells."""
    turns = np.diff(np.pad(fits, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    (rows, begins), (_, ends) = np.nonzero(turns == 1), np.nonzero(turns == -1)
    short = ends - begins < widest
    edges = np.zeros((fits.shape[0], fits.shape[1] + 1), dtype=np.int32)
    np.add.at(edges, (rows[short], begins[short]), 1)
    np.add.at(edges, (rows[short], ends[short]), -1)
    return np.asarray(np.cumsum(edges, axis=1)[:, :-1] > 0)


def _ends(ways: NDArray[np.int32], wide: NDArray[np.int32]) -> NDArray[np.int64]:
    """Return pairs [2, n] of a way and a wide part that begins where it ends, above or below; each once."""
    pairs = [np.zeros((2, 0), dtype=np.int64)]
    for way, part in ((ways[1:], wide[:-1]), (ways[:-1], wide[1:])):
        meet = (way > 0) & (part > 0)
        pairs.append(np.stack((way[meet], part[meet])).astype(np.int64))
    return np.unique(np.concatenate(pairs, axis=1), axis=1)


def _shares(ways: NDArray[np.int32], count: int) -> tuple[Numbers, Numbers, Metres]:
    """Return way, column and what share of the way's rows a line on that column goes through."""
    rows, columns = np.nonzero(ways)
    way = ways[rows, columns].astype(np.int64)
    (of, column), through = np.unique(np.stack((way, columns)), axis=1, return_counts=True)
    long = np.bincount(np.unique(np.stack((way, rows)), axis=1)[0], minlength=count + 1)
    return of, column, through / np.maximum(long[of], 1)

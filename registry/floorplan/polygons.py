"""Polygons on the map: their area, whether a point lies in one, whether one crosses itself; metres."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

Point = tuple[float, float]
Outline = tuple[Point, ...]


def sides_of(outline: Outline) -> Iterator[tuple[Point, Point]]:
    """Give the sides of a polygon in order, the one that closes it last."""
    return zip(outline, (*outline[1:], outline[0]), strict=True)


def area_m2(outline: Outline) -> float:
    """Return the area of a polygon by the shoelace formula."""
    return abs(sum(x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in sides_of(outline))) / 2


def is_in(point: Point, outline: Outline) -> bool:
    """Tell whether a point lies in a polygon: a ray from it to the right crosses the sides an odd number of times."""
    x, y = point
    crossed = (
        (x1 + (y - y1) * (x2 - x1) / (y2 - y1)) for (x1, y1), (x2, y2) in sides_of(outline) if (y1 > y) != (y2 > y)
    )
    return sum(x < at for at in crossed) % 2 == 1


def crosses_itself(outline: Outline) -> bool:
    """Tell whether two sides that are no neighbours meet, or two neighbours lie on each other."""
    sides = list(sides_of(outline))
    last = len(sides) - 1
    for (i, first), (j, second) in combinations(enumerate(sides), 2):
        if j == i + 1 or (i == 0 and j == last):
            if _folds_back(first, second) if j == i + 1 else _folds_back(second, first):
                return True
        elif _meet(first, second):
            return True
    return False


def _folds_back(first: tuple[Point, Point], second: tuple[Point, Point]) -> bool:
    """Tell whether a side that begins where another one ends goes back over it."""
    (a, b), (_, c) = first, second
    ahead, back = (b[0] - a[0], b[1] - a[1]), (c[0] - b[0], c[1] - b[1])
    turned = ahead[0] * back[1] - ahead[1] * back[0]
    return abs(turned) < 1e-12 and ahead[0] * back[0] + ahead[1] * back[1] <= 0


def _meet(first: tuple[Point, Point], second: tuple[Point, Point]) -> bool:
    (a, b), (c, d) = first, second
    around = (_turn(a, b, c), _turn(a, b, d)), (_turn(c, d, a), _turn(c, d, b))
    if all(one * other < 0 for one, other in around):
        return True
    ends = ((a, b, c), (a, b, d), (c, d, a), (c, d, b))
    return any(_turn(*three) == 0 and _between(*three) for three in ends)


def _turn(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _between(a: Point, b: Point, c: Point) -> bool:
    return min(a[0], b[0]) <= c[0] <= max(a[0], b[0]) and min(a[1], b[1]) <= c[1] <= max(a[1], b[1])

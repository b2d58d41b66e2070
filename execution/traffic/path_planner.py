"""Paths over the lattice: cheapest with few turns, away from walls, and drawn as a polyline."""

from __future__ import annotations

import heapq
from collections.abc import Collection, Mapping
from itertools import pairwise
from math import hypot

from execution.traffic.layout import Layout, Node
from registry.floorplan.lattice import Point

TURN_COST = 0.8
NARROW_COST = 0.35
AGAINST_COST = 0.1
"""Every other row and column is cheaper in one direction: robots that meet keep apart by themselves."""
ELSEWHERE_COST = 0.5
"""Where a floor has preferred zones, a robot drives half as far again before it leaves them."""


def find_route(
    layout: Layout,
    start: int,
    goal: int,
    closed: Collection[int] = (),
    extra: Mapping[int, float] | None = None,
) -> tuple[int, ...] | None:
    """Return the cheapest path from cell to cell, both included; None if there is none without the closed cells.

    `extra` adds a cost to single cells. A* over (cell, heading) with the Manhattan distance as its bound.
    """
    columns, against, preferred = layout.lattice.columns, layout.against, layout.preferred
    goal_row, goal_column = divmod(goal, columns)
    best: dict[tuple[int, int], float] = {(start, 0): 0.0}
    came: dict[tuple[int, int], tuple[int, int]] = {}
    queue: list[tuple[float, float, int, int]] = [(0.0, 0.0, start, 0)]
    while queue:
        _, cost, cell, heading = heapq.heappop(queue)
        if cell == goal:
            return _unwind(came, (cell, heading))
        if cost > best[cell, heading]:
            continue
        for neighbour in layout.lattice.links.get(cell, ()):
            if neighbour in closed or (against and (cell, neighbour) in against):
                continue
            turn = neighbour - cell
            total = cost + _cost(layout, cell, neighbour, heading) + (extra.get(neighbour, 0.0) if extra else 0.0)
            total += ELSEWHERE_COST if preferred and neighbour not in preferred else 0.0
            if total < best.get((neighbour, turn), float("inf")) - 1e-9:
                best[neighbour, turn] = total
                came[neighbour, turn] = (cell, heading)
                row, column = divmod(neighbour, columns)
                bound = abs(row - goal_row) + abs(column - goal_column)
                heapq.heappush(queue, (total + bound, total, neighbour, turn))
    return None


def _cost(layout: Layout, cell: int, neighbour: int, heading: int) -> float:
    turn = neighbour - cell
    cost = 1.0 + (TURN_COST if heading and turn != heading else 0.0)
    if neighbour not in layout.lattice.roomy:
        cost += NARROW_COST
    row, column = divmod(neighbour, layout.lattice.columns)
    forwards = turn > 0
    even = (row if abs(turn) == 1 else column) % 2 == 0
    return cost + (AGAINST_COST if forwards is not even else 0.0)


def _unwind(came: Mapping[tuple[int, int], tuple[int, int]], last: tuple[int, int]) -> tuple[int, ...]:
    path = [last[0]]
    while last in came:
        last = came[last]
        path.append(last[0])
    return tuple(reversed(path))


def plan_path(
    layout: Layout,
    start: Node,
    goal: Node,
    closed: Collection[int] = (),
    extra: Mapping[int, float] | None = None,
) -> tuple[Node, ...] | None:
    """Return the path from node to node, both included, or None; where it starts may be closed."""
    if start == goal:
        return (start,)
    cells = find_route(layout, layout.cell(start), layout.cell(goal), closed, extra)
    if cells is None:
        return None
    path: tuple[Node, ...] = cells if isinstance(start, int) else (start, *cells)
    return path if isinstance(goal, int) else (*path, goal)


def drawn(layout: Layout, path: tuple[Node, ...]) -> tuple[Point, ...]:
    """Return a path as a tidy line: only its corners, its ends at right angles to the spots that it joins."""
    points = [layout.point(node) for node in path]
    if len(path) > 2 and isinstance(path[0], str) and isinstance(path[1], int):
        points = _square_off(points)
    if len(path) > 2 and isinstance(path[-1], str) and isinstance(path[-2], int):
        points = _square_off(points[::-1])[::-1]
    return _corners(points)


def _square_off(points: list[Point]) -> list[Point]:
    """Shift the first straight stretch sideways, so that it begins at the first point."""
    (x, y), (x1, y1), (x2, _) = points[0], points[1], points[2]
    upright = abs(x2 - x1) < 1e-6
    end = 1
    while end + 1 < len(points) and abs(points[end + 1][0] - x1 if upright else points[end + 1][1] - y1) < 1e-6:
        end += 1
    if end == len(points) - 1:
        return points
    shifted = [(x, p[1]) if upright else (p[0], y) for p in points[1 : end + 1]]
    return [points[0], *shifted, *points[end + 1 :]]


def _corners(points: list[Point]) -> tuple[Point, ...]:
    kept: list[Point] = []
    for point in points:
        point = (round(point[0], 3), round(point[1], 3))
        if kept and kept[-1] == point:
            continue
        while len(kept) > 1 and _is_straight(kept[-2], kept[-1], point):
            kept.pop()
        kept.append(point)
    return tuple(kept)


def _is_straight(a: Point, b: Point, c: Point) -> bool:
    cross = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
    return abs(cross) < 1e-6


def length_m(points: tuple[Point, ...]) -> float:
    """Return the length of a line in metres."""
    return sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points))

"""Lanes over the whole of a zone: side by side, there and back, in pieces where walls and machines divide it.

The zone is cut into strips of one width along its longer side. In the middle of each strip a robot drives a lane as
far as it fits; corners and narrow places that no lane comes near get single points. Lanes side by side with nothing
between them make a block, which is driven there and back; blocks follow each other by their distance.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import atan2, ceil, cos, hypot, inf, sin
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from registry.floorplan.lattice import REACH_M, STANDING_MARGIN_M, Ground, Lattice, Point, Raster, attach

MOST_LANES = 1000
MOST_LENGTH_M = 10_000.0
STEP_M = 0.4
"""At most so far apart are the points that a robot takes of a lane; its body keeps all cells between two of them."""
NEAR = 0.75
"""A place that is farther from all lanes than this share of a lane's width gets a point of its own."""
MILLIMETRE = 1e-3
"""By as much at most is a point moved when it is rounded."""
Floats = NDArray[np.float64]
Outline = tuple[Point, ...]


class CannotCover(Exception):
    """A zone cannot be covered; `code` is outside, nothing or too_many, the message a sentence for a person."""

    def __init__(self, code: str, why: str) -> None:
        super().__init__(why)
        self.code = code


class Lane(NamedTuple):
    """A straight piece in metres, with so many `stops` at equal distances on it, its ends among them."""

    x1: float
    y1: float
    x2: float
    y2: float
    stops: int

    def points(self) -> Iterator[Point]:
        """Yield the points, in the order in which they are driven over."""
        for index in range(self.stops):
            yield self.point(index)

    def point(self, index: int) -> Point:
        """Return one of the points, to the millimetre."""
        share = index / (self.stops - 1) if self.stops > 1 else 0.0
        return (round(self.x1 + share * (self.x2 - self.x1), 3), round(self.y1 + share * (self.y2 - self.y1), 3))

    def part(self, begin: int, end: int) -> tuple[Lane, ...]:
        """Return the lane over the points from `begin` up to before `end`; none where there are none."""
        if begin >= end:
            return ()
        return (Lane(*self.point(begin), *self.point(end - 1), end - begin),)


@dataclass(frozen=True, slots=True)
class _Strips:
    """The strips of a zone: `along` is the unit vector of their direction, `first_m` across it the first's middle."""

    along: Point
    first_m: float
    width_m: float
    count: int
    reach_m: tuple[float, float]
    """From where to where the zone goes along them."""

    def point(self, along_m: float, strip: int) -> Point:
        """Return a point in the middle of a strip."""
        (ux, uy), across_m = self.along, self.first_m + strip * self.width_m
        return (along_m * ux - across_m * uy, along_m * uy + across_m * ux)


@dataclass(frozen=True, slots=True)
class _Piece:
    strip: int
    begin_m: float
    end_m: float


def plan_lanes(
    ground: Ground, lattice: Lattice, outline: Outline, lane_m: float, shut: Collection[int] = frozenset()
) -> tuple[tuple[Lane, ...], ...]:
    """Return the blocks of lanes over a zone, at most `lane_m` apart, each with its lanes in order.

    `outline` are its corners in metres; no robot goes where it would stand in a cell that is `shut`. Each place of the
    zone where a robot can stand is within the width of a lane of some lane.

    Raises:
        CannotCover: the zone is off the map, has no place where a robot can stand, or would have too many lanes.
    """
    corners = np.array(_on_map(ground.grid, outline))
    if len(corners) < 3:
        raise CannotCover("outside", "The zone is off the map; draw it on the map.")
    strips = _strips(corners, lane_m)
    reachable = _Reachable(ground, lattice, shut)
    pieces = [piece for strip in range(strips.count) for piece in _pieces(strips, corners, strip, reachable)]
    blocks = [[_lane(strips, each) for each in block] for block in _blocks(strips, pieces, ground)]
    blocks.extend([Lane(*point, *point, 1)] for point in _missed(corners, strips.width_m, blocks, reachable))
    if not blocks:
        raise CannotCover("nothing", "No robot can stand anywhere in the zone; draw it where there is free floor.")
    if sum(map(len, blocks)) > MOST_LANES:
        raise _too_many(sum(map(len, blocks)))
    return tuple(map(tuple, blocks))


def _on_map(grid: Raster, outline: Outline) -> list[Point]:
    """Return the corners of what of a zone lies on the map, cut off at each of its four sides in turn."""
    right, top = grid.origin_x_m + grid.width * grid.resolution_m, grid.origin_y_m + grid.height * grid.resolution_m
    corners = [(float(x), float(y)) for x, y in outline]
    for axis, at, sign in ((0, grid.origin_x_m, 1), (0, right, -1), (1, grid.origin_y_m, 1), (1, top, -1)):
        cut: list[Point] = []
        for here, there in zip(corners, (*corners[1:], *corners[:1]), strict=True):
            inside, next_inside = sign * (here[axis] - at) > 0, sign * (there[axis] - at) > 0
            if inside:
                cut.append(here)
            if inside != next_inside:
                share = (at - here[axis]) / (there[axis] - here[axis])
                cut.append((here[0] + share * (there[0] - here[0]), here[1] + share * (there[1] - here[1])))
        corners = cut
    return corners


def _too_many(count: float) -> CannotCover:
    return CannotCover("too_many", f"The zone would have {count:.0f} lanes, and {MOST_LANES} are the most; "
                       "make the lanes wider or the zone smaller.")  # fmt: skip


def _strips(corners: Floats, lane_m: float) -> _Strips:
    """Cut a zone along that side of it across which it is narrowest."""
    best: tuple[float, float, float, Point, tuple[float, float]] | None = None
    for (x1, y1), (x2, y2) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        length_m = hypot(x2 - x1, y2 - y1)
        if length_m < 1e-6:
            continue
        angle = round(atan2(y2 - y1, x2 - x1), 9)
        ux, uy = cos(angle), sin(angle)
        across = corners[:, 1] * ux - corners[:, 0] * uy
        along = corners[:, 0] * ux + corners[:, 1] * uy
        reach = (float(along.min()), float(along.max()))
        found = (round(float(across.max() - across.min()), 6), -length_m, float(across.min()), (ux, uy), reach)
        best = found if best is None or found[:2] < best[:2] else best
    if best is None:
        raise CannotCover("nothing", "The zone encloses no area; draw it anew.")
    width_m, _, low_m, direction, reach = best
    count = max(1, ceil(width_m / max(lane_m, 1e-6) - 1e-9))
    if count > MOST_LANES or count * (reach[1] - reach[0]) > MOST_LENGTH_M:
        raise _too_many(count) if count > MOST_LANES else CannotCover(
            "too_many", f"The lanes over the zone would be {count * (reach[1] - reach[0]) / 1000:.0f} km long, and "
            f"{MOST_LENGTH_M / 1000:.0f} km are the most; make the lanes wider or the zone smaller.")  # fmt: skip
    strip_m = width_m / count
    return _Strips(direction, low_m + strip_m / 2, strip_m, count, reach)


class _Reachable:
    """Where on the floor robots can stand and come to from the lattice."""

    def __init__(self, ground: Ground, lattice: Lattice, shut: Collection[int]) -> None:
        self.ground, self.lattice, self.shut = ground, lattice, shut
        labels, _ = scipy.ndimage.label(ground.clearance_m >= ground.radius_m + STANDING_MARGIN_M)
        cells = [ground.grid.cell_of(*lattice.centre(cell)) for cell in lattice.links]
        parts = {int(labels[cell]) for cell in cells if cell is not None} - {0}
        self.floor = np.isin(labels, list(parts))

    def on_floor(self, points: Floats) -> NDArray[np.bool_]:
        """Tell of many points at once whether they lie on the floor over which robots drive."""
        return _at(self.ground.grid, self.floor, points)

    def has(self, point: Point) -> bool:
        """Tell whether a robot can stand at a point, and come there from the lattice."""
        cell = attach(self.ground, self.lattice, point)
        return cell is not None and cell not in self.shut

    def near_open(self, points: Floats) -> Floats:
        """Return the points without those that are too far from every open cell to be come to."""
        if not len(points):
            return points
        (left, bottom), (right, top) = points.min(axis=0) - REACH_M, points.max(axis=0) + REACH_M
        cells = self.lattice.cells_in_box(float(left), float(bottom), float(right), float(top))
        middles = [self.lattice.centre(cell) for cell in cells if cell not in self.shut]
        if not middles:
            return points[:0]
        found: Floats = points[scipy.spatial.cKDTree(middles).query(points)[0] <= REACH_M + MILLIMETRE]
        return found


def _at(grid: Raster, yes: NDArray[np.bool_], points: Floats) -> NDArray[np.bool_]:
    """Return what stands in the cells of a map at many points; False off it."""
    columns = np.floor((points[:, 0] - grid.origin_x_m) / grid.resolution_m).astype(int)
    rows = np.floor((points[:, 1] - grid.origin_y_m) / grid.resolution_m).astype(int)
    inside = (columns >= 0) & (rows >= 0) & (columns < grid.width) & (rows < grid.height)
    found = np.zeros(len(points), dtype=bool)
    found[inside] = yes[rows[inside], columns[inside]]
    return found


def _crossings(corners: Floats, strips: _Strips, strip: int) -> list[tuple[float, float]]:
    """Return from where to where, along a strip, its middle lies in the zone (even-odd rule)."""
    ux, uy = strips.along
    across_m = strips.first_m + strip * strips.width_m
    along, across = corners[:, 0] * ux + corners[:, 1] * uy, corners[:, 1] * ux - corners[:, 0] * uy
    cuts: list[float] = []
    for i, j in zip(range(len(corners)), (*range(1, len(corners)), 0), strict=True):
        if (across[i] > across_m) != (across[j] > across_m):
            share = (across_m - across[i]) / (across[j] - across[i])
            cuts.append(float(along[i] + share * (along[j] - along[i])))
    cuts.sort()
    return list(zip(cuts[::2], cuts[1::2], strict=True))


def _pieces(strips: _Strips, corners: Floats, strip: int, reachable: _Reachable) -> Iterator[_Piece]:
    """Yield the pieces of a strip's middle over which a robot can drive; it stays half a lane within the edge."""
    pitch_m = min(0.05, reachable.ground.grid.resolution_m)
    for begin_m, end_m in _crossings(corners, strips, strip):
        inset_m = min(strips.width_m / 2, (end_m - begin_m) / 2)
        count = max(1, ceil((end_m - begin_m - 2 * inset_m) / pitch_m) + 1)
        along = np.linspace(begin_m + inset_m, end_m - inset_m, count)
        points = np.array([strips.point(each, strip) for each in along])
        free = np.flatnonzero(np.diff(np.concatenate(([False], reachable.on_floor(points), [False])).astype(np.int8)))
        for first, last in zip(free[::2], free[1::2], strict=True):
            yield from _joined(strips, strip, float(along[first]), float(along[last - 1]), reachable)


def _joined(strips: _Strips, strip: int, begin_m: float, end_m: float, reachable: _Reachable) -> Iterator[_Piece]:
    """Yield the parts of a free piece all of whose points can be come to."""
    count = _count(end_m - begin_m)
    stops = np.linspace(begin_m, end_m, count)
    good = [reachable.has(_rounded(strips.point(float(each), strip))) for each in stops]
    edges = np.flatnonzero(np.diff(np.concatenate(([False], good, [False])).astype(np.int8)))
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        yield from _passable(strips, _Piece(strip, float(stops[first]), float(stops[last - 1])), reachable)


def _passable(strips: _Strips, piece: _Piece, reachable: _Reachable) -> Iterator[_Piece]:
    """Yield a piece, or its parts where a robot that drives from point to point of it would touch a corner."""
    ground, points = reachable.ground, list(_lane(strips, piece).points())
    ways = enumerate(pairwise(points))
    stuck = next((index for index, way in ways if not ground.is_passable(*way, ground.radius_m)), None)
    if stuck is None:
        yield piece
        return
    stops = np.linspace(piece.begin_m, piece.end_m, len(points))
    yield from _joined(strips, piece.strip, piece.begin_m, float(stops[stuck]), reachable)
    yield from _joined(strips, piece.strip, float(stops[stuck + 1]), piece.end_m, reachable)


def _count(length_m: float) -> int:
    return 1 if length_m < 1e-3 else 1 + ceil(length_m / STEP_M - 1e-6)


def _rounded(point: Point) -> Point:
    return (round(point[0], 3), round(point[1], 3))


def _lane(strips: _Strips, piece: _Piece) -> Lane:
    begin, end = strips.point(piece.begin_m, piece.strip), strips.point(piece.end_m, piece.strip)
    return Lane(*_rounded(begin), *_rounded(end), _count(piece.end_m - piece.begin_m))


def _blocks(strips: _Strips, pieces: Sequence[_Piece], ground: Ground) -> list[list[_Piece]]:
    """Put pieces into one block that lie side by side, each beside one other only, with nothing between them."""
    by_strip: dict[int, list[_Piece]] = {}
    for piece in pieces:
        by_strip.setdefault(piece.strip, []).append(piece)
    blocks: list[list[_Piece]] = []
    open_blocks: dict[_Piece, list[_Piece]] = {}
    for strip in sorted(by_strip):
        before, here = by_strip.get(strip - 1, []), by_strip[strip]
        beside = {piece: [other for other in before if _are_beside(strips, other, piece, ground)] for piece in here}
        following: dict[_Piece, list[_Piece]] = {}
        for piece, others in beside.items():
            alone = len(others) == 1 and sum(others[0] in each for each in beside.values()) == 1
            block = open_blocks[others[0]] if alone else []
            if not alone:
                blocks.append(block)
            block.append(piece)
            following[piece] = block
        open_blocks = following
    return blocks


def _are_beside(strips: _Strips, one: _Piece, other: _Piece, ground: Ground) -> bool:
    begin_m, end_m = max(one.begin_m, other.begin_m), min(one.end_m, other.end_m)
    if begin_m > end_m:
        return False
    middle_m = (begin_m + end_m) / 2
    room_m = ground.radius_m + STANDING_MARGIN_M
    return ground.is_passable(strips.point(middle_m, one.strip), strips.point(middle_m, other.strip), room_m)


def _missed(corners: Floats, lane_m: float, blocks: Sequence[Sequence[Lane]], reachable: _Reachable) -> Iterator[Point]:
    """Yield points at places of the zone that no lane comes near."""
    pitch_m = min(0.2, max(lane_m / 3, reachable.ground.grid.resolution_m))
    left = np.concatenate((samples(corners, pitch_m), _around(corners, pitch_m)))
    left = left[reachable.on_floor(left)]
    driven = dense([lane for block in blocks for lane in block])
    if len(driven) and len(left):
        left = left[scipy.spatial.cKDTree(driven).query(left)[0] > NEAR * lane_m]
    left = reachable.near_open(left)
    is_left = np.ones(len(left), dtype=bool)
    for index, (x, y) in enumerate(left):
        if is_left[index] and reachable.has(point := _rounded((float(x), float(y)))):
            yield point
            is_left &= np.hypot(left[:, 0] - point[0], left[:, 1] - point[1]) > NEAR * lane_m


def _around(corners: Floats, pitch_m: float) -> Floats:
    """Return points along the edge of a zone: a needle may have none of the points all over it."""
    sides = zip(corners, np.roll(corners, -1, axis=0), strict=True)
    return dense([Lane(float(x1), float(y1), float(x2), float(y2), 2) for (x1, y1), (x2, y2) in sides], pitch_m)


def dense(lanes: Sequence[Lane], pitch_m: float = 0.05) -> Floats:
    """Return points all along some lanes, in metres, one in a row."""
    if not lanes:
        return np.zeros((0, 2))
    parts = []
    for lane in lanes:
        count = 1 + ceil(hypot(lane.x2 - lane.x1, lane.y2 - lane.y1) / pitch_m)
        parts.append(np.column_stack((np.linspace(lane.x1, lane.x2, count), np.linspace(lane.y1, lane.y2, count))))
    return np.concatenate(parts)


def samples(corners: Floats, pitch_m: float) -> Floats:
    """Return points all over a zone, in metres, one in a row; at most some hundred thousand."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    pitch_m = max(pitch_m, float(np.sqrt((high[0] - low[0]) * (high[1] - low[1]) / 200_000)))
    x, y = (np.arange(low[i] + pitch_m / 2, high[i] + pitch_m / 2, pitch_m) for i in (0, 1))
    points = np.column_stack([part.ravel() for part in np.meshgrid(x, y)])
    inside = np.zeros(len(points), dtype=bool)
    for (x1, y1), (x2, y2) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        crosses = (y1 > points[:, 1]) != (y2 > points[:, 1])
        if y1 != y2:
            inside ^= crosses & (points[:, 0] < x1 + (points[:, 1] - y1) * (x2 - x1) / (y2 - y1))
    found: Floats = points[inside]
    return found


def in_order(blocks: Sequence[Sequence[Lane]], start: Point) -> tuple[Lane, ...]:
    """Return the lanes as a robot drives them from `start`: the nearest block next, each there and back."""
    left, here, found = [(block, _entries(block)) for block in blocks], start, list[Lane]()
    while left:
        far_m, index, entry = inf, 0, 0
        for i, (_, entries) in enumerate(left):
            for j, (x, y) in enumerate(entries):
                if (x - here[0]) ** 2 + (y - here[1]) ** 2 < far_m:
                    far_m, index, entry = (x - here[0]) ** 2 + (y - here[1]) ** 2, i, j
        block = left.pop(index)[0]
        lanes = block if entry < 2 else block[::-1]
        found.extend(_turned(lane) if number % 2 != entry % 2 else lane for number, lane in enumerate(lanes))
        here = (found[-1].x2, found[-1].y2)
    return tuple(found)


def _entries(block: Sequence[Lane]) -> tuple[Point, Point, Point, Point]:
    """Return where one can begin with a block: at either end of its first lane, then of its last."""
    first, last = block[0], block[-1]
    return (first.x1, first.y1), (first.x2, first.y2), (last.x1, last.y1), (last.x2, last.y2)


def _turned(lane: Lane) -> Lane:
    return Lane(lane.x2, lane.y2, lane.x1, lane.y1, lane.stops)


def covered_share(ground: Ground, outline: Outline, lane_m: float, lanes: Sequence[Lane]) -> float:
    """Return which share of a zone's floor lies within half a lane of these lanes, from 0 to 1.

    The floor is all that is neither wall nor machine, whether a robot fits there or not.
    """
    points = samples(np.array(outline), max(0.05, ground.grid.resolution_m))
    floor = points[_at(ground.grid, ground.clearance_m > 0, points)]
    driven = dense(lanes)
    if not len(floor) or not len(driven):
        return 0.0
    near_m = lane_m / 2 + 0.03
    return float(np.mean(scipy.spatial.cKDTree(driven).query(floor, distance_upper_bound=near_m)[0] <= near_m))

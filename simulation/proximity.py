"""How near is a robot to walls, machines and other robots: pure geometry, the same for both drivers."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import ceil, cos, floor, hypot, sin

from registry.floorplan.plan import Box
from vipo_device.protocol.description import Description

REACH_M = 1.0
WALL = "wall"


@dataclass(frozen=True, slots=True)
class Body:
    """A box that stands on the floor: middle, half sides, heading; `name` is a device's id or `wall`."""

    name: str
    x: float
    y: float
    half_x: float
    half_y: float
    cos_theta: float = 1.0
    sin_theta: float = 0.0

    def nearest_point(self, x: float, y: float) -> tuple[float, float]:
        """Return the point of the box that is nearest to (x, y)."""
        dx, dy = x - self.x, y - self.y
        along = dx * self.cos_theta + dy * self.sin_theta
        across = dy * self.cos_theta - dx * self.sin_theta
        along = min(max(along, -self.half_x), self.half_x)
        across = min(max(across, -self.half_y), self.half_y)
        return (
            self.x + along * self.cos_theta - across * self.sin_theta,
            self.y + along * self.sin_theta + across * self.cos_theta,
        )

    def distance_m(self, x: float, y: float) -> float:
        """Return the distance from (x, y) to the box, 0 inside."""
        nearest_x, nearest_y = self.nearest_point(x, y)
        return hypot(x - nearest_x, y - nearest_y)

    def half_span(self) -> tuple[float, float]:
        """Return the half sides of the upright box around this one."""
        c, s = abs(self.cos_theta), abs(self.sin_theta)
        return self.half_x * c + self.half_y * s, self.half_x * s + self.half_y * c


@dataclass(frozen=True, slots=True)
class Near:
    """Something beside a robot: the gap between the surfaces (negative: overlap) and where it is."""

    other: str
    gap_m: float
    x: float
    y: float


def wall_bodies(boxes: Iterable[Box]) -> list[Body]:
    """Turn wall rectangles (x1, y1, x2, y2) into bodies."""
    return [Body(WALL, (x1 + x2) / 2, (y1 + y2) / 2, (x2 - x1) / 2, (y2 - y1) / 2) for x1, y1, x2, y2 in boxes]


def machine_bodies(devices: Iterable[Description]) -> list[Body]:
    """Return the boxes that the machines fill; a machine without a size fills nothing."""
    return [body_of(d) for d in devices if d.kind == "machine" and d.size.x > 0 and d.size.y > 0]


def body_of(device: Description) -> Body:
    """Return the box that a device fills."""
    pose, size = device.pose, device.size
    return Body(device.id, pose.x, pose.y, size.x / 2, size.y / 2, cos(pose.theta), sin(pose.theta))


class Obstacles:
    """Bodies that never move, found by place, for robots of at most that radius."""

    def __init__(self, bodies: Sequence[Body], most_radius_m: float) -> None:
        self._cells: dict[tuple[int, int], list[Body]] = defaultdict(list)
        reach_m = REACH_M + most_radius_m
        for body in bodies:
            span_x, span_y = body.half_span()
            for column in _cells_between(body.x - span_x - reach_m, body.x + span_x + reach_m):
                for row in _cells_between(body.y - span_y - reach_m, body.y + span_y + reach_m):
                    self._cells[column, row].append(body)

    def near(self, x: float, y: float, radius_m: float) -> list[Near]:
        """Return what is within `REACH_M` of the surface of a robot of that radius standing there, with the gap."""
        found = []
        for body in self._cells.get((floor(x), floor(y)), ()):
            nearest_x, nearest_y = body.nearest_point(x, y)
            distance = hypot(x - nearest_x, y - nearest_y)
            if distance - radius_m < REACH_M:
                found.append(Near(body.name, distance - radius_m, nearest_x, nearest_y))
        return found


def _cells_between(low: float, high: float) -> range:
    return range(floor(low), ceil(high))


class Crowd:
    """Robots by place, for finding the ones beside another."""

    def __init__(self, radii_m: Mapping[str, float]) -> None:
        self._radii_m = radii_m
        self._cell_m = REACH_M + 2 * max(radii_m.values(), default=0.0)
        self._places: dict[str, tuple[float, float]] = {}
        self._cells: dict[tuple[int, int], dict[str, None]] = defaultdict(dict)

    def put(self, robot: str, x: float, y: float) -> None:
        """Say where a robot is now."""
        old = self._places.get(robot)
        self._places[robot] = (x, y)
        cell = self._cell(x, y)
        if old is not None and self._cell(*old) != cell:
            self._cells[self._cell(*old)].pop(robot, None)
        self._cells[cell][robot] = None

    def near(self, robot: str) -> Iterator[Near]:
        """Yield the robots whose surface is within `REACH_M` of this one's."""
        x, y = self._places[robot]
        column, row = self._cell(x, y)
        for i in (column - 1, column, column + 1):
            for j in (row - 1, row, row + 1):
                for other in self._cells.get((i, j), ()):
                    if other != robot and (found := self._beside(robot, other)).gap_m < REACH_M:
                        yield found

    def _beside(self, robot: str, other: str) -> Near:
        x, y = self._places[robot]
        other_x, other_y = self._places[other]
        gap = hypot(x - other_x, y - other_y) - self._radii_m[robot] - self._radii_m[other]
        return Near(other, gap, other_x, other_y)

    def _cell(self, x: float, y: float) -> tuple[int, int]:
        return floor(x / self._cell_m), floor(y / self._cell_m)

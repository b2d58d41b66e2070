"""Where new steps stand on the map: near the devices they speak of, off those devices and off other steps."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from editor.language.nodes import Point
from editor.language.outline import mapping
from editor.language.surroundings import Surroundings
from editor.language.values import read_point

CHIP_WIDTH_M, CHIP_HEIGHT_M = 2.6, 0.8
"""The room that a step's chip takes on the map."""
_TRIES = 400
_OFF_WALLS_M = 0.1


@dataclass(slots=True)
class Layout:
    """The places that are taken; each new step gets the nearest free one."""

    surroundings: Surroundings
    taken: list[Point] = field(default_factory=list)
    cells: dict[tuple[int, int], list[Point]] = field(default_factory=dict)
    """The taken places by cells of a chip's size."""
    tried: dict[Point, int] = field(default_factory=dict)
    """How many places around a wanted one are known to be taken."""
    last: Point = (1.0, -1.0)

    def occupy(self, point: Point | None) -> None:
        """Keep a place for a step that stands there already."""
        if point is not None:
            self.taken.append(point)
            self.cells.setdefault(_cell(point), []).append(point)

    def follow(self, point: Point | None) -> None:
        """Put the next step that has no place of its own below this one."""
        if point is not None:
            self.last = point

    def start(self) -> list[float]:
        """Return a place for the start."""
        first = self.taken[0] if self.taken else self.last
        return [round(first[0], 2), round(first[1] + 2 * CHIP_HEIGHT_M, 2)]

    def put(self, kind: str, params: Mapping[str, object]) -> list[float]:
        """Return a free place for a step."""
        point = self._free_near(self._wanted(kind, params))
        self.occupy(point)
        self.last = point
        return list(point)

    def _wanted(self, kind: str, params: Mapping[str, object]) -> Point:
        named = [self._where(params.get(name)) for name in ("source", "target", "at", "device", "to")]
        known = [point for point in named if point is not None]
        if kind == "operate" and known:
            height = self._height(mapping(params.get("device")).get("device"))
            return known[0][0], known[0][1] + height / 2 + CHIP_HEIGHT_M / 2
        if known:
            return sum(x for x, _ in known) / len(known), sum(y for _, y in known) / len(known)
        return self.last[0], self.last[1] - 1.5 * CHIP_HEIGHT_M

    def _where(self, place: object) -> Point | None:
        named = mapping(place)
        device = self.surroundings.devices.get(str(named.get("device")))
        if device is not None:
            return device.description.pose.x, device.description.pose.y
        known = self.surroundings.places.get(str(named.get("place")))
        return read_point(named.get("point")) if known is None else (known.x, known.y)

    def _height(self, device: object) -> float:
        facts = self.surroundings.devices.get(str(device))
        return 1.0 if facts is None else facts.description.size.y

    def _free_near(self, wanted: Point) -> Point:
        """Look around the wanted place in growing rings, above and below first."""
        for index in range(self.tried.get(wanted, 0), _TRIES):
            ring, side = divmod(index, 4)
            dx = (0.0, 0.0, 1.0, -1.0)[side] * ring * CHIP_WIDTH_M / 2
            dy = (-1.0, 1.0, 0.0, 0.0)[side] * ring * CHIP_HEIGHT_M / 2
            point = (round(wanted[0] + dx, 2), round(wanted[1] + dy, 2))
            if self._is_free(point):
                self.tried[wanted] = index
                return point
        self.tried[wanted] = _TRIES
        return round(wanted[0], 2), round(wanted[1], 2)

    def _is_free(self, point: Point) -> bool:
        x, y = point
        column, row = _cell(point)
        near = (self.cells.get((column + i, row + j), ()) for i in (-1, 0, 1) for j in (-1, 0, 1))
        if any(abs(x - a) < CHIP_WIDTH_M and abs(y - b) < CHIP_HEIGHT_M for points in near for a, b in points):
            return False
        for facts in self.surroundings.devices.values():
            device = facts.description
            reach_x, reach_y = device.size.x / 2 + CHIP_WIDTH_M / 2, device.size.y / 2 + CHIP_HEIGHT_M / 2 - 0.1
            if device.kind == "machine" and abs(x - device.pose.x) < reach_x and abs(y - device.pose.y) < reach_y:
                return False
        floor = self.surroundings.floor
        return floor is None or (floor.is_inside(x, y) and floor.is_free(x, y, _OFF_WALLS_M))


def _cell(point: Point) -> tuple[int, int]:
    return math.floor(point[0] / CHIP_WIDTH_M), math.floor(point[1] / CHIP_HEIGHT_M)

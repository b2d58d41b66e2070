"""A floor as the building map of Open-RMF (`.building.yaml`), as its traffic editor reads and writes it.

The coordinate system is `cartesian_meters`: vertices are metres in the map frame, y up, so that the navigation graph
that RMF makes of it is in the frame of the robots' map. A parameter's value stands behind its type: 1 text, 2 whole
number, 3 number, 4 true or false. RMF draws every wall 10 cm thick.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

import yaml

from execution.floor.exports.road_map import Road, RoadMap, Stop
from execution.traffic.layout import Layout
from registry.floorplan.plan import Box, Grid

LEVEL = "L1"
THIN_M = 0.4
"""A wall up to so thick is drawn by its middle line, what is thicker by its outline."""
MOST_WALLS = 4000
"""Of speckled maps the longest are taken."""
_TEXT, _WHOLE, _NUMBER, _YES_NO = 1, 2, 3, 4
_Line = tuple[tuple[float, float], tuple[float, float]]


def write_building(name: str, grid: Grid, walls: Iterable[Box], layout: Layout, roads: RoadMap) -> bytes:
    """Return the building map of a site with one level: its floor, walls, places and lanes."""
    vertices = [_vertex(stop, layout, own) for stop, own in zip(roads.stops, _names(layout, roads), strict=True)]
    index = {stop.id: number for number, stop in enumerate(roads.stops)}
    mutexes = _mutexes(roads)
    lanes = [_lane(road, index, mutexes, layout) for road in roads.roads]
    corners = _add(vertices, _corners(grid))
    lines = [line for box in walls for line in _lines(box)]
    longest = sorted(lines, key=_length, reverse=True)[:MOST_WALLS]
    building = {
        "name": name,
        "coordinate_system": "cartesian_meters",
        "reference_level_name": LEVEL,
        "graphs": {0: {"name": name}},
        "levels": {
            LEVEL: {
                "elevation": 0.0,
                "x_meters": round(grid.width * grid.resolution_m, 4),
                "y_meters": round(grid.height * grid.resolution_m, 4),
                "doors": [],
                "fiducials": [],
                "floors": [{"parameters": {}, "vertices": corners}],
                "lanes": lanes,
                "layers": {},
                "measurements": [],
                "models": [],
                "walls": [[*_add(vertices, line), {}] for line in longest],
                "vertices": vertices,
            }
        },
        "lifts": {},
    }
    return (_comment(layout, roads) + yaml.safe_dump(building, sort_keys=False, allow_unicode=True)).encode()


def _comment(layout: Layout, roads: RoadMap) -> str:
    names = ", ".join(" ".join(layout.name(each).split()) for each in roads.left_out)
    return f"# Robots cannot come to: {names}.\n" if names else ""


def _names(layout: Layout, roads: RoadMap) -> list[str]:
    """Return what each stop is called; RMF finds waypoints by their names, so that two of one name have their ids."""
    names = ["" if stop.kind == "way" else layout.name(stop.id) for stop in roads.stops]
    count = Counter(names)
    return [
        f"{name} ({stop.id})" if name and count[name] > 1 else name
        for name, stop in zip(names, roads.stops, strict=True)
    ]


def _vertex(stop: Stop, layout: Layout, name: str) -> list[Any]:
    is_dock = stop.kind == "place" and stop.id in layout.docks
    yes = [_YES_NO, True]
    return [stop.x, stop.y, 0.0, name, {"is_charger": yes, "is_parking_spot": [*yes]} if is_dock else {}]


def _lane(road: Road, index: dict[str, int], mutexes: dict[str, str], layout: Layout) -> list[Any]:
    mutex = mutexes[road.alone[0]] if road.alone else ""
    parameters = {
        "bidirectional": [_YES_NO, not road.one_way],
        "graph_idx": [_WHOLE, 0],
        "mutex": [_TEXT, mutex],
        "orientation": [_TEXT, ""],
        "speed_limit": [_NUMBER, road.speed_m_s or 0.0],
    }
    return [index[road.start], index[road.end], parameters]


def _mutexes(roads: RoadMap) -> dict[str, str]:
    """Return the group of each zone for one robot at a time; zones that share a road are one, as a lane has but one."""
    group: dict[str, str] = {}
    for road in roads.roads:
        together = {group.get(key, key) for key in road.alone}
        group.update((key, min(together)) for key in road.alone)
        group.update((key, min(together)) for key, known in group.items() if known in together)
    return group


def _corners(grid: Grid) -> Sequence[tuple[float, float]]:
    left, bottom = grid.origin_x_m, grid.origin_y_m
    right, top = left + grid.width * grid.resolution_m, bottom + grid.height * grid.resolution_m
    return ((left, bottom), (right, bottom), (right, top), (left, top))


def _lines(box: Box) -> list[_Line]:
    left, bottom, right, top = box
    wide, high = right - left, top - bottom
    if min(wide, high) > THIN_M:
        corners = ((left, bottom), (right, bottom), (right, top), (left, top))
        return list(zip(corners, (*corners[1:], corners[0]), strict=True))
    x, y = (left + right) / 2, (bottom + top) / 2
    return [((left, y), (right, y))] if wide >= high else [((x, bottom), (x, top))]


def _length(line: _Line) -> float:
    (x1, y1), (x2, y2) = line
    return abs(x2 - x1) + abs(y2 - y1)


def _add(vertices: list[list[Any]], points: Iterable[tuple[float, float]]) -> list[int]:
    """Add vertices without a name; return their numbers."""
    first = len(vertices)
    vertices.extend([round(x, 4), round(y, 4), 0.0, "", {}] for x, y in points)
    return list(range(first, len(vertices)))

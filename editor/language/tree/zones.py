"""Zones of a document: named polygons on the map, in metres; nonsense is left out."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot
from typing import Literal

from editor.language.document.outline import mapping
from editor.language.expressions.nodes import Point, Zone
from editor.language.expressions.values import is_number, read_point

Rule = Literal["keep_out", "one_at_a_time", "slow", "door"]
RULES: Mapping[str, Rule] = {
    "keep_out": "keep_out",
    "one_at_a_time": "one_at_a_time",
    "slow": "slow",
    "door": "door",
}
"""What a zone asks of robots, by its name in documents."""
FEWEST_CORNERS = 3
SMALLEST_AREA_M2 = 1e-4
MOST_CORNERS = 200


def read_zones(document: object) -> tuple[Zone, ...]:
    """Return the zones of a document that can be drawn, by id."""
    zones = mapping(mapping(document).get("zones"))
    read = (read_zone(str(name), mapping(zones[name])) for name in sorted(zones, key=str))
    return tuple(zone for zone in read if zone is not None)


def zone_names(document: object) -> dict[str, str]:
    """Return what people call the zones, by id, whatever their shape."""
    zones = mapping(mapping(document).get("zones"))
    named = {str(key): mapping(item).get("name") for key, item in zones.items()}
    return {key: name if isinstance(name, str) and name else key for key, name in named.items()}


def read_zone(name: str, item: Mapping[str, object]) -> Zone | None:
    """Return a zone by its id from what is said of it; None if that is no zone that can be drawn."""
    rule, given, speed = RULES.get(str(item.get("rule"))), item.get("points"), item.get("speed_m_s")
    listed = [read_point(point) for point in given] if isinstance(given, list | tuple) else []
    points = tuple(point for point in listed if point is not None)
    is_polygon = FEWEST_CORNERS <= len(points) <= MOST_CORNERS and area_m2(points) >= SMALLEST_AREA_M2
    if not name or rule is None or not is_polygon:
        return None
    called, door = item.get("name"), item.get("door")
    return Zone(
        name,
        called if isinstance(called, str) and called else name,
        rule,
        points,
        float(speed) if is_number(speed) and speed > 0 else None,
        door if rule == "door" and isinstance(door, str) else "",
    )


def rule_text(rule: str) -> str:
    """Return how a script writes a rule: `one at a time`."""
    return rule.replace("_", " ")


def area_m2(points: tuple[Point, ...]) -> float:
    """Return the area of a polygon by the shoelace formula."""
    around = zip(points, (*points[1:], points[0]), strict=True)
    return abs(sum(x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in around)) / 2


def width_m(points: tuple[Point, ...]) -> float:
    """Return how wide a polygon is across that side along which it is narrowest, in metres."""
    widths = []
    for (x1, y1), (x2, y2) in zip(points, (*points[1:], points[0]), strict=True):
        length_m = hypot(x2 - x1, y2 - y1)
        if length_m > 0:
            across = [((x - x1) * (y2 - y1) - (y - y1) * (x2 - x1)) / length_m for x, y in points]
            widths.append(max(across) - min(across))
    return min(widths, default=0.0)


def is_in(point: Point, points: tuple[Point, ...]) -> bool:
    """Tell whether a point lies in a polygon: a ray from it to the right crosses the sides an odd number of times."""
    x, y = point
    crossings = 0
    for (x1, y1), (x2, y2) in zip(points, (*points[1:], points[0]), strict=True):
        if (y1 > y) != (y2 > y) and x < x1 + (y - y1) * (x2 - x1) / (y2 - y1):
            crossings += 1
    return crossings % 2 == 1

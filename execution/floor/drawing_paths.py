"""Paths for drawing: what a robot would drive between two places, outside the zones of the floor to keep out of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from execution.floor.layouts import get_layout
from execution.machine.floor_task import Target
from execution.traffic.layout import Layout, NoSuchSpot
from execution.traffic.path_planner import drawn, length_m
from execution.traffic.zones import path_round, waiting_cells
from execution.views import RouteView

SPEED_M_S = 0.5


def plan_routes(*, site: str, pairs: Sequence[tuple[Any, Any]]) -> tuple[RouteView | None, ...]:
    """Return for each (from, to) the path as a drawn line, or None where there is none.

    An end is a Place of docs/shapes/document.md (`{"device": id}`, `{"place": id}`, `{"point": [x, y]}`) or `[x, y]`.
    """
    layout = get_layout(site)
    speed = min((d.speed_m_s for d in layout.devices.values() if d.speed_m_s > 0), default=SPEED_M_S)
    return tuple(_route(layout, start, end, speed) for start, end in pairs)


def _route(layout: Layout, start: Any, end: Any, speed_m_s: float) -> RouteView | None:
    try:
        ends = (_node(layout, start), _node(layout, end))
        nodes = path_round(layout, layout.zones, ends, waiting_cells(layout, layout.zones, ends[0]))
    except NoSuchSpot:
        return None
    if nodes is None:
        return None
    path = drawn(layout, nodes)
    length = length_m(path)
    return RouteView(path, round(length, 2), round(length / speed_m_s))


def _node(layout: Layout, place: Any) -> str:
    return layout.spot_for(_target(place)).id


def _target(place: Any) -> Target:
    """Read an end of a route; nonsense has no spot."""
    if isinstance(place, Mapping):
        if isinstance(name := place.get("device", place.get("place")), str):
            return Target(name)
        place = place.get("point")
    if isinstance(place, Sequence) and len(place) == 2 and all(_is_number(n) for n in place):
        return Target(point=(float(place[0]), float(place[1])))
    raise NoSuchSpot("That is not a place: give a device, a place or a point [x, y].")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e6

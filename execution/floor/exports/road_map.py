"""The roads of a floor: where robots stop, and the ways that the planner finds between these, as a graph.

Nodes are the places and the machines' stations that robots can come to, and the bends and crossings between them.
Roads are straight and lead both ways, but for those in one-way zones. They are made of planned routes: from each place
to its nearest neighbours, and as many more as it takes that every place which robots can reach from another one is
joined to it.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import hypot
from typing import NamedTuple

from execution.traffic.layout import Layout, Node
from execution.traffic.messages import FloorZone
from execution.traffic.zones import is_in, is_shut_spot, path_outside, shut_cells

_Ends = tuple[str, str]


class _Edge(NamedTuple):
    """A straight edge from one node to another: the zones on it, and whether it leads against one that is one-way."""

    zones: frozenset[FloorZone]
    is_shut: bool


_Links = dict[Node, dict[Node, _Edge]]
"""What each node is joined to, and the edge there."""
NEAREST = 3
"""So many neighbours of a place are joined to it directly."""


@dataclass(frozen=True, slots=True)
class Stop:
    """A place (`place`), a machine's station (`machine`), or a bend or crossing of roads (`way`); metres, radians."""

    id: str
    kind: str
    x: float
    y: float
    theta: float | None = None


@dataclass(frozen=True, slots=True)
class Road:
    """A straight road between two stops, by their ids, that robots drive both ways unless it is `one_way`.

    `speed_m_s` is the limit of slow zones (None: none), `alone` the keys of the zones for one robot at a time.
    """

    start: str
    end: str
    speed_m_s: float | None
    alone: tuple[str, ...]
    one_way: bool = False


@dataclass(frozen=True, slots=True)
class RoadMap:
    """The roads of a floor; `left_out` are the ids of places and machines that robots cannot come to."""

    stops: tuple[Stop, ...]
    roads: tuple[Road, ...]
    left_out: tuple[str, ...]


def make_road_map(layout: Layout) -> RoadMap:
    """Return the roads of a floor, the same for the same layout."""
    links: _Links = {}
    for spots in _parts(layout):
        links.update((spot, {}) for spot in spots)
        pairs = _pairs(layout, spots)
        back = [(b, a) for a, b in pairs] if layout.against else []
        for ends in (*pairs, *back):
            for a, b in pairwise(path_outside(layout, layout.zones, ends) or ()):
                zones = _zones_at(layout, a) | _zones_at(layout, b)
                _join(links, a, b, _Edge(zones, layout.is_against(a, b)), _Edge(zones, layout.is_against(b, a)))
    for node in [node for node in links if isinstance(node, int)]:
        _straighten(layout, links, node)
    nodes = sorted(links, key=_order)
    pairs_of_nodes = ((a, b) for a in nodes for b in sorted(links[a], key=_order) if _order(a) < _order(b))
    roads = [road for a, b in pairs_of_nodes if (road := _road(links, a, b))]
    machines = {device.id for device in layout.devices.values() if device.kind == "machine"}
    wanted = machines | (set(layout.names) - set(layout.devices))
    return RoadMap(tuple(_stop(layout, node) for node in nodes), tuple(roads), tuple(sorted(wanted - set(links))))


def _parts(layout: Layout) -> list[list[str]]:
    """Return the spots that robots can come to, those together that one can drive between; zones part a floor."""
    shut = shut_cells(layout, layout.zones)
    spots = sorted(
        spot
        for spot in {*layout.stations, *layout.places}
        if layout.cell(spot) not in shut and not is_shut_spot(layout, layout.zones, spot)
    )
    parts: list[list[str]] = []
    while spots:
        reached = layout.lattice.distances(layout.cell(spots[0]), shut)
        parts.append([spot for spot in spots if layout.cell(spot) in reached])
        spots = [spot for spot in spots if layout.cell(spot) not in reached]
    return parts


def _pairs(layout: Layout, spots: list[str]) -> list[_Ends]:
    """Return which spots are joined by a route: each with its nearest, and the least that makes one of all."""
    at = {spot: layout.point(spot) for spot in spots}

    def far(a: str, b: str) -> tuple[float, str]:
        return round(hypot(at[a][0] - at[b][0], at[a][1] - at[b][1]), 3), b

    pairs = {_sorted(a, b) for a in spots for b in sorted(spots, key=lambda b: far(a, b))[1 : NEAREST + 1]}
    nearest = {spot: (*far(spots[0], spot)[:1], spots[0]) for spot in spots[1:]}
    while nearest:
        spot = min(nearest, key=lambda each: (nearest[each], each))
        pairs.add(_sorted(spot, nearest.pop(spot)[1]))
        nearest = {other: min(known, (far(other, spot)[0], spot)) for other, known in nearest.items()}
    return sorted(pairs)


def _sorted(a: str, b: str) -> _Ends:
    return (a, b) if a < b else (b, a)


def _zones_at(layout: Layout, node: Node) -> frozenset[FloorZone]:
    return frozenset(
        zone for zone in layout.zones if zone.rule in ("slow", "one_at_a_time") and is_in(layout, node, zone)
    )


def _join(links: _Links, a: Node, b: Node, there: _Edge, back: _Edge) -> None:
    links.setdefault(a, {})[b] = there
    links.setdefault(b, {})[a] = back


def _straighten(layout: Layout, links: _Links, node: Node) -> None:
    """Make one road of two that lead straight on through a node, if the same holds on both."""
    if len(links[node]) != 2:
        return
    a, b = links[node]
    there, back = links[a][node], links[b][node]
    (ax, ay), (x, y), (bx, by) = layout.point(a), layout.point(node), layout.point(b)
    is_straight = abs((x - ax) * (by - y) - (y - ay) * (bx - x)) < 1e-6 and b not in links[a]
    if there == links[node][b] and back == links[node][a] and is_straight:
        del links[a][node], links[b][node], links[node]
        _join(links, a, b, there, back)


def _order(node: Node) -> tuple[bool, str, int]:
    return (True, "", node) if isinstance(node, int) else (False, node, 0)


def _stop(layout: Layout, node: Node) -> Stop:
    x, y = (round(value, 3) for value in layout.point(node))
    if isinstance(node, int):
        return Stop(_id(node), "way", x, y)
    return Stop(node, "machine" if node in layout.stations else "place", x, y, layout.spot(node).theta)


def _id(node: Node) -> str:
    return f"way-{node}" if isinstance(node, int) else node


def _road(links: _Links, a: Node, b: Node) -> Road | None:
    """Return the road between two nodes, in its direction if it has one; None where zones shut it both ways."""
    (zones, there), (_, back) = links[a][b], links[b][a]
    if there and back:
        return None
    start, end = (b, a) if there else (a, b)
    speeds = [zone.speed_m_s for zone in zones if zone.rule == "slow" and zone.speed_m_s]
    alone = sorted(zone.key for zone in zones if zone.rule == "one_at_a_time" and zone.robots == 1)
    return Road(_id(start), _id(end), min(speeds, default=None), tuple(alone), there or back)

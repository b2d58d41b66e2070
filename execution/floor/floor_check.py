"""What a site's floor offers robots of a width: what they cannot come to and why, and where one is in another's way.

Pure. Whether robots come somewhere is what the planner of traffic says; why they do not is read off the map.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product
from math import hypot
from typing import Literal, get_args

from editor.language.site.surroundings import PlaceFacts
from execution.traffic.layout import Layout, Spot
from execution.traffic.messages import FloorZone
from execution.traffic.zones import is_in, is_shut_spot, shut_cells
from registry.floorplan.bottlenecks import Bottleneck, bottleneck_at, find_bottlenecks, width_through
from registry.floorplan.lattice import MARGIN_M, PASSING_MARGIN_M, STANDING_MARGIN_M, Point
from registry.floorplan.plan import Grid, device_footprints, points_beside
from registry.floorplan.polygons import is_in as lies_in
from vipo_device.protocol.description import Description

FindingCode = Literal[
    "no_room", "too_narrow", "no_way", "off_lattice", "keep_out", "cut_off", "no_way_in", "no_way_out", "together",
    "in_the_way",
]  # fmt: skip
_ORDER: tuple[FindingCode, ...] = get_args(FindingCode)
"""What is found is told in this order, the same together."""
AT_WALL_M = 0.15
"""What is that near to a machine's outline belongs to it, not to a wall: an outline is rounded up to whole cells."""
MOST_STARTS = 20
"""From so many spots at most it is looked for the largest part of the floor whose spots lead to each other."""


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that keeps robots from `target`, a place or machine, or may: `other` is a place or zone.

    Metres: `at` is where it is, `width_m` what there is and `needs_m` what a robot needs, `sides` the two ends of that
    width and `beside` the machines there, None for a wall.
    """

    code: FindingCode
    target: str
    at: Point
    other: str | None = None
    width_m: float | None = None
    needs_m: float | None = None
    sides: tuple[Point, ...] = ()
    beside: tuple[str | None, ...] = ()


@dataclass(frozen=True, slots=True)
class ZoneWidth:
    """How wide the way through a zone for so many robots is at its narrowest, and what two robots beside each other
    need; metres.
    """

    zone: str
    width_m: float
    needs_m: float


@dataclass(frozen=True, slots=True)
class FloorCheck:
    """What was found on a floor for robots of a radius in metres. `machines` and `places` say how many can be come to,
    and of how many.
    """

    radius_m: float
    machines: tuple[int, int]
    places: tuple[int, int]
    findings: tuple[Finding, ...]
    zones: tuple[ZoneWidth, ...]


def check_floor(grid: Grid, layout: Layout, places: Iterable[PlaceFacts], *, with_widths: bool = True) -> FloorCheck:
    """Check a floor as it is laid out for its widest robot. The places are those of the layout; rooms do not count.

    Without `with_widths` nothing is said of how wide zones are.
    """
    stops = {place.id: place for place in places if place.kind != "room"}
    machines = {device.id: device for device in layout.devices.values() if device.kind == "machine"}
    spots = {**layout.stations, **{name: spot for name, spot in layout.places.items() if name in stops}}
    parts = _Parts(layout, spots)
    findings = [
        *_without_spot(grid, layout, parts, {n: p for n, p in stops.items() if n not in spots}, machines),
        *_in_zones(layout, parts, spots),
        *_one_in_another_s_way(layout, parts, spots, stops),
    ]
    kept_out = {found.target for found in findings if found.code not in ("together", "in_the_way")}
    return FloorCheck(
        layout.ground.radius_m,
        (len(set(machines) - kept_out), len(machines)),
        (len(set(stops) - kept_out), len(stops)),
        tuple(sorted(findings, key=lambda found: _ORDER.index(found.code))),
        tuple(_widths(grid, layout)) if with_widths else (),
    )


class _Parts:
    """The floor that robots drive about on, and what zones cut off from it."""

    def __init__(self, layout: Layout, spots: Mapping[str, Spot]) -> None:
        self.layout, self.shut = layout, shut_cells(layout, layout.zones)
        self.main: Collection[int] = ()
        left = {spot.cell for spot in spots.values()} - self.shut
        most = -1
        while left:
            part = layout.lattice.distances(min(left), self.shut)
            inside = len(left & part.keys())
            if inside > most:
                self.main, most = part.keys(), inside
            left -= part.keys()

    def rest(self) -> Point | None:
        """Return a point from which robots drive about; None where none can drive at all."""
        cells = self.main or self.layout.lattice.links
        return self.layout.lattice.centre(min(cells)) if cells else None


def _without_spot(
    grid: Grid, layout: Layout, parts: _Parts, stops: Mapping[str, PlaceFacts], machines: Mapping[str, Description]
) -> Iterator[Finding]:
    """Tell why robots can stand at none of the sides of a machine, or not at a place."""
    missing = {name: (place.x, place.y) for name, place in stops.items()}
    for name, machine in machines.items():
        if name not in layout.stations:
            sides = points_beside(machine, layout.ground.radius_m)
            missing[name] = max(sides, key=layout.ground.room_m)
    names = sorted(missing)
    rest, needs_m = parts.rest(), 2 * (layout.ground.radius_m + PASSING_MARGIN_M)
    narrow = (
        find_bottlenecks(layout.ground, [missing[n] for n in names], rest, needs_m) if rest else [None] * len(names)
    )
    for name, found in zip(names, narrow, strict=True):
        yield _why_no_spot(grid, layout, name, missing[name], found, needs_m)


def _why_no_spot(
    grid: Grid, layout: Layout, name: str, at: Point, narrow: Bottleneck | None, needs_m: float
) -> Finding:
    standing_m = round(2 * (layout.ground.radius_m + STANDING_MARGIN_M), 3)
    cell = grid.cell_of(*at)
    if cell is not None and layout.ground.room_m(at) < standing_m / 2:
        here = bottleneck_at(layout.ground, cell)
        return _at_bottleneck(layout, Finding("no_room", name, at, needs_m=standing_m), here)
    if narrow is None:
        return Finding("off_lattice", name, at)
    if narrow.width_m == 0.0:
        return Finding("no_way", name, at)
    return _at_bottleneck(layout, Finding("too_narrow", name, at, needs_m=round(needs_m, 3)), narrow)


def _at_bottleneck(layout: Layout, finding: Finding, narrow: Bottleneck) -> Finding:
    beside = tuple(_machine_at(layout, side) for side in narrow.sides)
    at = finding.at if finding.code == "no_room" else (narrow.x, narrow.y)
    return replace(finding, at=at, width_m=narrow.width_m, sides=narrow.sides, beside=beside)


def _machine_at(layout: Layout, point: Point) -> str | None:
    """Return the machine to which a point belongs that is not free; None for a wall."""
    steps = sorted(product((-AT_WALL_M, 0.0, AT_WALL_M), repeat=2), key=lambda step: hypot(*step))
    near = (device for device in layout.devices.values() if _is_near(device, point))
    outlines = device_footprints(near)
    around = ((point[0] + dx, point[1] + dy) for dx, dy in steps)
    return next((name for at in around for name, outline in outlines.items() if lies_in(at, outline)), None)


def _is_near(device: Description, point: Point) -> bool:
    reach_m = hypot(device.size.x, device.size.y) / 2 + 2 * AT_WALL_M
    return hypot(device.pose.x - point[0], device.pose.y - point[1]) <= reach_m


def _in_zones(layout: Layout, parts: _Parts, spots: Mapping[str, Spot]) -> Iterator[Finding]:
    """Tell which spots zones keep robots out of, cut off, or let them come to but not away from, and otherwise."""
    keep_outs = [zone for zone in layout.zones if zone.rule == "keep_out"]
    home = next((spot.cell for _, spot in sorted(spots.items()) if spot.cell in parts.main), None)
    there = back = None
    if home is not None and layout.against:
        there, back = _there_and_back(layout, parts, spots)
    cut_off = []
    for name, spot in sorted(spots.items()):
        at = (spot.x, spot.y)
        if zone := _zone_around(layout, keep_outs, name):
            yield Finding("keep_out", name, at, zone.key)
        elif spot.cell not in parts.main:
            cut_off.append(spot)
        elif there is not None and spot.cell not in there:
            yield Finding("no_way_in", name, at)
        elif back is not None and spot.cell not in back:
            yield Finding("no_way_out", name, at)
    if cut_off and home is not None:
        yield from _cut_off(layout, keep_outs, home, cut_off)


def _there_and_back(
    layout: Layout, parts: _Parts, spots: Mapping[str, Spot]
) -> tuple[Collection[int], Collection[int]]:
    """Return the cells that robots come to, and those that they come from, in spite of one-way zones: seen from the
    most spots that all lead to each other, of as many from those with the first name.

    So what is told of is a dead end, not all the others, whatever it is called.
    """
    left = {name: spot.cell for name, spot in sorted(spots.items()) if spot.cell in parts.main}
    best: tuple[Collection[int], Collection[int]] = ((), ())
    most = 0
    for _ in range(MOST_STARTS):
        if len(left) <= most:
            break
        start = next(iter(left.values()))
        there = layout.lattice.distances(start, parts.shut, layout.against).keys()
        back = layout.lattice.distances(start, parts.shut, layout.against_backwards).keys()
        both = there & back
        rest = {name: cell for name, cell in left.items() if cell not in both}
        if len(left) - len(rest) > most:
            best, most = (there, back), len(left) - len(rest)
        left = rest
    return best


def _zone_around(layout: Layout, zones: Sequence[FloorZone], spot: str) -> FloorZone | None:
    return next((zone for zone in zones if is_in(layout, spot, zone) or is_shut_spot(layout, [zone], spot)), None)


def _cut_off(layout: Layout, zones: Sequence[FloorZone], home: int, spots: Sequence[Spot]) -> Iterator[Finding]:
    """Tell of spots that are cut off which zone does it; none is named where it takes more than one."""
    left = {spot.id: spot for spot in spots}
    for zone in zones:
        others = shut_cells(layout, [each for each in zones if each is not zone])
        reached = layout.lattice.distances(home, others)
        for spot in [spot for spot in left.values() if spot.cell in reached]:
            del left[spot.id]
            yield Finding("cut_off", spot.id, (spot.x, spot.y), zone.key)
        if not left:
            return
    for spot in left.values():
        yield Finding("cut_off", spot.id, (spot.x, spot.y))


def _one_in_another_s_way(
    layout: Layout, parts: _Parts, spots: Mapping[str, Spot], stops: Mapping[str, PlaceFacts]
) -> Iterator[Finding]:
    """Tell of places where two robots cannot stand at once, and where one that stands keeps others from a spot."""
    standing = [name for name in sorted(stops) if name in spots and spots[name].cell in parts.main]
    reachable = {name: spot for name, spot in sorted(spots.items()) if spot.cell in parts.main}
    near = {frozenset(pair) for pair in combinations(standing, 2) if spots[pair[0]].body & spots[pair[1]].body}
    for one, other in sorted(sorted(pair) for pair in near):
        a, b = spots[one], spots[other]
        apart_m = round(hypot(a.x - b.x, a.y - b.y), 3)
        yield Finding("together", one, (a.x, a.y), other, apart_m, sides=((a.x, a.y), (b.x, b.y)))
    for name in standing:
        for kept in _kept_from(layout, parts, reachable, spots[name]):
            if frozenset((name, kept)) not in near:
                yield Finding("in_the_way", kept, (spots[name].x, spots[name].y), name)


def _kept_from(layout: Layout, parts: _Parts, spots: Mapping[str, Spot], taken: Spot) -> list[str]:
    """Return the spots that nobody comes to from most of the others while a robot stands at one."""
    closed = parts.shut | taken.body
    if _goes_round(layout, closed, taken):
        return []
    left = {spot.cell for spot in spots.values()} - closed
    most: set[int] = set()
    inside = 0
    while len(left) > inside:
        part = set(layout.lattice.distances(min(left), closed))
        if len(left & part) > inside:
            most, inside = part, len(left & part)
        left -= part
    return [name for name, spot in spots.items() if spot.id != taken.id and spot.cell not in most | taken.body]


def _goes_round(layout: Layout, closed: Collection[int], taken: Spot) -> bool:
    """Tell whether all cells beside a robot that stands somewhere are joined by others near it: it parts no floor."""
    lattice = layout.lattice
    beside = {near for cell in taken.body for near in lattice.links.get(cell, ())} - set(closed)
    reach_m = max(hypot(x - taken.x, y - taken.y) for x, y in map(lattice.centre, taken.body)) + 2 * lattice.gap_m
    far = set(lattice.cells_within((taken.x, taken.y), reach_m))
    left = [next(iter(beside))] if beside else []
    found = set(left)
    while left:
        ahead = [near for near in lattice.links[left.pop()] if near in far and near not in closed and near not in found]
        found.update(ahead)
        left += ahead
    return beside <= found


def _widths(grid: Grid, layout: Layout) -> Iterator[ZoneWidth]:
    """Return how wide the ways through the zones are that only so many robots may be in at once."""
    needs_m = round(layout.lattice.gap_m + 2 * (layout.ground.radius_m + MARGIN_M), 3)
    for zone in layout.zones:
        if zone.rule == "one_at_a_time" and (width_m := width_through(grid, layout.ground, zone.points)) is not None:
            yield ZoneWidth(zone.key.removeprefix("site/"), width_m, needs_m)

"""What zones mean for robots: where they may not drive, drive slowly, or only so many at once. Which way they drive
in zones stands in `directions`.

Those of the site's floor hold for every robot at any time, those of a program for the robots of its runs. A zone's
cells are those from which a way to a neighbour, as far as its middle, lies in the zone or nearer to it than a robot's
radius: whoever drives over other cells alone does not come near it, however narrow it is. The passage of a door, which
is as narrow as can be, has only those cells whose middle is that near: a robot before the door is not in it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import chain

from execution.machine.places import lies_in
from execution.traffic.floor_state import Robot
from execution.traffic.layout import Layout, Node
from execution.traffic.messages import FloorZone
from execution.traffic.outlines import touches, touches_way
from execution.traffic.path_planner import plan_path
from execution.traffic.turn import Turn
from registry.floorplan.lattice import Point

SLOWEST_M_S = 0.05
INSIDE_COST = 1000.0
"""What a cell costs of a zone that a robot stands in and may only leave."""


def cells_of(layout: Layout, zone: FloorZone) -> frozenset[int]:
    """Return the cells of a zone; worked out once for each layout."""
    key = (zone.points, zone.rule == "door")
    if key not in layout.zone_cells:
        layout.zone_cells[key] = frozenset(_find_cells(layout, zone))
    return layout.zone_cells[key]


def _find_cells(layout: Layout, zone: FloorZone) -> Iterator[int]:
    lattice, reach_m = layout.lattice, layout.ground.radius_m
    near_m = reach_m + lattice.gap_m / 2
    (left, right), (bottom, top) = ((min(axis), max(axis)) for axis in zip(*zone.points, strict=True))
    for cell in lattice.cells_in_box(left - near_m, bottom - near_m, right + near_m, top + near_m):
        x, y = lattice.centre(cell)
        ways = _half_ways(layout, cell) if zone.rule != "door" else (((x, y), (x, y)),)
        if any(touches_way(zone.points, *way, reach_m) for way in ways):
            yield cell


def _half_ways(layout: Layout, cell: int) -> Iterator[tuple[Point, Point]]:
    """Go through the ways from a cell half to each neighbour: over them lies every way that robots drive there."""
    here = layout.lattice.centre(cell)
    yield here, here
    for neighbour in layout.lattice.links[cell]:
        x, y = layout.lattice.centre(neighbour)
        yield here, ((here[0] + x) / 2, (here[1] + y) / 2)


def _zones(turn: Turn, robot: Robot, rule: str) -> Iterator[FloorZone]:
    of_run = turn.zones.get(robot.run, ()) if robot.run else ()
    bodies = (body for body in turn.layout.bodies if body.key != f"body/{robot.id}")
    return (zone for zone in chain(turn.layout.zones, bodies, of_run) if zone.rule == rule)


def is_in(layout: Layout, node: Node, zone: FloorZone) -> bool:
    """Tell whether a node lies in a zone; a cell whose middle does is among the zone's cells."""
    if layout.cell(node) in cells_of(layout, zone):
        return True
    return not isinstance(node, int) and lies_in(layout.point(node), zone.points)


def kept_out(turn: Turn, robot: Robot) -> frozenset[int]:
    """Return the cells that a robot may not drive over."""
    return shut_cells(turn.layout, _zones(turn, robot, "keep_out"))


def zones_with_admission(zones: Iterable[FloorZone], now: float) -> list[FloorZone]:
    """Return those of the zones that a person lets robots into one by one, and has not opened to all at this time."""
    return [zone for zone in zones if zone.rule == "release" and not zone.is_open(now)]


def closed_cells(turn: Turn, robot: Robot) -> frozenset[int]:
    """Return the cells of the zones that a robot is outside of and that nobody has let it into."""
    shut = zones_with_admission(turn.layout.zones, turn.now)
    zones = (zone for zone in shut if (zone.key, robot.id) not in turn.admissions)
    return waiting_cells(turn.layout, zones, turn.node(robot))


def waiting_cells(layout: Layout, zones: Iterable[FloorZone], start: Node) -> frozenset[int]:
    """Return the cells of those of the zones that people let robots into, opened or not, but for that of the start."""
    return frozenset(
        cell
        for zone in zones
        if zone.rule == "release" and not is_in(layout, start, zone)
        for cell in cells_of(layout, zone)
    )


def shut_cells(layout: Layout, zones: Iterable[FloorZone]) -> frozenset[int]:
    """Return the cells of those of the zones that robots keep out of."""
    return frozenset(chain.from_iterable(cells_of(layout, zone) for zone in zones if zone.rule == "keep_out"))


def is_shut_way(turn: Turn, robot: Robot, start: Point, end: Point) -> bool:
    """Tell whether a straight way leads a robot where it may not drive."""
    reach_m = turn.layout.ground.radius_m
    return any(touches_way(zone.points, start, end, reach_m) for zone in _zones(turn, robot, "keep_out"))


def is_shut_spot(layout: Layout, zones: Iterable[FloorZone], node: Node) -> bool:
    """Tell whether a node off the lattice is where robots keep out, or can only be come to over such floor."""
    if isinstance(node, int):
        return False
    middle, spot, reach_m = layout.lattice.centre(layout.cell(node)), layout.point(node), layout.ground.radius_m
    return any(zone.rule == "keep_out" and touches_way(zone.points, middle, spot, reach_m) for zone in zones)


def path_for(
    turn: Turn,
    robot: Robot,
    goal: Node,
    closed: Collection[int] = (),
    extra: Mapping[int, float] | None = None,
    start: Node | None = None,
) -> tuple[Node, ...] | None:
    """Return a robot's path that keeps out of all zones it must; one that stands in such a zone may leave it.

    It leads from where the robot is, or from `start`, and round the zones that people let robots into, where it can.
    """
    zones = tuple(_zones(turn, robot, "keep_out"))
    ends = (turn.node(robot) if start is None else start, goal)
    return path_round(turn.layout, zones, ends, closed_cells(turn, robot), closed, extra)


def path_round(
    layout: Layout,
    zones: Collection[FloorZone],
    ends: tuple[Node, Node],
    waits: frozenset[int],
    closed: Collection[int] = (),
    extra: Mapping[int, float] | None = None,
) -> tuple[Node, ...] | None:
    """Return a path as `path_outside` does, round the cells where a robot would have to wait, if one leads there."""
    if waits and waits.isdisjoint(map(layout.cell, ends)):
        found = path_outside(layout, zones, ends, {*closed, *waits}, extra)
        if found is not None:
            return found
    return path_outside(layout, zones, ends, closed, extra)


def path_outside(
    layout: Layout,
    zones: Collection[FloorZone],
    ends: tuple[Node, Node],
    closed: Collection[int] = (),
    extra: Mapping[int, float] | None = None,
) -> tuple[Node, ...] | None:
    """Return a path that keeps out of those of the zones that ask for it, but for leaving one where it begins."""
    start, goal = ends
    shut = shut_cells(layout, zones)
    if not shut or start == goal:
        return plan_path(layout, start, goal, closed, extra)
    if is_shut_spot(layout, zones, goal):
        return None
    if layout.cell(start) not in shut:
        return plan_path(layout, start, goal, {*closed, *shut}, extra)
    path = plan_path(layout, start, goal, closed, {**(extra or {}), **dict.fromkeys(shut, INSIDE_COST)})
    inside = [layout.cell(node) in shut for node in path or ()]
    return None if path is None or True in inside[inside.index(False) if False in inside else 0 :] else path


def enters_at(turn: Turn, robot: Robot) -> int | None:
    """Return where on its path a robot comes where it may not drive, or that way; None: it does not.

    One that is inside already is not asked to stay there: it plans anew, and so leaves by the shortest way.
    """
    layout, zones = turn.layout, tuple(_zones(turn, robot, "keep_out"))
    shut = shut_cells(layout, zones)
    for index, node in enumerate(robot.path[robot.passed + 1 :], robot.passed + 1):
        is_against = layout.is_against(robot.path[index - 1], node)
        if is_against or layout.cell(node) in shut or is_shut_spot(layout, zones, node):
            return index
    return None


def leads_through(layout: Layout, nodes: Iterable[Node], zones: Collection[FloorZone]) -> bool:
    """Tell whether a path leads through one of the zones."""
    return any(is_in(layout, node, zone) for node in nodes for zone in zones)


def speed_limit(turn: Turn, robot: Robot, nodes: tuple[Node, ...]) -> float | None:
    """Return how fast (m/s) a robot may drive over these nodes; None: as fast as it can."""
    limits = [
        zone.speed_m_s or SLOWEST_M_S
        for zone in _zones(turn, robot, "slow")
        if any(is_in(turn.layout, node, zone) for node in nodes)
    ]
    return max(SLOWEST_M_S, min(limits)) if limits else None


def _wanted(turn: Turn, robot: Robot, index: int) -> list[FloorZone]:
    """Return the zones for so many robots at once that the path leads through from there on without a break.

    They are taken all at once: two robots in neighbouring zones would else wait for each other for ever.
    """
    zones = list(_zones(turn, robot, "one_at_a_time"))
    wanted: dict[str, FloorZone] = {}
    for node in robot.path[index:] if zones else ():
        here = {zone.key: zone for zone in zones if is_in(turn.layout, node, zone)}
        if not here:
            break
        wanted |= here
    return list(wanted.values())


def _seats(zone: FloorZone) -> list[str]:
    """Return the keys under which robots hold a zone, one for each that may be in it at once."""
    return [zone.key, *(f"{zone.key}#{number}" for number in range(2, zone.robots + 1))]


def _holds(turn: Turn, robot: Robot, zone: FloorZone) -> bool:
    return any(turn.locks.get(seat) == robot.id for seat in _seats(zone))


def _take(turn: Turn, robot: Robot, zone: FloorZone) -> None:
    """Give a robot a free seat of a zone, unless it has one or there is none."""
    if _holds(turn, robot, zone):
        return
    free = next((seat for seat in _seats(zone) if seat not in turn.locks), None)
    if free is not None:
        turn.locks[free] = robot.id


def in_the_way(turn: Turn, robot: Robot, index: int) -> tuple[FloorZone, list[Robot]] | None:
    """Return the first zone that a robot may not enter at a node of its path, and who has its seats."""
    for zone in _wanted(turn, robot, index):
        if _holds(turn, robot, zone):
            continue
        seats = _seats(zone)
        holders = [turn.robots[holder] for seat in seats if (holder := turn.locks.get(seat)) in turn.robots]
        if len(holders) == len(seats):
            return zone, holders
    return None


def take_zones(turn: Turn, robot: Robot, index: int) -> None:
    """A robot goes to a node of its path: it has a seat in the zones there."""
    for zone in _wanted(turn, robot, index):
        _take(turn, robot, zone)


def keep_zones(turn: Turn) -> None:
    """Give back what a robot has left, and let who stands in a zone with room have a seat in it.

    Runs of two versions of a program may tell of a zone at two places: it is left by who is at neither.
    """
    known: dict[str, list[FloorZone]] = {seat: [] for seat in turn.locks}
    for zone in chain(turn.layout.zones, *turn.zones.values()) if known else ():
        for seat in known.keys() & _seats(zone) if zone.rule == "one_at_a_time" else ():
            if zone not in known[seat]:
                known[seat].append(zone)
    for seat, holder in list(turn.locks.items()):
        robot = turn.robots.get(holder)
        if robot is None or not any(_stays_in(turn, robot, zone) for zone in known[seat]):
            del turn.locks[seat]
    for robot in turn.robots.values():
        for zone in _zones(turn, robot, "one_at_a_time"):
            if robot.path and is_in(turn.layout, turn.node(robot), zone):
                _take(turn, robot, zone)


def _stays_in(turn: Turn, robot: Robot, zone: FloorZone) -> bool:
    """Tell whether a robot is in a zone, or has been let into it or into one before it."""
    ahead = range(robot.passed, min(robot.released + 1, len(robot.path)))
    if any(zone in _wanted(turn, robot, index) for index in ahead):
        return True
    here = touches(zone.points, (robot.x, robot.y), turn.layout.ground.radius_m)
    return here and bool(cells_of(turn.layout, zone) & set(robot.held))

"""What zones of a program mean for its robots: where they may not drive, drive slowly, or only one at a time.

A zone's cells are those whose middle lies in it or nearer to its edge than a robot's radius.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from itertools import chain
from math import hypot

from execution.machine.places import lies_in
from execution.traffic.floor_state import Robot
from execution.traffic.layout import Layout, Node
from execution.traffic.messages import FloorZone
from execution.traffic.routes import plan_path
from execution.traffic.turn import Turn
from registry.floorplan.lattice import Point

SLOWEST_M_S = 0.05
INSIDE_COST = 1000.0
"""What a cell costs of a zone that a robot stands in and may only leave."""


def cells_of(layout: Layout, zone: FloorZone) -> frozenset[int]:
    """Return the cells of a zone; worked out once for each layout."""
    if zone.points not in layout.zone_cells:
        lattice, reach_m = layout.lattice, layout.ground.radius_m
        cells = (c for c in lattice.links if touches(zone.points, lattice.centre(c), reach_m))
        layout.zone_cells[zone.points] = frozenset(cells)
    return layout.zone_cells[zone.points]


def touches(outline: tuple[Point, ...], point: Point, reach_m: float) -> bool:
    """Tell whether a point lies in an outline or nearer to its edge than `reach_m`."""
    edges = zip(outline, (*outline[1:], *outline[:1]), strict=True)
    return lies_in(point, outline) or any(_edge_distance_m(point, start, end) < reach_m for start, end in edges)


def _edge_distance_m(point: Point, start: Point, end: Point) -> float:
    dx, dy = end[0] - start[0], end[1] - start[1]
    span = dx * dx + dy * dy
    share = 0.0 if span == 0 else ((point[0] - start[0]) * dx + (point[1] - start[1]) * dy) / span
    share = min(1.0, max(0.0, share))
    return hypot(start[0] + share * dx - point[0], start[1] + share * dy - point[1])


def _zones(turn: Turn, robot: Robot, rule: str) -> Iterator[FloorZone]:
    return (zone for zone in turn.zones.get(robot.run, ()) if zone.rule == rule)


def is_in(layout: Layout, node: Node, zone: FloorZone) -> bool:
    """Tell whether a node lies in a zone."""
    return layout.cell(node) in cells_of(layout, zone) or lies_in(layout.point(node), zone.points)


def kept_out(turn: Turn, robot: Robot) -> frozenset[int]:
    """Return the cells that a robot may not drive over."""
    return frozenset(chain.from_iterable(cells_of(turn.layout, zone) for zone in _zones(turn, robot, "keep_out")))


def path_for(
    turn: Turn,
    robot: Robot,
    goal: Node,
    closed: Collection[int] = (),
    extra: Mapping[int, float] | None = None,
    start: Node | None = None,
) -> tuple[Node, ...] | None:
    """Return a robot's path that keeps out of the zones of its run; one that stands in such a zone may leave it.

    It leads from where the robot is, or from `start`.
    """
    layout = turn.layout
    start = turn.node(robot) if start is None else start
    shut = kept_out(turn, robot)
    if layout.cell(start) not in shut:
        return plan_path(layout, start, goal, {*closed, *shut} if shut else closed, extra)
    path = plan_path(layout, start, goal, closed, {**(extra or {}), **dict.fromkeys(shut, INSIDE_COST)})
    inside = [layout.cell(node) in shut for node in path or ()]
    return None if path is None or True in inside[inside.index(False) if False in inside else 0 :] else path


def speed_limit(turn: Turn, robot: Robot, nodes: tuple[Node, ...]) -> float | None:
    """Return how fast (m/s) a robot may drive over these nodes; None: as fast as it can."""
    limits = [
        zone.speed_m_s or SLOWEST_M_S
        for zone in _zones(turn, robot, "slow")
        if any(is_in(turn.layout, node, zone) for node in nodes)
    ]
    return max(SLOWEST_M_S, min(limits)) if limits else None


def _wanted(turn: Turn, robot: Robot, index: int) -> list[FloorZone]:
    """Return the zones for one robot at a time that the path leads through from there on without a break between them.

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


def in_the_way(turn: Turn, robot: Robot, index: int) -> tuple[FloorZone, Robot] | None:
    """Return the first zone that a robot may not enter at a node of its path, and who is in it."""
    for zone in _wanted(turn, robot, index):
        holder = turn.robots.get(turn.locks.get(zone.key, robot.id))
        if holder is not None and holder.id != robot.id:
            return zone, holder
    return None


def take_zones(turn: Turn, robot: Robot, index: int) -> None:
    """A robot goes to a node of its path: the zones there are its own."""
    for zone in _wanted(turn, robot, index):
        turn.locks[zone.key] = robot.id


def keep_zones(turn: Turn) -> None:
    """Give back what a robot has left, and let who stands in a free zone have it."""
    known = {zone.key: zone for zones in turn.zones.values() for zone in zones if zone.rule == "one_at_a_time"}
    for key, holder in list(turn.locks.items()):
        robot = turn.robots.get(holder)
        if key not in known or robot is None or not _stays_in(turn, robot, known[key]):
            del turn.locks[key]
    for robot in turn.robots.values():
        for zone in _zones(turn, robot, "one_at_a_time"):
            if robot.path and is_in(turn.layout, turn.node(robot), zone):
                turn.locks.setdefault(zone.key, robot.id)


def _stays_in(turn: Turn, robot: Robot, zone: FloorZone) -> bool:
    """Tell whether a robot is in a zone, or has been let into it or into one before it."""
    ahead = range(robot.passed, min(robot.released + 1, len(robot.path)))
    if any(zone in _wanted(turn, robot, index) for index in ahead):
        return True
    here = touches(zone.points, (robot.x, robot.y), turn.layout.ground.radius_m)
    return here and bool(cells_of(turn.layout, zone) & set(robot.held))

"""How a robot is let drive: where it is on its path, which cells it holds, which piece of path it gets next."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain, pairwise
from math import hypot

from execution.traffic.admissions import zone_before
from execution.traffic.doors import shut_door
from execution.traffic.floor_state import Robot, Sent
from execution.traffic.layout import Node
from execution.traffic.messages import FloorZone, PathPlanned
from execution.traffic.path_planner import drawn
from execution.traffic.route_points import pass_points
from execution.traffic.turn import Turn
from execution.traffic.zones import enters_at, in_the_way, leads_through, speed_limit, take_zones
from registry.floorplan.lattice import STANDING_MARGIN_M, Point, attach
from vipo_device.kit.arguments import ASTRAY_M

AHEAD = 4
"""Nodes that a robot may be released ahead of where it is."""
EXTEND_AT = 2
"""With so many nodes left it gets the next piece, so that it drives on without stopping."""
LAST_NODES = 5
"""The end of the path to a machine, entered only by the robot that the machine serves."""
LOST_M = 0.4
SITE = ""
"""Under this name, which no run has, the floor remembers which zones of the site its robots heed."""
FORESEEN = 12
"""Nodes behind what is released of which a robot is told, so that it may prepare for them."""


def place(turn: Turn, robot: Robot) -> Robot:
    """Put a robot that stands still onto the node it stands at, and let it hold that node's cells.

    Cells that somebody else holds already are left to them: two robots never hold one.
    """
    node = _nearest_node(turn, robot)
    others = {cell for other in turn.robots.values() if other.id != robot.id for cell in other.held}
    held = tuple(sorted(set(turn.layout.needed(node)) - others))
    return turn.put(robot, path=(node,), passed=0, released=0, held=held)


def _nearest_node(turn: Turn, robot: Robot) -> Node:
    layout, here = turn.layout, (robot.x, robot.y)
    spots = {**layout.places, **layout.stations}
    near = [(hypot(s.x - here[0], s.y - here[1]), s.id) for s in spots.values()]
    best = min(near, default=(9.0, ""))
    if best[0] < 0.2:
        return best[1]
    cells = [cell for cell in layout.lattice.cells_within(here, 3.0) if cell in layout.lattice.links]
    if cells and hypot(layout.point(cells[0])[0] - here[0], layout.point(cells[0])[1] - here[1]) < 0.12:
        return cells[0]
    if _can_stand(turn, here):
        return f"@{here[0]:.3f},{here[1]:.3f}"
    return (cells or [min(layout.lattice.links, default=0)])[0]


def why_stranded(turn: Turn, robot: Robot) -> str:
    """Return why a robot at rest cannot be sent anywhere, or an empty text.

    No way begins so near that it would drive there: robots refuse to drive straight on to one that is farther off,
    which may lead through walls. One that is at something may be moved by that: it is placed when it is done.
    """
    if turn.is_driving(robot) or turn.is_acting(robot):
        return ""
    begin, here = turn.layout.point(turn.node(robot)), (robot.x, robot.y)
    if hypot(begin[0] - here[0], begin[1] - here[1]) <= ASTRAY_M:
        return ""
    name, point = turn.name(robot.id), f"{begin[0]:.2f}, {begin[1]:.2f}"
    room_m = turn.layout.ground.radius_m + STANDING_MARGIN_M
    if turn.layout.ground.room_m(here) < room_m:
        return (
            f"{name} stands where it has no room to turn: it needs {room_m:.2f} m to all sides. "
            f"Drive it by hand to about ({point})."
        )
    return f"No way leads to where {name} stands. Drive it by hand to about ({point})."


def _can_stand(turn: Turn, point: Point) -> bool:
    return attach(turn.layout.ground, turn.layout.lattice, point) is not None


def take_pose(turn: Turn, robot: Robot, x: float, y: float, theta: float) -> None:
    """Take in where a robot is: pass nodes, give back cells behind it."""
    if not robot.path:
        place(turn, turn.put(robot, x=x, y=y, theta=theta))
        return
    robot = turn.put(robot, x=x, y=y, theta=theta)
    if turn.is_driving(robot):
        passed = _passed(turn, robot)
        if passed > robot.passed:
            robot = pass_points(turn, turn.put(robot, passed=passed, progress_at=turn.now))
        release_behind(turn, robot)
        return
    at = turn.layout.point(turn.node(robot))
    if hypot(at[0] - x, at[1] - y) > LOST_M and not turn.is_acting(robot):
        place(turn, turn.put(robot, evading=""))


def _passed(turn: Turn, robot: Robot) -> int:
    """Return the last node of the released path that lies behind the robot, by projection on the way."""
    points = [turn.layout.point(node) for node in robot.path[robot.passed : robot.released + 1]]
    best, index = 9.0, robot.passed
    for i, (a, b) in enumerate(pairwise(points)):
        span = hypot(b[0] - a[0], b[1] - a[1]) or 1e-9
        share = ((robot.x - a[0]) * (b[0] - a[0]) + (robot.y - a[1]) * (b[1] - a[1])) / span**2
        share = min(1.0, max(0.0, share))
        off = hypot(a[0] + share * (b[0] - a[0]) - robot.x, a[1] + share * (b[1] - a[1]) - robot.y)
        if off < best - 0.02:
            best, index = off, robot.passed + i + (1 if (1 - share) * span < 0.02 else 0)
    return index


def release_behind(turn: Turn, robot: Robot) -> None:
    """Give back the cells that the robot has left behind far enough."""
    layout = turn.layout
    kept = {cell for node in robot.path[robot.passed : robot.released + 1] for cell in layout.needed(node)}
    for cell in set(robot.held) - kept:
        x, y = layout.lattice.centre(cell)
        if hypot(x - robot.x, y - robot.y) < layout.clear_of_m:
            kept.add(cell)
    held = tuple(sorted(kept & set(robot.held)))
    if held != robot.held:
        turn.put(robot, held=held)


def end_piece(turn: Turn, robot: Robot, sent: Sent) -> None:
    """A piece of path is done: the robot has reached its end."""
    passed = max(robot.passed, min(sent.upto, robot.released))
    robot = pass_points(turn, turn.put(robot, passed=passed, progress_at=turn.now, refusals=0))
    release_behind(turn, robot)
    robot = turn.robots[robot.id]
    if not turn.is_driving(robot) and robot.passed == robot.released:
        x, y = turn.layout.point(turn.node(robot))
        robot = turn.put(robot, x=x, y=y) if hypot(robot.x - x, robot.y - y) > 0.1 else robot
        release_behind(turn, robot)
        if len(robot.path) == robot.passed + 1:
            turn.put(turn.robots[robot.id], path=robot.path[-1:], passed=0, released=0, evading="", idle_since=turn.now)


def set_path(turn: Turn, robot: Robot, path: tuple[Node, ...], evading: str = "") -> Robot:
    """Give a robot a new path from where it stands or will stop; only for one that has no piece under way."""
    turn.actions.append(PathPlanned(robot.id, robot.run if not evading else "", drawn(turn.layout, path)))
    robot = turn.put(robot, path=path, passed=0, released=0, evading=evading, blocked_since=None, progress_at=turn.now)
    return turn.put(robot, route_of="", route_at=())


def cut_path(turn: Turn, robot: Robot) -> Robot:
    """Let the robot go no farther than what is released to it."""
    if not turn.is_driving(robot):
        robot = turn.put(robot, path=(turn.node(robot),), passed=0, released=0, idle_since=turn.now)
    route_at = tuple(index for index in robot.route_at if index <= robot.released)
    path = robot.path[: robot.released + 1]
    return turn.put(robot, path=path, route_at=route_at, evading="", blocked_since=None)


def release_next(turn: Turn, robot: Robot) -> None:
    """Reserve the next cells of a robot's path, as many as are free, and send it there."""
    left = robot.released - robot.passed
    if left > EXTEND_AT or robot.released + 1 >= len(robot.path) or not _may_drive(turn, robot):
        return
    end = robot.released
    held = set(robot.held)
    holders = turn.holders(robot.id)
    while end + 1 < len(robot.path) and end + 1 - robot.passed <= AHEAD and may_enter(turn, robot, end + 1):
        needed = turn.layout.needed(robot.path[end + 1])
        if any(holders.get(cell, robot.id) != robot.id for cell in needed):
            break
        held |= needed
        end += 1
        take_zones(turn, robot, end)
    if end == robot.released:
        if not turn.is_driving(robot) and robot.blocked_since is None:
            turn.put(robot, blocked_since=turn.now)
        return
    if not turn.is_driving(robot):
        turn.put(robot, progress_at=turn.now)
    nodes = robot.path[robot.released + 1 : end + 1]
    robot = turn.put(turn.robots[robot.id], held=tuple(sorted(held)), released=end, blocked_since=None)
    _send_piece(turn, robot, nodes)


def _may_drive(turn: Turn, robot: Robot) -> bool:
    if turn.stopped or not robot.online or turn.is_acting(robot):
        return False
    return bool(robot.evading) or not (robot.yields_to or robot.run in turn.paused)


def may_enter(turn: Turn, robot: Robot, index: int) -> bool:
    """Tell whether the robot may go to that node as far as machines, zones and doors are concerned."""
    is_free = _machine_is_ready(turn, robot, index) and in_the_way(turn, robot, index) is None
    return is_free and zone_before(turn, robot, index) is None and shut_door(turn, robot, index) is None


def _machine_is_ready(turn: Turn, robot: Robot, index: int) -> bool:
    goal = robot.path[-1]
    if not isinstance(goal, str) or goal not in turn.layout.stations or index < len(robot.path) - LAST_NODES:
        return True
    return turn.stations.get(goal) == robot.id


def _send_piece(turn: Turn, robot: Robot, nodes: tuple[Node, ...]) -> None:
    points = [list(turn.layout.point(node)) for node in nodes]
    begin = turn.layout.point(robot.path[robot.released - len(nodes)])
    arguments: dict[str, object] = {
        "path": [[round(x, 4), round(y, 4)] for x, y in points],
        "from": [round(begin[0], 4), round(begin[1], 4)],
    }
    rest = robot.path[robot.released + 1 : robot.released + 1 + FORESEEN]
    if rest:
        arguments["ahead"] = [[round(x, 4), round(y, 4)] for x, y in map(turn.layout.point, rest)]
    last = nodes[-1]
    theta = turn.layout.spot(last).theta if isinstance(last, str) and robot.released == len(robot.path) - 1 else None
    if theta is not None:
        arguments["theta"] = round(theta, 4)
    limit_m_s = speed_limit(turn, robot, (turn.node(robot), *nodes))
    if limit_m_s is not None:
        arguments["speed"] = limit_m_s
    task = None if robot.evading else turn.task_of(robot)
    run, step = (task.run, task.order.step) if task else ("", "")
    turn.send(Sent("", robot.id, run, upto=robot.released), "move", arguments, step)


def drop_pieces(turn: Turn, robot: Robot, *, cancel: bool) -> None:
    """Forget the pieces of path that a robot has; with `cancel` it is told so."""
    for sent in turn.pieces(robot):
        if cancel:
            turn.tell(sent, "cancel")
        del turn.sent[sent.id]


def leave_gone(turn: Turn) -> None:
    """Reckon no more with what was taken out or moved: a robot that stands or drives there stays where it is.

    A robot that was taken out itself is nowhere once what it was told has ended: who takes it out says that its place
    is free.
    """
    for machine in [machine for machine in turn.stations if machine not in turn.layout.stations]:
        del turn.stations[machine]
    told = {sent.device for sent in turn.sent.values()}
    for robot in list(turn.robots.values()):
        if robot.id not in turn.layout.devices:
            turn.offline.setdefault(robot.id, turn.now)
            robot = turn.put(robot, online=False) if robot.online else robot
            if robot.id not in told:
                _forget_place(turn, robot)
                continue
        if not all(turn.layout.has_node(node) for node in robot.path) or _is_misled(turn, robot):
            _stand_here(turn, robot)


def _forget_place(turn: Turn, robot: Robot) -> None:
    """Give back all that a robot keeps from others: its cells and its machines; `keep_zones` then sees to its seats.

    Whoever is nowhere has given them back before: only a robot with a path keeps anything.
    """
    if not robot.path:
        return
    turn.put(robot, path=(), passed=0, released=0, held=(), evading="", yields_to="", blocked_since=None)
    turn.stations = {machine: holder for machine, holder in turn.stations.items() if holder != robot.id}


def _is_misled(turn: Turn, robot: Robot) -> bool:
    """Tell whether a place on the path is not where it was when the path was planned.

    What says so: a robot at rest is not there, the path does not come to it by its cell, or the run of a robot on its
    way has kept it where it was.
    """
    path, places = robot.path[robot.passed :], turn.layout.places
    if not any(node in places for node in path):
        return False
    x, y = turn.layout.point(path[0])
    at_rest = not turn.is_driving(robot) and not turn.is_acting(robot)
    if path[0] in places and at_rest and hypot(x - robot.x, y - robot.y) > LOST_M:
        return True
    if any(_is_detached(turn, one, other) for one, other in pairwise(path)):
        return True
    task = turn.task_of(robot)
    goal = "" if task is None else task.order.target.id
    return task is not None and len(path) > 1 and path[-1] == goal and (task.run, goal) in turn.layout.kept


def _is_detached(turn: Turn, one: Node, other: Node) -> bool:
    """Tell whether one of two nodes of a path is a place that is not reached from the other, a cell."""
    spot, cell = (other, one) if isinstance(one, int) else (one, other)
    return isinstance(cell, int) and spot in turn.layout.places and turn.layout.cell(spot) != cell


def leave_other_lattice(turn: Turn) -> None:
    """Let all robots plan anew when cells are numbered by another lattice, as when a wider robot was let in.

    They are told to stop, and hold the cells where they are; what they hold by the other numbers says nothing.
    """
    if turn.before.lattice == turn.layout.numbering:
        return
    robots = [robot for robot in turn.robots.values() if robot.path]
    for robot in robots:
        turn.put(robot, held=())
    for robot in robots:
        _stand_here(turn, turn.robots[robot.id])


def _stand_here(turn: Turn, robot: Robot) -> None:
    """Let a robot stop where it is and forget its path."""
    drop_pieces(turn, robot, cancel=True)
    place(turn, turn.put(robot, evading="", yields_to="", blocked_since=None, idle_since=turn.now))


def _heeded(turn: Turn) -> Iterator[FloorZone]:
    """Go through the zones of the floor that ask something of robots now: one that is open to all does not."""
    zones = chain(turn.layout.zones, turn.layout.bodies)
    return (zone for zone in zones if not zone.is_open(turn.now))


def heed_zones(turn: Turn) -> None:
    """Let robots under way heed zones of the floor that are new or another since the last step.

    A path that leads into a keep-out, or against a one-way zone, is cut before it; what of it was released already is
    called off, and the robot plans anew from where it comes to stand. So is what was released with too high a speed, or
    into a zone that a person lets robots into.
    """
    before, now = turn.zones.get(SITE, ()), tuple(_heeded(turn))
    if before == now:
        return
    stricter = [zone for zone in now if zone.rule in {"slow", "release"} and zone not in before]
    for robot in [robot for robot in turn.robots.values() if robot.path]:
        released = robot.path[robot.passed : robot.released + 1] if turn.is_driving(robot) else ()
        enters = enters_at(turn, robot)
        if (enters is not None and released and enters <= robot.released) or leads_through(
            turn.layout, released, stricter
        ):
            _stand_here(turn, robot)
        elif enters is not None:
            cut_path(turn, robot)
    turn.zones = {run: zones for run, zones in turn.zones.items() if run != SITE} | ({SITE: now} if now else {})


def keep_stations(turn: Turn) -> None:
    """Give machines back that their robot neither stands at nor is on its path to."""
    for machine, holder in list(turn.stations.items()):
        robot = turn.robots[holder]
        x, y = turn.layout.point(machine)
        near = hypot(x - robot.x, y - robot.y) < turn.layout.clear_of_m
        task = turn.task_of(robot)
        wanted = task is not None and task.order.target.id == machine
        if not (near or wanted or machine in robot.path[robot.passed :]):
            del turn.stations[machine]

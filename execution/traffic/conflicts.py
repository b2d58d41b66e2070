"""What robots do that are in each other's way: wait, go round, or make room."""

from __future__ import annotations

from math import hypot

from execution.traffic.admissions import wait_for_admission, zone_before
from execution.traffic.covering import go_round_lanes
from execution.traffic.doors import report_stuck, shut_door, why_not_waited_for
from execution.traffic.floor_state import Door, Robot
from execution.traffic.layout import Node
from execution.traffic.messages import FloorZone
from execution.traffic.path_release import cut_path, may_enter, set_path, why_stranded
from execution.traffic.route_points import path_along, points_ahead, set_points
from execution.traffic.turn import Turn
from execution.traffic.zones import cells_of, closed_cells, in_the_way, kept_out, path_for

ROUND_AFTER_S = 2.0
"""How long a blocked robot waits before it looks for a path round."""
YIELD_AT_MOST_S = 20.0
GIVE_UP_EVADING_S = 4.0
BLOCKED_LIMIT_S = 180.0
CLOSE_M = 1.3
HOME_AFTER_S = 3.0
NOBODY = 1 << 60


def resolve(turn: Turn) -> None:
    """Look after every robot that stands and cannot go on, those with the oldest tasks first."""
    for robot in sorted(turn.robots.values(), key=lambda r: (_rank(turn, r), r.id)):
        robot = turn.robots[robot.id]
        _end_yielding(turn, robot)
        robot = turn.robots[robot.id]
        stands = robot.path and not turn.is_driving(robot) and robot.online and not turn.is_acting(robot)
        if not stands or robot.released + 1 >= len(robot.path) or robot.blocked_since is None or turn.stopped:
            continue
        door = shut_door(turn, robot, robot.released + 1)
        if robot.evading and (_is_let_out(turn, robot) or _waits_on_its_way_home(turn, robot)):
            continue
        if robot.evading:
            limit_s = GIVE_UP_EVADING_S if door is None or why_not_waited_for(turn, door) else BLOCKED_LIMIT_S
            if turn.now - robot.blocked_since > limit_s:
                _settle_here(turn, robot)
        elif door is not None:
            _wait_for_door(turn, robot, door)
        elif not robot.yields_to and robot.run not in turn.paused:
            _unblock(turn, robot)


def _waits_on_its_way_home(turn: Turn, robot: Robot) -> bool:
    """Let a robot wait on its way home that people have to let in: nobody needs it elsewhere; tell if it does."""
    closed = zone_before(turn, robot, robot.released + 1) if robot.evading == "home" else None
    if closed is not None:
        wait_for_admission(turn, robot, closed)
    return closed is not None


def _is_let_out(turn: Turn, robot: Robot) -> bool:
    """Let whom a robot makes room for leave the zone that it would have to come through; tell if it does.

    Two would else wait for ever: one at the dock that the other is sent to, and that one in the zone before the dock.
    """
    taken = in_the_way(turn, robot, robot.released + 1)
    other = turn.robots.get(robot.yields_to)
    if taken is None or other is None or other.id not in {holder.id for holder in taken[1]}:
        return False
    is_busy = turn.is_driving(other) or turn.is_acting(other) or not other.online
    return not is_busy and _evade(turn, other, robot)


def _rank(turn: Turn, robot: Robot) -> int:
    task = turn.task_of(robot)
    return task.seq if task else NOBODY


def _settle_here(turn: Turn, robot: Robot) -> None:
    node = turn.node(robot)
    turn.put(robot, path=(node,), passed=0, released=0, evading="", blocked_since=None, idle_since=turn.now)


def _end_yielding(turn: Turn, robot: Robot) -> None:
    """Let a robot go on once the one it made room for has passed."""
    if not robot.yields_to or robot.evading:
        return
    other = turn.robots.get(robot.yields_to)
    gone = other is None or len(other.path) <= other.passed + 1 or bool(other.yields_to)
    waits = other is not None and not gone and not may_enter(turn, other, min(other.released + 1, len(other.path) - 1))
    if gone or waits or turn.now - robot.yields_since > YIELD_AT_MOST_S or not _is_near_path(turn, robot, other):
        turn.put(robot, yields_to="", blocked_since=None)


def _is_near_path(turn: Turn, robot: Robot, other: Robot | None) -> bool:
    if other is None:
        return False
    points = (turn.layout.point(node) for node in other.path[other.passed :])
    return any(hypot(x - robot.x, y - robot.y) < CLOSE_M for x, y in points)


def _unblock(turn: Turn, robot: Robot) -> None:
    """Find out who is in the way, and who shall move."""
    index = robot.released + 1
    task = turn.task_of(robot)
    taken = in_the_way(turn, robot, index)
    if taken is not None:
        _wait_for_zone(turn, robot, taken[0], taken[1])
        return
    if (closed := zone_before(turn, robot, index)) is not None:
        wait_for_admission(turn, robot, closed)
        if turn.node(robot) in turn.layout.stations:
            _evade(turn, robot, robot)
        return
    if not may_enter(turn, robot, index):
        if turn.node(robot) in turn.layout.stations:
            _evade(turn, robot, robot)
        return
    holders = turn.holders(robot.id)
    blockers = sorted(
        {holders[c] for c in turn.layout.needed(robot.path[index]) if holders.get(c, robot.id) != robot.id}
    )
    if task and blockers:
        names = " and ".join(turn.name(b) for b in blockers)
        turn.wait(
            task,
            "blocked_by",
            f"{turn.name(robot.id)} waits for {names} to pass.",
            robot=robot.id,
            others=",".join(blockers),
        )
    since = turn.now - (robot.blocked_since if robot.blocked_since is not None else turn.now)
    for blocker in blockers:
        _move_blocker(turn, turn.robots[robot.id], turn.robots[blocker])
    if since >= ROUND_AFTER_S and not turn.robots[robot.id].evading:
        _go_round(turn, turn.robots[robot.id])
    if task and since >= BLOCKED_LIMIT_S:
        names = " and ".join(turn.name(b) for b in blockers)
        turn.finish(task, "blocked", f"{turn.name(robot.id)} has been blocked by {names} for too long.")
        cut_path(turn, turn.robots[robot.id])


def _wait_for_door(turn: Turn, robot: Robot, door: Door) -> None:
    """Say which door a robot waits for; a task that has waited too long for it fails."""
    task = turn.task_of(robot)
    if task is None or robot.run in turn.paused:
        return
    if why := why_not_waited_for(turn, door):
        report_stuck(turn, door)
        turn.finish(task, "blocked", why)
        cut_path(turn, robot)
        return
    name, code = turn.name(door.id), "door_away" if door.id in turn.offline else "door_shut"
    text = f"{turn.name(robot.id)} waits for {name}" + (", which is offline." if code == "door_away" else " to open.")
    turn.wait(task, code, text, robot=robot.id, device=door.id)


def _wait_for_zone(turn: Turn, robot: Robot, zone: FloorZone, holders: list[Robot]) -> None:
    """Say what the robot waits for; who stands in the zone without getting on leaves it, who is at a machine too.

    Where several are in it, one that has nothing to do is asked first.
    """
    task = turn.task_of(robot)
    if task:
        text = f"{turn.name(robot.id)} waits until {zone.name} is free."
        others = ",".join(each.id for each in holders)
        turn.wait(task, "zone_taken", text, robot=robot.id, zone=zone.name, zone_key=zone.key, others=others)
    _move_blocker(turn, robot, min(holders, key=lambda each: (not turn.is_idle(each), each.id)))
    robot = turn.robots[robot.id]
    if not robot.evading and turn.node(robot) in turn.layout.stations:
        _evade(turn, robot, robot)


def _move_blocker(turn: Turn, robot: Robot, blocker: Robot) -> None:
    """Ask the one in the way to make room if it may and should; else make room oneself."""
    busy = turn.is_driving(blocker) or turn.is_acting(blocker) or blocker.evading
    if busy or not blocker.online or (blocker.run and blocker.run in turn.paused):
        return
    index = blocker.released + 1
    has_more = len(blocker.path) > index and shut_door(turn, blocker, index) is None
    waits_for_machine = has_more and not may_enter(turn, blocker, index)
    if turn.is_idle(blocker) or blocker.yields_to or waits_for_machine or _rank(turn, robot) < _rank(turn, blocker):
        if turn.is_idle(blocker) and turn.now - blocker.idle_since < 0.5:
            return
        if not make_room_for(turn, blocker, robot):
            _evade(turn, robot, blocker)


def _go_round(turn: Turn, robot: Robot) -> None:
    """Plan anew around the cells of all who stand still."""
    standing = {c for r in turn.robots.values() if r.id != robot.id and not turn.is_driving(r) for c in r.held}
    goal = robot.path[-1]
    moving = {c for r in turn.robots.values() if r.id != robot.id for c in r.held} - standing
    task = turn.task_of(robot) if robot.route_at else None
    if task is not None and task.lanes:
        go_round_lanes(turn, task, robot, standing)
        return
    along = path_along(turn, robot, points_ahead(task), goal, closed=standing, extra=dict.fromkeys(moving, 4.0))
    if along is not None and along[0] != robot.path[robot.passed :] and not standing & turn.layout.needed(goal):
        since = robot.blocked_since
        robot = turn.put(set_path(turn, robot, along[0]), blocked_since=since)
        if task is not None:
            set_points(turn, robot, task, along[1])


def make_room_for(turn: Turn, robot: Robot, other: Robot) -> bool:
    """Send a standing robot off another's path: home if it is free, else to the nearest cell that is; tell if so."""
    if why_stranded(turn, robot):
        return False
    if robot.run == "" and _go_home(turn, robot, set(_ahead(turn, other))):
        return True
    return _evade(turn, robot, other)


def _ahead(turn: Turn, robot: Robot) -> list[int]:
    return [cell for node in robot.path[robot.passed :] for cell in turn.layout.needed(node)]


def _evade(turn: Turn, robot: Robot, other: Robot) -> bool:
    """Send a robot to the nearest cell that nobody holds, off the other's path, that is in front of no machine."""
    if robot.yields_to == other.id and robot.evading:
        return True
    layout = turn.layout
    taken = {cell for r in turn.robots.values() if r.id != robot.id for cell in r.held}
    spots = {cell for spot in (*layout.stations.values(), *layout.places.values()) for cell in spot.body}
    own_path = set() if robot.id == other.id else set(_ahead(turn, other))
    taken_zone = in_the_way(turn, other, min(other.released + 1, len(other.path) - 1))
    if taken_zone is not None and robot.id in {holder.id for holder in taken_zone[1]}:
        own_path |= cells_of(layout, taken_zone[0])
    taken |= (kept_out(turn, robot) | closed_cells(turn, robot)) - {layout.cell(turn.node(robot))}
    others_paths = {c for r in turn.robots.values() if r.id not in {robot.id, other.id} for c in _ahead(turn, r)}
    start = layout.cell(turn.node(robot))
    reach = layout.lattice.distances(start, closed=taken, closed_links=layout.against)
    for avoid in (own_path | spots | others_paths, own_path | spots, own_path):
        free = [
            (steps, cell) for cell, steps in reach.items() if cell not in avoid and (steps or robot.path[0] != start)
        ]
        if free:
            break
    else:
        return False
    goal = min(free)[1]
    path = path_for(turn, robot, goal, closed=taken)
    if path is None or len(path) < 2:
        return False
    robot = set_path(turn, robot, path, evading=other.id)
    yields_to = "" if robot.id == other.id else other.id
    turn.put(robot, yields_to=yields_to, yields_since=turn.now)
    return True


def _go_home(turn: Turn, robot: Robot, avoid: set[int]) -> bool:
    """Send a free robot to the nearest free dock."""
    layout = turn.layout
    others = [r for r in turn.robots.values() if r.id != robot.id and r.path]
    taken = {cell for r in others for cell in (*r.held, *layout.needed(r.path[-1]))}
    node: Node = turn.node(robot)
    found = []
    for dock in layout.docks:
        if not layout.needed(dock) & (taken | avoid) and dock != node:
            path = path_for(turn, robot, dock, closed=taken)
            if path is not None:
                found.append((len(path), dock, path))
    if not found or node in layout.docks:
        return False
    set_path(turn, robot, min(found)[2], evading="home")
    return True


def send_home(turn: Turn) -> None:
    """Send robots home that belong to no run and stand about."""
    for robot in list(turn.robots.values()):
        rested = turn.now - robot.idle_since >= HOME_AFTER_S
        free = robot.online and robot.run == "" and robot.path and turn.is_idle(robot) and rested and not turn.stopped
        if free and turn.node(robot) not in turn.layout.docks and not why_stranded(turn, robot):
            _go_home(turn, robot, set())

"""How a robot covers a zone: lanes over all of it, driven point by point along a path that grows as it drives.

The lanes are worked out from the map when the robot is chosen. Where somebody stands in a lane, the robot drives the
others first, and leaves out what is in somebody's way still when it comes back; how much was covered is told.
"""

from __future__ import annotations

from collections.abc import Collection
from itertools import pairwise
from math import hypot

from execution.traffic.floor_state import FloorTask, Robot
from execution.traffic.lanes import drop, lanes_over, passed_lanes, put_off
from execution.traffic.layout import DEFAULT_RADIUS_M, Node, NoSuchSpot
from execution.traffic.messages import FloorZone, PathPlanned, Reason, TaskTold
from execution.traffic.path_planner import drawn
from execution.traffic.path_release import cut_path, set_path
from execution.traffic.route_points import HORIZON, leads_along, points_ahead, set_points
from execution.traffic.turn import Turn
from execution.traffic.zones import cells_of, is_shut_way, kept_out, path_for, speed_limit
from registry.floorplan.coverage import STEP_M, CannotCover, Lane, covered_share, in_order
from registry.floorplan.lattice import STANDING_MARGIN_M
from vipo_device.protocol.description import Scalar

GROW_AT = 12
"""With so many nodes left of its path it is made longer, so that the robot drives on without stopping."""
STRAIGHT_M = 0.75
"""Over so much a robot drives straight between two points; the cells that it holds at both keep others off."""
LEAVE_OUT_AFTER_S = 20.0
"""How long a robot waits at what it tries a second time before it leaves that out."""
USUAL_SPEED_M_S = 0.5
"""How fast a robot is thought to drive that does not say so; for the estimate of time alone."""
TURN_S = 3.0
"""How long it is thought to turn on the spot at either end of a lane."""


def zone_of(turn: Turn, task: FloorTask) -> FloorZone | None:
    """Return the zone that a task is to cover; None when its program has none of that id."""
    wanted = str(task.order.arguments.get("zone", ""))
    return next((zone for zone in turn.zones.get(task.run, ()) if zone.key.partition("/")[2] == wanted), None)


def lane_m(turn: Turn, task: FloorTask, robot: Robot) -> float:
    """Return how wide the lanes of a task are at most: as it says, or as the robot is."""
    given = task.order.arguments.get("lane", 0)
    if isinstance(given, int | float) and given > 0:
        return float(given)
    device = turn.layout.devices.get(robot.id)
    return 2 * ((device.radius_m if device else 0.0) or DEFAULT_RADIUS_M)


def distance_to_zone(turn: Turn, task: FloorTask, robot: Robot) -> float | None:
    """Return how many cells lie between a robot and the zone that it might cover; None where no way leads there."""
    zone = zone_of(turn, task)
    layout = turn.layout
    reach = layout.lattice.distances(layout.cell(turn.node(robot)), closed_links=layout.against)
    cells = cells_of(layout, zone) if zone else ()
    return min((float(reach[cell]) for cell in cells if cell in reach), default=None)


def cover(turn: Turn, task: FloorTask, robot: Robot) -> None:
    """Bring a cover on: plan its lanes, see to it that the robot is on its path over them, and tell when it is done."""
    if not task.lanes:
        if task.points_passed == 0 and _begin(turn, task, robot):
            cover(turn, turn.tasks[task.run, task.number], robot)
        return
    if robot.evading or robot.yields_to or turn.is_acting(robot):
        return
    if not points_ahead(task):
        if not turn.is_driving(robot):
            _finish(turn, task, robot)
    elif leads_along(robot, task):
        if len(robot.path) - robot.passed <= GROW_AT:
            _grow(turn, task, robot)
    elif turn.is_driving(robot):
        cut_path(turn, robot)
    else:
        _set_out(turn, task, robot, frozenset(), leave_out=True)


def _begin(turn: Turn, task: FloorTask, robot: Robot) -> bool:
    """Work out the lanes and tell how many they are; a zone that cannot be covered ends the task."""
    zone = zone_of(turn, task)
    if zone is None:
        turn.finish(task, "refused", "The zone is not there any more; choose another one.")
        return False
    width_m = lane_m(turn, task, robot)
    shut = kept_out(turn, robot)
    try:
        blocks = lanes_over(turn.layout, zone, width_m, shut)
    except CannotCover as error:
        kind = "refused" if error.code == "too_many" else "blocked"
        turn.finish(task, kind, f"{turn.name(robot.id)} cannot cover {zone.name}. {error}")
        return False
    lanes = in_order(blocks, (robot.x, robot.y))
    turn.put_task(task, lanes=lanes)
    _tell_beginning(turn, task, robot, zone, lanes)
    return True


def _tell_beginning(turn: Turn, task: FloorTask, robot: Robot, zone: FloorZone, lanes: tuple[Lane, ...]) -> None:
    device = turn.layout.devices.get(robot.id)
    speed_m_s = (device.speed_m_s if device else 0.0) or USUAL_SPEED_M_S
    limit_m_s = speed_limit(turn, robot, (f"@{lanes[0].x1:.3f},{lanes[0].y1:.3f}",))
    ends = [(robot.x, robot.y), *(end for lane in lanes for end in ((lane.x1, lane.y1), (lane.x2, lane.y2)))]
    length_m = round(sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(ends)))
    driven_s = length_m / min(speed_m_s, limit_m_s or speed_m_s) + 2 * TURN_S * len(lanes)
    minutes = max(1, round(driven_s / 60))
    text = f"{turn.name(robot.id)} covers {zone.name} in {len(lanes)} lanes, {length_m} m, about {minutes} min."
    said: dict[str, Scalar] = {"zone": zone.name, "lanes": len(lanes), "length_m": length_m, "minutes": minutes}
    reason = Reason("cover_begins", text, said)
    turn.actions.append(TaskTold(task.run, task.number, task.order.step, robot.id, reason))


def _finish(turn: Turn, task: FloorTask, robot: Robot) -> None:
    """Tell how much of the zone was covered; a robot that came nowhere has not done it."""
    percent = covered_percent(turn, task, robot)
    zone = zone_of(turn, task)
    name = zone.name if zone else ""
    if percent == 0:
        turn.finish(task, "blocked", f"{turn.name(robot.id)} has found no way to any part of {name}.")
        return
    text = f"{turn.name(robot.id)} has covered {percent} % of {name}."
    reason = Reason("covered", text, {"zone": name, "percent": percent})
    turn.actions.append(TaskTold(task.run, task.number, task.order.step, robot.id, reason))
    turn.finish(task, result={"covered": percent})


def covered_percent(turn: Turn, task: FloorTask, robot: Robot) -> int:
    """Return how much of its zone's floor a robot has covered so far, in percent."""
    zone, driven = zone_of(turn, task), passed_lanes(task)
    if zone is None or not driven:
        return 0
    share = covered_share(turn.layout.ground, zone.points, lane_m(turn, task, robot), driven)
    return max(1, round(100 * share))


def _set_out(turn: Turn, task: FloorTask, robot: Robot, closed: Collection[int], *, leave_out: bool) -> bool:
    """Set the robot on its path over the points ahead; those to which no way leads are put off. Tell if it goes.

    With `leave_out` those that were put off before are given up.
    """
    while points := points_ahead(task) if leave_out or not _is_again(task) else ():
        path, at = _path_over(turn, robot, (turn.node(robot),), points, closed)
        if at:
            set_points(turn, set_path(turn, robot, path), task, at)
            return True
        changed = drop(task) if _is_again(task) else put_off(task)
        task = turn.put_task(task, lanes=changed.lanes, put_off=changed.put_off)
    return False


def _is_again(task: FloorTask) -> bool:
    """Tell whether the next point was put off before."""
    return task.points_passed >= sum(lane.stops for lane in task.lanes) - task.put_off


def _grow(turn: Turn, task: FloorTask, robot: Robot) -> None:
    """Make the robot's path longer by the points behind those that it leads over; what lies behind it is dropped."""
    more = points_ahead(task)[len(robot.route_at) :]
    if not more:
        return
    path, at = _path_over(turn, robot, robot.path[-1:], more, frozenset())
    if not at:
        return
    turn.actions.append(PathPlanned(robot.id, robot.run, drawn(turn.layout, path)))
    pieces = turn.pieces(robot)
    behind = min([robot.passed, *(sent.upto for sent in pieces)])
    for sent in pieces:
        turn.shift(sent, behind)
    ahead = len(robot.path) - 1 - behind
    turn.put(
        robot,
        path=(*robot.path[behind:], *path[1:]),
        passed=robot.passed - behind,
        released=robot.released - behind,
        route_at=(*(index - behind for index in robot.route_at), *(ahead + index for index in at)),
    )


def go_round_lanes(turn: Turn, task: FloorTask, robot: Robot, standing: Collection[int]) -> None:
    """A robot is blocked on its lanes: it leaves what those who stand keep from it for later, and drives the rest."""
    since_s = 0.0 if robot.blocked_since is None else turn.now - robot.blocked_since
    leave_out = since_s >= LEAVE_OUT_AFTER_S
    if _is_again(task) and not leave_out:
        return
    if not _set_out(turn, task, robot, standing, leave_out=leave_out):
        cut_path(turn, robot)


def _path_over(
    turn: Turn, robot: Robot, start: tuple[Node, ...], points: tuple[tuple[float, float], ...], closed: Collection[int]
) -> tuple[tuple[Node, ...], tuple[int, ...]]:
    """Return a path over these points as far as a way leads, with the index of each point's node."""
    path, at = start, list[int]()
    shut = kept_out(turn, robot)
    for x, y in points[:HORIZON]:
        leg = _leg(turn, robot, path[-1], f"@{x:.3f},{y:.3f}", closed, shut)
        if leg is None:
            break
        path += leg[1:]
        at.append(len(path) - 1)
    return path, tuple(at)


def _leg(
    turn: Turn, robot: Robot, start: Node, goal: str, closed: Collection[int], shut: Collection[int]
) -> tuple[Node, ...] | None:
    layout = turn.layout
    try:
        needed = layout.needed(goal)
    except NoSuchSpot:
        return None
    there = layout.point(goal)
    if not needed.isdisjoint(closed) or layout.cell(goal) in shut or (shut and is_shut_way(turn, robot, there, there)):
        return None
    if start == goal:
        return (start,)
    here = layout.point(start)
    near = hypot(there[0] - here[0], there[1] - here[1]) <= max(STRAIGHT_M, STEP_M)
    near = near and not (shut and is_shut_way(turn, robot, here, there))
    if near and layout.ground.is_passable(here, there, layout.ground.radius_m + STANDING_MARGIN_M):
        return (start, goal)
    return path_for(turn, robot, goal, closed, start=start)

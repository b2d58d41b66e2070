"""The points that a task's robot is to drive over on its way, in their order and without a stop.

A robot drives from cell to cell, so it comes as near to a point as the cell does from which one drives straight to it.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping

from execution.machine.floor_task import Target
from execution.traffic.floor_state import FloorTask, Robot
from execution.traffic.layout import Node
from execution.traffic.turn import Turn
from execution.traffic.zones import path_for

HORIZON = 60
"""So many points of a cover are looked at ahead; its path is made longer as the robot drives."""
Along = tuple[tuple[Node, ...], tuple[int, ...]]
"""A path, and where on it the points of a route are."""


def points_ahead(task: FloorTask | None) -> tuple[tuple[float, float], ...]:
    """Return the points of a task's route that its robot has still to drive over."""
    if task is None:
        return ()
    return points_of_lanes(task) if task.lanes else task.order.route[task.points_passed :]


def points_of_lanes(task: FloorTask) -> tuple[tuple[float, float], ...]:
    """Return the points of a cover's lanes that its robot has still to drive over, at most `HORIZON` of them."""
    skipped, found = task.points_passed, list[tuple[float, float]]()
    for lane in task.lanes:
        found.extend(lane.point(index) for index in range(min(skipped, lane.stops), lane.stops))
        skipped = max(0, skipped - lane.stops)
        if len(found) >= HORIZON:
            break
    return tuple(found[:HORIZON])


def path_along(
    turn: Turn,
    robot: Robot,
    points: tuple[tuple[float, float], ...],
    goal: Node,
    closed: Collection[int] = (),
    extra: Mapping[int, float] | None = None,
) -> Along | None:
    """Return a robot's path over these points to a goal, with the index of each point's node; None if there is none.

    Raises:
        NoSuchSpot: no robot can stand at one of the points.
    """
    path: tuple[Node, ...] = (turn.node(robot),)
    at: list[int] = []
    for stop in (*(turn.layout.spot_for(Target(point=point)).cell for point in points), goal):
        leg = path_for(turn, robot, stop, closed, extra, start=path[-1])
        if leg is None:
            return None
        path += leg[1:]
        at.append(len(path) - 1)
    return path, tuple(at[:-1])


def set_points(turn: Turn, robot: Robot, task: FloorTask, at: tuple[int, ...]) -> None:
    """Remember where on its new path a robot comes over the points of its task."""
    if at:
        pass_points(turn, turn.put(robot, route_of=_name(task), route_at=at))


def leads_along(robot: Robot, task: FloorTask) -> bool:
    """Tell whether a robot is on a path over all the points that its task has ahead."""
    return not points_ahead(task) or (robot.route_of == _name(task) and len(robot.path) > robot.passed + 1)


def pass_points(turn: Turn, robot: Robot) -> Robot:
    """Count the points that the robot has driven over."""
    ahead = tuple(index for index in robot.route_at if index > robot.passed)
    count = len(robot.route_at) - len(ahead)
    if not count:
        return robot
    run, _, number = robot.route_of.rpartition("/")
    task = turn.tasks.get((run, int(number)))
    if task is not None:
        turn.put_task(task, points_passed=task.points_passed + count)
    return turn.put(robot, route_at=ahead)


def _name(task: FloorTask) -> str:
    return f"{task.run}/{task.number}"

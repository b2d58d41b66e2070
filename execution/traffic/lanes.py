"""The lanes of a cover as its task keeps them: worked out once for a map, put off and left out in parts."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import replace

from execution.traffic.floor_state import FloorTask
from execution.traffic.layout import Layout
from execution.traffic.messages import FloorZone
from registry.floorplan.coverage import Lane, plan_lanes

Blocks = tuple[tuple[Lane, ...], ...]


def lanes_over(layout: Layout, zone: FloorZone, lane_m: float, shut: Collection[int]) -> Blocks:
    """Return the blocks of lanes over a zone that keep out of the cells that are shut.

    Raises:
        CannotCover: the zone is off the map, nobody can stand in it, or it would have too many lanes.
    """
    return plan_lanes(layout.ground, layout.lattice, zone.points, lane_m, shut)


def _next(task: FloorTask) -> tuple[int, int]:
    """Return the lane that is driven next, and the first of its points that is still ahead."""
    left = task.points_passed
    for index, lane in enumerate(task.lanes):
        if left < lane.stops:
            return index, left
        left -= lane.stops
    return len(task.lanes), 0


def put_off(task: FloorTask) -> FloorTask:
    """Return the task with the rest of its next lane behind all others, to be tried a second time.

    Of a lane of several points only the next is put off, and the rest is gone on with.
    """
    index, first = _next(task)
    lane, before, behind = task.lanes[index], task.lanes[:index], task.lanes[index + 1 :]
    lanes = (*before, *lane.part(0, first), *lane.part(first + 1, lane.stops), *behind, *lane.part(first, first + 1))
    return replace(task, lanes=_joined(lanes, task.put_off), put_off=task.put_off + 1)


def drop(task: FloorTask) -> FloorTask:
    """Return the task without the next point of its next lane, which was tried twice."""
    index, first = _next(task)
    lane, before, behind = task.lanes[index], task.lanes[:index], task.lanes[index + 1 :]
    lanes = (*before, *lane.part(0, first), *lane.part(first + 1, lane.stops), *behind)
    return replace(task, lanes=lanes, put_off=task.put_off - 1)


def _joined(lanes: tuple[Lane, ...], put_off_before: int) -> tuple[Lane, ...]:
    """Join the last point to the lane of points that was put off right before it, if it goes on in line."""
    last, point = lanes[-2:] if len(lanes) > 1 and put_off_before else (None, None)
    if last is None or point is None or point.stops != 1 or not _goes_on(last, point):
        return lanes
    return (*lanes[:-2], Lane(last.x1, last.y1, point.x1, point.y1, last.stops + 1))


def _goes_on(lane: Lane, point: Lane) -> bool:
    step = (
        0.45
        if lane.stops == 1
        else 1.01 * ((lane.x2 - lane.x1) ** 2 + (lane.y2 - lane.y1) ** 2) ** 0.5 / (lane.stops - 1)
    )
    far = ((point.x1 - lane.x2) ** 2 + (point.y1 - lane.y2) ** 2) ** 0.5
    cross = (lane.x2 - lane.x1) * (point.y1 - lane.y2) - (lane.y2 - lane.y1) * (point.x1 - lane.x2)
    return far <= step and abs(cross) < 1e-3


def passed_lanes(task: FloorTask) -> tuple[Lane, ...]:
    """Return what of a task's lanes its robot has driven over."""
    return tuple(_passed(task))


def _passed(task: FloorTask) -> Iterator[Lane]:
    left = task.points_passed
    for lane in task.lanes:
        yield from lane.part(0, min(left, lane.stops))
        left -= min(left, lane.stops)

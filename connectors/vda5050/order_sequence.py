"""The order in which a vehicle is given what waits; pure."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from connectors.vda5050.messages import Located, VehicleState
from connectors.vda5050.orders import OURS, Order, action, begin_actions, begin_drive, extend_drive
from connectors.vda5050.tasks import Task, Vehicle, action_parameters, drives_in_front


def growing(order: Order | None, state: VehicleState, *, is_under_way: bool) -> Order | None:
    """Return the order if it is one that grows: of a vehicle that drives, or waits at the end of its base."""
    return order if order and order.kind == "drive" and (is_under_way or state.has_horizon) else None


def next_order(
    vehicle: Vehicle, located: Located, waiting: Sequence[Task], grown: Order | None, new_id: Callable[[], str]
) -> Order:
    """Return the order for what is first in turn: moves in one that grows, anything else in one of its own.

    A horizon is taken away first, since only then does a vehicle take an order of another kind.
    """
    drives = drives_in_front(waiting)
    if not drives:
        return extend_drive(grown, (), ()) if grown else _acting(vehicle, located, waiting[0], OURS + new_id())
    end = grown.end_sequence if grown else 0
    for task in drives:
        task.last = end = end + 2 * len(task.way)
    way, ahead = [waypoint for task in drives for waypoint in task.way], drives[-1].ahead
    if grown:
        return extend_drive(grown, way, ahead)
    return begin_drive(OURS + new_id(), located.map_id, (located.pose.x, located.pose.y), way, ahead)


def _acting(vehicle: Vehicle, located: Located, task: Task, name: str) -> Order:
    parameters = action_parameters(vehicle, task)
    task.actions = tuple(f"{name}-{count}" for count in range(len(parameters)))
    told = [action(i, task.method, p) for i, p in zip(task.actions, parameters, strict=True)]
    return begin_actions(name, located.map_id, (located.pose.x, located.pose.y), told)

"""Commands of the server, turned into what a vehicle can be ordered to do, and into which order; pure."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

from connectors.vda5050.coordinates import Frame, Point
from connectors.vda5050.factsheet import HANDLING, Factsheet, capacity, offered_actions
from connectors.vda5050.messages import DRIVING_MODES, Located, VehicleState
from connectors.vda5050.orders import OURS, Order, Waypoint, action, begin_actions, begin_drive, extend_drive
from vipo_device.kit.arguments import read_move, why_astray
from vipo_device.protocol.arguments import MOST_WHOLE, is_number
from vipo_device.protocol.description import Description
from vipo_device.protocol.messages import DeviceCommand

MOST_POINTS = 200


@dataclass(slots=True)
class Task:
    """A command that is open. Once it is handed over, `last` is its last node's sequence id, or `actions` their ids.

    `begin` is where a move has to begin (site frame, metres), None where it does not say so.
    """

    command: str
    method: str
    arguments: Mapping[str, Any]
    way: tuple[Waypoint, ...] = ()
    ahead: tuple[Point, ...] = ()
    last: int = -1
    actions: tuple[str, ...] = ()
    begin: Point | None = None

    @property
    def is_handed_over(self) -> bool:
        """True when it is part of an order."""
        return self.last >= 0 or bool(self.actions)

    def go_on_from(self, sequence: int) -> None:
        """Take it back from an order that is over: what is left of its way has to be driven anew."""
        first = self.last - 2 * (len(self.way) - 1)
        left = tuple(w for at, w in enumerate(self.way) if first + 2 * at > sequence)
        self.way, self.last, self.actions, self.begin = left or self.way[-1:], -1, (), None


@dataclass(frozen=True, slots=True)
class Vehicle:
    """What is fixed about a vehicle: how it describes itself, its factsheet, its map, and the version it speaks."""

    description: Description
    sheet: Factsheet
    frame: Frame
    version: str
    station_type: str = "floor"

    @property
    def can_pause(self) -> bool:
        """True when the vehicle can be paused."""
        return self.sheet.can("startPause", "INSTANT") and self.sheet.can("stopPause", "INSTANT")


def read_task(vehicle: Vehicle, command: DeviceCommand, way_begins: Point | None) -> Task | str:
    """Return the task of a command, or why it cannot be; `way_begins` is where a piece has to begin (site frame)."""
    if vehicle.description.method(command.method) is None:
        known = ", ".join(method.name for method in vehicle.description.methods)
        return f"{vehicle.description.name} cannot {command.method}; it can: {known}."
    if command.method == "move":
        return _read_move(vehicle, command, way_begins)
    why = _misfit(vehicle, command) if command.method in HANDLING else _misfit_of_action(vehicle, command)
    return why or Task(command.id, command.method, dict(command.arguments))


def action_parameters(vehicle: Vehicle, task: Task) -> list[dict[str, object]]:
    """Return the parameters of each action that a task needs: a pick of two loads is two actions."""
    listed = {p.key for a in vehicle.sheet.actions if a.type == task.method for p in a.parameters}
    if task.method not in HANDLING:
        return [{key: value for key, value in task.arguments.items() if key in listed and value is not None}]
    known: dict[str, object] = {"stationType": vehicle.station_type, "loadType": task.arguments["object"]}
    if task.arguments.get("device"):
        known["stationName"] = task.arguments["device"]
    return [{key: value for key, value in known.items() if key in listed}] * int(task.arguments.get("value") or 1)


def _read_move(vehicle: Vehicle, command: DeviceCommand, way_begins: Point | None) -> Task | str:
    if not _is_path(command.arguments.get("path")):
        return f"move needs a path: a list of 1 to {MOST_POINTS} points [x, y] in metres."
    move = read_move(command.arguments)
    if isinstance(move, str):
        return move
    if why := why_astray(vehicle.description.name, move.begin, way_begins):
        return why
    points = [vehicle.frame.to_vehicle(point) for point in move.path]
    heading = vehicle.frame.heading_to_vehicle(move.theta) if move.theta is not None else None
    way = [Waypoint(p, speed_m_s=move.speed_m_s) for p in points[:-1]]
    way.append(Waypoint(points[-1], heading, move.speed_m_s))
    ahead = tuple(_ahead(vehicle, command.arguments.get("ahead")))
    return Task(command.id, "move", {}, tuple(way), ahead, begin=move.begin)


def _ahead(vehicle: Vehicle, value: object) -> list[Point]:
    """Return where the way will probably go on; what cannot be read is left out, for nothing hangs on it."""
    if not isinstance(value, list) or not all(_is_point(p) for p in value):
        return []
    return [vehicle.frame.to_vehicle((p[0], p[1])) for p in value[:MOST_POINTS]]


def _is_path(value: object) -> bool:
    return isinstance(value, list) and 1 <= len(value) <= MOST_POINTS and all(_is_point(p) for p in value)


def _is_point(value: object) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(is_number(c) and abs(c) <= 1e6 for c in value)


def _point(value: object) -> Point | None:
    return (float(value[0]), float(value[1])) if isinstance(value, list) and _is_point(value) else None


def _misfit(vehicle: Vehicle, command: DeviceCommand) -> str:
    load, count = command.arguments.get("object"), command.arguments.get("value")
    if not isinstance(load, str) or not load:
        return "An object must be named."
    if vehicle.sheet.load_types and load not in vehicle.sheet.load_types:
        return f"{vehicle.description.name} carries {', '.join(vehicle.sheet.load_types)[:150]}, not {load[:40]}."
    most = capacity(vehicle.sheet) or 1
    if count is not None and not (is_number(count) and count in range(1, most + 1)):
        return f"The quantity must be a whole number from 1 to {most}."
    return "" if isinstance(command.arguments.get("device", ""), str) else "device must be a device's id."


def _misfit_of_action(vehicle: Vehicle, command: DeviceCommand) -> str:
    action = next(a for a in offered_actions(vehicle.sheet) if a.type == command.method)
    kinds = {"BOOL": bool, "STRING": str}
    for parameter in action.parameters:
        value = command.arguments.get(parameter.key)
        if value is None:
            if not parameter.optional:
                return f"{command.method} needs a value for {parameter.key}."
            continue
        if parameter.type in kinds:
            fits = isinstance(value, kinds[parameter.type])
        else:
            fits = is_number(value) and (parameter.type != "INTEGER" or _is_whole(value))
        if not fits:
            return f"{command.method}: {parameter.key} must be of the type {parameter.type}."
    return ""


def _is_whole(value: float) -> bool:
    return float(value).is_integer() and abs(value) <= MOST_WHOLE


def task_to_json(task: Task) -> dict[str, Any]:
    """Return what task_from_json reads."""
    way = [{"point": w.point, "theta": w.theta, "speed_m_s": w.speed_m_s} for w in task.way]
    return {**{field.name: getattr(task, field.name) for field in fields(task)}, "way": way}


def task_from_json(body: Mapping[str, Any]) -> Task:
    """Return a task that was kept."""
    way = tuple(Waypoint((w["point"][0], w["point"][1]), w["theta"], w["speed_m_s"]) for w in body["way"])
    ahead = tuple((p[0], p[1]) for p in body["ahead"])
    begin = _point(body.get("begin"))
    return Task(**{**body, "way": way, "ahead": ahead, "actions": tuple(body["actions"]), "begin": begin})


def drives_in_front(tasks: Sequence[Task]) -> list[Task]:
    """Return the moves at the head of a queue."""
    found = []
    for task in tasks:
        if not task.way:
            break
        found.append(task)
    return found


def why_not(name: str, state: VehicleState, *, is_located: bool) -> str:
    """Return why a vehicle takes no command now, for people; empty when it does."""
    if state.fatal is not None:
        return f"{name} needs a person: {state.fatal.sentence}"
    if state.mode not in DRIVING_MODES:
        return f"{name} is in the mode {state.mode[:40]}; switch it to AUTOMATIC."
    if works_for_others(state):
        return f"{name} carries out an order of somebody else ({state.order[:60]})."
    return "" if is_located and not state.is_lost else f"{name} does not know where it is; set its position."


def works_for_others(state: VehicleState) -> bool:
    """Tell whether the vehicle drives by an order that is not VIPO's."""
    return state.has_way_left and not state.order.startswith(OURS)


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
    actions = [action(i, task.method, p) for i, p in zip(task.actions, parameters, strict=True)]
    return begin_actions(name, located.map_id, (located.pose.x, located.pose.y), actions)

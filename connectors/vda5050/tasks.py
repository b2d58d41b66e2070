"""Commands of the server, turned into what a vehicle can be ordered to do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from math import hypot
from typing import Any

from connectors.commands import is_number
from connectors.vda5050.coordinates import Frame, Point
from connectors.vda5050.factsheet import HANDLING, Factsheet, capacity, offered_actions
from connectors.vda5050.messages import DRIVING_MODES, VehicleState
from connectors.vda5050.orders import OURS, Waypoint
from vipo_device.protocol.description import Description
from vipo_device.protocol.messages import Told

MOST_POINTS = 200
ASTRAY_M = 0.6
"""How far from its end the next piece of way may begin."""


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


def read_task(vehicle: Vehicle, told: Told, way_begins: Point | None) -> Task | str:
    """Return the task of a command, or why it cannot be; `way_begins` is where a piece has to begin (site frame)."""
    if vehicle.description.method(told.method) is None:
        known = ", ".join(method.name for method in vehicle.description.methods)
        return f"{vehicle.description.name} cannot {told.method}; it can: {known}."
    if told.method == "move":
        return _read_move(vehicle, told, way_begins)
    why = _misfit(vehicle, told) if told.method in HANDLING else _misfit_of_action(vehicle, told)
    return why or Task(told.command, told.method, dict(told.arguments))


def action_parameters(vehicle: Vehicle, task: Task) -> list[dict[str, object]]:
    """Return the parameters of each action that a task needs: a pick of two loads is two actions."""
    listed = {p.key for a in vehicle.sheet.actions if a.type == task.method for p in a.parameters}
    if task.method not in HANDLING:
        return [{key: value for key, value in task.arguments.items() if key in listed and value is not None}]
    known: dict[str, object] = {"stationType": vehicle.station_type, "loadType": task.arguments["object"]}
    if task.arguments.get("device"):
        known["stationName"] = task.arguments["device"]
    return [{key: value for key, value in known.items() if key in listed}] * int(task.arguments.get("value") or 1)


def _read_move(vehicle: Vehicle, told: Told, way_begins: Point | None) -> Task | str:
    path, theta, speed = (told.arguments.get(name) for name in ("path", "theta", "speed"))
    if not isinstance(path, list) or not 1 <= len(path) <= MOST_POINTS or not all(_is_point(p) for p in path):
        return f"move needs a path: a list of 1 to {MOST_POINTS} points [x, y] in metres."
    if theta is not None and not is_number(theta):
        return "theta must be a number in radians."
    if speed is not None and not (is_number(speed) and float(str(speed)) > 0):
        return "speed must be a number above 0, in metres a second."
    begin = told.arguments.get("from")
    if begin is not None and not _is_point(begin):
        return "from must be a point [x, y] in metres."
    if why := why_astray(vehicle, _point(begin), way_begins):
        return why
    limit = float(str(speed)) if speed is not None else None
    points = [vehicle.frame.to_vehicle((p[0], p[1])) for p in path]
    heading = vehicle.frame.heading_to_vehicle(float(str(theta))) if theta is not None else None
    way = [Waypoint(p, speed_m_s=limit) for p in points[:-1]] + [Waypoint(points[-1], heading, limit)]
    ahead = tuple(_ahead(vehicle, told.arguments.get("ahead")))
    return Task(told.command, "move", {}, tuple(way), ahead, begin=_point(told.arguments.get("from")))


def _ahead(vehicle: Vehicle, value: object) -> list[Point]:
    """Return where the way will probably go on; what cannot be read is left out, for nothing hangs on it."""
    if not isinstance(value, list) or not all(_is_point(p) for p in value):
        return []
    return [vehicle.frame.to_vehicle((p[0], p[1])) for p in value[:MOST_POINTS]]


def why_astray(vehicle: Vehicle, begin: Point | None, here: Point | None) -> str:
    """Return why a way that begins elsewhere is not driven: to get there straight on may lead through walls."""
    if begin is None:
        return ""
    if here is None:
        return f"{vehicle.description.name} does not know where it is."
    away_m = hypot(begin[0] - here[0], begin[1] - here[1])
    return f"The way begins {away_m:.1f} m from where {vehicle.description.name} will be." if away_m > ASTRAY_M else ""


def _is_point(value: object) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(is_number(c) and abs(c) <= 1e6 for c in value)


def _point(value: object) -> Point | None:
    return (float(value[0]), float(value[1])) if isinstance(value, list) and _is_point(value) else None


def _misfit(vehicle: Vehicle, told: Told) -> str:
    load, count = told.arguments.get("object"), told.arguments.get("value")
    if not isinstance(load, str) or not load:
        return "An object must be named."
    if vehicle.sheet.load_types and load not in vehicle.sheet.load_types:
        return f"{vehicle.description.name} carries {', '.join(vehicle.sheet.load_types)[:150]}, not {load[:40]}."
    most = capacity(vehicle.sheet) or 1
    if count is not None and not (is_number(count) and count in range(1, most + 1)):
        return f"The quantity must be a whole number from 1 to {most}."
    return "" if isinstance(told.arguments.get("device", ""), str) else "device must be a device's id."


def _misfit_of_action(vehicle: Vehicle, told: Told) -> str:
    action = next(a for a in offered_actions(vehicle.sheet) if a.type == told.method)
    kinds = {"BOOL": bool, "STRING": str}
    for parameter in action.parameters:
        value = told.arguments.get(parameter.key)
        if value is None:
            if not parameter.optional:
                return f"{told.method} needs a value for {parameter.key}."
            continue
        fits = isinstance(value, kinds[parameter.type]) if parameter.type in kinds else is_number(value)
        if parameter.type == "INTEGER" and fits:
            fits = value == int(str(value).split(".")[0])
        if not fits:
            return f"{told.method}: {parameter.key} must be of the type {parameter.type}."
    return ""


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

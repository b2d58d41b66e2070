"""Checks of passages: whether each has a door that opens and lies where robots drive, and of doors left open."""

from __future__ import annotations

from collections.abc import Iterator

from editor.language.checks.context import Context
from editor.language.expressions.nodes import Point, Zone
from editor.language.messages.phrases import Options
from editor.language.tree import nodes as n
from editor.language.tree.zones import is_in
from vipo_device.protocol.description import Description
from vipo_device.protocol.doors import DoorMethods, door_methods

LOOKED_AT = 20
"""A passage is looked through at so many points along each side of the box around it."""


def check_passages(context: Context, zones: tuple[Zone, ...]) -> None:
    """Check the zones that are passages of doors."""
    doors: dict[str, DoorMethods] = {}
    for zone in zones:
        if zone.rule == "door":
            device = _door_of(context, zone)
            methods = door_methods(device) if device is not None else None
            if device is not None and methods is not None:
                doors[device.id] = methods
            _check_way_through(context, zone)
    if doors:
        _check_left_open(context, doors)


def _door_of(context: Context, zone: Zone) -> Description | None:
    """Return the device that is opened; what is wrong with it is reported."""
    field = f"zones.{zone.id}"
    if not zone.door:
        context.report_step("", "missing_door", field, {"zone": zone.name})
        return None
    facts = context.surroundings.devices.get(zone.door)
    if facts is None:
        context.report_step("", "unknown_device", field, {"device": zone.door})
        return None
    device = facts.description
    if door_methods(device) is None:
        can = Options(tuple(method.name for method in device.methods))
        context.report_step("", "door_cannot_open", field, {"device": device.name, "zone": zone.name, "options": can})
    elif facts.lifecycle != "approved":
        code = "pending_device" if facts.lifecycle == "pending" else "retired_device"
        context.report_step("", code, field, {"device": device.name})
    elif not facts.online:
        context.report_step("", "offline_device", field, {"device": device.name})
    return device


def _check_way_through(context: Context, zone: Zone) -> None:
    """A passage in which no robot has room, or to which none finds a way, opens for nobody."""
    floor = context.surroundings.floor
    robots = [f.description for f in context.surroundings.devices.values() if f.description.kind == "robot"]
    if floor is None or not robots:
        return
    small = min(robots, key=lambda robot: (robot.radius_m, robot.id))
    free = [point for point in _points_in(zone) if floor.is_free(*point, small.radius_m)]
    for robot in robots:
        here = (robot.pose.x, robot.pose.y)
        if any(floor.is_reachable(here, point, robot.radius_m) for point in free):
            return
    context.report_step("", "passage_nowhere", f"zones.{zone.id}", {"zone": zone.name})


def _points_in(zone: Zone) -> Iterator[Point]:
    """Give points all over a passage and on its sides; a narrow one may have no others."""
    xs, ys = [x for x, _ in zone.points], [y for _, y in zone.points]
    for column in range(LOOKED_AT + 1):
        for row in range(LOOKED_AT + 1):
            x = min(xs) + (max(xs) - min(xs)) * column / LOOKED_AT
            y = min(ys) + (max(ys) - min(ys)) * row / LOOKED_AT
            if is_in((x, y), zone.points):
                yield (x, y)
    for (x1, y1), (x2, y2) in zip(zone.points, (*zone.points[1:], zone.points[0]), strict=True):
        yield ((x1 + x2) / 2, (y1 + y2) / 2)


def _check_left_open(context: Context, doors: dict[str, DoorMethods]) -> None:
    """A door that a step opens stays open until a step closes it, however many robots have passed."""
    tree = context.tree
    blocks = (tree.body, *(event.body for event in tree.events), *(f.body for f in tree.functions))
    told = [node for block in blocks for node in tree.walked(block) if isinstance(node, n.Operate)]
    closed = {
        node.device.device
        for node in told
        if node.device.device in doors and node.method == doors[node.device.device].closes
    }
    for node in told:
        door = node.device.device
        if door in doors and door not in closed and node.method == doors[door].opens and doors[door].closes:
            name = context.surroundings.devices[door].description.name
            context.report(node, "door_left_open", "method", {"device": name})

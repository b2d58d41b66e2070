"""Checks of machines and places on the floor: room to stand beside a machine, and zones."""

from __future__ import annotations

from math import pi

from editor.language.checks.context import Context
from editor.language.expressions import nodes as e
from editor.language.expressions.nodes import PlaceRef, Zone
from editor.language.messages.diagnostics import TextArguments
from editor.language.tree import nodes as n
from editor.language.tree.zones import area_m2, is_in, read_zones
from vipo_device.protocol.description import Description


def check_floor(context: Context, document: object) -> None:
    """Check where robots are sent, and the zones of the document."""
    zones = read_zones(document)
    if context.surroundings.floor is None and not zones:
        return
    tree = context.tree
    closed = [zone for zone in zones if zone.rule == "keep_out"]
    for block in (tree.body, *(event.body for event in tree.events), *(f.body for f in tree.functions)):
        for node in tree.walked(block):
            if isinstance(node, n.LOADS):
                _check_goal(context, node, node.at, node.place_field, closed)
            elif isinstance(node, n.Move) and not node.added:
                _check_goal(context, node, node.to, "to", closed)
    _check_sizes(context, zones)


def _check_goal(
    context: Context, node: n.Move | n.Pick | n.Drop, place: PlaceRef, field: str, closed: list[Zone]
) -> None:
    """Check that the robot finds the machine's station, and that its goal is not kept free of robots."""
    goals = _goals(context, node.role, place)
    if not goals:
        return
    if all(goal is None for goal in goals):
        facts = context.surroundings.devices[place.device or ""]
        names: TextArguments = {"robot": context.robot_name(node.role), "device": facts.description.name}
        context.report(node, "station_unreachable", field, names)
        return
    for zone in closed:
        if all(goal is None or is_in(goal, zone.points) for goal in goals):
            context.report(node, "place_in_keep_out", field, {"zone": zone.name})
            return


def _goals(context: Context, role: str, place: PlaceRef) -> tuple[e.Point | None, ...]:
    """Return where each robot of the role would stand, None where it cannot; empty when that is not known."""
    if place.point is not None:
        return (place.point,)
    named = context.surroundings.places.get(place.place or "")
    if named is not None:
        return ((named.x, named.y),)
    floor, key = context.surroundings.floor, (role, place.device or "")
    if place.device is None or floor is None or not floor.has_machine(place.device):
        return ()
    if key not in context.stations:
        robots = context.robots(role)
        context.stations[key] = tuple(_station(context, place.device, robot) for robot in robots)
    return context.stations[key]


def _station(context: Context, device: str, robot: Description) -> e.Point | None:
    floor = context.surroundings.floor
    station = None if floor is None else floor.station(device, robot.radius_m)
    if floor is None or station is None:
        return None
    here = (robot.pose.x, robot.pose.y)
    return station if floor.is_reachable(here, station, robot.radius_m) else None


def _check_sizes(context: Context, zones: tuple[Zone, ...]) -> None:
    """A zone in which not even the smallest robot has room changes nothing for any."""
    robots = [f.description for f in context.surroundings.devices.values() if f.description.kind == "robot"]
    smallest = min(robots, key=lambda robot: (robot.radius_m, robot.id), default=None)
    for zone in zones:
        if smallest is not None and area_m2(zone.points) < pi * smallest.radius_m**2:
            context.report_step("", "zone_too_small", f"zones.{zone.id}", {"zone": zone.name, "robot": smallest.name})

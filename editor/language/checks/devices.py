"""Checks of devices and places: whether they exist, can do what is asked, can be reached, and have room beside them."""

from __future__ import annotations

from functools import partial
from math import pi

from editor.language.checks.context import Context
from editor.language.checks.doors import check_passages
from editor.language.checks.possible import check_each_device, check_held_device, check_held_place
from editor.language.checks.robot_readings import check_robot_reading, tell_unknown
from editor.language.expressions import nodes as e
from editor.language.expressions.names import ROBOT_METHODS
from editor.language.expressions.nodes import Constant, Located, PlaceRef, Reading, Zone
from editor.language.expressions.ranges import Here
from editor.language.messages.diagnostics import Fix, TextArguments
from editor.language.messages.phrases import Options
from editor.language.site.surroundings import DeviceFacts, ZoneFacts
from editor.language.tree import nodes as n
from editor.language.tree.program import Role
from editor.language.tree.robots import robots_for
from editor.language.tree.zones import area_m2, is_in, read_zones
from vipo_device.protocol.description import Description

MOST_ROUTE_POINTS = 100
"""A way leads over so many points."""
USUAL_RADIUS_M = 0.18
"""What traffic takes for robots that do not say their size."""


def known_device(context: Context, node: n.Node, device_id: str, field: str) -> DeviceFacts | None:
    """Return a device that the program may use, now or later; what is wrong with it is reported."""
    facts = context.surroundings.devices.get(device_id)
    if facts is None:
        context.report(node, "unknown_device", field, {"device": device_id})
        return None
    name = {"device": facts.description.name}
    if facts.lifecycle == "pending":
        context.report(node, "pending_device", field, name)
    elif facts.lifecycle == "retired":
        context.report(node, "retired_device", field, name)
    elif not facts.online:
        context.report(node, "offline_device", field, name)
    return facts


def usable_device(
    context: Context, node: n.Node, place: PlaceRef, field: str, missing_code: str
) -> Description | None:  # fmt: skip
    """Return the description of the machine that a step names, if it is known before the run."""
    if place.device is not None:
        facts = known_device(context, node, place.device, field)
        return None if facts is None else facts.description
    if place.value is None:
        context.report(node, missing_code, field)
    return None


def check_load_place(context: Context, node: n.Pick | n.Drop, *, gives: bool) -> None:
    """Check where a pick or a drop happens: a machine that gives or takes the object."""
    missing = "missing_source" if gives else "missing_target"
    device = usable_device(context, node, node.at, node.place_field, missing)
    if device is not None:
        _check_load_at(context, node, device, gives=gives)
    check_held_device(
        context, node, node.at, node.place_field, lambda f: _check_load_at(context, node, f.description, gives=gives)
    )


def _check_load_at(context: Context, node: n.Pick | n.Drop, device: Description, *, gives: bool) -> None:
    if device.kind == "robot":
        context.report(node, "robot_as_place", node.place_field, {"device": device.name})
        return
    things = device.gives if gives else device.takes
    words = Here(context.surroundings, context.known).words(node.object)
    for thing in sorted(map(str, words)) if words and words.isdisjoint(things) else ():
        details: TextArguments = {"device": device.name, "object": thing, "options": Options(things)}
        fix = None
        if len(things) == 1 and gives:
            fix = Fix("set_to", node.step, "object", things[0], {"value": things[0]})
        context.report(node, "not_given" if gives else "not_taken", node.place_field, details, fix)
        return


def check_place(context: Context, node: n.Move, place: PlaceRef, field: str, missing_code: str) -> None:
    """Check where a robot is sent."""
    check_held_place(context, node, place, field, lambda facts: _check_goal_device(context, node, facts, field))
    if place.device is not None:
        known = known_device(context, node, place.device, field)
        if known is not None:
            _check_goal_device(context, node, known, field)
    elif place.place is not None:
        facts = context.surroundings.places.get(place.place)
        if facts is None:
            context.report(node, "unknown_place", field, {"place": place.place})
        else:
            _check_floor(context, node, (facts.x, facts.y), field)
    elif place.point is not None:
        _check_floor(context, node, place.point, field)
    elif place.value is None:
        context.report(node, missing_code, field)


def check_route_length(context: Context, node: n.Move) -> None:
    """A way leads over a limited number of points: each is kept with every state of the floor."""
    if len(node.route) > MOST_ROUTE_POINTS:
        context.report(node, "route_too_long", "route", {"count": len(node.route), "most": MOST_ROUTE_POINTS})


def _check_goal_device(context: Context, node: n.Move, facts: DeviceFacts, field: str) -> None:
    """A robot stands beside machines, not beside other robots: these go where they like."""
    if facts.description.kind == "robot":
        context.report(node, "robot_as_goal", field, {"device": facts.description.name})


def _check_floor(context: Context, node: n.Move, point: e.Point, field: str) -> None:
    """Check that the robot fits at a point and finds a path to it; for any robot it is enough that one does."""
    floor, robots = context.surroundings.floor, context.robots(node.role)
    if floor is None:
        return
    if not floor.is_inside(*point):
        context.report(node, "place_outside", field)
        return
    if not robots:
        return
    name = {"robot": context.robot_name(node.role)}
    if not any(floor.is_free(*point, robot.radius_m) for robot in robots):
        context.report(node, "place_blocked", field, name)
    elif not any(floor.is_reachable((r.pose.x, r.pose.y), point, r.radius_m) for r in robots):
        context.report(node, "place_unreachable", field, name)
    elif not floor.can_stop(*point, context.largest_radius_m(USUAL_RADIUS_M)):
        context.report(node, "place_blocked", field, name)


def check_reading(context: Context, node: n.Node, reading: Reading, field: str) -> None:
    """Check a reading against what the device reports."""
    if isinstance(reading.device, Constant):
        facts = known_device(context, node, str(reading.device.value), field)
        if facts is not None:
            _check_reported(context, node, reading, field, facts)
    elif isinstance(reading.device, Located):
        check_robot_reading(context, node, reading, field)
    else:
        check = partial(_check_reported, context, node, reading, field)
        check_each_device(context, node, reading.device, field, check)


def _check_reported(context: Context, node: n.Node, reading: Reading, field: str, facts: DeviceFacts) -> None:
    if facts.description.property(reading.property) is None:
        tell_unknown(context, node, reading, field, facts.description)


def check_role(context: Context, node: n.Node, role: Role, needed: tuple[str, ...]) -> None:
    """Check that there is a robot for a role; it is reported at the first step that needs it."""
    field = n.robot_field(node)
    told = {method for method in needed if _is_told_at_its_step(context, role, method)}
    if role.device is not None:
        facts = known_device(context, node, role.device, field)
        if facts is None:
            return
        description = facts.description
        if description.kind != "robot":
            context.report(node, "not_a_robot", field, {"device": description.name, "role": role.name})
            return
        for method in needed:
            if method not in told and description.method(method) is None:
                context.report(node, "cannot_do", field, {"device": description.name, "method": method})
        return
    robots = context.robots(role.name)
    methods: TextArguments = {"methods": Options(role.can, "and")}
    if not robots:
        if not told:
            context.report(node, "no_robot_can", field, methods)
    elif not any(context.surroundings.devices[robot.id].online for robot in robots):
        context.report(node, "no_robot_online", field, methods)


def _is_told_at_its_step(context: Context, role: Role, method: str) -> bool:
    """Tell whether a method that a role needs is one that no robot in question has, which its step tells."""
    offering = robots_for(context.surroundings, role.device, ())
    return method not in ROBOT_METHODS and not any(robot.method(method) for robot in offering)


def check_floor(context: Context, document: object) -> None:
    """Check where robots are sent, against the zones of the document and of the site's floor, and those themselves."""
    zones, of_site = read_zones(document), context.surroundings.zones
    if context.surroundings.floor is None and not zones and not of_site:
        return
    tree = context.tree
    everywhere: tuple[Zone | ZoneFacts, ...] = (*zones, *of_site)
    closed = [zone for zone in everywhere if zone.rule == "keep_out"]
    for block in (tree.body, *(event.body for event in tree.events), *(f.body for f in tree.functions)):
        for node in tree.walked(block):
            if isinstance(node, n.LOADS):
                _check_goal(context, node, node.at, node.place_field, closed)
            elif isinstance(node, n.Move):
                if not node.added:
                    _check_goal(context, node, node.to, "to", closed)
                _check_route(context, node, closed)
    _check_sizes(context, zones)
    check_passages(context, zones)


def _check_goal(
    context: Context, node: n.Move | n.Pick | n.Drop, place: PlaceRef, field: str, closed: list[Zone | ZoneFacts]
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


def _check_route(context: Context, node: n.Move, closed: list[Zone | ZoneFacts]) -> None:
    """Check that any robot of the role can drive over the points of a way; the first that none can is told."""
    for number, point in enumerate(node.route[:MOST_ROUTE_POINTS], start=1):
        zone = next((zone for zone in closed if is_in(point, zone.points)), None)
        if zone is not None:
            context.report(node, "route_in_keep_out", "route", {"number": number, "zone": zone.name})
            return
        if not _is_passed(context, node.role, point):
            context.report(node, "route_blocked", "route", {"number": number, "robot": context.robot_name(node.role)})
            return


def _is_passed(context: Context, role: str, point: e.Point) -> bool:
    """Tell whether some robot of a role fits at a point and finds a path to it; true where nobody knows."""
    floor, robots = context.surroundings.floor, context.robots(role)
    if floor is None or not robots:
        return floor is None or floor.is_inside(*point)
    if not floor.can_stop(*point, context.largest_radius_m(USUAL_RADIUS_M)):
        return False
    fitting = (robot for robot in robots if floor.is_free(*point, robot.radius_m))
    return any(floor.is_reachable((robot.pose.x, robot.pose.y), point, robot.radius_m) for robot in fitting)


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
    """A zone in which not even the smallest robot has room changes nothing for any; a passage may be narrow."""
    robots = [f.description for f in context.surroundings.devices.values() if f.description.kind == "robot"]
    smallest = min(robots, key=lambda robot: (robot.radius_m, robot.id), default=None)
    for zone in zones:
        if zone.rule != "door" and smallest is not None and area_m2(zone.points) < pi * smallest.radius_m**2:
            context.report_step("", "zone_too_small", f"zones.{zone.id}", {"zone": zone.name, "robot": smallest.name})

"""Checks of what a role's robot tells of itself: all robots that may have the role must tell it, in the same way."""

from __future__ import annotations

from itertools import islice

from editor.language.checks.context import Context
from editor.language.expressions.nodes import Located, Reading
from editor.language.expressions.value_types import property_spec
from editor.language.messages.diagnostics import TextArguments
from editor.language.messages.phrases import Options
from editor.language.tree import nodes as n
from editor.language.tree.choice import surely_read
from editor.language.tree.robots import Robots, joined_spec, readings_told
from vipo_device.protocol.description import Description, PropertySpec

Told = list[tuple[Description, PropertySpec | None]]

MOST_NAMED = 12
"""So many readings are named at most where all that robots tell could be named."""


def check_robot_reading(context: Context, node: n.Node, reading: Reading, field: str) -> None:
    """Check the reading of a role's robot against the descriptions of all robots that may have the role."""
    role = context.roles.get(reading.device.role or "") if isinstance(reading.device, Located) else None
    robots: Robots = () if role is None else context.surroundings.crew.robots(role.name)
    if role is None or not robots:
        return  # that there is no robot for it is told where the role is first used
    told = context.surroundings.crew.told_by(role.name, reading.property)
    if any(told):
        _check_alike(context, node, reading, field, list(zip(robots, told, strict=True)))
        if None in told and reading.property not in surely_read(role.where):
            silent = robots[told.index(None)]
            details: TextArguments = {"device": silent.name, "role": role.name, "property": reading.property}
            context.report(node, "may_not_tell", field, details)
    elif role.device is not None:
        tell_unknown(context, node, reading, field, robots[0])
    else:
        options = Options(tuple(islice(readings_told(robots), MOST_NAMED)))
        context.report(
            node, "no_robot_tells", field, {"role": role.name, "property": reading.property, "options": options}
        )


def tell_unknown(context: Context, node: n.Node, reading: Reading, field: str, device: Description) -> None:
    """Say that a device does not report this, and what it reports."""
    options = Options(tuple(spec.name for spec in device.properties))
    details: TextArguments = {"device": device.name, "property": reading.property, "options": options}
    context.report(node, "unknown_property", field, details)


def _check_alike(context: Context, node: n.Node, reading: Reading, field: str, told: Told) -> None:
    """Tell of robots that measure the same in kinds or units that differ: what it is worth could not be said."""
    if property_spec(reading, context.surroundings) is None:
        specs = [(robot, spec) for robot, spec in told if spec is not None]
        first, spec = specs[0]
        other = next(robot for robot, each in specs if joined_spec([spec, each]) is None)
        names: TextArguments = {"first": first.name, "second": other.name, "property": reading.property}
        context.report(node, "readings_differ", field, names)

"""Checks of an Operate whose device is a robot: whether robots offer the method, alike, and take what is given."""

from __future__ import annotations

from editor.language.checks.context import Context
from editor.language.checks.values import check_given
from editor.language.expressions.names import ROBOT_METHODS
from editor.language.messages.diagnostics import Fix, TextArguments
from editor.language.messages.phrases import Options
from editor.language.tree import nodes as n
from editor.language.tree.robots import Robots, described_alike, own_methods, robots_for
from vipo_device.protocol.description import MethodSpec

MOST_NAMED = 12
"""So many methods are named at most where all that robots offer could be named."""


def check_own_method(context: Context, node: n.Perform) -> None:
    """Check a method of a robot's own against the descriptions of all robots that may take the role."""
    role = context.roles[node.role]
    offering = robots_for(context.surroundings, role.device, ())
    if not node.method:
        _ask_for_method(context, node, offering)
    elif node.method in ROBOT_METHODS:
        context.report(node, "step_of_its_own", "method", {"method": node.method})
    elif offering and not any(robot.method(node.method) for robot in offering):
        _tell_unknown(context, node, offering)
    else:
        _check_arguments(context, node, context.robots(node.role))


def _ask_for_method(context: Context, node: n.Perform, robots: Robots) -> None:
    known = own_methods(robots)
    fix = Fix("choose", node.step, "method", known[0], {"value": known[0]}) if len(known) == 1 else None
    context.report(node, "missing_own_method", "method", {"options": Options(known[:MOST_NAMED])}, fix)


def _tell_unknown(context: Context, node: n.Perform, robots: Robots) -> None:
    """Say that nobody can do this, and what can be done."""
    usual = [name for name in ROBOT_METHODS if any(robot.method(name) for robot in robots)]
    options = Options((*usual, *own_methods(robots))[:MOST_NAMED])
    if context.roles[node.role].device is not None:
        details: TextArguments = {"device": robots[0].name, "method": node.method, "options": options}
        context.report(node, "unknown_method", "method", details)
    else:
        context.report(node, "no_robot_offers", "method", {"method": node.method, "options": options})


def _check_arguments(context: Context, node: n.Perform, robots: Robots) -> None:
    """Check what is given against each description: limits may differ from robot to robot, the parameters may not."""
    described = {robot.id: method for robot in robots if (method := robot.method(node.method)) is not None}
    if not described:
        return
    if described_alike(robots, node.method) is None:
        first = robots[0]
        other = next(r for r in robots if described_alike((first, r), node.method) is None)
        names: TextArguments = {"first": first.name, "second": other.name, "method": node.method}
        context.report(node, "methods_differ", "method", names)
        return
    for method in dict.fromkeys(_bare(method) for method in described.values()):
        check_given(context, node, method)


def _bare(method: MethodSpec) -> MethodSpec:
    """Return what matters of a method here, so that robots that say the same are looked at once."""
    return MethodSpec(method.name, "", parameters=method.parameters)

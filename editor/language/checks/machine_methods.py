"""Checks of what machines are asked to do and given, also where a variable names the machine."""

from __future__ import annotations

from editor.language.checks.context import Context
from editor.language.checks.devices import usable_device
from editor.language.checks.possible import check_held_device
from editor.language.checks.values import check_given
from editor.language.expressions.nodes import Expression
from editor.language.expressions.temperatures import go_together, is_temperature
from editor.language.expressions.value_types import UNITS_DIFFER, TypeChecker, unit_word, units_that_differ
from editor.language.messages.diagnostics import Fix, TextArguments
from editor.language.messages.phrases import Options
from editor.language.tree import nodes as n
from vipo_device.protocol.description import Description
from vipo_device.protocol.units import UNSAID, is_measure


def check_operate(context: Context, node: n.Operate) -> None:
    """Check what a machine is asked to do; of one that a variable names, each that it may be."""
    device = usable_device(context, node, node.device, "device", "missing_machine")
    if device is not None:
        _operate_at(context, node, device)
    if node.device.value is not None:
        _check_units(context, node, node.device.value)  # first: who fits but for a unit told of here, fits
    check_held_device(context, node, node.device, "device", lambda f: _operate_at(context, node, f.description))


def _operate_at(context: Context, node: n.Operate, device: Description) -> None:
    """Check what a device is asked to do against its description."""
    known = Options(tuple(method.name for method in device.methods))
    if not node.method:
        fix = None
        if len(device.methods) == 1:
            only = device.methods[0].name
            fix = Fix("choose", node.step, "method", only, {"value": only})
        context.report(node, "missing_method", "method", {"device": device.name, "options": known}, fix)
        return
    method = device.method(node.method)
    if method is None:
        details: TextArguments = {"device": device.name, "method": node.method, "options": known}
        context.report(node, "unknown_method", "method", details)
        return
    check_given(context, node, method)


def _check_units(context: Context, node: n.Operate, device: Expression) -> None:
    """Check what is measured against the unit in which each device counts that may be meant; all must count alike.

    Nothing is said where the variable holds no device, as in a function that nobody calls. Of a device that is known
    to have no such parameter it is told otherwise.
    """
    checker = TypeChecker(context.surroundings, context.variables, [])
    held = checker.type_of(device).held
    crew = context.surroundings.crew
    if not crew.held(held):
        return
    taken = crew.units_taken(held, node.method)
    chosen = held is None or any(each.is_chosen for each in held)
    for name, value in node.arguments:
        field, given = f"args.{name}", checker.type_of(value).unit
        if not is_measure(given) or (name not in taken and not chosen):
            continue
        first, other = taken.get(name, (None, None))
        units = [UNSAID if each is None else each[1] for each in (first, other or first)]
        wanted = next((unit for unit in units if not go_together(given, unit)), None)
        if wanted is not None:
            alike = is_temperature(given) and is_temperature(wanted)
            code = "temperature_or_difference" if alike else "wrong_unit" if is_measure(wanted) else "unit_not_taken"
            words = {"subject": name.capitalize(), "wanted": unit_word(wanted), "given": unit_word(given)}
            context.report(node, code, field, words)
        elif first is not None and other is not None:
            context.report(node, UNITS_DIFFER, field, units_that_differ(name, first, other))

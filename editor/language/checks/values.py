"""Checks of values: what is missing, of the wrong type or unit, or out of its range."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import inf
from typing import Any

from editor.language.checks.context import Context
from editor.language.checks.devices import check_reading, known_device
from editor.language.expressions import nodes as e
from editor.language.expressions.constant_values import constant_value
from editor.language.expressions.nodes import Constant, Expression, Located, Operation, Reading, Variable
from editor.language.expressions.ranges import ANY, NOTHING_KNOWN, Here, Range, possible
from editor.language.expressions.temperatures import base_unit, go_together, is_difference, is_scale, is_temperature
from editor.language.expressions.unit_conversion import convert_units
from editor.language.expressions.value_types import (
    BOOLEAN,
    NUMBER,
    TEXT,
    TYPE_WORDS,
    UNKNOWN_TYPE,
    TypeChecker,
    ValueType,
    plain_type,
    property_spec,
    type_of_scalar,
    type_word,
    unit_word,
)
from editor.language.expressions.values import MOST_ITEMS, is_number, parts_of
from editor.language.messages.diagnostics import Fix, TextArguments, fix_value
from editor.language.messages.phrases import Amounts, Driver, Options, Plural, Span
from editor.language.tree import nodes as n
from vipo_device.protocol.description import MethodSpec, ParameterSpec
from vipo_device.protocol.units import PLAIN, declared_unit, is_measure


def has_missing(expression: Expression) -> bool:
    """Tell whether the expression, or a part of it, is still to be entered."""
    if isinstance(expression, Constant):
        return expression.value is None
    if isinstance(expression, Operation):
        return any(map(has_missing, expression.arguments))
    return isinstance(expression, Reading) and has_missing(expression.device)


def check_value(
    context: Context, node: n.Node, value: Expression, field: str, wanted: ValueType, subject: str
) -> bool:  # fmt: skip
    """Check what a value reads and of which type and unit it is; tell whether it is good."""
    before = len(context.found)
    if isinstance(value, Constant) and not isinstance(value.value, tuple):
        value_type = type_of_scalar(value.value)
    else:
        value_type = _check_parts(context, node, value, field)
    if value_type.type and wanted.type and value_type.type != plain_type(wanted.type):
        details = {"subject": subject, "wanted": TYPE_WORDS[wanted.type], "given": TYPE_WORDS[value_type.type]}
        context.report(node, "wrong_type", field, details)
    elif value_type.of and wanted.of and value_type.of != wanted.of:
        details = {"subject": subject, "wanted": type_word(wanted), "given": type_word(value_type)}
        context.report(node, "wrong_type", field, details)
    elif value_type.type == "number" == wanted.type or value_type.of == "number" == wanted.of:
        _check_unit(context, node, value, field, (value_type.unit, wanted.unit), subject)
    return len(context.found) == before


def _check_parts(context: Context, node: n.Node, value: Expression, field: str) -> ValueType:
    """Check what a value is worked out from, and return its type."""
    for part in parts_of(value):
        if (check := _CHECKS.get(part.__class__)) is not None:
            check(context, node, part, field)
    checker = TypeChecker(context.surroundings, context.variables, [])
    value_type = checker.type_of(value)
    for mismatch in checker.mismatches:
        context.report(node, mismatch.code, field, mismatch.args)
    return value_type


def _check_operation(context: Context, node: n.Node, part: Operation, field: str) -> None:
    if part.operator == "/":
        _check_divisor(context, node, part.arguments[1], field)
    elif part.operator == "nth":
        _check_number_of_item(context, node, part, field)
    elif part.operator == "list":
        check_length(context, node, part.arguments, field)


def _check_divisor(context: Context, node: n.Node, value: Expression, field: str) -> None:
    """Tell of what is divided by nothing else than 0, or by what may be 0 as far as it is known.

    Of variables nothing is known before the paths are followed, which tell then.
    """
    divisor = range_in(context, value, "")
    if divisor.least == divisor.most == 0:
        context.report(node, "divided_by_zero", field)
    elif divisor != ANY and divisor.has_zero and not _is_unknown_yet(context, value):
        context.report(node, "may_divide_by_zero", field)


def _is_unknown_yet(context: Context, value: Expression) -> bool:
    return context.known is NOTHING_KNOWN and any(isinstance(part, Variable) for part in parts_of(value))


def _check_number_of_item(context: Context, node: n.Node, part: Operation, field: str) -> None:
    """Tell of an item that the list does not have, or may not have as far as it is known."""
    here = Here(context.surroundings, context.known)
    items, number = here.items(part.arguments[0]), here.range(converted(context, part.arguments[1], ""))
    if number.is_fraction or number.most < 1 or (items is not None and number.least > items.most):
        context.report(node, "no_such_item", field)
        return
    told = context.known is not NOTHING_KNOWN and items is not None and number != ANY
    if told and items is not None and (number.least < 1 or number.most > items.least):
        context.report(node, "may_be_no_such_item", field)


def _check_constant(context: Context, node: n.Node, part: Constant, field: str) -> None:
    if isinstance(part.value, tuple):
        check_length(context, node, part.value, field)


def check_length(context: Context, node: n.Node, items: Sequence[object], field: str) -> None:
    """Tell of a list that is longer than a list can be."""
    if len(items) > MOST_ITEMS:
        context.report(node, "list_too_long", field, {"count": len(items)})


def check_limits(  # noqa: PLR0913 - a value, its limits, and how to speak of it
    context: Context,
    node: n.Node,
    field: str,
    found: Range,
    limits: tuple[float | None, float | None],
    subject: str,
    unit: str,
) -> None:
    """Tell of numbers that all lie outside of what is allowed, or some of them as far as variables are known."""
    least = -inf if limits[0] is None else limits[0]
    most = inf if limits[1] is None else limits[1]
    details: TextArguments = {"subject": subject, "range": Span(*limits, unit_word(unit))}
    if found.most < least or found.least > most:
        context.report(node, "out_of_range", field, details)
    elif context.known is not NOTHING_KNOWN and found != ANY and (found.least < least or found.most > most):
        context.report(node, "may_be_out_of_range", field, details)


def _check_unit(
    context: Context, node: n.Node, value: Expression, field: str, units: tuple[str, str], subject: str
) -> None:
    """Check a number against the unit that is wanted of it."""
    given, wanted = units
    code, fix = "", None
    if is_measure(wanted):
        if is_measure(given) and not go_together(given, wanted):
            alike = is_temperature(given) and is_temperature(wanted)
            code = "temperature_or_difference" if alike else "wrong_unit"
        elif given == PLAIN:
            code, fix = "plain_number", _with_unit(context, node, value, field, ("*", wanted))
    elif is_measure(given) and (wanted == PLAIN or not isinstance(value, Reading)):
        code, fix = "unit_not_taken", _with_unit(context, node, value, field, ("/", given))
    if code:
        words = {"subject": subject, "wanted": unit_word(wanted), "given": unit_word(given)}
        context.report(node, code, field, words, fix)


def _with_unit(
    context: Context, node: n.Node, value: Expression, field: str, into: tuple[str, str]
) -> Fix | None:  # fmt: skip
    """Return the fix that takes a value in a unit, or takes the unit from it; a list has one for each item."""
    raw, (operator, unit) = context.raw_value(node.step, field), into
    if raw is None or TypeChecker(context.surroundings, context.variables, []).type_of(value).type == "list":
        return None
    taken = {"op": operator, "args": [raw, {"quantity": [1, base_unit(unit)]}]}
    return Fix("take_in" if operator == "*" else "number_of", node.step, field, taken, {"value": unit_word(unit)})


def check_difference(
    context: Context, node: n.Node, value: Expression, field: str, unit: str, subject: str
) -> None:  # fmt: skip
    """Check that no function takes or gives a difference of temperatures in °C or °F, where it would count as one."""
    given = TypeChecker(context.surroundings, context.variables, []).type_of(value).unit
    if is_difference(given) and is_scale(unit):
        context.report(node, "difference_needs_kelvins", field, {"subject": subject, "wanted": unit_word(unit)})


def check_kept(
    context: Context, node: n.Node, value: Expression, field: str, kept: ValueType, subject: str
) -> None:  # fmt: skip
    """Check a value that a variable takes, which is kept in a unit: one that is written out has to say it, too."""
    if not check_value(context, node, value, field, kept, subject) or not is_measure(kept.unit):
        return
    unit = TypeChecker(context.surroundings, context.variables, []).type_of(value).unit
    has_zero = not is_temperature(kept.unit) or is_difference(kept.unit)
    empty = isinstance(value, Operation) and value.operator == "list" and not value.arguments
    if unit or empty or (has_zero and constant_value(value) == 0):
        return
    words = {"subject": subject, "wanted": unit_word(kept.unit)}
    fix = _with_unit(context, node, value, field, ("*", kept.unit))
    if isinstance(value, Constant) and is_number(value.value):
        shown = f"{value.value} {unit_word(kept.unit)}"
        fix = Fix("set_to", node.step, field, {"quantity": [value.value, base_unit(kept.unit)]}, {"value": shown})
    context.report(node, "plain_number", field, words, None if field == "items" else fix)


def _check_thing(context: Context, node: n.Node, part: Located, field: str) -> None:
    """Check that the device, place or zone that an expression speaks of exists."""
    if part.device is not None:
        known_device(context, node, part.device, field)
    elif part.place is not None and part.place not in context.surroundings.places:
        context.report(node, "unknown_place", field, {"place": part.place})
    elif part.zone is not None and part.zone not in context.zones:
        context.report(node, "unknown_zone", field, {"zone": part.zone})


_CHECKS: Mapping[type[Expression], Callable[[Context, n.Node, Any, str], None]] = {
    Constant: _check_constant,
    Reading: check_reading,
    Operation: _check_operation,
    Located: _check_thing,
}
"""What is checked of each part of a value."""


def converted(context: Context, value: Expression, unit: str) -> Expression:
    """Return a value as it is in a unit when the program runs."""
    if isinstance(value, Constant):
        return value
    return convert_units(value, unit, TypeChecker(context.surroundings, context.variables, []))


def range_in(context: Context, value: Expression, unit: str) -> Range:
    """Return between which numbers a value lies whenever it is asked for, in this unit."""
    return Here(context.surroundings, context.known).range(converted(context, value, unit))


def check_condition(context: Context, node: n.Node, condition: Expression, field: str) -> None:
    """Check a condition: it must be there, and give yes or no."""
    if has_missing(condition):
        context.report(node, "missing_condition", field)
    elif check_value(context, node, condition, field, BOOLEAN, "A condition"):
        _check_possible(context, node, condition, field)


def _check_possible(context: Context, node: n.Node, condition: Expression, field: str) -> None:
    """Tell of a condition that can never hold, or always does, in the ranges that its devices declare."""
    site, types = context.surroundings, context.variables
    waits = isinstance(node, n.WaitUntil) and node.timeout_s is None
    if waits and possible(condition, site, types, context.known) is False:
        context.report(node, "waits_for_ever", field)
        return
    verdict = possible(condition, site, types)
    if verdict is None:
        return
    if constant_value(condition) is None:
        reading = _first_limited_reading(context, condition)
        if verdict is False and _each_is_possible(context, condition):
            context.report(node, "contradiction", field)
        elif reading is not None:
            code = "always_true_in_range" if verdict else "never_true_in_range"
            context.report(node, code, field, _declared(context, reading))


def _first_limited_reading(context: Context, expression: Expression) -> Reading | None:
    """Return the first reading of an expression for which its device declares a range or options."""
    for part in parts_of(expression):
        spec = property_spec(part, context.surroundings) if isinstance(part, Reading) else None
        limited = spec is not None and (spec.minimum is not None or spec.maximum is not None or spec.options)
        if isinstance(part, Reading) and limited:
            return part
    return None


def _each_is_possible(context: Context, condition: Expression) -> bool:
    """Tell whether conditions that never hold together could each hold alone."""
    if not isinstance(condition, Operation) or condition.operator != "and":
        return False
    site, variables = context.surroundings, context.variables
    return all(possible(argument, site, variables) is not False for argument in condition.arguments)


def _declared(context: Context, reading: Reading) -> TextArguments:
    """Return what a device declares of its property, for a sentence."""
    spec = property_spec(reading, context.surroundings)
    if isinstance(reading.device, Located):
        name: str | Driver = context.driver_name(reading.device.role or "")
    else:
        device = str(reading.device.value) if isinstance(reading.device, Constant) else ""
        facts = context.surroundings.devices.get(device)
        name = device if facts is None else facts.description.name
    limits: Options | Span = Options(())
    if spec is not None:
        span = Span(spec.minimum, spec.maximum, unit_word(spec.unit))
        limits = Options(spec.options, "or") if spec.options else span
    return {"device": name, "property": reading.property, "range": limits}


def check_argument(  # noqa: PLR0913 - one argument is checked in the light of all of these
    context: Context,
    node: n.Node,
    parameter: ParameterSpec,
    value: Expression,
    method: str,
    missing_code: str,
    *,
    typed: bool = True,
) -> None:
    """Check one argument of a method or a function against what is declared of it."""
    field = f"args.{parameter.name}"
    if has_missing(value):
        if parameter.required or value != e.MISSING:
            span = Span(parameter.minimum, parameter.maximum, unit_word(parameter.unit), ": ")
            details = {"argument": parameter.name, "method": method, "function": method}
            fix = None if parameter.minimum is None else fix_value(node.step, field, parameter.minimum)
            context.report(node, missing_code, field, {**details, "range": span}, fix)
        return
    wanted = ValueType(parameter.type, declared_unit(parameter.unit)) if typed else UNKNOWN_TYPE
    if not check_value(context, node, value, field, wanted, parameter.name.capitalize()):
        return
    value = converted(context, value, parameter.unit)
    if isinstance(value, Constant):
        _check_limits(context, node, parameter, value, field)
    elif parameter.type == "number":
        found = Here(context.surroundings, context.known).range(value)
        limits = parameter.minimum, parameter.maximum
        check_limits(context, node, field, found, limits, parameter.name.capitalize(), parameter.unit)


def check_given(context: Context, node: n.Operate | n.Perform, method: MethodSpec) -> None:
    """Check what a machine or a robot is given with a method: each parameter, and that there is nothing else."""
    given = dict(node.arguments)
    for parameter in method.parameters:
        value = given.pop(parameter.name, e.MISSING)
        check_argument(context, node, parameter, value, node.method, "missing_argument")
    options = Options(tuple(parameter.name for parameter in method.parameters))
    for name in given:
        details: TextArguments = {"method": node.method, "argument": name, "options": options}
        fix = Fix("remove", node.step, f"args.{name}", None, {"value": name})
        context.report(node, "unknown_argument", f"args.{name}", details, fix)


def _check_limits(context: Context, node: n.Node, parameter: ParameterSpec, value: Constant, field: str) -> None:
    given, subject = value.value, parameter.name.capitalize()
    if parameter.options and given not in parameter.options:
        context.report(node, "not_an_option", field, {"subject": subject, "options": Options(parameter.options)})
    if not is_number(given):
        return
    nearest = given
    if parameter.minimum is not None:
        nearest = max(nearest, parameter.minimum)
    if parameter.maximum is not None:
        nearest = min(nearest, parameter.maximum)
    if nearest != given:
        limits = Span(parameter.minimum, parameter.maximum, unit_word(parameter.unit))
        fix = fix_value(node.step, field, int(nearest) if float(nearest).is_integer() else nearest)
        context.report(node, "out_of_range", field, {"subject": subject, "range": limits}, fix)


def check_quantity(context: Context, node: n.Pick | n.Drop) -> None:
    """Check how many of what is carried."""
    _check_object(context, node)
    capacity = context.capacity(node.role)
    robot = context.robot_name(node.role)
    if has_missing(node.quantity):
        thing = node.object.value if isinstance(node.object, Constant) else None
        details = {"things": Plural(thing if isinstance(thing, str) else "")}
        fix = fix_value(node.step, "quantity", 1)
        context.report(
            node, "missing_quantity", "quantity", {**details, "robot": robot, "range": Amounts(capacity)}, fix
        )
        return
    if not check_value(context, node, node.quantity, "quantity", NUMBER, "The quantity"):
        return
    found = range_in(context, node.quantity, "")
    if found.most <= 0 or found.is_fraction:
        context.report(node, "quantity_not_positive", "quantity", {}, fix_value(node.step, "quantity", 1))
    elif capacity and found.least > capacity:
        fix = fix_value(node.step, "quantity", capacity)
        context.report(node, "quantity_above_capacity", "quantity", {"robot": robot, "range": Amounts(capacity)}, fix)
    else:
        check_limits(context, node, "quantity", found, (1, capacity or None), "The quantity", "")


def _check_object(context: Context, node: n.Pick | n.Drop) -> None:
    if not has_missing(node.object):
        check_value(context, node, node.object, "object", TEXT, "The object")
        return
    facts = context.surroundings.devices.get(node.at.device or "")
    if facts is None:
        things = sorted({thing for f in context.surroundings.devices.values() for thing in f.description.gives})
    else:
        things = list(facts.description.gives if isinstance(node, n.Pick) else facts.description.takes)
    fix = fix_value(node.step, "object", things[0]) if len(things) == 1 else None
    context.report(
        node, "missing_object", "object", {"options": Options(tuple(things), "or", "there is nothing here")}, fix
    )

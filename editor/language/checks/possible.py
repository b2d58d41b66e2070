"""Checks of a device or a place that a variable holds: each that it may be here is checked as if it stood there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from editor.language.checks.context import Context
from editor.language.expressions.nodes import Expression, PlaceRef, Variable
from editor.language.expressions.ranges import Here
from editor.language.expressions.value_types import TYPE_WORDS, TypeChecker
from editor.language.messages.diagnostics import Problem
from editor.language.messages.en import TEXTS
from editor.language.site.surroundings import DeviceFacts
from editor.language.tree import nodes as n

Found = list[tuple[Problem, int]]
_OF_UNITS = frozenset({"wrong_unit", "unit_not_taken", "temperature_or_difference"})


def check_held_device(
    context: Context, node: n.Node, place: PlaceRef, field: str, check: Callable[[DeviceFacts], None]
) -> None:
    """Check a step at every device that its variable may hold here; a place is none."""
    if place.value is not None and _may_be_place(context, node, place.value, field, "a device"):
        check_each_device(context, node, place.value, field, check)


def check_each_device(
    context: Context, node: n.Node, value: Expression, field: str, check: Callable[[DeviceFacts], None]
) -> None:
    """Check every device that a value may be here."""

    def check_one(name: str) -> None:
        facts = context.surroundings.devices.get(name)
        if facts is None:
            context.report(node, "unknown_device", field, {"device": name})
        else:
            check(facts)

    _check_each(context, node, value, field, check_one)


def check_held_place(
    context: Context, node: n.Node, place: PlaceRef, field: str, check: Callable[[DeviceFacts], None]
) -> None:
    """Check every device or place that a variable may hold where a robot is sent to it."""
    if place.value is None or not _may_be_place(context, node, place.value, field, "a place"):
        return

    def check_one(name: str) -> None:
        facts = context.surroundings.devices.get(name)
        if facts is not None:
            check(facts)
        elif name not in context.surroundings.places:
            context.report(node, "unknown_place", field, {"place": name})

    _check_each(context, node, place.value, field, check_one)


def _check_each(
    context: Context, node: n.Node, value: Expression, field: str, check_one: Callable[[str], None]
) -> None:  # fmt: skip
    """Tell what is wrong with all that a value may be; where only some of it is wrong, which.

    A unit is a fault of what the step gives, so it is told beside a device that does not fit whatever it is given.
    """
    words = Here(context.surroundings, context.known).words(value)
    names = sorted(word for word in words if isinstance(word, str))
    wrong: dict[str, Found] = {}
    for name in names:
        outside, context.found = context.found, []
        check_one(name)
        found, context.found = context.found, outside
        if _errors(found):
            wrong[name] = found
    if not wrong:
        return
    others = [name for name, found in wrong.items() if _is_of_units_alone(found)]
    misfits = [name for name in wrong if name not in others]
    if len(wrong) == len(words):
        first = (others or misfits)[0]
        context.found.extend((replace(problem, held=first), key) for problem, key in wrong[first])
        names = misfits if others else []
    else:
        names = misfits or [name for name in others if not _is_told(context, node, wrong[name])]
    for first in names[:1]:
        facts = context.surroundings.devices.get(first)
        context.report(node, "may_not_fit", field, {"device": first if facts is None else facts.description.name})


def _errors(found: Found) -> list[Problem]:
    return [problem for problem, _ in found if TEXTS[problem.code][0] == "error"]


def _is_of_units_alone(found: Found) -> bool:
    """Tell whether a device would fit if the step gave its values in other units."""
    return all(problem.code in _OF_UNITS for problem in _errors(found))


def _is_told(context: Context, node: n.Node, found: Found) -> bool:
    """Tell whether the units that do not fit a device are told of already, so that it need not be told of, too."""
    told = {problem.field for problem, key in context.found if key == id(node) and problem.code in _OF_UNITS}
    return told.issuperset(problem.field for problem in _errors(found))


def _may_be_place(context: Context, node: n.Node, value: Expression, field: str, wanted: str) -> bool:
    """Tell whether a value can be a device or a place at all, as far as its type says."""
    given = TypeChecker(context.surroundings, context.variables, []).type_of(value).type
    if given == "text":
        given = _declared(context, value)
    if given in {"", "device", "place", "location"}:
        return True
    context.report(node, "wrong_type", field, {"subject": "The place", "wanted": wanted, "given": TYPE_WORDS[given]})
    return False


def _declared(context: Context, value: Expression) -> str:
    """Return what a parameter is declared to be; empty where a value is none, or may be something else.

    A function may be given a device as a text; who starts a program is asked for a text, and enters one.
    """
    if not isinstance(value, Variable) or value.name in context.changing():
        return ""
    function = context.functions.get(context.body)
    own = {} if function is None else {p.name: "" if p.type == "text" else p.type for p in function.parameters}
    return own.get(value.name, next((p.type for p in context.tree.parameters if p.name == value.name), ""))

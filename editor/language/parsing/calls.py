"""Calls in a script → nodes, by the records of constructs: `self.wait(60)`, `self.robot.move(self.oven.location)`."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import groupby
from typing import Any, Final

from editor.language.constructs.record import Field, FieldType
from editor.language.constructs.script_form import CALLS, ScriptCall
from editor.language.constructs.table import FORMS
from editor.language.expressions import nodes as e
from editor.language.expressions.declarations import ANSWER_TYPES, normal_answer
from editor.language.expressions.nodes import AnswerSpec
from editor.language.expressions.printing import quote
from editor.language.parsing.expressions import parse_expression, parse_place, parse_point, parse_scalar
from editor.language.parsing.scope import Refused, Scope, quoted
from editor.language.tree import nodes as n
from vipo_device.protocol.units import unit_code

Given = dict[str, ast.expr]
CallParser = Callable[[Scope, ast.Call, str], n.Node]
"""Returns the node of a call; the text is the role that does it, or the variable that takes its value."""


class _Misshapen(Exception):
    """A call has something of another form in a field than the field takes."""


def _value(scope: Scope, field: Field, node: ast.expr) -> e.Expression | None:
    value = parse_expression(node, scope)
    return None if field.optional and e.is_missing(value) else value


def _choice(scope: Scope, field: Field, node: ast.expr) -> str:
    if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value in field.choices:
        return node.value
    raise Refused(node, quoted(node), f"Write one of: {', '.join(map(quote, field.choices))}.")


def _route(scope: Scope, field: Field, node: ast.expr) -> tuple[e.Point, ...]:
    if not isinstance(node, ast.List):
        raise _Misshapen
    return tuple(parse_point(point) for point in node.elts)


def _zone(scope: Scope, field: Field, node: ast.expr) -> str:
    value = parse_expression(node, scope)
    if isinstance(value, e.Located) and value.zone is not None:
        return value.zone
    if e.is_missing(value):
        return ""
    raise Refused(node, quoted(node), 'Write a zone: self.hall, with self.hall = ctx.zone("hall") in run.')


_PARSERS: Mapping[FieldType, Callable[[Scope, Field, ast.expr], object]] = {
    "place": lambda scope, field, node: parse_place(node, scope),
    "value": _value,
    "choice": _choice,
    "route": _route,
    "zone": _zone,
}
_UNWRITTEN: Mapping[FieldType, object] = {"place": e.NOWHERE, "route": (), "value": None}
"""What a node has where the call says nothing."""


@dataclass(frozen=True, slots=True)
class _CallForm:
    """One form in which a call is written, with the class of its node and what is read for each of its attributes."""

    call: ScriptCall
    node: type[Any]
    fields: tuple[Field, ...]
    keywords: Mapping[str, str]
    """The fields that are written with a keyword, by it."""
    needed: frozenset[str]
    """The fields that must be written with theirs."""
    example: str

    def given(self, call: ast.Call) -> tuple[Given, Given] | None:
        """Return what stands in each field and what else has keywords; None where the call is of another form."""
        positional = self._positional(call.args)
        if positional is None:
            return None
        more: Given = {}
        for keyword in call.keywords:
            field = self.keywords.get(keyword.arg or "")
            if field is not None:
                positional[field] = keyword.value
            elif keyword.arg is None or self.call.spread is None:
                return None
            else:
                more[keyword.arg] = keyword.value
        return (positional, more) if self.needed <= positional.keys() else None

    def _positional(self, given: list[ast.expr]) -> Given | None:
        if not self.call.entries:
            fields = self.call.arguments
            same = len(fields) == len(given)
            return {field.name: node for field, node in zip(fields, given, strict=True)} if same else None
        match given:
            case [ast.Dict(keys=keys, values=values)]:
                entries = dict(self.call.entries)
                pairs = zip(keys, values, strict=True)
                found = {key.value: node for key, node in pairs if isinstance(key, ast.Constant)}
                if len(keys) == len(entries) and found.keys() == entries.keys():
                    return {field.name: found[key] for key, field in entries.items()}
        return None


def _call_form(name: str, call: ScriptCall) -> _CallForm:
    form = FORMS[name][1]
    keywords = {key: field.name for key, field in call.keywords}
    needed = frozenset(field.name for _, field in call.keywords if not field.optional and field.type != "choice")
    return _CallForm(call, n.NODES[name], form.fields, keywords, needed, form.example)


def _parser_of(forms: tuple[_CallForm, ...]) -> CallParser:
    """Return what reads the calls of a method, which may be written in several forms."""

    def parse(scope: Scope, call: ast.Call, name: str) -> n.Node:
        for form in forms:
            given = form.given(call)
            if given is not None:
                try:
                    node: n.Node = form.node(*[_field(scope, field, call, given, name) for field in form.fields])
                except _Misshapen:
                    break
                return node
        raise Refused(call, quoted(call), _example(forms[0], name))

    return parse


def _example(form: _CallForm, name: str) -> str:
    """Return how a call is written; one of a robot by the role that is meant."""
    if form.call.role is None or not name:
        return form.example
    return form.example.replace("self.robot.pick(", f"self.{name}.{form.call.method}(").replace(
        "self.robot.", f"self.{name}."
    )


def _field(scope: Scope, field: Field, call: ast.Call, given: tuple[Given, Given], name: str) -> object:
    """Return what a field has."""
    kind = field.type
    if kind in _NAMES:
        return name
    if kind == "answer":
        return _answer(call, given[1])
    node = given[0].get(field.name)
    if node is None:
        return field.choices[0] if kind == "choice" else _UNWRITTEN[kind]
    return _PARSERS[kind](scope, field, node)


_NAMES: Final = frozenset({"role", "variable"})


def _answer(call: ast.Call, named: Given) -> AnswerSpec:
    """Return what may be answered; nothing may be said that does not belong to the type."""
    given: dict[str, object] = {}
    for name, value in named.items():
        if name == "options" and isinstance(value, ast.List):
            given["options"] = [parse_scalar(item) for item in value.elts]
        else:
            given[name] = parse_scalar(value)
    if isinstance(given.get("unit"), str):
        given["unit"] = unit_code(str(given["unit"]))
    answer = normal_answer(given)
    said = {"type": answer.type, "unit": answer.unit or None, "minimum": answer.minimum, "maximum": answer.maximum}
    known = {
        name: value for name, value in {**said, "options": list(answer.options) or None}.items() if value is not None
    }
    if {"type": "boolean", **given} != known:
        types = ", ".join(f'"{kind}"' for kind in ANSWER_TYPES)
        raise Refused(call, quoted(call), f"type is one of {types}; unit, minimum and maximum go with \"number\", "
                      'options=["red", "blue"] with "choice".')  # fmt: skip
    return answer


def _parsers(*, of_robots: bool) -> dict[str, CallParser]:
    """Return what reads the calls of the task itself, or of its robots, by the method."""
    forms = [
        (call.method, _call_form(name, call)) for name, call in CALLS.items() if (call.role is not None) == of_robots
    ]
    grouped = groupby(forms, key=lambda pair: pair[0])
    return {method: _parser_of(tuple(form for _, form in group)) for method, group in grouped}


OWN_CALLS: Final = _parsers(of_robots=False)
ROBOT_CALLS: Final = _parsers(of_robots=True)
ASSIGNED_CALLS: Final = frozenset(call.method for call in CALLS.values() if call.variable is not None)
"""The methods of the task whose value may go into a variable."""

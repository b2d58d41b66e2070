"""How a construct stands in a script: a call, taken apart once so that printing and parsing follow the same form."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from editor.language.constructs.record import Field, Form
from editor.language.constructs.table import FORMS


@dataclass(frozen=True, slots=True)
class ScriptCall:
    """`variable = self.method(argument, {"key": entry}, keyword=field, **spread)`; a role may stand in self's place."""

    method: str
    role: Field | None = None
    variable: Field | None = None
    """What the call's value goes into, where it goes into anything."""
    arguments: tuple[Field, ...] = ()
    entries: tuple[tuple[str, Field], ...] = ()
    """The members of the one object that is the argument, in its place."""
    keywords: tuple[tuple[str, Field], ...] = ()
    spread: Field | None = None
    """A field that is written with several keywords of its own."""


def script_call(form: Form) -> ScriptCall:
    """Return the call as which a form is written.

    Raises:
        ValueError: the form's script is no such call.
    """
    fields = {field.name: field for field in form.fields}
    match ast.parse(form.script).body:
        case [ast.Assign(targets=[ast.Name(id=name)], value=ast.Call(func=ast.Attribute() as function) as call)]:
            variable = fields.get(name)
        case [ast.Expr(value=ast.Call(func=ast.Attribute() as function) as call)]:
            variable = None
        case _:
            raise ValueError(form.script)
    role, entries = fields.get(_name(function.value)), _entries(call.args, fields)
    arguments = () if entries else tuple(fields[_name(node)] for node in call.args)
    named = tuple((keyword.arg, fields[_name(keyword.value)]) for keyword in call.keywords if keyword.arg)
    spread = next((fields[_name(keyword.value)] for keyword in call.keywords if not keyword.arg), None)
    return ScriptCall(function.attr, role, variable, arguments, entries, named, spread)


def _entries(given: list[ast.expr], fields: dict[str, Field]) -> tuple[tuple[str, Field], ...]:
    """Return the members of the object that is the only argument; none where it is no object."""
    match given:
        case [ast.Dict(keys=keys, values=values)]:
            names = [key.value if isinstance(key, ast.Constant) else None for key in keys]
            return tuple((str(name), fields[_name(node)]) for name, node in zip(names, values, strict=True))
    return ()


def _name(node: ast.expr) -> str:
    return node.id if isinstance(node, ast.Name) else ""


CALLS: Final[Mapping[str, ScriptCall]] = {node: script_call(form) for node, (_, form) in FORMS.items() if form.script}
"""How nodes are written that are calls, by the names of their classes."""
RELEASE: Final = "release"
"""The call by which a role gives its robot back: the fleet is asked, not the robot."""
OF_THE_FLEET: Final = frozenset({RELEASE, "cover"})
"""Calls of a role that the fleet carries out; a robot needs no method that is called so."""

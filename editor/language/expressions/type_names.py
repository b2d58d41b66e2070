"""The types of parameters and results as the script writes them: `Number("MIN")`, `Text`, `Place`."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from typing import Final

from editor.language.expressions.quoting import quote

TYPE_NAMES: Final[Mapping[str, str]] = {
    "number": "Number",
    "text": "Text",
    "boolean": "Boolean",
    "object": "Object",
    "device": "Device",
    "place": "Place",
}
_TYPES = {name: type_name for type_name, name in TYPE_NAMES.items()}
_ALSO_CALLED = {"location": "place", "choice": "text"}


class UnknownType(Exception):
    """A piece of a script that stands where a type is wanted names none."""


def settle_type(type_name: object, unit: object = "") -> tuple[str, str]:
    """Return a type and its unit in their normal form; what is no type is empty, and only numbers have a unit."""
    name = type_name if isinstance(type_name, str) else ""
    name = _ALSO_CALLED.get(name, name)
    if name not in TYPE_NAMES:
        return "", ""
    return name, unit if name == "number" and isinstance(unit, str) else ""


def write_type(type_name: str, unit: str = "") -> str:
    """Return a type as the script writes it; empty when the type is not known."""
    name, settled_unit = settle_type(type_name, unit)
    if not name:
        return ""
    return f"{TYPE_NAMES[name]}({quote(settled_unit)})" if settled_unit else TYPE_NAMES[name]


def parse_type(node: ast.expr | None) -> tuple[str, str]:
    """Return the type and the unit that a piece of the script names; both empty where there is none.

    Raises:
        UnknownType: it names no type of the language.
    """
    match node:
        case None:
            return "", ""
        case ast.Name(id=name) if name in _TYPES:
            return _TYPES[name], ""
        case ast.Call(func=ast.Name(id="Number"), args=[ast.Constant(value=str() as unit)], keywords=[]) if unit:
            return "number", unit
    raise UnknownType(f'Write one of: {", ".join(_TYPES)}, or a number with its unit: Number("MIN").')

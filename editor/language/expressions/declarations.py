"""What is declared of parameters, results and answers: type, unit and limits, as document and script have them."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from typing import Final

from editor.language.expressions.nodes import AnswerSpec
from editor.language.expressions.printing import quote
from editor.language.expressions.values import is_number, plain
from vipo_device.protocol.units import unit_code, unit_symbol

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


def normal_type(type_name: object, unit: object = "") -> tuple[str, str]:
    """Return a type and its unit in their normal form; what is no type is empty, and only numbers have a unit."""
    name = type_name if isinstance(type_name, str) else ""
    name = _ALSO_CALLED.get(name, name)
    if name not in TYPE_NAMES:
        return "", ""
    return name, unit_code(unit) if name == "number" and isinstance(unit, str) else ""


def write_type(type_name: str, unit: str = "") -> str:
    """Return a type as the script writes it; empty when the type is not known."""
    name, settled_unit = normal_type(type_name, unit)
    if not name:
        return ""
    return f"{TYPE_NAMES[name]}({quote(unit_symbol(settled_unit))})" if settled_unit else TYPE_NAMES[name]


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
            return "number", unit_code(unit)
    raise UnknownType(f'Write one of: {", ".join(_TYPES)}, or a number with its unit: Number("min").')


ANSWER_TYPES = ("boolean", "number", "text", "choice")


def normal_answer(given: Mapping[str, object]) -> AnswerSpec:
    """Return what is said of an answer; what does not belong to its type is left out, nonsense too."""
    kind = given.get("type")
    if kind == "number":
        unit = given.get("unit")
        least, most = _limit(given.get("minimum")), _limit(given.get("maximum"))
        return AnswerSpec("number", unit_code(unit) if isinstance(unit, str) else "", least, most)
    if kind == "choice":
        options = given.get("options")
        listed = options if isinstance(options, list | tuple) else ()
        named = dict.fromkeys(option for option in listed if isinstance(option, str) and option)
        return AnswerSpec("choice", options=tuple(named))
    return AnswerSpec("text" if kind == "text" else "boolean")


def _limit(value: object) -> float | None:
    limit = plain(value)
    return limit if is_number(limit) else None


def answer_to_json(answer: AnswerSpec) -> dict[str, object]:
    """Return what the document says of an answer."""
    said = {"unit": answer.unit or None, "minimum": answer.minimum, "maximum": answer.maximum}
    body = {"type": answer.type, **said, "options": list(answer.options) or None}
    return {name: value for name, value in body.items() if value is not None}

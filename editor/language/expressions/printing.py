"""Expressions as Python text, with no more brackets than Python needs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

from editor.language.expressions.nodes import Constant, Expression, Located, Operation, Quantity, Reading, Variable
from editor.language.expressions.values import FUNCTIONS
from vipo_device.protocol.description import Scalar
from vipo_device.protocol.units import unit_symbol

_STRENGTH = {"or": 1, "and": 2, "not": 3, "+": 5, "-": 5, "*": 6, "/": 6}
_COMPARISON = 4
_NEGATION = 7
_ATOM = 9


class Names(Protocol):
    """What a printer knows of names."""

    def variable(self, name: str) -> str:
        """Return how a parameter is written."""

    def reading(self, device: str, property_name: str) -> str:
        """Return how a device's property is written."""

    def robot_reading(self, role: str, property_name: str) -> str:
        """Return how a property of a role's robot is written."""

    def located(self, located: Located) -> str:
        """Return how a device, a named place, a role's robot or a zone is written."""

    def quantity(self, quantity: Quantity) -> str:
        """Return how a number with its unit is written."""


def scalar_text(value: Scalar) -> str:
    """Return a single value as Python writes it."""
    return quote(value) if isinstance(value, str) else repr(value)


def quantity_text(quantity: Quantity) -> str:
    """Return a number with its unit as the script writes it."""
    return f"quantity({scalar_text(quantity.value)}, {quote(unit_symbol(quantity.unit))})"


def read_of(thing: str, short: str | None, name: str) -> str:
    """Return how a property of something is written: under its short name, or written out where it has none."""
    return f"{thing}.{short}" if short else f"{thing}.read({quote(name)})"


def write_expression(expression: Expression, names: Names) -> str:
    """Return an expression as text; a missing value is None."""
    return _write(expression, names, 0)


def _write(expression: Expression, names: Names, around: int) -> str:
    return _WRITERS[expression.__class__](expression, names, around)


def _constant(expression: Constant, names: Names, around: int) -> str:
    value = expression.value
    if not isinstance(value, tuple):
        return scalar_text(value)
    return f"[{', '.join(map(scalar_text, value))}]"


def _choice(expression: Expression, names: Names) -> str:
    """Return what may be on the right of `in`; values that are written out stand in round brackets there."""
    if not isinstance(expression, Constant) or not isinstance(expression.value, tuple):
        return _write(expression, names, _COMPARISON + 1)
    inside = ", ".join(map(scalar_text, expression.value))
    return f"({inside},)" if len(expression.value) == 1 else f"({inside})"


def _reading(expression: Reading, names: Names, around: int) -> str:
    device, name = expression.device, expression.property
    if isinstance(device, Constant):
        return names.reading(str(device.value), name)
    if isinstance(device, Located) and device.role is not None:
        return names.robot_reading(device.role, name)
    return f"{_write(device, names, _ATOM)}.read({quote(name)})"


def _located(expression: Located, names: Names, around: int) -> str:
    if expression.point is None:
        return names.located(expression)
    x, y = expression.point
    return f"point({scalar_text(x)}, {scalar_text(y)})"


def _operation(expression: Operation, names: Names, around: int) -> str:
    operator, arguments = expression.operator, expression.arguments
    if operator in FUNCTIONS:
        written = [_write(argument, names, 0) for argument in arguments]
        formatted = _formatted(arguments, written) if operator == "text" else None
        return formatted or f"{operator}({', '.join(written)})"
    if operator == "list":
        return f"[{', '.join(_write(argument, names, 0) for argument in arguments)}]"
    if len(arguments) == 1:
        return _unary(operator, arguments[0], names, around)
    strength = _STRENGTH.get(operator, _COMPARISON)
    first = strength + 1 if strength in {1, 2, _COMPARISON} else strength
    written = [_write(arguments[0], names, first)]
    if operator in {"in", "not in"}:
        written.append(_choice(arguments[1], names))
    else:
        written += [_write(argument, names, strength + 1) for argument in arguments[1:]]
    text = f" {operator} ".join(written)
    return f"({text})" if strength < around else text


def _unary(operator: str, argument: Expression, names: Names, around: int) -> str:
    strength = _STRENGTH["not"] if operator == "not" else _NEGATION
    text = f"not {_write(argument, names, strength)}" if operator == "not" else f"-{_write(argument, names, strength)}"
    return f"({text})" if strength < around else text


def _formatted(parts: tuple[Expression, ...], written: list[str]) -> str | None:
    """Return a text of several parts as an f-string; None where one of them cannot stand in it."""
    pieces: list[str] = []
    for part, text in zip(parts, written, strict=True):
        if isinstance(part, Constant) and isinstance(part.value, str):
            pieces.append(escape(part.value).replace("{", "{{").replace("}", "}}"))
            continue
        inside = text.replace('"', "'") if "'" not in text else text
        if any(character in inside for character in '"\\#{}'):
            return None
        pieces.append(f"{{{inside}}}")
    return f'f"{"".join(pieces)}"'


_WRITERS: Mapping[type[Expression], Callable[[Any, Names, int], str]] = {
    Constant: _constant,
    Variable: lambda expression, names, around: names.variable(expression.name),
    Reading: _reading,
    Quantity: lambda expression, names, around: names.quantity(expression),
    Located: _located,
    Operation: _operation,
}


_ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\r": "\\r", "\t": "\\t"}


def quote(text: str) -> str:
    """Return a text as a Python string in double quotes; what cannot be seen is escaped."""
    if text.isascii() and text.isalnum():
        return f'"{text}"'
    return f'"{escape(text)}"'


def escape(text: str) -> str:
    """Return a text as it stands between double quotes."""
    return "".join(map(_character, text))


def _character(character: str) -> str:
    if character in _ESCAPES:
        return _ESCAPES[character]
    if character.isprintable():
        return character
    code = ord(character)
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"

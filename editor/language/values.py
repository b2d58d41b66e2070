"""Values as the document holds them, read into expressions and written back; nonsense reads as missing."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TypeGuard

from editor.language.nodes import MISSING, NOWHERE, Point
from editor.language.plan import Constant, Expression, Operation, PlaceRef, Reading, Variable
from registry.capability import Scalar

COMPARISONS = ("<", "<=", ">", ">=", "==", "!=", "in", "not in")
ARITHMETIC = ("+", "-", "*", "/")
FUNCTIONS = {"abs": 1, "round": 1, "min": 2, "max": 2}
DEEPEST_EXPRESSION = 24
LARGEST = 1e15

Names = Mapping[str, str]
"""Parameters that can be seen here: the name in the document → the name in the script."""


class UnknownParameter(Exception):
    """A value names a parameter that does not exist here."""


def is_number(value: object) -> TypeGuard[int | float]:
    """Tell whether a value is a number that can be worked with."""
    return isinstance(value, int | float) and not isinstance(value, bool) and -LARGEST <= value <= LARGEST


def plain(value: object) -> Scalar:
    """Return a scalar in its normal form: whole numbers as int, nonsense as None."""
    if isinstance(value, bool | str):
        return value
    if not is_number(value) or math.isnan(value):
        return None
    return int(value) if isinstance(value, float) and value.is_integer() else value


def operation(operator: str, arguments: tuple[Expression, ...]) -> Expression:
    """Return the operation in its normal form: `and`/`or` flat, a minus before a number as part of the number."""
    if operator in {"and", "or"}:
        flat: list[Expression] = []
        for argument in arguments:
            inside = isinstance(argument, Operation) and argument.operator == operator
            flat.extend(argument.arguments if inside and isinstance(argument, Operation) else (argument,))
        return flat[0] if len(flat) == 1 else Operation(operator, tuple(flat))
    if operator == "-" and len(arguments) == 1 and isinstance(arguments[0], Constant):
        value = arguments[0].value
        if is_number(value):
            return Constant(-value)
    return Operation(operator, arguments)


def arity_fits(operator: str, count: int) -> bool:
    """Tell whether an operator of the language takes so many arguments."""
    if operator in {"and", "or"}:
        return count >= 1
    if operator == "not":
        return count == 1
    if operator == "-" and count == 1:
        return True
    return count == FUNCTIONS.get(operator, 2 if operator in COMPARISONS or operator in ARITHMETIC else -1)


def read_value(value: object, names: Names, depth: int = 0) -> Expression:
    """Return the expression that a Value of the document stands for.

    Raises:
        UnknownParameter: it names a parameter that does not exist here.
    """
    if value.__class__ is int or isinstance(value, str | bool | float | int):
        scalar = plain(value)
        return MISSING if scalar is None else Constant(scalar)
    if isinstance(value, list | tuple):
        scalars = tuple(plain(item) for item in value)
        return MISSING if not scalars or None in scalars else Constant(scalars)
    if not isinstance(value, Mapping) or depth > DEEPEST_EXPRESSION:
        return MISSING
    if "param" in value:
        return _variable(value["param"], names)
    if "property" in value:
        return _reading(value["property"], names)
    return _operation(value, names, depth)


def _variable(name: object, names: Names) -> Expression:
    if not isinstance(name, str) or not name:
        return MISSING
    if name not in names:
        raise UnknownParameter(name)
    return Variable(names[name])


def _reading(value: object, names: Names) -> Expression:
    if not isinstance(value, list | tuple) or len(value) != 2:
        return MISSING
    device, name = value
    if not isinstance(name, str) or not name:
        return MISSING
    if isinstance(device, str) and device:
        return Reading(Constant(device), name)
    if isinstance(device, Mapping):
        read = _variable(device.get("param"), names)
        return MISSING if read == MISSING else Reading(read, name)
    return MISSING


def _operation(value: Mapping[str, object], names: Names, depth: int) -> Expression:
    operator, given = value.get("op"), value.get("args")
    if not isinstance(operator, str) or not isinstance(given, list | tuple) or not arity_fits(operator, len(given)):
        return MISSING
    return operation(operator, tuple(read_value(argument, names, depth + 1) for argument in given))


def read_place(value: object, names: Names) -> PlaceRef:
    """Return the place that a Place of the document stands for.

    Raises:
        UnknownParameter: it names a parameter that does not exist here.
    """
    if not isinstance(value, Mapping):
        return NOWHERE
    device, place = value.get("device"), value.get("place")
    if isinstance(device, str) and device:
        return PlaceRef(device=device)
    if isinstance(place, str) and place:
        return PlaceRef(place=place)
    if "param" in value:
        variable = _variable(value["param"], names)
        return NOWHERE if variable == MISSING else PlaceRef(value=variable)
    point = read_point(value.get("point"))
    return NOWHERE if point is None else PlaceRef(point=point)


def read_point(value: object) -> Point | None:
    """Return a point in metres, or None when the value is none."""
    if not isinstance(value, list | tuple) or len(value) != 2:
        return None
    x, y = plain(value[0]), plain(value[1])
    return (x, y) if is_number(x) and is_number(y) else None


def write_value(expression: Expression | None) -> object:
    """Return the Value of the document for an expression."""
    match expression:
        case None:
            return None
        case Constant(value=value):
            return list(value) if isinstance(value, tuple) else value
        case Variable(name=name):
            return {"param": name}
        case Reading(device=Constant(value=device), property=name):
            return {"property": [device, name]}
        case Reading(device=device, property=name):
            return {"property": [write_value(device), name]}
        case Operation(operator=operator, arguments=arguments):
            return {"op": operator, "args": [write_value(argument) for argument in arguments]}


def write_place(place: PlaceRef) -> object:
    """Return the Place of the document for a place."""
    if place.device is not None:
        return {"device": place.device}
    if place.place is not None:
        return {"place": place.place}
    if place.point is not None:
        return {"point": list(place.point)}
    return None if place.value is None else write_value(place.value)


def parts_of(expression: Expression) -> Iterator[Expression]:
    """Yield an expression and everything in it, the outermost first."""
    yield expression
    if isinstance(expression, Operation):
        for argument in expression.arguments:
            yield from parts_of(argument)
    elif isinstance(expression, Reading):
        yield expression.device

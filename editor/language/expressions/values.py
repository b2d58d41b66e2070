"""Values as the document holds them, read into expressions and written back; nonsense reads as missing."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Final, TypeGuard

from editor.language.expressions.nodes import (
    MISSING,
    NOWHERE,
    Constant,
    Expression,
    Located,
    Operation,
    PlaceRef,
    Point,
    Quantity,
    Reading,
    Variable,
)
from vipo_device.protocol.description import Scalar
from vipo_device.protocol.units import unit_code

COMPARISONS = ("<", "<=", ">", ">=", "==", "!=", "in", "not in")
ARITHMETIC = ("+", "-", "*", "/")
FUNCTIONS: Mapping[str, tuple[int, int | None]] = {
    "abs": (1, 1), "round": (1, 1), "min": (2, None), "max": (2, None), "distance": (2, 2), "nearest": (2, None),
    "count": (1, None), "now": (0, 0), "text": (1, None), "len": (1, 1), "nth": (2, 2),
}  # fmt: skip
"""The functions of the language, with how many values they take at least and at most."""
_NUMBERS: Final = (int, float)
_WORDS: Final = (bool, str)
_SCALARS: Final = (str, bool, float, int)
_LISTS: Final = (list, tuple)
DEEPEST_EXPRESSION = 24
LARGEST = 1e15
FURTHEST_M = 1e5
"""No site is as large; browsers that draw further away run out of memory."""
MOST_ITEMS = 1000
"""A list has at most so many items."""

Names = Mapping[str, str]
"""Parameters that can be seen here: the name in the document → the name in the script."""
RobotOf = Callable[[str], Expression]
"""What stands in the tree for the robot of a role, which the document names by its id."""


class UnknownParameter(Exception):
    """A value names a parameter that does not exist here."""


def is_number(value: object) -> TypeGuard[int | float]:
    """Tell whether a value is a number that can be worked with."""
    return isinstance(value, _NUMBERS) and not isinstance(value, bool) and -LARGEST <= value <= LARGEST


def plain(value: object) -> Scalar:
    """Return a scalar in its normal form: whole numbers as int, nonsense as None."""
    if isinstance(value, _WORDS):
        return value
    if value.__class__ is int and is_number(value):
        return value
    if not is_number(value) or math.isnan(value):
        return None
    return int(value) if isinstance(value, float) and value.is_integer() else value


def operation(operator: str, arguments: tuple[Expression, ...]) -> Expression:
    """Return the operation in its normal form.

    `and`, `or` and texts are flat, and a minus before a number is a part of the number.
    """
    if operator in {"and", "or"}:
        flat = _flat(operator, arguments)
        return flat[0] if len(flat) == 1 else Operation(operator, flat)
    if operator == "text":
        return _text(_flat(operator, arguments))
    if operator == "list":
        return _list(arguments)
    if operator == "-" and len(arguments) == 1:
        return _negative(arguments[0])
    return Operation(operator, arguments)


def _flat(operator: str, arguments: tuple[Expression, ...]) -> tuple[Expression, ...]:
    flat: list[Expression] = []
    for argument in arguments:
        inside = isinstance(argument, Operation) and argument.operator == operator
        flat.extend(argument.arguments if inside and isinstance(argument, Operation) else (argument,))
    return tuple(flat)


def _negative(argument: Expression) -> Expression:
    match argument:
        case Constant(value=value) if is_number(value):
            return Constant(-value)
        case Quantity(value=value, unit=unit):
            return Quantity(-value, unit)
    return Operation("-", (argument,))


def _text(parts: tuple[Expression, ...]) -> Expression:
    """Return parts one behind another; texts that meet are one, and empty ones say nothing."""
    joined: list[Expression] = []
    for part in parts:
        before = joined[-1] if joined else None
        match before, part:
            case _, Constant(value=""):
                continue
            case Constant(value=str(first)), Constant(value=str(second)):
                joined[-1] = Constant(first + second)
            case _:
                joined.append(part)
    match joined:
        case []:
            return Constant("")
        case [Constant(value=str()) as only]:
            return only
    return Operation("text", tuple(joined))


def _list(items: tuple[Expression, ...]) -> Expression:
    """Return a list; one of values that are all written out is a constant, an empty one is none."""
    values = tuple(item.value for item in items if isinstance(item, Constant) and not isinstance(item.value, tuple))
    whole = values and len(values) == len(items) and None not in values
    return Constant(values) if whole else Operation("list", items)


def arity_fits(operator: str, count: int) -> bool:
    """Tell whether an operator of the language takes so many arguments."""
    if operator == "list":
        return True
    if operator in {"and", "or"}:
        return count >= 1
    if operator == "not":
        return count == 1
    if operator == "-" and count == 1:
        return True
    if operator in FUNCTIONS:
        least, most = FUNCTIONS[operator]
        return least <= count and (most is None or count <= most)
    return count == 2 and (operator in COMPARISONS or operator in ARITHMETIC)


def no_robot(role: str) -> Expression:
    """Return that no role's robot has a place here."""
    return MISSING


def read_value(value: object, names: Names, robot_of: RobotOf = no_robot, depth: int = 0) -> Expression:
    """Return the expression that a Value of the document stands for.

    Raises:
        UnknownParameter: it names a parameter that does not exist here.
    """
    if value.__class__ is not dict and isinstance(value, _SCALARS):
        scalar = plain(value)
        return MISSING if scalar is None else Constant(scalar)
    if isinstance(value, _LISTS):
        scalars = tuple(plain(item) for item in value)
        return MISSING if not scalars or None in scalars else Constant(scalars)
    if not (value.__class__ is dict or isinstance(value, Mapping)) or depth > DEEPEST_EXPRESSION:
        return MISSING
    if "param" in value:
        return _variable(value["param"], names)
    if "property" in value:
        return _reading(value["property"], names, robot_of)
    if "op" in value:
        return _operation(value, names, robot_of, depth)
    if "quantity" in value:
        return _quantity(value["quantity"])
    return _located(value, names, robot_of)


def _quantity(value: object) -> Expression:
    if not isinstance(value, _LISTS) or len(value) != 2:
        return MISSING
    number, unit = plain(value[0]), value[1]
    if not is_number(number) or not isinstance(unit, str):
        return MISSING
    return Quantity(number, unit_code(unit)) if unit else Constant(number)


def _located(value: Mapping[str, object], names: Names, robot_of: RobotOf) -> Expression:
    """A Place that stands where a value is needed means what stands there, too."""
    zone = value.get("zone")
    if isinstance(zone, str) and zone:
        return Located(zone=zone)
    whole = value.get("at", value)
    if isinstance(whole, Mapping) and isinstance(whole.get("role"), str):
        return robot_of(str(whole["role"]))
    place = read_place(whole, names)
    if place.value is not None:
        return place.value
    return MISSING if place == NOWHERE else Located(place.device, place.place, place.point)


def _variable(name: object, names: Names) -> Expression:
    if not isinstance(name, str) or not name:
        return MISSING
    if name not in names:
        raise UnknownParameter(name)
    return Variable(names[name])


def _reading(value: object, names: Names, robot_of: RobotOf) -> Expression:
    if not isinstance(value, _LISTS) or len(value) != 2:
        return MISSING
    device, name = value
    if not isinstance(name, str) or not name:
        return MISSING
    if isinstance(device, str) and device:
        return Reading(Constant(device), name)
    if isinstance(device, Mapping):
        role = device.get("role")
        read = _of_robot(robot_of(role)) if isinstance(role, str) else _variable(device.get("param"), names)
        return MISSING if read == MISSING else Reading(read, name)
    return MISSING


def _of_robot(robot: Expression) -> Expression:
    """Return of what a robot's readings are: its role, or the device that it is known to be."""
    return Constant(robot.device) if isinstance(robot, Located) and robot.device is not None else robot


def _operation(value: Mapping[str, object], names: Names, robot_of: RobotOf, depth: int) -> Expression:
    operator, given = value.get("op"), value.get("args")
    if not isinstance(operator, str) or not isinstance(given, _LISTS) or not arity_fits(operator, len(given)):
        return MISSING
    return operation(operator, tuple(read_value(argument, names, robot_of, depth + 1) for argument in given))


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
    """Return a point in metres, or None when the value is none, or beyond every site."""
    if not isinstance(value, _LISTS) or len(value) != 2:
        return None
    x, y = plain(value[0]), plain(value[1])
    return (x, y) if _is_near(x) and _is_near(y) else None


def _is_near(value: object) -> TypeGuard[int | float]:
    return is_number(value) and -FURTHEST_M <= value <= FURTHEST_M


def write_value(expression: Expression | None) -> object:
    """Return the Value of the document for an expression; roles go by their names in the script."""
    match expression:
        case None:
            return None
        case Constant(value=value):
            return list(value) if isinstance(value, tuple) else value
        case Variable(name=name):
            return {"param": name}
        case Reading(device=Constant(value=device), property=name):
            return {"property": [device, name]}
        case Reading(device=Located(role=str(role)), property=name):
            return {"property": [{"role": role}, name]}
        case Reading(device=device, property=name):
            return {"property": [write_value(device), name]}
        case Operation(operator=operator, arguments=arguments):
            return {"op": operator, "args": [write_value(argument) for argument in arguments]}
        case Quantity(value=value, unit=unit):
            return {"quantity": [value, unit]}
        case Located():
            return _write_located(expression)


def _write_located(located: Located) -> object:
    if located.zone is not None:
        return {"zone": located.zone}
    if located.role is not None:
        return {"at": {"role": located.role}}
    return {"at": write_place(PlaceRef(located.device, located.place, located.point))}


def write_argument(expression: Expression) -> object:
    """Return the Value, or for a device or a named place the Place, that a call is given."""
    if isinstance(expression, Located) and (expression.device is not None or expression.place is not None):
        return write_place(PlaceRef(expression.device, expression.place))
    return write_value(expression)


def write_place(place: PlaceRef) -> object:
    """Return the Place of the document for a place."""
    if place.device is not None:
        return {"device": place.device}
    if place.place is not None:
        return {"place": place.place}
    if place.point is not None:
        return {"point": list(place.point)}
    return None if place.value is None else write_value(place.value)


def parts_of(expression: Expression) -> list[Expression]:
    """Return an expression and everything in it, the outermost first."""
    parts: list[Expression] = []
    _gather(expression, parts)
    return parts


def _gather(expression: Expression, parts: list[Expression]) -> None:
    parts.append(expression)
    if isinstance(expression, Constant):
        return
    if isinstance(expression, Operation):
        for argument in expression.arguments:
            _gather(argument, parts)
    elif isinstance(expression, Reading):
        parts.append(expression.device)


def rename_roles(expression: Expression, names: Mapping[str, str]) -> Expression:
    """Return an expression whose roles have other names."""
    match expression:
        case Located(role=str(role)):
            return Located(role=names.get(role, role))
        case Reading(device=Located(role=str(role)), property=name):
            return Reading(Located(role=names.get(role, role)), name)
        case Operation(operator=operator, arguments=arguments):
            return Operation(operator, tuple(rename_roles(argument, names) for argument in arguments))
    return expression


def roles_in(expression: Expression) -> frozenset[str]:
    """Return the roles whose robots an expression asks about: where they are, or what they tell."""
    return frozenset(part.role for part in parts_of(expression) if isinstance(part, Located) and part.role is not None)

"""Units are converted when a program is compiled: what meets is brought into one unit, and no plan has a Quantity."""

from __future__ import annotations

from editor.language.expressions.nodes import Constant, Expression, Located, Operation, Quantity, Reading
from editor.language.expressions.products import product_of
from editor.language.expressions.temperatures import conversion_of, go_together, number_in
from editor.language.expressions.value_types import TypeChecker, ValueType, common_unit, sum_of_types
from editor.language.expressions.values import ARITHMETIC, COMPARISONS, is_number, operation
from editor.language.site.surroundings import Surroundings
from vipo_device.protocol.units import is_measure, tidy, unit_symbol

_WITH_UNITS = frozenset({"now", "distance", "nearest", "text"})
_MEETING = frozenset({*COMPARISONS, "+", "-", "min", "max", "abs", "round", "list"})


def convert_units(expression: Expression, wanted_unit: str, checker: TypeChecker) -> Expression:
    """Return an expression without quantities, in the wanted unit if one is wanted (empty: in its own)."""
    if isinstance(expression, Constant):
        return expression
    converted = expression if _units_in(expression) <= 1 else _convert(expression, checker)
    return into_unit(converted, _type_of(expression, checker).unit, wanted_unit) if wanted_unit else converted


def _units_in(expression: Expression) -> int:
    """Return how many parts of an expression are measured; nothing is converted where it is one, or none.

    What may bring a unit by itself counts as two.
    """
    if isinstance(expression, Constant):
        return 0
    if isinstance(expression, Operation) and expression.operator not in _WITH_UNITS:
        inside = sum(map(_units_in, expression.arguments))
        return 2 if inside and expression.operator == "/" else inside
    return 1 if isinstance(expression, Reading) and isinstance(expression.device, Constant) else 2


def _type_of(expression: Expression, checker: TypeChecker) -> ValueType:
    return TypeChecker(checker.surroundings, checker.variables, []).type_of(expression)


def _convert(expression: Expression, checker: TypeChecker) -> Expression:
    """Return the expression without quantities, in its own unit."""
    match expression:
        case Quantity(value=value):
            return Constant(value)
        case Operation(operator=name, arguments=arguments):
            if name == "text":
                return Operation(name, tuple(_as_text(argument, checker) for argument in arguments))
            if name in {"distance", "nearest"} or _is_in_zone(expression):
                return Operation(name, _placed(name, arguments, checker))
            if name in {"*", "/"}:
                return _folded(Operation(name, _multiplied(name, arguments, checker)), expression)
            if name == "list":
                return operation(name, _met(name, arguments, checker))
            if name in _MEETING:
                return _folded(Operation(name, _met(name, arguments, checker)), expression)
            return _folded(Operation(name, tuple(_convert(argument, checker) for argument in arguments)), expression)
    return expression


def _met(name: str, arguments: tuple[Expression, ...], checker: TypeChecker) -> tuple[Expression, ...]:
    """Return values that meet, all in one unit."""
    types = [_type_of(argument, checker) for argument in arguments]
    units = (common_unit(arguments, types),) * len(arguments)
    if name in {"+", "-"} and len(arguments) == 2 and "list" not in {each.type for each in types}:
        found = sum_of_types(name, arguments, types)
        units = (found.left, found.right)
    rows = zip(arguments, types, units, strict=True)
    return tuple(into_unit(_convert(argument, checker), each.unit, unit) for argument, each, unit in rows)


def _multiplied(name: str, arguments: tuple[Expression, ...], checker: TypeChecker) -> tuple[Expression, ...]:
    """Return two values that are multiplied or divided, each in the unit in which the product is measured."""
    left, right = (_convert(argument, checker) for argument in arguments)
    product = product_of(name, *(_type_of(argument, checker).unit for argument in arguments))
    return (left, right) if product is None else (_times(left, product.left), _times(right, product.right))


def _times(expression: Expression, factor: float) -> Expression:
    if isinstance(expression, Constant) and is_number(expression.value):
        return Constant(tidy(expression.value * factor))
    return _scaled(expression, factor)


def _as_text(part: Expression, checker: TypeChecker) -> Expression:
    if isinstance(part, Quantity):
        return Constant(f"{tidy(part.value)} {unit_symbol(part.unit)}")
    return _convert(part, checker)


def _is_in_zone(expression: Operation) -> bool:
    last = expression.arguments[-1] if expression.arguments else None
    return isinstance(last, Located) and last.zone is not None


def _placed(name: str, arguments: tuple[Expression, ...], checker: TypeChecker) -> tuple[Expression, ...]:
    """Return things with a place; a named place of the map is its point wherever only its place is asked for."""
    fixed = len(arguments) if name == "distance" else 1
    return tuple(
        _point_of(argument, checker.surroundings) if index < fixed else _convert(argument, checker)
        for index, argument in enumerate(arguments)
    )


def _point_of(argument: Expression, surroundings: Surroundings) -> Expression:
    place = surroundings.places.get(argument.place or "") if isinstance(argument, Located) else None
    return argument if place is None else Located(point=(place.x, place.y))


def _folded(converted: Operation, before: Expression) -> Expression:
    """Work out plain arithmetic with quantities, so that a plan holds the number."""
    numbers = [a.value for a in converted.arguments if isinstance(a, Constant) and is_number(a.value)]
    if (
        converted.operator not in ARITHMETIC
        or converted == before
        or len(numbers) != 2
        or len(converted.arguments) != 2
    ):
        return converted
    left, right = numbers
    match converted.operator:
        case "+":
            return Constant(tidy(left + right))
        case "-":
            return Constant(tidy(left - right))
        case "*":
            return Constant(tidy(left * right))
    return converted if right == 0 else Constant(tidy(left / right))


def into_unit(expression: Expression, source: str, target: str) -> Expression:
    """Return an expression that is in one unit in another one, or as it is where neither goes over into the other."""
    if source == target or not is_measure(source) or not go_together(source, target):
        return expression
    if isinstance(expression, Operation) and expression.operator == "list":
        return operation("list", tuple(into_unit(item, source, target) for item in expression.arguments))
    if isinstance(expression, Constant) and is_number(expression.value):
        return Constant(number_in(expression.value, source, target))
    factor, offset = conversion_of(source, target)
    scaled = _scaled(expression, factor)
    return scaled if not offset else Operation("+", (scaled, Constant(offset)))


def _scaled(expression: Expression, factor: float) -> Expression:
    if factor == 1:
        return expression
    inverse = tidy(1 / factor)
    if factor < 1 and isinstance(inverse, int):
        return Operation("/", (expression, Constant(inverse)))
    return Operation("*", (expression, Constant(factor)))

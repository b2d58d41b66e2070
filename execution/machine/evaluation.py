"""What an expression of a plan is worth, given variables, facts and zones; pure."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from editor.language.expressions.nodes import (
    Constant,
    Expression,
    Located,
    Operation,
    PlaceRef,
    Quantity,
    Reading,
    Variable,
)
from editor.language.expressions.values import MOST_ITEMS, arity_fits
from editor.language.plan.instructions import Plan
from execution.machine.places import CLOCK, NO_ZONES, ROLE, Facts, Point, Zones, distance_m, lies_in, position_of
from vipo_device.protocol.description import Scalar

Value = Scalar | tuple[Scalar, ...]
LARGEST = 1e15
LONGEST_TEXT = 2000
DEEPEST = 200


class EvaluationError(Exception):
    """An expression has no value; the message says why, in a sentence for a person."""


class NoReading(EvaluationError):
    """A device has not said yet what the expression asks."""


class NoValue(EvaluationError):
    """A variable has not been set yet."""


_COMPARE: Mapping[str, Callable[[float | str, float | str], bool]] = {
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge,
}  # fmt: skip
_RECKON: Mapping[str, Callable[[float, float], float]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv,
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Evaluation:
    """What an expression is worked out from."""

    variables: Mapping[str, Value]
    facts: Facts
    zones: Zones


def evaluate(
    expression: Expression, variables: Mapping[str, Value], facts: Facts, zones: Zones = NO_ZONES
) -> Value:  # fmt: skip
    """Return the expression's value.

    Raises:
        EvaluationError: a name is unknown, a reading is missing, or the values do not go together.
    """
    return _value(expression, _Evaluation(variables, facts, zones), 0)


def evaluate_scalar(
    expression: Expression, variables: Mapping[str, Value], facts: Facts, zones: Zones = NO_ZONES
) -> Scalar:
    """Return the expression's value, which must be a single one. Raises EvaluationError."""
    return _single(evaluate(expression, variables, facts, zones))


def evaluate_number(
    expression: Expression, variables: Mapping[str, Value], facts: Facts, zones: Zones = NO_ZONES
) -> float:
    """Return the expression's value, which must be a finite number. Raises EvaluationError."""
    return _number(evaluate(expression, variables, facts, zones))


def is_true(
    expression: Expression, variables: Mapping[str, Value], facts: Facts, zones: Zones = NO_ZONES
) -> bool:  # fmt: skip
    """Tell whether a condition holds; only yes and no will do. Raises EvaluationError."""
    return _truth(evaluate(expression, variables, facts, zones))


def _value(expression: Expression, of: _Evaluation, depth: int) -> Value:
    if depth > DEEPEST:
        raise EvaluationError("An expression is nested too deeply.")
    match expression:
        case Constant(value=value):
            return value
        case Variable(name=name):
            if name not in of.variables:
                raise NoValue(f"There is no value called “{name}” here.")
            return of.variables[name]
        case Reading():
            return _read(expression, of, depth)
        case Operation(operator=name, arguments=arguments):
            return _operate(name, arguments, of, depth + 1)
        case Quantity():
            raise EvaluationError("A number still has its unit. Compile the program again.")
        case Located():
            return _thing(expression, of)


def _truth(value: Value) -> bool:
    if not isinstance(value, bool):
        raise EvaluationError(f"The condition gives {value!r} where yes or no is needed.")
    return value


def _list(arguments: tuple[Expression, ...], of: _Evaluation, depth: int) -> Value:
    return _bounded(tuple(_single(_value(a, of, depth)) for a in arguments))


def _single(value: Value) -> Scalar:
    if isinstance(value, tuple):
        raise EvaluationError("A list stands where one value is needed.")
    return value


def _bounded(items: tuple[Scalar, ...]) -> tuple[Scalar, ...]:
    if len(items) > MOST_ITEMS:
        raise EvaluationError(f"A list has more than {MOST_ITEMS:,} items.")
    return items


def _items(value: Value) -> tuple[Scalar, ...]:
    if not isinstance(value, tuple):
        raise EvaluationError(f"{value!r} stands where a list is needed.")
    return value


def _len(arguments: tuple[Expression, ...], of: _Evaluation, depth: int) -> Value:
    return len(_items(_value(arguments[0], of, depth)))


def _nth(arguments: tuple[Expression, ...], of: _Evaluation, depth: int) -> Value:
    """Return one item; the first has the number 1."""
    items, number = _items(_value(arguments[0], of, depth)), _number(_value(arguments[1], of, depth))
    if number != int(number) or not 1 <= number <= len(items):
        raise EvaluationError(f"There is no item {in_words(number)}: the list has {len(items)}.")
    return items[int(number) - 1]


def _read(reading: Reading, of: _Evaluation, depth: int) -> Scalar:
    device = _value(reading.device, of, depth + 1)
    value = of.facts.get((str(device), reading.property))
    if value is None:
        raise NoReading(f"{device} has not reported its {reading.property} yet.")
    return value


def _thing(located: Located, of: _Evaluation) -> str:
    """Return the id of a device, a place, or of the robot that has a role."""
    if located.role is not None:
        robot = of.facts.get((ROLE, located.role))
        if not isinstance(robot, str) or not robot:
            raise NoReading(f"No robot has the role {located.role} yet.")
        return robot
    thing = located.device if located.device is not None else located.place
    if thing is None:
        raise EvaluationError("A point or a zone stands where one value is needed.")
    return thing


def _point(expression: Expression, of: _Evaluation, depth: int) -> Point:
    """Return where something is, in metres."""
    if isinstance(expression, Located) and expression.point is not None:
        return expression.point
    thing = _value(expression, of, depth)
    if not isinstance(thing, str):
        raise EvaluationError(f"{thing!r} stands where a device or a place is needed.")
    found = position_of(thing, of.facts)
    if found is None:
        raise NoReading(f"It is not known yet where {thing} is.")
    return found


def _operate(name: str, arguments: tuple[Expression, ...], of: _Evaluation, depth: int) -> Value:
    if not arity_fits(name, len(arguments)):
        raise EvaluationError(f"“{name}” cannot be worked out from {len(arguments)} value(s).")
    if name in {"and", "or"}:
        wanted = name == "or"
        return wanted if any(_truth(_value(a, of, depth)) is wanted for a in arguments) else not wanted
    if name in _SPECIAL:
        return _SPECIAL[name](arguments, of, depth)
    if name in {"in", "not in"} and isinstance(arguments[1], Located) and arguments[1].zone is not None:
        return _in_zone(arguments[0], arguments[1].zone, of, depth) is (name == "in")
    values = tuple(_value(a, of, depth) for a in arguments)
    if name in {"min", "max"}:
        return (min if name == "min" else max)(map(_number, values))
    return _apply_one(name, values[0]) if len(values) == 1 else _apply_two(name, values[0], values[1])


def _not(arguments: tuple[Expression, ...], of: _Evaluation, depth: int) -> Value:
    return not _truth(_value(arguments[0], of, depth))


def _distance(arguments: tuple[Expression, ...], of: _Evaluation, depth: int) -> Value:
    return distance_m(_point(arguments[0], of, depth), _point(arguments[1], of, depth))


def _nearest(arguments: tuple[Expression, ...], of: _Evaluation, depth: int) -> Value:
    """Return the id of the nearest; of those that are just as near, the first."""
    start = _point(arguments[0], of, depth)
    things = [(distance_m(start, _point(a, of, depth)), _value(a, of, depth)) for a in arguments[1:]]
    return min(things, key=operator.itemgetter(0))[1]


def _count(arguments: tuple[Expression, ...], of: _Evaluation, depth: int) -> Value:
    return sum(_truth(_value(a, of, depth)) for a in arguments)


def _now(arguments: tuple[Expression, ...], of: _Evaluation, depth: int) -> Value:
    value = of.facts.get((CLOCK, "now"))
    if value is None:
        raise NoReading("The time of day is not known yet.")
    return _number(value)


def _text(arguments: tuple[Expression, ...], of: _Evaluation, depth: int) -> Value:
    text = "".join(in_words(_value(a, of, depth)) for a in arguments)
    if len(text) > LONGEST_TEXT:
        raise EvaluationError(f"A text has more than {LONGEST_TEXT} characters.")
    return text


def in_words(value: Value) -> str:
    """Return a value as people write it."""
    if isinstance(value, tuple):
        return ", ".join(map(in_words, value))
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float) and math.isfinite(value):
        return f"{round(value, 3) or 0.0:.15g}"
    return "" if value is None else str(value)


def _in_zone(thing: Expression, zone: str, of: _Evaluation, depth: int) -> bool:
    if zone not in of.zones:
        raise EvaluationError(f"There is no zone {zone}.")
    return lies_in(_point(thing, of, depth), of.zones[zone])


_SPECIAL: Mapping[str, Callable[[tuple[Expression, ...], _Evaluation, int], Value]] = {
    "not": _not, "distance": _distance, "nearest": _nearest, "count": _count, "now": _now, "text": _text,
    "list": _list, "len": _len, "nth": _nth,
}  # fmt: skip


def _apply_one(name: str, value: Value) -> Value:
    number = _number(value)
    match name:
        case "-":
            return -number
        case "abs":
            return abs(number)
        case "round":
            return round(number)
    raise EvaluationError(f"“{name}” is not something that can be worked out from one value.")


def _apply_two(name: str, left: Value, right: Value) -> Value:
    if name in {"==", "!="}:
        return (left == right) is (name == "==")
    if name in {"in", "not in"}:
        return _contains(right, left) is (name == "in")
    if name in _COMPARE:
        if isinstance(left, str) and isinstance(right, str):
            return _COMPARE[name](left, right)
        return _COMPARE[name](_number(left), _number(right))
    if isinstance(left, tuple) and name in _RECKON:
        if name == "+" and isinstance(right, tuple):
            return _bounded(left + right)
        return tuple(_reckon(name, _number(item), _number(right)) for item in left)  # into another unit
    if name in _RECKON:
        return _reckon(name, _number(left), _number(right))
    raise EvaluationError(f"“{name}” is not an operator of this language.")


def _contains(whole: Value, part: Value) -> bool:
    if isinstance(whole, tuple):
        return part in whole
    if isinstance(whole, str) and isinstance(part, str):
        return part in whole
    raise EvaluationError("“in” needs a list or a text on its right.")


def _reckon(name: str, left: float, right: float) -> float:
    if name == "/" and right == 0:
        raise EvaluationError("A number is divided by zero.")
    return _number(_RECKON[name](left, right))


def _number(value: Value) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise EvaluationError(f"{value!r} stands where a number is needed.")
    if not abs(value) <= LARGEST:
        raise EvaluationError("A number has grown beyond all measure.")
    return value


def parts_of_plan(plan: Plan) -> Iterator[Expression]:
    """Yield every expression of a plan with everything in it."""
    for event in plan.events:
        yield from _parts(event.condition)
    for instruction in plan.instructions:
        for slot in type(instruction.do).__dataclass_fields__:
            yield from _parts(getattr(instruction.do, slot))


def watched_properties(plan: Plan) -> frozenset[str]:
    """Return the names of the properties that any expression of the plan reads."""
    read = (part.property for part in parts_of_plan(plan) if isinstance(part, Reading))
    return frozenset({name for _, name in plan.reads}.union(read))


def needs_the_clock(plan: Plan) -> bool:
    """Tell whether any expression of the plan asks for the time of day."""
    return any(isinstance(part, Operation) and part.operator == "now" for part in parts_of_plan(plan))


def located_things(plan: Plan) -> frozenset[Located]:
    """Return the devices, places, roles and zones that expressions of the plan speak of."""
    return frozenset(part for part in parts_of_plan(plan) if isinstance(part, Located))


def bound_roles(plan: Plan) -> dict[tuple[str, str], Scalar]:
    """Return the robots of the roles that expressions speak of and that are bound to one: known from the start."""
    roles = {thing.role for thing in located_things(plan)}
    bound = (binding for binding in plan.roles.values() if binding.role in roles)
    return {(ROLE, binding.role): binding.device for binding in bound if binding.device is not None}


def _parts(value: object) -> Iterator[Expression]:
    match value:
        case Constant() | Variable() | Quantity() | Located():
            yield value
        case Reading(device=device):
            yield value
            yield from _parts(device)
        case Operation(arguments=arguments):
            yield value
            for argument in arguments:
                yield from _parts(argument)
        case PlaceRef(value=inner):
            yield from _parts(inner)
        case Mapping():
            for argument in value.values():
                yield from _parts(argument)

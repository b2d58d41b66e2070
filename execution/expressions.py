"""What an expression of a plan is worth, given variables and readings; pure."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterator, Mapping

from editor.language.plan import Constant, Expression, Operation, Plan, Reading, Variable
from registry.capability import Scalar

Value = Scalar | tuple[Scalar, ...]
Facts = Mapping[tuple[str, str], Scalar]
LARGEST = 1e15


class EvaluationError(Exception):
    """An expression has no value; the message says why, in a sentence for a person."""


class NoReading(EvaluationError):
    """A device has not said yet what the expression asks."""


_COMPARE: Mapping[str, Callable[[float | str, float | str], bool]] = {
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge,
}  # fmt: skip
_RECKON: Mapping[str, Callable[[float, float], float]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv, "min": min, "max": max,
}  # fmt: skip


def evaluate(expression: Expression, variables: Mapping[str, Scalar], facts: Facts) -> Value:
    """Return the expression's value.

    Raises:
        EvaluationError: a name is unknown, a reading is missing, or the values do not go together.
    """
    match expression:
        case Constant(value=value):
            return value
        case Variable(name=name):
            if name not in variables:
                raise EvaluationError(f"There is no value called “{name}” here.")
            return variables[name]
        case Reading():
            return _read(expression, variables, facts)
        case Operation(operator=name, arguments=arguments):
            return _operate(name, arguments, variables, facts)


def evaluate_scalar(expression: Expression, variables: Mapping[str, Scalar], facts: Facts) -> Scalar:
    """Return the expression's value, which must be a single one."""
    value = evaluate(expression, variables, facts)
    if isinstance(value, tuple):
        raise EvaluationError("A list stands where one value is needed.")
    return value


def evaluate_number(expression: Expression, variables: Mapping[str, Scalar], facts: Facts) -> float:
    """Return the expression's value, which must be a finite number."""
    return _number(evaluate(expression, variables, facts))


def is_true(expression: Expression, variables: Mapping[str, Scalar], facts: Facts) -> bool:
    """Tell whether a condition holds; only yes and no will do."""
    value = evaluate(expression, variables, facts)
    if not isinstance(value, bool):
        raise EvaluationError(f"The condition gives {value!r} where yes or no is needed.")
    return value


def _read(reading: Reading, variables: Mapping[str, Scalar], facts: Facts) -> Scalar:
    device = evaluate(reading.device, variables, facts)
    value = facts.get((str(device), reading.property))
    if value is None:
        raise NoReading(f"{device} has not reported its {reading.property} yet.")
    return value


def _operate(name: str, arguments: tuple[Expression, ...], variables: Mapping[str, Scalar], facts: Facts) -> Value:
    if name in {"and", "or"}:
        wanted = name == "or"
        return wanted if any(is_true(a, variables, facts) is wanted for a in arguments) else not wanted
    if name == "not":
        return not is_true(arguments[0], variables, facts)
    values = tuple(evaluate(a, variables, facts) for a in arguments)
    if len(values) == 1:
        return _apply_one(name, values[0])
    if len(values) != 2:
        raise EvaluationError(f"“{name}” needs two values and was given {len(values)}.")
    return _apply_two(name, values[0], values[1])


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
    if not math.isfinite(value) or abs(value) > LARGEST:
        raise EvaluationError("A number has grown beyond all measure.")
    return value


def watched_properties(plan: Plan) -> frozenset[str]:
    """Return the names of the properties that any expression of the plan reads."""
    names = {name for _, name in plan.reads}
    for instruction in plan.instructions:
        for slot in type(instruction.do).__dataclass_fields__:
            names.update(_property_names(getattr(instruction.do, slot)))
    return frozenset(names)


def _property_names(value: object) -> Iterator[str]:
    match value:
        case Reading(property=name):
            yield name
        case Operation(arguments=arguments):
            for argument in arguments:
                yield from _property_names(argument)
        case Mapping():
            for argument in value.values():
                yield from _property_names(argument)

"""Which values are written out, what those are worth, and which are measured anew whenever they are asked for."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from functools import reduce
from typing import Any

from editor.language.expressions.nodes import Constant, Expression, Located, Operation, Quantity, Reading
from editor.language.expressions.values import parts_of

_COMPUTE: Mapping[str, Callable[[Any, Any], Any]] = {
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge, "==": operator.eq, "!=": operator.ne,
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv, "min": min, "max": max,
    "in": lambda part, whole: operator.contains(whole, part),
    "not in": lambda part, whole: not operator.contains(whole, part),
    "and": lambda a, b: a and b, "or": lambda a, b: a or b,
}  # fmt: skip
_COMPUTE_ONE: Mapping[str, Callable[[Any], Any]] = {
    "-": operator.neg, "not": operator.not_, "abs": abs, "round": round,
}  # fmt: skip


def constant_value(expression: Expression) -> object:
    """Return what an expression without readings and parameters is always worth; None when that cannot be said."""
    if _depends(expression):
        return None
    try:
        return _compute(expression)
    except (TypeError, ArithmeticError, ValueError, LookupError):
        return None


def _depends(expression: Expression) -> bool:
    """Tell whether anything in an expression is measured or given, so that nothing need be worked out."""
    if isinstance(expression, Operation):
        return any(map(_depends, expression.arguments))
    return not isinstance(expression, Constant)


def _compute(expression: Expression) -> object:
    match expression:
        case Constant(value=value):
            return value
        case Operation(operator=name, arguments=(only,)):
            return _COMPUTE_ONE[name](_compute(only))
        case Operation(operator=name, arguments=arguments):
            return reduce(_COMPUTE[name], [_compute(argument) for argument in arguments])
    raise LookupError("It depends on what is measured or given.")


def is_written(expression: Expression) -> bool:
    """Tell whether nothing in an expression is measured or given: it says the same whenever it is asked."""
    return all(
        isinstance(part, Constant | Quantity) or (isinstance(part, Operation) and part.operator != "now")
        for part in parts_of(expression)
    )


def is_measured(expression: Expression) -> bool:
    """Tell whether the expression looks at anything that changes by itself: a device, a place, the time."""
    return any(
        isinstance(part, Reading) or (isinstance(part, Operation) and part.operator in {"now", "distance", "nearest"})
        or (isinstance(part, Located) and part.role is not None)
        for part in parts_of(expression)
    )  # fmt: skip

"""What a condition can ever be: computed with the ranges that devices declare for their properties."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf
from typing import TYPE_CHECKING

from editor.language.expressions.nodes import Constant, Expression, Operation, Reading, Variable
from editor.language.expressions.unit_conversion import convert_units
from editor.language.expressions.value_types import TypeChecker, ValueType, property_spec
from editor.language.expressions.values import COMPARISONS, is_number, parts_of
from editor.language.site.surroundings import Surroundings

if TYPE_CHECKING:
    from dataclasses import dataclass
else:
    from editor.language.allocation import dataclass

_DAY_S = 86400


@dataclass(frozen=True, slots=True)
class Range:
    """Numbers from the least to the most; an open end is not reached itself."""

    least: float = -inf
    most: float = inf
    least_open: bool = False
    most_open: bool = False

    @property
    def empty(self) -> bool:
        """Tell whether no number lies in it."""
        return self.least > self.most or (self.least == self.most and (self.least_open or self.most_open))

    def meet(self, other: Range) -> Range:
        """Return the numbers that lie in both."""
        low = max((self.least, self.least_open), (other.least, other.least_open))
        high = min((self.most, not self.most_open), (other.most, not other.most_open))
        return Range(low[0], high[0], low[1], not high[1])


ANY = Range()


def possible(
    expression: Expression, surroundings: Surroundings, variables: Mapping[str, ValueType] | None = None
) -> bool | None:
    """Tell whether a condition always holds (True), never holds (False), or may do either (None)."""
    checker = TypeChecker(surroundings, variables or {}, [])
    return _truth(convert_units(expression, "", checker), surroundings)


def range_of(expression: Expression, surroundings: Surroundings, variables: Mapping[str, Range] | None = None) -> Range:
    """Return between which numbers the value of an expression without quantities lies."""
    if isinstance(expression, Constant):
        value = expression.value
        return Range(value, value) if is_number(value) else ANY
    if isinstance(expression, Reading):
        return _declared(expression, surroundings)
    if isinstance(expression, Variable):
        return ANY if variables is None else variables.get(expression.name, ANY)
    if isinstance(expression, Operation):
        name, arguments = expression.operator, expression.arguments
        if name in {"count", "now", "distance"}:
            return _counted(name, arguments, surroundings)
        return _computed(name, [range_of(argument, surroundings, variables) for argument in arguments])
    return ANY


def _declared(reading: Reading, surroundings: Surroundings) -> Range:
    spec = property_spec(reading, surroundings)
    if spec is None or spec.type != "number":
        return ANY
    return Range(-inf if spec.minimum is None else spec.minimum, inf if spec.maximum is None else spec.maximum)


def _counted(name: str, arguments: Sequence[Expression], surroundings: Surroundings) -> Range:
    if name != "count":
        return Range(0, _DAY_S if name == "now" else inf, most_open=name == "now")
    truths = [_truth(argument, surroundings) for argument in arguments]
    return Range(truths.count(True), len(truths) - truths.count(False))


def _computed(name: str, ranges: Sequence[Range]) -> Range:
    match name, ranges:
        case "-", [only]:
            return Range(-only.most, -only.least)
        case "abs", [only]:
            least = 0 if only.least <= 0 <= only.most else min(abs(only.least), abs(only.most))
            return Range(least, max(abs(only.least), abs(only.most)))
        case "round", [only]:
            return Range(_rounded(only.least), _rounded(only.most))
        case "+", [left, right]:
            return Range(left.least + right.least, left.most + right.most)
        case "-", [left, right]:
            return Range(left.least - right.most, left.most - right.least)
        case "*", [left, right]:
            return _product(left, right)
        case "/", [left, Range(least=least, most=most)] if least == most != 0:
            return _product(left, Range(1 / least, 1 / least))
        case "min", _:
            return Range(min(each.least for each in ranges), min(each.most for each in ranges))
        case "max", _:
            return Range(max(each.least for each in ranges), max(each.most for each in ranges))
    return ANY


def _rounded(number: float) -> float:
    return number if number in {inf, -inf} else round(number)


def _product(left: Range, right: Range) -> Range:
    ends = [0 if 0 in {a, b} else a * b for a in (left.least, left.most) for b in (right.least, right.most)]
    return Range(min(ends), max(ends))


def _truth(expression: Expression, surroundings: Surroundings) -> bool | None:
    if isinstance(expression, Constant) and isinstance(expression.value, bool):
        return expression.value
    if not isinstance(expression, Operation):
        return None
    name, arguments = expression.operator, expression.arguments
    if name in COMPARISONS:
        return _compared(name, arguments[0], arguments[1], surroundings)
    if name == "not":
        inner = _truth(arguments[0], surroundings)
        return None if inner is None else not inner
    return _joined(name, arguments, surroundings) if name in {"and", "or"} else None


def _joined(name: str, arguments: Sequence[Expression], surroundings: Surroundings) -> bool | None:
    decides = name == "or"
    truths = [_truth(argument, surroundings) for argument in arguments]
    if decides in truths:
        return decides
    if None not in truths:
        return not decides
    return False if name == "and" and _exclude_each_other(arguments, surroundings) else None


def _exclude_each_other(arguments: Sequence[Expression], surroundings: Surroundings) -> bool:
    """Tell whether comparisons of one reading with numbers leave no number: `t > 60 and t < 50`."""
    left: dict[Reading | Variable, Range] = {}
    for argument in arguments:
        found = _limited(argument)
        if found is not None:
            measured, limits = found
            left[measured] = left.get(measured, range_of(measured, surroundings)).meet(limits)
    return any(limits.empty for limits in left.values())


_MIRRORED: Mapping[str, str] = {"<": ">", ">": "<", "<=": ">=", ">=": "<=", "==": "=="}


def _limited(comparison: Expression) -> tuple[Reading | Variable, Range] | None:
    """Return the reading and the numbers that a comparison with a number leaves for it."""
    match comparison:
        case Operation(operator=name, arguments=(Reading() | Variable() as measured, Constant(value=value))):
            pass
        case Operation(operator=other, arguments=(Constant(value=value), Reading() | Variable() as measured)):
            name = _MIRRORED.get(other, "")
        case _:
            return None
    if not is_number(value) or name not in _MIRRORED:
        return None
    if name == "==":
        return measured, Range(value, value)
    strict = len(name) == 1
    return measured, (Range(most=value, most_open=strict) if "<" in name else Range(value, least_open=strict))


def _compared(name: str, left: Expression, right: Expression, surroundings: Surroundings) -> bool | None:
    if name in {"in", "not in"}:
        found = _contained(left, right, surroundings)
        return found if found is None or name == "in" else not found
    if name in {"==", "!="}:
        same = _same(left, right, surroundings)
        return same if same is None or name == "==" else not same
    mine, theirs = range_of(left, surroundings), range_of(right, surroundings)
    if name in {">", ">="}:
        mine, theirs = theirs, mine
    return _below(mine, theirs, strict=len(name) == 1)


def _below(left: Range, right: Range, *, strict: bool) -> bool | None:
    """Tell whether all numbers of one range lie below all of the other (True), or none does (False)."""
    touches_low = left.most == right.least and not (left.most_open or right.least_open)
    if left.most < right.least or (left.most == right.least and not (strict and touches_low)):
        return True
    touches_high = left.least == right.most and not (left.least_open or right.most_open)
    if left.least > right.most or (left.least == right.most and (strict or not touches_high)):
        return False
    return None


def _same(left: Expression, right: Expression, surroundings: Surroundings) -> bool | None:
    if isinstance(left, Constant) and isinstance(right, Constant):
        return left.value == right.value
    words = _words(left, surroundings), _words(right, surroundings)
    if words[0] and words[1]:
        return None if words[0] & words[1] else False
    mine, theirs = range_of(left, surroundings), range_of(right, surroundings)
    if mine.meet(theirs).empty:
        return False
    return True if mine.least == mine.most == theirs.least == theirs.most else None


def _words(expression: Expression, surroundings: Surroundings) -> frozenset[str]:
    """Return the texts that an expression can be; empty when that is not known."""
    if isinstance(expression, Constant) and isinstance(expression.value, str):
        return frozenset({expression.value})
    spec = property_spec(expression, surroundings) if isinstance(expression, Reading) else None
    return frozenset(spec.options) if spec is not None else frozenset()


def _contained(left: Expression, right: Expression, surroundings: Surroundings) -> bool | None:
    values = right.value if isinstance(right, Constant) else None
    if not isinstance(values, tuple):
        return None
    truths = [_same(left, Constant(value), surroundings) for value in values]
    if True in truths:
        return True
    options = _words(left, surroundings)
    if options and options <= frozenset(value for value in values if isinstance(value, str)):
        return True
    return None if None in truths else False


def first_limited_reading(expression: Expression, surroundings: Surroundings) -> Reading | None:
    """Return the first reading of an expression for which its device declares a range or options."""
    for part in parts_of(expression):
        spec = property_spec(part, surroundings) if isinstance(part, Reading) else None
        limited = spec is not None and (spec.minimum is not None or spec.maximum is not None or spec.options)
        if isinstance(part, Reading) and limited:
            return part
    return None

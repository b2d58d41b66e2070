"""What a value or a condition can be, as far as its devices and what is known of the variables tell."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce
from math import inf
from typing import TYPE_CHECKING, Final, Protocol

from editor.language.expressions.nodes import Constant, Expression, Located, Operation, Reading, Variable
from editor.language.expressions.unit_conversion import convert_units
from editor.language.expressions.value_types import TypeChecker, ValueType, property_spec
from editor.language.expressions.values import COMPARISONS, MOST_ITEMS, is_number
from editor.language.site.surroundings import Surroundings

if TYPE_CHECKING:
    from dataclasses import dataclass
else:
    from editor.language.allocation import dataclass

_DAY_S = 86400


@dataclass(frozen=True, slots=True)
class Range:
    """Numbers from the least to the most; an open end is not reached itself, and 0 may be left out between them."""

    least: float = -inf
    most: float = inf
    least_open: bool = False
    most_open: bool = False
    not_zero: bool = False

    @property
    def empty(self) -> bool:
        """Tell whether no number lies in it."""
        return self.least > self.most or (self.least == self.most and (self.least_open or self.most_open))

    @property
    def is_fraction(self) -> bool:
        """Tell whether it is one number alone, and no whole one."""
        return -inf < self.least == self.most < inf and self.least != int(self.least)

    def meet(self, other: Range) -> Range:
        """Return the numbers that lie in both."""
        low = max((self.least, self.least_open), (other.least, other.least_open))
        high = min((self.most, not self.most_open), (other.most, not other.most_open))
        return Range(low[0], high[0], low[1], not high[1], self.not_zero or other.not_zero)

    @property
    def has_zero(self) -> bool:
        """Tell whether 0 lies in it."""
        starts = self.least < 0 or (self.least == 0 and not self.least_open)
        ends = self.most > 0 or (self.most == 0 and not self.most_open)
        return starts and ends and not self.not_zero


ANY = Range()


Words = frozenset[str | bool]
"""The texts, devices or truths that a value is one of."""
MOST_WORDS = 16
MOST_LOOKED_AT = 100
"""Of a longer list nothing is known but its length."""


@dataclass(frozen=True, slots=True)
class Items:
    """A list: how many items it has at least and at most, and what each of them may be."""

    least: int = 0
    most: int = MOST_ITEMS
    each: Range | Words | None = None
    sure: Words = frozenset()
    """What is among them whatever the others are."""


Known = Range | Words | Items | None
"""What is known of a value; None: nothing."""


def either_known(first: Known, second: Known) -> Known:
    """Return what is known of a value that is one or the other."""
    if isinstance(first, Range) and isinstance(second, Range):
        low = min((first.least, first.least_open), (second.least, second.least_open))
        high = max((first.most, not first.most_open), (second.most, not second.most_open))
        return Range(low[0], high[0], low[1], not high[1], not (first.has_zero or second.has_zero))
    if isinstance(first, frozenset) and isinstance(second, frozenset) and len(first | second) <= MOST_WORDS:
        return first | second
    if isinstance(first, Items) and isinstance(second, Items):
        least, most = min(first.least, second.least), max(first.most, second.most)
        return Items(least, most, _each_of(first, second), first.sure & second.sure)
    return None


def _each_of(first: Items, second: Items) -> Range | Words | None:
    """Return what an item of one list or of the other may be; an empty one has no say."""
    if not first.most or not second.most:
        return second.each if not first.most else first.each
    found = either_known(first.each, second.each)
    return None if isinstance(found, Items) else found


class Variables(Protocol):
    """What is known of the variables where an expression stands."""

    def get(self, name: str, /) -> Known:
        """Return what is known of a variable."""


class _Nothing:
    def get(self, name: str, /) -> Known:
        return None


NOTHING_KNOWN: Final[Variables] = _Nothing()


@dataclass(frozen=True, slots=True)
class Here:
    """The place of an expression without quantities: its site, and what is known of the variables there."""

    surroundings: Surroundings
    variables: Variables = NOTHING_KNOWN

    def known(self, expression: Expression) -> Known:
        """Return what is known of a value."""
        told = self.items(expression) or self.words(expression)
        if told:
            return told
        if _is_condition(expression):
            truth = self.truth(expression)
            return None if truth is None else frozenset({truth})
        found = self.range(expression)
        return None if found == ANY else found

    def items(self, expression: Expression) -> Items | None:
        """Return what is known of a list; None where nothing is, or where it is none."""
        match expression:
            case Constant(value=tuple(values)):
                return self._listed([Constant(value) for value in values])
            case Operation(operator="list", arguments=arguments):
                return self._listed(arguments)
            case Variable(name=name):
                known = self.variables.get(name)
                return known if isinstance(known, Items) else None
            case Operation(operator="+", arguments=(left, right)):
                first, second = self.items(left), self.items(right)
                if first is not None and second is not None:
                    most = min(first.most + second.most, max(MOST_ITEMS, first.least + second.least))
                    sure = first.sure | second.sure
                    return Items(first.least + second.least, most, _each_of(first, second), sure)
        return None

    def _listed(self, items: Sequence[Expression]) -> Items:
        if not items or len(items) > MOST_LOOKED_AT:
            return Items(len(items), len(items))
        known = reduce(either_known, map(self.known, items))
        return Items(len(items), len(items), None if isinstance(known, Items) else known, self._sure(items))

    def _sure(self, items: Sequence[Expression]) -> Words:
        """Return what is among items whatever the others are."""
        return frozenset().union(*[each for each in map(self.words, items) if len(each) == 1])

    def range(self, expression: Expression) -> Range:
        """Return between which numbers a value lies."""
        match expression:
            case Constant(value=value):
                return Range(value, value) if is_number(value) else ANY
            case Reading():
                return _declared(expression, self.surroundings)
            case Variable(name=name):
                known = self.variables.get(name)
                return known if isinstance(known, Range) else ANY
            case Operation(operator="len", arguments=(whole,)):
                items = self.items(whole) or Items()
                return Range(items.least, items.most)
            case Operation(operator="nth", arguments=(whole, _)):
                each = (self.items(whole) or Items()).each
                return each if isinstance(each, Range) else ANY
            case Operation(operator="count" | "now" | "distance" as name, arguments=arguments):
                return self._counted(name, arguments)
            case Operation(operator=name, arguments=arguments):
                return _computed(name, [self.range(argument) for argument in arguments])
        return ANY

    def _counted(self, name: str, arguments: Sequence[Expression]) -> Range:
        if name != "count":
            return Range(0, _DAY_S if name == "now" else inf, most_open=name == "now")
        truths = [self.truth(argument) for argument in arguments]
        return Range(truths.count(True), len(truths) - truths.count(False))

    def truth(self, expression: Expression) -> bool | None:
        """Tell whether a condition always holds (True), never holds (False), or may do either (None)."""
        match expression:
            case Constant(value=bool(value)):
                return value
            case Variable(name=name):
                known = self.variables.get(name)
                return next(iter(known)) is True if isinstance(known, frozenset) and len(known) == 1 else None
            case Operation(operator="not", arguments=(inner,)):
                truth = self.truth(inner)
                return None if truth is None else not truth
            case Operation(operator="and" | "or" as name, arguments=arguments):
                return self._joined(name, arguments)
            case Operation(operator=name, arguments=(left, right)) if name in COMPARISONS:
                return self._compared(name, left, right)
        return None

    def _joined(self, name: str, arguments: Sequence[Expression]) -> bool | None:
        decides = name == "or"
        truths = [self.truth(argument) for argument in arguments]
        if decides in truths:
            return decides
        if None not in truths:
            return not decides
        return False if name == "and" and self._exclude_each_other(arguments) else None

    def _exclude_each_other(self, arguments: Sequence[Expression]) -> bool:
        """Tell whether comparisons of one value with numbers leave no number: `t > 60 and t < 50`."""
        left: dict[Reading | Variable, Range] = {}
        for argument in arguments:
            found = limited(argument)
            if found is not None:
                measured, limits = found
                left[measured] = left.get(measured, self.range(measured)).meet(limits)
        return any(limits.empty for limits in left.values())

    def _compared(self, name: str, left: Expression, right: Expression) -> bool | None:
        if name in {"in", "not in"}:
            found = self._contained(left, right)
            return found if found is None or name == "in" else not found
        if name in {"==", "!="}:
            same = self._same(left, right)
            return same if same is None or name == "==" else not same
        mine, theirs = self.range(left), self.range(right)
        if name in {">", ">="}:
            mine, theirs = theirs, mine
        return _below(mine, theirs, strict=len(name) == 1)

    def _same(self, left: Expression, right: Expression) -> bool | None:
        if isinstance(left, Constant) and isinstance(right, Constant):
            return left.value == right.value
        words = self.words(left), self.words(right)
        if words[0] and words[1]:
            if not words[0] & words[1]:
                return False
            return True if words[0] == words[1] and len(words[0]) == 1 else None
        mine, theirs = self.range(left), self.range(right)
        if mine.meet(theirs).empty:
            return False
        return True if mine.least == mine.most == theirs.least == theirs.most else None

    def words(self, expression: Expression) -> Words:
        """Return the texts, devices or truths that a value can be; empty when that is not known."""
        match expression:
            case Constant(value=str() | bool() as value):
                return frozenset({value})
            case Reading():
                spec = property_spec(expression, self.surroundings)
                return frozenset(spec.options) if spec is not None else frozenset()
            case Variable(name=name):
                known = self.variables.get(name)
                return known if isinstance(known, frozenset) else frozenset()
            case Located(device=str(value)) | Located(place=str(value)):
                return frozenset({value})
            case Operation(operator="nth", arguments=(whole, _)):
                each_item = (self.items(whole) or Items()).each
                return each_item if isinstance(each_item, frozenset) else frozenset()
            case Operation(operator="nearest", arguments=(_, *candidates)):
                each = [self.words(candidate) for candidate in candidates]
                return frozenset().union(*each) if all(each) else frozenset()
        return frozenset()

    def _contained(self, left: Expression, right: Expression) -> bool | None:
        options = self.words(left)
        match right:
            case Constant(value=tuple(values)):
                items: Sequence[Expression] = [Constant(value) for value in values]
            case Operation(operator="list", arguments=arguments):
                items = arguments
            case _:
                return _held_in(options, self.items(right) or Items())
        truths = [self._same(left, item) for item in items]
        if True in truths or (options and options <= self._sure(items)):
            return True
        return None if None in truths else False


def _held_in(options: Words, listed: Items) -> bool | None:
    """Tell whether one of some words is in a list of which no more is known than what its items may be."""
    if options and options <= listed.sure:
        return True
    is_other = bool(options) and isinstance(listed.each, frozenset) and not options & listed.each
    return False if is_other or not listed.most else None


def possible(
    expression: Expression,
    surroundings: Surroundings,
    types: Mapping[str, ValueType] | None = None,
    variables: Variables = NOTHING_KNOWN,
) -> bool | None:
    """Tell whether a condition always holds (True), never holds (False), or may do either (None)."""
    checker = TypeChecker(surroundings, types or {}, [])
    return Here(surroundings, variables).truth(convert_units(expression, "", checker))


def _is_condition(expression: Expression) -> bool:
    operator = expression.operator if isinstance(expression, Operation) else ""
    return operator in COMPARISONS or operator in {"and", "or", "not"}


def _declared(reading: Reading, surroundings: Surroundings) -> Range:
    spec = property_spec(reading, surroundings)
    if spec is None or spec.type != "number":
        return ANY
    return Range(-inf if spec.minimum is None else spec.minimum, inf if spec.maximum is None else spec.maximum)


def _computed(name: str, ranges: Sequence[Range]) -> Range:
    match name, ranges:
        case "-", [only]:
            return _times(only, -1)
        case "abs", [only]:
            least = 0 if only.least <= 0 <= only.most else min(abs(only.least), abs(only.most))
            return Range(least, max(abs(only.least), abs(only.most)))
        case "round", [only]:
            return Range(_rounded(only.least), _rounded(only.most))
        case "+", [left, right]:
            return _sum(left, right)
        case "-", [left, right]:
            return _sum(left, _times(right, -1))
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


def _sum(left: Range, right: Range) -> Range:
    low, high = left.least_open or right.least_open, left.most_open or right.most_open
    return Range(left.least + right.least, left.most + right.most, low, high)


def _times(only: Range, factor: float) -> Range:
    """Return a range times a number that is not 0."""
    least, most = only.least * factor, only.most * factor
    if factor < 0:
        return Range(most, least, only.most_open, only.least_open, only.not_zero)
    return Range(least, most, only.least_open, only.most_open, only.not_zero)


def _product(left: Range, right: Range) -> Range:
    for one, other in ((left, right), (right, left)):
        if one.least == one.most and one.least not in {0, inf, -inf}:
            return _times(other, one.least)
    ends = [0 if 0 in {a, b} else a * b for a in (left.least, left.most) for b in (right.least, right.most)]
    return Range(min(ends), max(ends))


_MIRRORED: Mapping[str, str] = {"<": ">", ">": "<", "<=": ">=", ">=": "<=", "==": "=="}


def limited(comparison: Expression) -> tuple[Reading | Variable, Range] | None:
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


def _below(left: Range, right: Range, *, strict: bool) -> bool | None:
    """Tell whether all numbers of one range lie below all of the other (True), or none does (False)."""
    touches_low = left.most == right.least and not (left.most_open or right.least_open)
    if left.most < right.least or (left.most == right.least and not (strict and touches_low)):
        return True
    touches_high = left.least == right.most and not (left.least_open or right.most_open)
    if left.least > right.most or (left.least == right.most and (strict or not touches_high)):
        return False
    return None

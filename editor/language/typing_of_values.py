"""What kind of value an expression gives, and whether its parts go together."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import reduce
from typing import Any

from editor.language.plan import Constant, Expression, Operation, Reading, Variable
from editor.language.surroundings import Surroundings
from editor.language.values import ARITHMETIC, COMPARISONS, FUNCTIONS, parts_of
from registry.capability import PropertySpec

UNIT_WORDS: Mapping[str, str] = {
    "MIN": "min", "SEC": "s", "HR": "h", "DEG_C": "°C", "PERCENT": "%", "M": "m", "MilliM": "mm",
    "KiloGM": "kg", "BAR": "bar", "PA": "Pa", "L": "l", "MilliL": "ml",
}  # fmt: skip
TYPE_WORDS: Mapping[str, str] = {
    "number": "a number", "text": "a text", "boolean": "yes or no", "list": "a list", "object": "a kind of object",
    "device": "a device", "place": "a place", "location": "a place",
}  # fmt: skip
_TEXT_LIKE = frozenset({"object", "device", "place", "location"})


@dataclass(frozen=True, slots=True)
class Kind:
    """The type of a value (empty: not known) and its unit (empty: none, or not known)."""

    type: str = ""
    unit: str = ""


@dataclass(frozen=True, slots=True)
class Mismatch:
    """Something that does not go together: a diagnostic's code with its arguments."""

    code: str
    args: Mapping[str, str]


UNKNOWN_KIND = Kind()
NUMBER, BOOLEAN = Kind("number"), Kind("boolean")


def unit_word(unit: str) -> str:
    """Return how people write a unit."""
    return UNIT_WORDS.get(unit, unit)


def property_spec(reading: Reading, surroundings: Surroundings) -> PropertySpec | None:
    """Return what the device says of the property that is read, if it says anything."""
    if not isinstance(reading.device, Constant):
        return None
    facts = surroundings.devices.get(str(reading.device.value))
    return None if facts is None else facts.description.property(reading.property)


@dataclass(slots=True)
class Typing:
    """Types expressions for one site; what does not go together is gathered in `mismatches`."""

    surroundings: Surroundings
    variables: Mapping[str, Kind]
    mismatches: list[Mismatch]

    def kind_of(self, expression: Expression) -> Kind:
        """Return the kind of value that the expression gives."""
        match expression:
            case Constant(value=value):
                return _constant_kind(value)
            case Variable(name=name):
                return self.variables.get(name, UNKNOWN_KIND)
            case Reading():
                spec = property_spec(expression, self.surroundings)
                return UNKNOWN_KIND if spec is None else Kind(plain_type(spec.type), spec.unit)
            case Operation():
                return self._operation(expression)

    def _operation(self, expression: Operation) -> Kind:
        name, arguments = expression.operator, expression.arguments
        kinds = [self.kind_of(argument) for argument in arguments]
        if name in {"and", "or", "not"}:
            for kind in kinds:
                self._need(kind, "boolean", f"“{name}”")
            return BOOLEAN
        if name in COMPARISONS:
            self._compare(name, kinds[0], kinds[1])
            return BOOLEAN
        for kind in kinds:
            self._need(kind, "number", f"“{name}”")
        unit = next((kind.unit for kind in kinds if kind.unit), "")
        if name in {"+", "-", "min", "max"}:
            self._same_unit(kinds)
        return Kind("number", unit) if name in ARITHMETIC or name in FUNCTIONS else UNKNOWN_KIND

    def _need(self, kind: Kind, wanted: str, subject: str) -> None:
        if kind.type not in {"", wanted}:
            given = TYPE_WORDS[kind.type]
            self.mismatches.append(
                Mismatch("wrong_type", {"subject": subject, "wanted": TYPE_WORDS[wanted], "given": given})
            )

    def _compare(self, name: str, left: Kind, right: Kind) -> None:
        if not left.type or not right.type:
            return
        if name in {"in", "not in"}:
            fits = right.type == "list" or (left.type == right.type == "text")
        elif name in {"==", "!="}:
            fits = left.type == right.type
        else:
            fits = left.type == right.type and left.type in {"number", "text"}
        if not fits:
            words = {"left": TYPE_WORDS[left.type], "right": TYPE_WORDS[right.type], "operator": f"“{name}”"}
            self.mismatches.append(Mismatch("not_comparable", {**words, "left": words["left"].capitalize()}))
        elif left.type == "number":
            self._same_unit([left, right])

    def _same_unit(self, kinds: list[Kind]) -> None:
        units = list(dict.fromkeys(kind.unit for kind in kinds if kind.unit))
        if len(units) > 1:
            words = {"subject": "The first value", "wanted": unit_word(units[0]), "given": unit_word(units[1])}
            self.mismatches.append(Mismatch("wrong_unit", words))


def plain_type(name: str) -> str:
    """Return the type that a value of this declared type has when it is compared."""
    return "text" if name in _TEXT_LIKE else name


def _constant_kind(value: object) -> Kind:
    if isinstance(value, bool):
        return BOOLEAN
    if isinstance(value, int | float):
        return NUMBER
    if isinstance(value, str):
        return Kind("text")
    return Kind("list") if isinstance(value, tuple) else UNKNOWN_KIND


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


def is_measured(expression: Expression) -> bool:
    """Tell whether the expression looks at any device."""
    return any(isinstance(part, Reading) for part in parts_of(expression))


def constant_value(expression: Expression) -> object:
    """Return what an expression without readings and parameters is always worth; None when that cannot be said."""
    try:
        return _compute(expression)
    except (TypeError, ArithmeticError, ValueError, LookupError):
        return None


def _compute(expression: Expression) -> object:
    match expression:
        case Constant(value=value):
            return value
        case Operation(operator=name, arguments=(only,)):
            return _COMPUTE_ONE[name](_compute(only))
        case Operation(operator=name, arguments=arguments):
            return reduce(_COMPUTE[name], [_compute(argument) for argument in arguments])
    raise LookupError("It depends on what is measured or given.")

"""The type and the unit of what an expression gives, and whether its parts go together."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from editor.language.expressions.constant_values import is_written
from editor.language.expressions.nodes import Constant, Expression, Located, Operation, Quantity, Reading, Variable
from editor.language.expressions.products import product_of
from editor.language.expressions.temperatures import (
    Sum,
    Term,
    base_unit,
    go_together,
    is_difference,
    is_temperature,
    joined_unit,
    sum_of,
)
from editor.language.expressions.values import COMPARISONS
from editor.language.site.surroundings import HeldDevice, Surroundings
from vipo_device.protocol.description import Description, PropertySpec, Scalar
from vipo_device.protocol.units import (
    PLAIN,
    UNITS,
    UNSAID,
    declared_unit,
    is_measure,
    unit_symbol,
)

if TYPE_CHECKING:
    from dataclasses import dataclass
else:
    from editor.language.allocation import dataclass

TYPE_WORDS: Mapping[str, str] = {
    "number": "a number", "text": "a text", "boolean": "yes or no", "list": "a list", "object": "a kind of object",
    "device": "a device", "place": "a place", "location": "a place", "zone": "a zone", "point": "a point",
}  # fmt: skip
LIST_OF = "list of "
"""How the name of a declared type of lists begins; that of its items follows."""
LIST_WORDS: Mapping[str, str] = {
    "number": "a list of numbers", "text": "a list of texts", "boolean": "a list of yes or no",
}  # fmt: skip
_NUMBERS = (int, float)
_COMPARISONS = frozenset(COMPARISONS)
UNITS_DIFFER = "units_differ"
_UNARY = frozenset({"abs", "round", "-"})
_TEXT_LIKE = frozenset({"object", "device", "place", "location"})


@dataclass(frozen=True, slots=True)
class ValueType:
    """The type of a value (empty: not known) and its unit.

    A number without a unit is one that is written so; it takes the unit of what it meets. All others say one, also
    that they are plain numbers, or that their device does not say which.
    """

    type: str = ""
    unit: str = ""
    of: str = ""
    """The type of the items, where it is a list; then the unit is theirs."""
    measured: bool = False
    """It is known to be a temperature and no difference: a device reports it, or what it is worked out from."""
    held: frozenset[HeldDevice] | None = None
    """The devices that a variable may hold; None: not known."""

    @property
    def item(self) -> ValueType:
        """Return the type of an item of a list."""
        return ValueType(self.of, self.unit, measured=self.measured) if self.of else UNKNOWN_TYPE


@dataclass(frozen=True, slots=True)
class Mismatch:
    """Something that does not go together: a diagnostic's code with its arguments."""

    code: str
    args: Mapping[str, str]


UNKNOWN_TYPE = ValueType()
TEXT, BOOLEAN = ValueType("text"), ValueType("boolean")
WRITTEN, NUMBER = ValueType("number"), ValueType("number", PLAIN)
ZONE, POINT, LIST = ValueType("zone"), ValueType("point"), ValueType("list")
METRES, SECONDS = ValueType("number", "M"), ValueType("number", "SEC")


def unit_word(unit: str) -> str:
    """Return how people write a unit."""
    return unit_symbol(base_unit(unit))


def property_spec(reading: Reading, surroundings: Surroundings) -> PropertySpec | None:
    """Return what the device says of the property that is read, if it says anything.

    Of a role it is what all robots say that may take it, None where they do not say the same.
    """
    match reading.device:
        case Constant(value=device):
            facts = surroundings.devices.get(str(device))
            return None if facts is None else facts.description.property(reading.property)
        case Located(role=str(role)):
            return surroundings.crew.reading(role, reading.property)
    return None


def units_that_differ(name: str, first: tuple[Description, str], other: tuple[Description, str]) -> Mapping[str, str]:
    """Return the words for two devices, each with the unit that it counts something in that both call the same."""
    words = {"name": name, "first": first[0].name, "second": other[0].name}
    return {**words, "wanted": _counted_in(first[1]), "given": _counted_in(other[1])}


def _counted_in(unit: str) -> str:
    return {PLAIN: "plain numbers", UNSAID: "a unit that it does not say"}.get(unit) or unit_word(unit)


def type_of_scalar(value: Scalar) -> ValueType:
    """Return the type of a value that is written out; UNKNOWN_TYPE of one that is still to be entered (None)."""
    if isinstance(value, bool):
        return BOOLEAN
    if isinstance(value, _NUMBERS):
        return WRITTEN
    return TEXT if isinstance(value, str) else UNKNOWN_TYPE


@dataclass(slots=True)
class TypeChecker:
    """Types expressions for one site; what does not go together is gathered in `mismatches`."""

    surroundings: Surroundings
    variables: Mapping[str, ValueType]
    mismatches: list[Mismatch]

    def type_of(self, expression: Expression) -> ValueType:
        """Return the type of value that the expression gives."""
        return _TYPES[expression.__class__](self, expression)

    def constant(self, expression: Constant) -> ValueType:
        """Return the type of a value that is written out."""
        value = expression.value
        return (
            self._list_of([type_of_scalar(item) for item in value])
            if isinstance(value, tuple)
            else type_of_scalar(value)
        )

    def variable(self, expression: Variable) -> ValueType:
        """Return the type of a parameter or a variable."""
        return self.variables.get(expression.name, UNKNOWN_TYPE)

    def reading(self, expression: Reading) -> ValueType:
        """Return the type of a device's property."""
        if isinstance(expression.device, Variable):
            return self._read_of_held(self.variable(expression.device).held, expression.property)
        spec = property_spec(expression, self.surroundings)
        return UNKNOWN_TYPE if spec is None else _reported(declared_type(spec.type, declared_unit(spec.unit)))

    def _read_of_held(self, held: frozenset[HeldDevice] | None, name: str) -> ValueType:
        """Return the type of a property of a device that a variable holds; numbers must be in one unit, whichever."""
        kind, counting = self.surroundings.crew.told_by_held(held, name)
        if counting is None:
            return ValueType(kind)
        if counting.other is not None:
            words = units_that_differ(name, counting.first, counting.other)
            self.mismatches.append(Mismatch(UNITS_DIFFER, words))
            return UNKNOWN_TYPE
        return _reported(ValueType(kind, counting.first[1]))

    def _shown(self, expression: Expression) -> ValueType:
        """Return the type of what is put into a text; a number needs no unit there."""
        before = len(self.mismatches)
        found = self.type_of(expression)
        if _is_as_read(expression):
            self.mismatches[before:] = [each for each in self.mismatches[before:] if each.code != UNITS_DIFFER]
        return found

    def quantity(self, expression: Quantity) -> ValueType:
        """Return the type of a number with a unit."""
        if expression.unit not in UNITS:
            self.mismatches.append(Mismatch("unknown_unit", {"unit": expression.unit}))
        return ValueType("number", expression.unit)

    def located(self, expression: Located) -> ValueType:
        """Return the type of something that has a place."""
        if expression.zone is not None:
            return ZONE
        return TEXT if expression.point is None else POINT

    def operation(self, expression: Operation) -> ValueType:
        """Return the type of what an operation gives."""
        name, arguments = expression.operator, expression.arguments
        if name in {"in", "not in"} and isinstance(arguments[1], Constant) and isinstance(arguments[1].value, tuple):
            self.type_of(arguments[0])
            return BOOLEAN
        type_of = self._shown if name == "text" else self.type_of
        types = [type_of(argument) for argument in arguments]
        if name in {"and", "or", "not", "count"}:
            for value_type in types:
                self._need(value_type, "boolean", f"“{name}”")
            return NUMBER if name == "count" else BOOLEAN
        if name in _COMPARISONS:
            self._compare(name, expression, types[0], types[1])
            return BOOLEAN
        if name in {"distance", "nearest"}:
            for argument, value_type in zip(arguments, types, strict=True):
                self._need_place(argument, value_type, name)
            return METRES if name == "distance" else TEXT
        if name in {"text", "now"}:
            return TEXT if name == "text" else SECONDS
        if name in {"list", "len", "nth"}:
            return self._of_list(expression, types)
        if name == "+" and len(types) == 2 and "list" in {types[0].type, types[1].type}:
            return self._longer(expression, types)
        return self._computed(expression, types)

    def _of_list(self, expression: Operation, types: list[ValueType]) -> ValueType:
        """Return the type of a list, of how many items it has, or of one of them."""
        name = expression.operator
        if name == "list":
            unit = common_unit(expression.arguments, types) if types else ""
            return replace(self._list_of(types), unit=unit, measured=any(each.measured for each in types))
        self._need(types[0], "list", f"“{name}”")
        if name == "len":
            return NUMBER
        self._need(types[1], "number", f"“{name}”")
        if is_measure(types[1].unit):
            words = {"subject": "The number of the item", "given": unit_word(types[1].unit)}
            self.mismatches.append(Mismatch("unit_not_taken", words))
        return types[0].item if types[0].type == "list" else UNKNOWN_TYPE

    def _list_of(self, types: Sequence[ValueType]) -> ValueType:
        """Return the type of a list of such items, which must all be of one type that a list can hold."""
        known = [each.type for each in types if each.type]
        bad = next((each for each in known if each not in LIST_WORDS), "")
        other = next((each for each in known if each != known[0]), "")
        if bad:
            self.mismatches.append(Mismatch("not_in_a_list", {"given": TYPE_WORDS[bad]}))
        elif other:
            words = {"left": TYPE_WORDS[known[0]], "right": TYPE_WORDS[other]}
            self.mismatches.append(Mismatch("mixed_list", words))
        elif known and known[0] == "number":
            self._same_unit(list(types))
        return ValueType("list", "", "" if bad or not known else known[0])

    def _longer(self, expression: Operation, types: list[ValueType]) -> ValueType:
        """Return the type of two lists one behind the other."""
        for value_type in types:
            if value_type.type not in {"", "list"}:
                words = {"left": "A list", "right": TYPE_WORDS[value_type.type]}
                self.mismatches.append(Mismatch("list_and_item", words))
        items = [each.item for each in types]
        joined = self._list_of([item for item in items if item.type])
        return replace(joined, unit=common_unit(expression.arguments, types))

    def _computed(self, expression: Operation, types: list[ValueType]) -> ValueType:
        """Return the type of a number that is worked out from numbers."""
        name = expression.operator
        for value_type in types:
            self._need(value_type, "number", f"“{name}”")
        if name in {"*", "/"}:
            unit = self._unit_of_product(name, types[0].unit, types[1].unit)
            return ValueType("number", unit, measured=is_temperature(unit) and any(each.measured for each in types))
        self._same_unit(types)
        if len(types) == 2 and name in {"+", "-"}:
            found = sum_of_types(name, expression.arguments, types)
            if found.unclear:
                self.mismatches.append(_either_way(found.left, types))
            return ValueType("number", found.unit, measured=found.measured)
        unit = common_unit(expression.arguments, types)
        return ValueType("number", unit, measured=any(each.measured for each in types))

    def _need_place(self, argument: Expression, value_type: ValueType, name: str) -> None:
        """Only a point, or something that is known by its id, has a place."""
        written = isinstance(argument, Constant) or (isinstance(argument, Operation) and argument.operator != "nearest")
        if value_type.type not in {"", "text", "point"} or (written and value_type.type):
            words = {"subject": f"“{name}”", "wanted": TYPE_WORDS["place"], "given": TYPE_WORDS[value_type.type]}
            self.mismatches.append(Mismatch("wrong_type", words))

    def _need(self, value_type: ValueType, wanted: str, subject: str) -> None:
        if value_type.type not in {"", wanted}:
            given = TYPE_WORDS[value_type.type]
            self.mismatches.append(
                Mismatch("wrong_type", {"subject": subject, "wanted": TYPE_WORDS[wanted], "given": given})
            )

    def _compare(self, name: str, expression: Operation, left: ValueType, right: ValueType) -> None:
        if right.type == "zone" and name in {"in", "not in"}:
            self._need_place(expression.arguments[0], left, name)
            return
        if not left.type or not right.type:
            return
        if name in {"in", "not in"}:
            fits = (right.type == "list" and right.of in {"", left.type}) or (left.type == right.type == "text")
        elif name in {"==", "!="}:
            fits = left.type == right.type and left.type not in {"zone", "point"}
        else:
            fits = left.type == right.type and left.type in {"number", "text"}
        if not fits:
            words = {"left": TYPE_WORDS[left.type], "right": TYPE_WORDS[right.type], "operator": f"“{name}”"}
            self.mismatches.append(Mismatch("not_comparable", {**words, "left": words["left"].capitalize()}))
        elif left.type == "number" or left.of == right.of == "number":
            self._same_unit([left, right])

    def _same_unit(self, types: list[ValueType]) -> None:
        units = [value_type.unit for value_type in types if is_measure(value_type.unit)]
        other = next((unit for unit in units if not go_together(unit, units[0])), None)
        if other is not None and is_temperature(other) and is_temperature(units[0]):
            self.mismatches.append(_either_way(units[0], types))
        elif other is not None:
            words = {"subject": "The first value", "wanted": unit_word(units[0]), "given": unit_word(other)}
            self.mismatches.append(Mismatch("wrong_unit", words))
        elif units and any(value_type.unit == PLAIN for value_type in types):
            words = {"subject": "One of the values", "wanted": unit_word(units[0])}
            self.mismatches.append(Mismatch("plain_number", words))

    def _unit_of_product(self, name: str, left: str, right: str) -> str:
        product = product_of(name, left, right)
        if product is not None:
            return product.unit
        units = {"left": unit_word(left) if is_measure(left) else "1", "right": unit_word(right)}
        self.mismatches.append(Mismatch("no_such_product", {**units, "operator": "\u00d7" if name == "*" else "/"}))
        return UNSAID


_TYPES: Mapping[type[Expression], Callable[[TypeChecker, Any], ValueType]] = {
    Constant: TypeChecker.constant,
    Variable: TypeChecker.variable,
    Reading: TypeChecker.reading,
    Quantity: TypeChecker.quantity,
    Located: TypeChecker.located,
    Operation: TypeChecker.operation,
}


def common_unit(arguments: Sequence[Expression], types: Sequence[ValueType]) -> str:
    """Return the unit in which values meet: that of the first one that is measured or given, else the first."""
    units = [value_type.unit for value_type in types if is_measure(value_type.unit)]
    if not units:
        others = {value_type.unit for value_type in types}
        return next((unit for unit in (UNSAID, PLAIN) if unit in others), "")
    if len(set(units)) == 1:
        return units[0]
    paired = zip(arguments, types, strict=True)
    first = next(
        (each.unit for argument, each in paired if is_measure(each.unit) and not is_written(argument)), units[0]
    )
    return joined_unit(first, units)


def sum_of_types(name: str, arguments: Sequence[Expression], types: Sequence[ValueType]) -> Sum:
    """Return what two numbers give by `+` or `-`, and in which units they meet."""
    paired = zip(arguments, types, strict=True)
    left, right = (Term(each.unit, each.measured, is_written(argument)) for argument, each in paired)
    return sum_of(name, left, right, common_unit(arguments, types))


def _reported(found: ValueType) -> ValueType:
    return replace(found, measured=True) if is_temperature(found.unit) and not is_difference(found.unit) else found


def _is_as_read(expression: Expression) -> bool:
    """Tell whether a number is in the unit in which a device reports it, whichever that is."""
    if isinstance(expression, Operation):
        return expression.operator in _UNARY and len(expression.arguments) == 1 and _is_as_read(expression.arguments[0])
    return isinstance(expression, Reading)


def _either_way(unit: str, types: Sequence[ValueType]) -> Mismatch:
    """Return that a temperature meets another unit, of which nobody knows whether it is a difference."""
    other = next((each.unit for each in types if base_unit(each.unit) != base_unit(unit)), unit)
    return Mismatch("temperature_or_difference", {"wanted": unit_word(unit), "given": unit_word(other)})


def declared_type(type_name: str, unit: str) -> ValueType:
    """Return the type of what is declared; a number without a unit is a plain one."""
    if type_name.startswith(LIST_OF):
        item = declared_type(type_name.removeprefix(LIST_OF), unit)
        return ValueType("list", item.unit, item.type)
    return ValueType(plain_type(type_name), unit or PLAIN if type_name == "number" else "")


def type_word(value_type: ValueType) -> str:
    """Return how people speak of a value of this type."""
    return LIST_WORDS.get(value_type.of) or TYPE_WORDS[value_type.type]


def plain_type(name: str) -> str:
    """Return the type that a value of this declared type has when it is compared."""
    return "text" if name in _TEXT_LIKE else name

"""Temperatures and differences of temperatures: both are in °C, °F or K, and go over into another of these differently.

A difference has a unit of its own, which says so; also what may be either, since a program does not say whether it
takes one temperature from another or lowers one: that goes over into no other unit.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Final

from vipo_device.protocol.units import UNITS, conversion, convert, is_measure, same_dimension, tidy

_DIFFERENCE: Final = "Δ"
_EITHER: Final = "~"
_TEMPERATURES: Final = frozenset(code for code, unit in UNITS.items() if unit.dimension == "temperature")
_ABSOLUTE: Final = "K"


def base_unit(unit: str) -> str:
    """Return the unit as people write it, also of a difference."""
    return unit[1:] if is_difference(unit) or is_either(unit) else unit


def is_difference(unit: str) -> bool:
    """Tell whether a value in this unit is a difference of temperatures."""
    return unit[:1] == _DIFFERENCE and unit[1:] in _TEMPERATURES


def is_either(unit: str) -> bool:
    """Tell whether a value in this unit may be a temperature or a difference of two."""
    return unit[:1] == _EITHER and unit[1:] in _TEMPERATURES


def is_temperature(unit: str) -> bool:
    """Tell whether a value in this unit is a temperature, or a difference of two."""
    return base_unit(unit) in _TEMPERATURES


def is_scale(unit: str) -> bool:
    """Tell whether temperatures in this unit do not count from absolute zero, as differences do."""
    return unit in _TEMPERATURES and unit != _ABSOLUTE


def go_together(left: str, right: str) -> bool:
    """Tell whether values in two units go over into each other."""
    first, second = base_unit(left), base_unit(right)
    return same_dimension(first, second) and (first == second or not (is_either(left) or is_either(right)))


def conversion_of(source: str, target: str) -> tuple[float, float]:
    """Return the factor and the offset that take a value from one unit into another; differences have no offset.

    Raises:
        DifferentDimensions: the units do not measure the same.
    """
    factor, offset = conversion(base_unit(source), base_unit(target))
    return factor, 0 if is_difference(source) or is_difference(target) else offset


def number_in(value: float, source: str, target: str) -> float:
    """Return a number that is in one unit in another one; a difference by the factor alone.

    Raises:
        DifferentDimensions: the units do not measure the same.
    """
    if is_difference(source) or is_difference(target):
        return tidy(value * conversion_of(source, target)[0])
    return convert(value, base_unit(source), base_unit(target))


def joined_unit(unit: str, units: Collection[str]) -> str:
    """Return the unit in which values meet that are in these, which is this one but for differences among them."""
    base = base_unit(unit)
    if any(map(is_either, units)):
        return _EITHER + base
    return _DIFFERENCE + base if any(map(is_difference, units)) else base


def kept_unit(unit: str, units: Collection[str], *, measured: bool) -> str:
    """Return the unit of a variable that is given values in several: this one, of a temperature or a difference.

    A value is `measured` where a device reports one of them.
    """
    base = base_unit(unit)
    if any(map(is_difference, units)):
        return (_EITHER if measured else _DIFFERENCE) + base
    sure = measured or any(map(is_scale, units))
    return _EITHER + base if any(map(is_either, units)) and not sure else base


@dataclass(frozen=True, slots=True)
class Term:
    """One of two values that are added or subtracted: its unit, and what else is known of it."""

    unit: str
    measured: bool = False
    """It is known to be a temperature, for a device reports it or what it is worked out from."""
    written: bool = False
    """Nothing in it is measured or given."""


@dataclass(frozen=True, slots=True)
class Sum:
    """What two values give that are added or subtracted, and the units into which they are brought first."""

    unit: str
    left: str
    right: str
    measured: bool = False
    unclear: bool = False
    """Into which unit, and how, cannot be said."""


def sum_of(operator: str, left: Term, right: Term, common: str) -> Sum:
    """Return what values in units that go together give by `+` or `-` in a common unit."""
    if not (is_temperature(left.unit) or is_temperature(right.unit)):
        return Sum(common, common, common)
    base = base_unit(common)
    if is_either(left.unit) or is_either(right.unit):
        return Sum(_EITHER + base, base, base)
    if not (is_measure(left.unit) and is_measure(right.unit)):
        return _with_number(operator, left, right, base)
    return _plus(left, right, base) if operator == "+" else _minus(left, right, base)


def _with_number(operator: str, left: Term, right: Term, base: str) -> Sum:
    """Return what a number without a unit gives with a temperature, or with a difference of two."""
    term = left if is_measure(left.unit) else right
    unit = term.unit
    if operator == "-" and not is_difference(unit):
        unit = (_DIFFERENCE if term is right and term.measured else _EITHER) + base
    return Sum(unit, base, base, term.measured and unit == base)


def _minus(left: Term, right: Term, base: str) -> Sum:
    """Return what one temperature gives less another, which is a difference, or less a difference."""
    difference = _DIFFERENCE + base
    if is_difference(left.unit):
        either = right.measured and not is_difference(right.unit)
        return Sum(_EITHER + base if either else difference, difference, difference)
    if is_difference(right.unit) or (left.written and right.written) or _is_step(left, right):
        return Sum(base, base, difference, left.measured)
    if right.measured:
        return Sum(difference, base, base)
    return Sum(_EITHER + base, base, base, unclear=left.unit != right.unit)


def _is_step(left: Term, right: Term) -> bool:
    """Tell whether a temperature is lowered: what is said in kelvins beside one in °C or °F is a difference."""
    return not right.measured and right.unit == _ABSOLUTE != left.unit and not left.written


def _plus(left: Term, right: Term, base: str) -> Sum:
    """Return what a temperature gives and a difference, two differences, or two temperatures on their way to a mean."""
    difference = _DIFFERENCE + base
    if is_difference(left.unit) and is_difference(right.unit):
        return Sum(difference, difference, difference)
    if is_difference(left.unit) or is_difference(right.unit):
        return _with_difference(left, right, base)
    if left.measured and right.measured:
        return Sum(base, base, base, measured=True)
    left_is_step = right.measured or (left.written and not right.written and not left.measured)
    if left_is_step:
        return Sum(base, difference, base, right.measured)
    return Sum(base, base, difference, left.measured)


def _with_difference(left: Term, right: Term, base: str) -> Sum:
    """Return what a difference gives with a value that is none for sure."""
    other = right if is_difference(left.unit) else left
    difference = _DIFFERENCE + base
    if other.written and other.unit == _ABSOLUTE:
        return Sum(difference, difference, difference)
    units = (base, difference) if other is left else (difference, base)
    if other.measured:
        return Sum(base, *units, measured=True)
    return Sum(_EITHER + base, base, base, unclear=base_unit(left.unit) != base_unit(right.unit))

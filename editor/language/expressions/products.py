"""What values with units give that are multiplied or divided; pure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from editor.language.expressions.temperatures import conversion_of, go_together, is_either
from vipo_device.protocol.units import PLAIN, UNITS, UNSAID, is_measure


@dataclass(frozen=True, slots=True)
class Product:
    """The unit of a product or a quotient, and by what its two parts are multiplied first."""

    unit: str
    left: float = 1
    right: float = 1


_PRODUCTS: Final[Mapping[tuple[str, str], str]] = {
    ("speed", "time"): "length",
    ("power", "time"): "energy",
    ("voltage", "current"): "power",
    ("force", "length"): "energy",
    ("force", "speed"): "power",
    ("frequency", "time"): PLAIN,
}
"""What the product of two measures measures."""
_BY_PAIR: Final[Mapping[tuple[str, str, str], str]] = {
    **{("*", first, second): third for (first, second), third in _PRODUCTS.items()},
    **{("*", second, first): third for (first, second), third in _PRODUCTS.items()},
    **{("/", third, first): second for (first, second), third in _PRODUCTS.items()},
    **{("/", third, second): first for (first, second), third in _PRODUCTS.items()},
}
_BASE_UNITS: Final[Mapping[str, str]] = {
    **{unit.dimension: unit.code for unit in UNITS.values() if unit.factor == 1 and not unit.offset},
    PLAIN: PLAIN,
}


def product_of(operator: str, left: str, right: str) -> Product | None:
    """Return what values in two units give by `*` or `/`; None where nothing is measured so."""
    if UNSAID in {left, right}:
        return Product(UNSAID)
    if not is_measure(right) and not is_measure(left):
        return Product(left or right)
    if not is_measure(right):
        return Product(left)
    if not is_measure(left) and operator == "*":
        return Product(right)
    if is_measure(left) and operator == "/" and go_together(left, right):
        return _quotient(left, right)
    return _share(operator, left, right) or _by_pair(operator, left, right)


def _quotient(left: str, right: str) -> Product | None:
    """Return how many times one measure goes into another of its kind; degrees have no zero to count from."""
    factor, offset = conversion_of(right, left)
    return None if offset or _has_offset(left) or _has_offset(right) else Product(PLAIN, 1, factor)


def _share(operator: str, left: str, right: str) -> Product | None:
    """Return what a share in per cent is of something, or of which whole something is a share."""
    if _dimension(right) == "ratio":
        return Product(left or PLAIN, 1, UNITS[right].factor)
    if _dimension(left) == "ratio" and operator == "*":
        return Product(right, UNITS[left].factor)
    return None


def _by_pair(operator: str, left: str, right: str) -> Product | None:
    measured = _BY_PAIR.get((operator, _dimension(left), _dimension(right)))
    return None if measured is None else Product(_BASE_UNITS[measured], _factor(left), _factor(right))


def _dimension(unit: str) -> str:
    return UNITS[unit].dimension if unit in UNITS else unit or PLAIN


def _factor(unit: str) -> float:
    return UNITS[unit].factor if unit in UNITS else 1


def _has_offset(unit: str) -> bool:
    return is_either(unit) or (unit in UNITS and UNITS[unit].offset != 0)

"""Fractional orders: texts over 0-9A-Za-z, compared bytewise, so that a step goes between two others."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from typing import Any

_DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
_MIDDLE = _DIGITS[len(_DIGITS) // 2]


def spread(count: int) -> list[str]:
    """Return orders for a branch that is drawn anew."""
    width = 1 if count < len(_DIGITS) else 3
    return [_digits(index, width) + _MIDDLE for index in range(count)]


def keep_orders(wanted: Sequence[tuple[str, str | None]]) -> list[str]:
    """Return the orders of a branch's steps, given as (id, order before or None): as few change as can be."""
    if all(order is None for _, order in wanted):
        return spread(len(wanted))
    kept = longest_rise([None if order is None else (order, step) for step, order in wanted])
    orders: list[str] = []
    for index, (_, before) in enumerate(wanted):
        if index in kept and before is not None:
            orders.append(before)
            continue
        above = next((wanted[later][1] for later in range(index, len(wanted)) if later in kept), None)
        made = order_between(orders[-1] if orders else "", above)
        if made is None:
            return spread(len(wanted))
        orders.append(made)
    return orders


def order_between(low: str, high: str | None) -> str | None:
    """Return an order above `low` and below `high` (None: the open end); None where there is no room."""
    made = ""
    for index in range(max(len(low), len(high or "")) + 1):
        least = _value(low, index)
        most = len(_DIGITS) if high is None else _value(high, index)
        if most - least > 1:
            return made + _DIGITS[(least + most) // 2]
        made += _DIGITS[least]
        if most > least:
            high = None
    return made + _MIDDLE if high is None else None


def _digits(index: int, width: int) -> str:
    digits = ""
    for _ in range(width):
        index, digit = divmod(index, len(_DIGITS))
        digits = _DIGITS[digit] + digits
    return digits


def _value(order: str, index: int) -> int:
    return max(_DIGITS.find(order[index]), 0) if index < len(order) else 0


def longest_rise(keys: Sequence[tuple[Any, ...] | None]) -> set[int]:
    """Return the places of a longest rising row among the keys that are there."""
    ends: list[tuple[Any, ...]] = []
    places: list[int] = []
    before: dict[int, int] = {}
    for index, key in enumerate(keys):
        if key is None:
            continue
        length = bisect_left(ends, key)
        before[index] = places[length - 1] if length else -1
        ends[length:], places[length:] = [key, *ends[length + 1 :]], [index, *places[length + 1 :]]
    row: set[int] = set()
    index = places[-1] if places else -1
    while index >= 0:
        row.add(index)
        index = before[index]
    return row

"""Orders between which there is always room for another."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from editor.language.document.fractional_index import keep_orders, order_between


def test_orders_change_as_little_as_can_be() -> None:
    assert keep_orders([("a", "1"), ("new", None), ("b", "2"), ("c", "0"), ("d", "3")]) == ["1", "1V", "2", "2V", "3"]
    assert keep_orders([("new", None), ("a", "V")]) == ["F", "V"]
    assert keep_orders([("a", "V"), ("new", None), ("b", "V")]) == ["0V", "1V", "2V"]
    assert order_between("V", "V0") is None


@given(st.lists(st.integers(0, 30), max_size=40))
def test_there_is_always_an_order_between_two(places: list[int]) -> None:
    orders: list[str] = []
    for place in places:
        at = min(place, len(orders))
        made = order_between(orders[at - 1] if at else "", orders[at] if at < len(orders) else None)
        assert made is not None
        orders.insert(at, made)
    assert orders == sorted(set(orders))

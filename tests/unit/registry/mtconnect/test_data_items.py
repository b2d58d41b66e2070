"""What VIPO's own agent makes of a reading in a unit."""

from __future__ import annotations

import pytest

from registry.mtconnect.data_items import item_of, say_value
from vipo_device.protocol.description import PropertySpec


@pytest.mark.parametrize(
    ("unit", "shown", "told"), [("DEG_C", 61.5, "61.5"), ("DEG_F", 212, "100.0"), ("K", 300, "26.85")]
)
def test_a_temperature_is_told_in_celsius_whatever_unit_it_is_shown_in(unit: str, shown: float, told: str) -> None:
    item = item_of("kiln", PropertySpec("heat", "number", unit))
    assert (item.attributes["category"], item.type, item.attributes["units"]) == ("SAMPLE", "TEMPERATURE", "CELSIUS")
    assert say_value(item, shown) == told

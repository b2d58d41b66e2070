"""When a battery is low, by what a device says of it and in which unit."""

from __future__ import annotations

import pytest

from registry.alerts.causes import is_battery_low


@pytest.mark.parametrize(
    ("charge", "unit", "low"),
    [
        (14.9, "", True),
        (15, "", False),
        (3, "PERCENT", True),
        (80, "PERCENT", False),
        (3, "NUM", True),
        (3, "UNITLESS", True),
        (3, "PPM", False),
        (12.6, "V", False),
        (0.4, "KiloW-HR", False),
        ("full", "", False),
        (True, "", False),
        (False, "", False),
        (None, "PERCENT", False),
    ],
)
def test_a_battery_is_low_below_15_per_cent_and_volts_do_not_tell(charge: object, unit: str, low: bool) -> None:
    assert is_battery_low(charge, unit) is low

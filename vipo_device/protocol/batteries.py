"""Which readings of a battery say how full it is; pure."""

from __future__ import annotations

from vipo_device.protocol.description import Description
from vipo_device.protocol.units import declared_unit, is_measure


def is_charge(unit: str) -> bool:
    """Tell whether a number in this unit, as a description has it, says in per cent how full a battery is.

    A number without a unit is per cent. What is measured otherwise, such as volts, says nothing without the kind of
    battery.
    """
    code = declared_unit(unit)
    return code == "PERCENT" or not is_measure(code)


def says_charge(device: Description) -> bool:
    """Tell whether a device describes a `battery` that says in per cent how full it is."""
    spec = device.property("battery")
    return spec is not None and spec.type == "number" and is_charge(spec.unit)

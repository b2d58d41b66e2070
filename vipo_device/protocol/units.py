"""Units of measurement: QUDT's short codes, what people write for them, and conversion between them.

A value in a unit is `value * factor + offset` in the base unit of its dimension.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import Final


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit: its QUDT code, its symbol, what it measures, and how it goes over into the base unit."""

    code: str
    symbol: str
    dimension: str
    factor: float = 1
    offset: float = 0
    also: tuple[str, ...] = ()
    """Other ways in which people write it."""


class DifferentDimensions(ValueError):
    """Two units that measure different things, so that neither goes over into the other."""


_UNITS: Final = (
    Unit("SEC", "s", "time", also=("sec", "second", "seconds")),
    Unit("MilliSEC", "ms", "time", 0.001),
    Unit("MIN", "min", "time", 60, also=("minute", "minutes")),
    Unit("HR", "h", "time", 3600, also=("hour", "hours")),
    Unit("DAY", "d", "time", 86400, also=("day", "days")),
    Unit("M", "m", "length", also=("metre", "metres")),
    Unit("MilliM", "mm", "length", 0.001),
    Unit("CentiM", "cm", "length", 0.01),
    Unit("KiloM", "km", "length", 1000),
    Unit("KiloGM", "kg", "mass"),
    Unit("GM", "g", "mass", 0.001),
    Unit("MilliGM", "mg", "mass", 0.000001),
    Unit("TONNE", "t", "mass", 1000),
    Unit("K", "K", "temperature"),
    Unit("DEG_C", "°C", "temperature", 1, 273.15, ("C", "degC")),
    Unit("DEG_F", "°F", "temperature", 5 / 9, 459.67 * 5 / 9, ("F", "degF")),
    Unit("PA", "Pa", "pressure"),
    Unit("KiloPA", "kPa", "pressure", 1000),
    Unit("MilliBAR", "mbar", "pressure", 100),
    Unit("BAR", "bar", "pressure", 100000),
    Unit("L", "l", "volume", also=("litre", "litres")),
    Unit("MilliL", "ml", "volume", 0.001, also=("mL",)),
    Unit("M3", "m³", "volume", 1000, also=("m3",)),
    Unit("PERCENT", "%", "ratio", 0.01, also=("percent",)),
    Unit("PPM", "ppm", "ratio", 0.000001),
    Unit("M-PER-SEC", "m/s", "speed"),
    Unit("KiloM-PER-HR", "km/h", "speed", 1 / 3.6),
    Unit("MilliM-PER-SEC", "mm/s", "speed", 0.001),
    Unit("RAD", "rad", "angle"),
    Unit("DEG", "°", "angle", pi / 180, also=("deg",)),
    Unit("HZ", "Hz", "frequency"),
    Unit("REV-PER-MIN", "rpm", "frequency", 1 / 60),
    Unit("V", "V", "voltage"),
    Unit("MilliV", "mV", "voltage", 0.001),
    Unit("A", "A", "current"),
    Unit("MilliA", "mA", "current", 0.001),
    Unit("W", "W", "power"),
    Unit("KiloW", "kW", "power", 1000),
    Unit("J", "J", "energy"),
    Unit("KiloW-HR", "kWh", "energy", 3600000),
    Unit("N", "N", "force"),
    Unit("LUX", "lx", "illuminance"),
    Unit("DEC_B", "dB", "level"),
)
UNITS: Final[Mapping[str, Unit]] = {unit.code: unit for unit in _UNITS}
PLAIN: Final = "1"
"""The unit of a number that measures nothing: a count, or one quantity divided by another of its kind."""
UNSAID: Final = "?"
"""The unit of a number whose device does not say one: it is taken in the unit of what it meets."""
_WRITTEN: Final[Mapping[str, str]] = {
    **{word: unit.code for unit in _UNITS for word in unit.also},
    **{unit.symbol: unit.code for unit in _UNITS},
}


def unit_code(written: str) -> str:
    """Return the code of a unit as people write it; a code, and what is not known, stays as it is."""
    return written if written in UNITS else _WRITTEN.get(written, written)


def unit_symbol(code: str) -> str:
    """Return how people write a unit; an unknown one as it is."""
    unit = UNITS.get(code)
    return code if unit is None else unit.symbol


def is_unit(written: str) -> bool:
    """Tell whether a word is a unit's code or one of the ways in which people write it."""
    return unit_code(written) in UNITS


_UNITLESS: Final = frozenset({PLAIN, "UNITLESS", "NUM"})
_QUDT_ONLY: Final = frozenset({"C", "F"})
"""QUDT's coulomb and farad: people also write so for temperatures, descriptions of devices do not."""


def device_unit(written: str) -> str:
    """Return the code of a unit in a device's description: QUDT's own, or what people write for one."""
    return written if written in _QUDT_ONLY else unit_code(written)


def declared_unit(unit: str) -> str:
    """Return the unit of a number that a device declares; QUDT has two words for plain numbers."""
    code = device_unit(unit)
    return PLAIN if code in _UNITLESS else code or UNSAID


def is_measure(unit: str) -> bool:
    """Tell whether a value in this unit is measured: not written without one, plain, or of a unit that nobody says."""
    return unit not in {"", PLAIN, UNSAID}


def same_dimension(left: str, right: str) -> bool:
    """Tell whether two units measure the same, so that values can be converted."""
    if left == right:
        return True
    first, second = UNITS.get(left), UNITS.get(right)
    return first is not None and second is not None and first.dimension == second.dimension


def conversion(source: str, target: str) -> tuple[float, float]:
    """Return the factor and the offset that take a value from one unit into another.

    Raises:
        DifferentDimensions: the units do not measure the same.
    """
    if source == target:
        return 1, 0
    if not same_dimension(source, target):
        raise DifferentDimensions(f"{unit_symbol(source)} does not go over into {unit_symbol(target)}.")
    first, second = UNITS[source], UNITS[target]
    return tidy(first.factor / second.factor, 15), tidy((first.offset - second.offset) / second.factor)


def convert(value: float, source: str, target: str) -> float:
    """Return a value in another unit. Raises DifferentDimensions."""
    if source == target:
        return value
    factor, offset = conversion(source, target)
    return tidy(round(value * factor + offset, 9) if offset else value * factor)


def tidy(value: float, digits: int = 12) -> float:
    """Return a number without the rounding errors of arithmetic: so many digits, whole ones as int."""
    rounded = float(f"{value:.{digits}g}")
    return int(rounded) if rounded.is_integer() and abs(rounded) < 1e15 else rounded

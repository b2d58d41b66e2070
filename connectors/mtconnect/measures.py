"""MTConnect's units in VIPO's: the short names of QUDT, with what to multiply a number."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Measure:
    """A unit of QUDT (empty: none), and the factor to it; `axes` is 3 for a number in each direction."""

    unit: str
    factor: float = 1.0
    axes: int = 1


MEASURES: Mapping[str, Measure] = {
    "AMPERE": Measure("A"),
    "CELSIUS": Measure("DEG_C"),
    "COUNT": Measure(""),
    "CUBIC_METER": Measure("M3"),
    "CUBIC_MILLIMETER": Measure("MilliL", 0.001),
    "DECIBEL": Measure("DEC_B"),
    "DEGREE": Measure("DEG"),
    "DEGREE_3D": Measure("DEG", axes=3),
    "DEGREE/SECOND": Measure("DEG-PER-SEC"),
    "GRAM": Measure("GM"),
    "HERTZ": Measure("HZ"),
    "HOUR": Measure("HR"),
    "JOULE": Measure("J"),
    "KILOGRAM": Measure("KiloGM"),
    "LITER": Measure("L"),
    "METER": Measure("M"),
    "MILLIGRAM": Measure("MilliGM"),
    "MILLILITER": Measure("MilliL"),
    "MILLIMETER": Measure("M", 0.001),
    "MILLIMETER_3D": Measure("M", 0.001, 3),
    "MILLIMETER/SECOND": Measure("M-PER-SEC", 0.001),
    "MILLIMETER/SECOND^2": Measure("M-PER-SEC2", 0.001),
    "MINUTE": Measure("MIN"),
    "NEWTON": Measure("N"),
    "NEWTON_METER": Measure("N-M"),
    "OHM": Measure("OHM"),
    "PASCAL": Measure("PA"),
    "PERCENT": Measure("PERCENT"),
    "REVOLUTION/MINUTE": Measure("REV-PER-MIN"),
    "REVOLUTION/SECOND": Measure("REV-PER-MIN", 60.0),
    "SECOND": Measure("SEC"),
    "VOLT": Measure("V"),
    "WATT": Measure("W"),
    "WATT_SECOND": Measure("J"),
}
AXES = ("x", "y", "z")


def measure_of(units: str) -> Measure:
    """Return what to make of a unit; one that is not known goes over as a number without a unit."""
    return MEASURES.get(units) or Measure("", axes=3 if units.endswith("_3D") else 1)

"""Units: symbols both ways, and conversion."""

import pytest

from vipo_device.protocol.batteries import is_charge
from vipo_device.protocol.units import (
    UNITS,
    DifferentDimensions,
    conversion,
    convert,
    declared_unit,
    is_unit,
    unit_code,
    unit_symbol,
)


@pytest.mark.parametrize("code", UNITS)
def test_a_unit_is_found_again_by_its_symbol(code: str) -> None:
    assert unit_code(unit_symbol(code)) == code
    assert unit_code(code) == code


@pytest.mark.parametrize("code", UNITS)
def test_every_other_way_of_writing_a_unit_means_it(code: str) -> None:
    assert {unit_code(word) for word in UNITS[code].also} <= {code}


@pytest.mark.parametrize(
    ("value", "source", "target", "expected"),
    [
        (10, "MIN", "SEC", 600),
        (90, "SEC", "MIN", 1.5),
        (1.5, "HR", "MIN", 90),
        (250, "CentiM", "M", 2.5),
        (3, "M", "MilliM", 3000),
        (20, "DEG_C", "DEG_F", 68),
        (32, "DEG_F", "DEG_C", 0),
        (-40, "DEG_F", "DEG_C", -40),
        (0, "DEG_C", "K", 273.15),
        (1.2, "BAR", "KiloPA", 120),
        (500, "MilliL", "L", 0.5),
        (0.1, "KiloGM", "GM", 100),
        (36, "KiloM-PER-HR", "M-PER-SEC", 10),
        (180, "DEG", "DEG", 180),
        (7, "widgets", "widgets", 7),
    ],
)
def test_values_are_converted_exactly(value: float, source: str, target: str, expected: float) -> None:
    assert convert(value, source, target) == expected


ONE_IN_THE_BASE_UNIT = {
    "SEC": 1, "MilliSEC": 0.001, "MIN": 60, "HR": 3600, "DAY": 86400,
    "M": 1, "MilliM": 0.001, "CentiM": 0.01, "KiloM": 1000,
    "KiloGM": 1, "GM": 0.001, "MilliGM": 0.000001, "TONNE": 1000,
    "PA": 1, "KiloPA": 1000, "MilliBAR": 100, "BAR": 100000,
    "L": 1, "MilliL": 0.001, "M3": 1000,
    "M-PER-SEC": 1, "KiloM-PER-HR": 0.277777777778, "MilliM-PER-SEC": 0.001,
    "RAD": 1, "DEG": 0.0174532925199, "HZ": 1, "REV-PER-MIN": 0.0166666666667,
    "V": 1, "MilliV": 0.001, "A": 1, "MilliA": 0.001, "W": 1, "KiloW": 1000, "J": 1, "KiloW-HR": 3600000,
    "N": 1, "LUX": 1, "DEC_B": 1, "K": 1, "DEG_C": 274.15, "DEG_F": 255.927777778,
}  # fmt: skip


def test_every_unit_goes_over_into_the_base_unit_of_what_it_measures() -> None:
    bases: dict[str, str] = {}
    for unit in UNITS.values():
        if unit.factor == 1 and not unit.offset:
            bases.setdefault(unit.dimension, unit.code)
    units = [unit for unit in UNITS.values() if unit.dimension != "ratio"]
    assert {u.code: convert(1, u.code, bases[u.dimension]) for u in units} == ONE_IN_THE_BASE_UNIT
    assert (convert(1, "PERCENT", "PPM"), UNITS["PERCENT"].factor) == (10000, 0.01)


def test_units_that_measure_different_things_are_refused() -> None:
    with pytest.raises(DifferentDimensions, match="min does not go over into °C"):
        conversion("MIN", "DEG_C")
    with pytest.raises(DifferentDimensions):
        conversion("MIN", "widgets")


def test_what_is_no_unit_stays_as_it_is() -> None:
    assert (unit_code("widgets"), unit_symbol("widgets"), is_unit("widgets")) == ("widgets", "widgets", False)
    assert (is_unit("°C"), is_unit("DEG_C"), is_unit("minutes")) == (True, True, True)


@pytest.mark.parametrize(
    ("said", "unit"),
    [
        ("percent", "PERCENT"),
        ("min", "MIN"),
        ("°C", "DEG_C"),
        ("C", "C"),
        ("NUM", "1"),
        ("", "?"),
        ("widgets", "widgets"),
    ],
)
def test_a_device_says_its_unit_by_qudts_code_or_as_people_do(said: str, unit: str) -> None:
    assert declared_unit(said) == unit


@pytest.mark.parametrize(
    ("unit", "says"), [("PERCENT", True), ("percent", True), ("", True), ("V", False), ("C", False)]
)
def test_a_battery_in_per_cent_says_how_full_it_is(unit: str, says: bool) -> None:
    assert is_charge(unit) is says

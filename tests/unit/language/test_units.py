"""Units: symbols both ways, and conversion."""

import pytest

from editor.language.units import UNITS, DifferentDimensions, conversion, convert, is_unit, unit_code, unit_symbol


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


def test_units_that_measure_different_things_are_refused() -> None:
    with pytest.raises(DifferentDimensions, match="min does not go over into °C"):
        conversion("MIN", "DEG_C")
    with pytest.raises(DifferentDimensions):
        conversion("MIN", "widgets")


def test_what_is_no_unit_stays_as_it_is() -> None:
    assert (unit_code("widgets"), unit_symbol("widgets"), is_unit("widgets")) == ("widgets", "widgets", False)
    assert (is_unit("°C"), is_unit("DEG_C"), is_unit("minutes")) == (True, True, True)

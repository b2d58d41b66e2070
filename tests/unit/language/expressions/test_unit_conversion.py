"""Quantities are brought into the unit of what they meet."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from editor.language.expressions.nodes import Constant, Expression, Quantity
from editor.language.expressions.unit_conversion import convert_units
from editor.language.expressions.value_types import TypeChecker, ValueType
from editor.language.expressions.values import parts_of, read_value, write_value
from editor.language.one_line.scope import make_line_scope
from editor.language.one_line.values import parse_line
from tests.kit.demo_site import factory

DOCUMENT = {"parameters": {"p": {"name": "minutes", "type": "number", "unit": "MIN"}, "n": {"name": "n"}}, "steps": {}}
TYPING = TypeChecker(factory(), {"minutes": ValueType("number", "MIN")}, [])
HEAT = {"property": ["curingOven01", "temperature"]}
PRESSURE = {"property": ["paintMachine01", "pressure"]}
MINUTES = {"param": "minutes"}


def expression(text: str) -> Expression:
    line = make_line_scope(DOCUMENT, factory(), "")
    return read_value(parse_line(text, line), line.names)


def op(name: str, *args: object) -> dict[str, object]:
    return {"op": name, "args": list(args)}


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("10 min", "SEC", 600),
        ("10 min", "", 10),
        ("10 min", "DEG_C", 10),
        ("10", "SEC", 10),
        ("90 s", "MIN", 1.5),
        ("2 * 5 min", "SEC", 600),
        ("1 h + 30 min", "SEC", 5400),
        ("1 h + 5", "SEC", 21600),
        ("minutes", "SEC", op("*", MINUTES, 60)),
        ("minutes + 90 s", "MIN", op("+", MINUTES, 1.5)),
        ("minutes + 90 s", "SEC", op("*", op("+", MINUTES, 1.5), 60)),
        ("now()", "MIN", op("/", op("now"), 60)),
        ("curing_oven.temperature > 140 °F", "", op(">", HEAT, 60)),
        ("140 °F < curing_oven.temperature", "", op("<", 60, HEAT)),
        ("curing_oven.temperature > minutes", "", op(">", HEAT, MINUTES)),
        ("curing_oven.temperature + 9 °F > 60", "", op(">", op("+", HEAT, 5), 60)),
        ("9 °F + curing_oven.temperature", "", op("+", 5, HEAT)),
        ("curing_oven.temperature", "DEG_F", op("+", op("*", HEAT, 1.8), 32)),
        ("painting_machine.pressure > 250 kPa", "", op(">", PRESSURE, 2.5)),
        ("max(minutes, 120 s, 3)", "", op("max", MINUTES, 2, 3)),
        ("now() > 8 h", "", op(">", op("now"), 28800)),
        ("10 min > 500 s", "", op(">", 10, 8.33333333333)),
        ("distance(curing_oven, point(1, 2)) < 250 cm", "", None),
        ('f"after {10 min}"', "", op("text", "after ", "10 min")),
        ("count(minutes > 60 s, not minutes > 1 h)", "", None),
        ("[1, 2]", "SEC", [1, 2]),
    ],
)
def test_a_quantity_takes_the_unit_of_what_it_meets(text: str, unit: str, expected: object) -> None:
    settled = convert_units(expression(text), unit, TYPING)
    assert not any(isinstance(part, Quantity) for part in parts_of(settled))
    if expected is not None:
        assert write_value(settled) == expected


def test_a_named_place_is_its_point_where_only_its_place_is_asked_for() -> None:
    dock = factory().places["dock1"]
    settled = convert_units(expression("distance(curing_oven, dock_1) < 2 m"), "", TYPING)
    oven, point = {"at": {"device": "curingOven01"}}, {"at": {"point": [dock.x, dock.y]}}
    assert write_value(settled) == op("<", op("distance", oven, point), 2)


@given(st.integers(-1000, 1000), st.sampled_from(["SEC", "MIN", "HR"]), st.sampled_from(["SEC", "MIN", "HR"]))
def test_there_and_back_is_the_same(value: int, source: str, target: str) -> None:
    there = convert_units(Quantity(value, source), target, TYPING)
    assert isinstance(there, Constant)
    assert isinstance(there.value, int | float)
    back = convert_units(Quantity(there.value, target), source, TYPING)
    assert isinstance(back, Constant)
    assert back.value == pytest.approx(value, abs=1e-6)

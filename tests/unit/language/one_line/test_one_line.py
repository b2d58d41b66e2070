"""Values as one line: read, printed, and refused with the column."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from editor.language.expressions.value_types import ValueType
from editor.language.expressions.values import FUNCTIONS
from editor.language.one_line.scope import LineScope, make_line_scope
from editor.language.one_line.values import NotUnderstood, parse_line, print_line, type_of_line
from tests.kit.demo_site import factory
from vipo_device.protocol.units import UNITS

DOCUMENT: dict[str, Any] = {
    "format": 2,
    "start_pos": [0, 0],
    "steps": {
        "s": {
            "kind": "set",
            "place": ["program", "body", "a"],
            "pos": [0, 0],
            "params": {"variable": "count", "value": 1},
        },
        "m": {"kind": "move", "place": ["program", "body", "b"], "pos": [0, 0], "params": {"role": "carrier"}},
        "inner": {"kind": "wait", "place": ["f", "body", "a"], "pos": [0, 0], "params": {}},
    },
    "functions": {"f": {"name": "Mix", "parameters": [{"name": "Paint shade", "type": "text", "unit": ""}]}},
    "roles": {"carrier": {"name": "Box carrier", "can": []}},
    "parameters": {"p": {"name": "minutes", "type": "number", "unit": "MIN", "default": 3}},
    "zones": {"z1": {"name": "Slow area", "rule": "slow", "points": [[0, 0], [1, 0], [1, 1]]}},
}
OVEN = {"at": {"device": "curingOven01"}}
HEAT = {"property": ["curingOven01", "temperature"]}
CHARGE = {"property": [{"role": "carrier"}, "battery"]}


def scope(step: str = "s") -> LineScope:
    return make_line_scope(DOCUMENT, factory(), "", step)


@pytest.mark.parametrize(
    ("text", "value", "printed"),
    [
        ("", None, ""),
        ("   ", None, ""),
        ("None", None, ""),
        ("3", 3, "3"),
        ("-2.50", -2.5, "-2.5"),
        ("yes", True, "True"),
        ('"box"', "box", '"box"'),
        ("[1, 2]", [1, 2], "[1, 2]"),
        ("minutes", {"param": "minutes"}, "minutes"),
        ("count + 1", {"op": "+", "args": [{"param": "count"}, 1]}, "count + 1"),
        ("10 min", {"quantity": [10, "MIN"]}, "10 min"),
        ("10min", {"quantity": [10, "MIN"]}, "10 min"),
        ("- 3 °C", {"quantity": [-3, "DEG_C"]}, "-3 °C"),
        ("50%", {"quantity": [50, "PERCENT"]}, "50 %"),
        ("3 m/s", {"quantity": [3, "M-PER-SEC"]}, "3 m/s"),
        ("3 m / 2", {"op": "/", "args": [{"quantity": [3, "M"]}, 2]}, "3 m / 2"),
        ('quantity(1.5, "hours")', {"quantity": [1.5, "HR"]}, "1.5 h"),
        (
            "curing_oven.temperature ≥ 60 °C",
            {"op": ">=", "args": [HEAT, {"quantity": [60, "DEG_C"]}]},
            "curing_oven.temperature >= 60 °C",
        ),
        ("self.curing_oven.temperature", HEAT, "curing_oven.temperature"),
        ('curing_oven.read("temperature")', HEAT, "curing_oven.temperature"),
        ("count = 3", {"op": "==", "args": [{"param": "count"}, 3]}, "count == 3"),
        ("box_carrier in slow_area", {"op": "in", "args": [{"at": {"role": "carrier"}}, {"zone": "z1"}]}, None),
        ("box_carrier.battery > 30 %", {"op": ">", "args": [CHARGE, {"quantity": [30, "PERCENT"]}]}, None),
        ('box_carrier.read("battery")', CHARGE, "box_carrier.battery"),
        ('box_carrier.read("wheel slip")', {"property": [{"role": "carrier"}, "wheel slip"]}, None),
        ("curing_oven not in slow_area", {"op": "not in", "args": [OVEN, {"zone": "z1"}]}, None),
        ("distance(curing_oven, dock_1)", {"op": "distance", "args": [OVEN, {"at": {"place": "dock1"}}]}, None),
        ("nearest(point(3.5, -8), curing_oven)", {"op": "nearest", "args": [{"at": {"point": [3.5, -8]}}, OVEN]}, None),
        ("count(True, False)", {"op": "count", "args": [True, False]}, None),
        ("now() > 8 h", {"op": ">", "args": [{"op": "now", "args": []}, {"quantity": [8, "HR"]}]}, None),
        ("min(1, 2, 3)", {"op": "min", "args": [1, 2, 3]}, None),
        (
            'f"{count} boxes after {10 min} {{ok}}"',
            {"op": "text", "args": [{"param": "count"}, " boxes after ", {"quantity": [10, "MIN"]}, " {ok}"]},
            None,
        ),
        ('f"just this"', "just this", '"just this"'),
        (
            "not (count > 1 or count < -1)",
            {
                "op": "not",
                "args": [
                    {
                        "op": "or",
                        "args": [
                            {"op": ">", "args": [{"param": "count"}, 1]},
                            {"op": "<", "args": [{"param": "count"}, -1]},
                        ],
                    }
                ],
            },
            None,
        ),
    ],
)
def test_a_line_is_read_and_printed(text: str, value: object, printed: str | None) -> None:
    line = scope()
    assert parse_line(text, line) == value
    assert print_line(value, line) == (text if printed is None else printed)


def test_a_refusal_is_told_in_german_too() -> None:
    with pytest.raises(NotUnderstood) as caught:
        parse_line("curing_oven.temprature > 1", scope())
    assert caught.value.messages["de"] == (
        "„curing_oven.temprature“ kann hier nicht stehen. Meinten Sie temperature? "
        "Was hier gelesen werden kann: job_status, temperature, quality."
    )


def test_what_a_function_is_given_can_be_seen_only_in_it() -> None:
    assert parse_line("paint_shade", scope("inner")) == {"param": "Paint shade"}
    with pytest.raises(NotUnderstood):
        parse_line("paint_shade", scope("s"))


@pytest.mark.parametrize(
    ("text", "column", "message"),
    [
        ("ovn.temperature", 1, "There is nothing called “ovn” here."),
        ("3 + curing_ovn", 5, "There is nothing called “curing_ovn” here. Do you mean curing_oven, curing?"),
        ("  10 min + nothing", 12, "There is nothing called “nothing” here."),
        ("oven", 1, "There is nothing called “oven” here. Do you mean curing_oven?"),
        ("(1 + 2", 1, "A bracket is not closed."),
        ("1 + 2)", 6, "A bracket is closed that was never opened."),
        ('count == "abc', 10, "A text is not closed with a quotation mark."),
        ("1 +", 4, "Something is missing, or too much, here. Write for example: oven.temperature > 60."),
        ("1 2", 3, "Something is missing, or too much, here. Write for example: oven.temperature > 60."),
        (
            "curing_oven.temprature > 1",
            1,
            "“curing_oven.temprature” cannot stand here. Did you mean temperature? "
            "What can be read here: job_status, temperature, quality.",
        ),
        ("distance(curing_oven)", 1, "“distance(curing_oven)” cannot stand here. distance takes 2 values."),
        ("1 if count else 2", 1, None),
        ("lambda: 1", 1, None),
        ("count.append(1)", 1, None),
        ("__import__('os')", 1, "There is nothing called “__import__” here."),
        ("1 < 2 < 3", 1, None),
        ("x" * 3000, 2000, "The line is too long."),
    ],
)
def test_a_line_that_is_no_value_says_where_and_why(text: str, column: int, message: str | None) -> None:
    with pytest.raises(NotUnderstood) as caught:
        parse_line(text, scope())
    assert caught.value.column == column
    assert message is None or caught.value.messages["en"] == message
    assert caught.value.messages["de"]


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("curing_oven.temperature + 1", ValueType("number", "DEG_C", measured=True)),
        ("minutes * 2", ValueType("number", "MIN")),
        ("10 m / 2 s", ValueType("number", "M-PER-SEC")),
        ("distance(curing_oven, dock_1)", ValueType("number", "M")),
        ("now()", ValueType("number", "SEC")),
        ("nearest(dock_1, curing_oven)", ValueType("text")),
        ("curing_oven in slow_area", ValueType("boolean")),
        ("count(True)", ValueType("number", "1")),
        ('f"{count}"', ValueType("text")),
        ("count", ValueType()),
        ("slow_area", ValueType("zone")),
        ("point(1, 2)", ValueType("point")),
    ],
)
def test_the_kind_of_a_line_is_known(text: str, kind: ValueType) -> None:
    line = scope()
    assert type_of_line(parse_line(text, line), line) == kind


_LEAVES = st.one_of(
    st.integers(-1000, 1000),
    st.floats(-1e6, 1e6, allow_nan=False).filter(lambda number: not number.is_integer()),
    st.booleans(),
    st.text(max_size=12),
    st.lists(st.integers(0, 9), min_size=1, max_size=3),
    st.sampled_from([HEAT, CHARGE, OVEN, {"param": "count"}, {"param": "minutes"}, {"at": {"role": "carrier"}}]),
    st.sampled_from([{"at": {"place": "dock1"}}, {"at": {"point": [1, -2.5]}}, {"zone": "z1"}]),
    st.builds(lambda number, unit: {"quantity": [number, unit]}, st.integers(-99, 99), st.sampled_from(list(UNITS))),
)


def _operations(inner: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    pairs = st.sampled_from(["+", "-", "*", "/", "<", "<=", ">", ">=", "==", "!=", "in", "not in", "and", "or"])
    calls = [(name, least, least if most is not None else least + 2) for name, (least, most) in FUNCTIONS.items()]
    return st.one_of(
        st.builds(lambda op, args: {"op": op, "args": args}, pairs, st.lists(inner, min_size=2, max_size=2)),
        st.builds(lambda arg: {"op": "not", "args": [arg]}, inner),
        st.builds(lambda arg: {"op": "-", "args": [arg]}, inner),
        st.sampled_from(calls).flatmap(
            lambda call: st.builds(
                lambda args: {"op": call[0], "args": args}, st.lists(inner, min_size=call[1], max_size=call[2])
            )
        ),
    )


@given(st.recursive(_LEAVES, _operations, max_leaves=12))
def test_what_is_printed_reads_back(value: Any) -> None:
    line = scope()
    text = print_line(value, line)
    again = parse_line(text, line)
    assert print_line(again, line) == text
    assert parse_line(print_line(again, line), line) == again


@given(st.text(max_size=40))
def test_no_line_breaks_the_reader(text: str) -> None:
    line = scope()
    column, value = 1, None
    try:
        value = parse_line(text, line)
    except NotUnderstood as error:
        column = error.column
    assert 1 <= column <= len(text) + 1
    assert parse_line(print_line(value, line), line) == value


@given(st.recursive(st.none() | st.booleans() | st.integers() | st.text(max_size=5), lambda x: st.lists(x, max_size=3) | st.dictionaries(st.sampled_from(["op", "args", "at", "quantity", "property", "param", "zone", "role"]), x, max_size=3)))  # fmt: skip  # noqa: E501
def test_any_nonsense_prints_as_some_line(value: Any) -> None:
    assert isinstance(print_line(value, scope()), str)


CAUGHT: dict[str, Any] = {
    **DOCUMENT,
    "steps": {
        "t": {"kind": "try", "place": ["program", "body", "a"], "pos": [0, 0], "params": {}},
        "i": {"kind": "if", "place": ["t", "catch", "a"], "pos": [0, 0], "params": {}},
        "n": {"kind": "notify", "place": ["i", "then", "a"], "pos": [0, 0], "params": {}},
        "m": {"kind": "notify", "place": ["t", "body", "a"], "pos": [0, 0], "params": {}},
    },
}


@pytest.mark.parametrize("step", ["i", "n"])
def test_in_a_catch_the_failure_can_be_named(step: str) -> None:
    line = make_line_scope(CAUGHT, factory(), "", step)
    value = {"op": "==", "args": [{"param": "problem.kind"}, "offline"]}
    assert parse_line('problem.kind == "offline"', line) == value
    assert print_line(value, line) == 'problem.kind == "offline"'
    assert type_of_line({"param": "problem.text"}, line).type == "text"
    assert "problem.text" in line.known_names()


def test_elsewhere_a_failure_is_no_value() -> None:
    with pytest.raises(NotUnderstood, match=r"There is nothing called “problem” here\."):
        parse_line("problem.text", make_line_scope(CAUGHT, factory(), "", "m"))


def test_the_reading_of_a_role_has_its_kind_and_unit_and_an_unknown_one_is_answered_with_what_is_known() -> None:
    found = type_of_line(CHARGE, scope())
    assert (found.type, found.unit) == ("number", "PERCENT")
    with pytest.raises(NotUnderstood, match="Did you mean battery"):
        parse_line("box_carrier.batery > 3", scope())

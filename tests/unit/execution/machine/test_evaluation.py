"""What expressions are worth."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from editor.language.expressions.nodes import Constant, Expression, Located, Operation, Quantity, Reading, Variable
from editor.language.expressions.values import COMPARISONS, FUNCTIONS
from execution.machine.evaluation import EvaluationError, NoReading, evaluate, evaluate_number, is_true
from execution.machine.places import lies_in

FACTS: dict[tuple[str, str], Any] = {
    ("oven", "temperature"): 62.5,
    ("oven", "$x"): 3,
    ("oven", "$y"): 4,
    ("mixer", "$x"): 1,
    ("mixer", "$y"): 1,
    ("robot01", "$x"): 0,
    ("robot01", "$y"): 0,
    ("$role", "carrier"): "robot01",
    ("$clock", "now"): 28800,
}
VARIABLES: dict[str, Any] = {"count": 3, "machine": "oven", "shade": "teal", "dry": True}
ZONES = {"yard": ((0, 0), (2, 0), (2, 2), (0, 2))}
OVEN, MIXER, CARRIER = Located(device="oven"), Located(device="mixer"), Located(role="carrier")
HEAT = Reading(Constant("oven"), "temperature")


def op(name: str, *arguments: object) -> Operation:
    whole = (one if isinstance(one, Expression) else Constant(one) for one in arguments)  # type: ignore[arg-type]
    return Operation(name, tuple(whole))


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        (OVEN, "oven"),
        (Located(place="dock"), "dock"),
        (CARRIER, "robot01"),
        (Reading(Variable("machine"), "temperature"), 62.5),
        (op("distance", OVEN, CARRIER), 5),
        (op("distance", Variable("machine"), Located(point=(3, 8))), 4),
        (op("nearest", CARRIER, OVEN, MIXER), "mixer"),
        (op("nearest", CARRIER, MIXER, MIXER), "mixer"),
        (op("nearest", Located(point=(3, 3)), MIXER, Variable("machine")), "oven"),
        (op("in", MIXER, Located(zone="yard")), True),
        (op("in", OVEN, Located(zone="yard")), False),
        (op("not in", OVEN, Located(zone="yard")), True),
        (op("in", Located(point=(2, 1)), Located(zone="yard")), True),
        (op("count", op(">", HEAT, 60), op(">", HEAT, 70), True), 2),
        (op("now"), 28800),
        (op("min", 3, HEAT, 1, 2), 1),
        (op("max", 3, HEAT, 1, 2), 62.5),
        (op("text", "Painted ", Variable("count"), " boxes"), "Painted 3 boxes"),
        (op("text", HEAT, " ", 2.0, " ", 1 / 3, " ", Variable("dry")), "62.5 2 0.333 yes"),
        (op("text", Constant((1, "b", False))), "1, b, no"),
        (op("in", "box", Constant(("box", "can"))), True),
        (op("round", HEAT), 62),
        (op("and", True, op("==", Variable("shade"), "teal")), True),
        (op("-", HEAT, 2.5), 60),
    ],
)
def test_an_expression_has_a_value(expression: Expression, value: object) -> None:
    assert evaluate(expression, VARIABLES, FACTS, ZONES) == value


@pytest.mark.parametrize(
    "expression",
    [
        Reading(Constant("oven"), "pressure"),
        Located(role="nobody"),
        op("distance", OVEN, Located(place="dock")),
        op("nearest", Located(device="gone"), OVEN, MIXER),
        op("in", Located(device="gone"), Located(zone="yard")),
    ],
)
def test_what_nobody_has_said_yet_is_told_apart(expression: Expression) -> None:
    with pytest.raises(NoReading):
        evaluate(expression, VARIABLES, FACTS, ZONES)


def test_the_time_of_day_may_not_be_known_yet() -> None:
    with pytest.raises(NoReading):
        evaluate(op("now"), {}, {})


@pytest.mark.parametrize(
    "expression",
    [
        Variable("gone"),
        Quantity(10, "MIN"),
        Located(point=(1, 2)),
        Located(zone="yard"),
        op("distance", 3, OVEN),
        op("distance", OVEN),
        op("in", OVEN, Located(zone="elsewhere")),
        op("count", 1, True),
        op("nearest", OVEN),
        op("min", 1),
        op("min", "a", "b"),
        op("/", 1, 0),
        op("+", "a", "b"),
        op("<", "a", 1),
        op("boom", 1, 2),
        op("not", 3),
        op("now", 1),
        op("*", 1e15, 1e15),
        op("text", *["x" * 900] * 3),
    ],
)
def test_what_does_not_go_together_has_no_value(expression: Expression) -> None:
    with pytest.raises(EvaluationError) as caught:
        evaluate(expression, VARIABLES, FACTS, ZONES)
    assert not isinstance(caught.value, NoReading)


def test_a_condition_gives_yes_or_no_and_a_number_is_a_number() -> None:
    assert is_true(op("<", 1, 2), {}, {})
    assert evaluate_number(HEAT, {}, FACTS) == 62.5
    with pytest.raises(EvaluationError):
        is_true(Constant(1), {}, {})
    with pytest.raises(EvaluationError):
        evaluate_number(Constant(value=True), {}, {})


@pytest.mark.parametrize(
    ("point", "inside"),
    [((1, 1), True), ((3, 1), False), ((0.5, 2.5), True), ((2, 2.5), False), ((0, 0), True), ((1, 2), True)],
)
def test_a_zone_may_have_a_corner_that_goes_inward(point: tuple[float, float], inside: bool) -> None:
    assert lies_in(point, ((0, 0), (2, 0), (2, 2), (1, 2), (1, 3), (0, 3))) is inside


_NAMES = [*FUNCTIONS, *COMPARISONS, "+", "-", "*", "/", "and", "or", "not", "boom"]
_LEAVES = st.one_of(
    st.builds(Constant, st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=4)),
    st.builds(Constant, st.lists(st.integers() | st.text(max_size=2), max_size=3).map(tuple)),
    st.sampled_from([OVEN, CARRIER, Located(zone="yard"), Located(point=(1, 1)), Located(), HEAT, Quantity(1, "MIN")]),
    st.builds(Variable, st.sampled_from(["count", "machine", "gone"])),
)
_EXPRESSIONS = st.recursive(
    _LEAVES,
    lambda inner: st.one_of(
        st.builds(Operation, st.sampled_from(_NAMES), st.lists(inner, max_size=3).map(tuple)),
        st.builds(Reading, inner, st.sampled_from(["temperature", "$x"])),
    ),
    max_leaves=12,
)
_VALUES = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=4)


@given(_EXPRESSIONS, st.dictionaries(st.sampled_from(list(FACTS)), _VALUES))
def test_nothing_but_an_evaluation_error_comes_of_any_expression(expression: Expression, facts: Any) -> None:
    try:
        evaluate(expression, VARIABLES, {**FACTS, **facts}, ZONES)
    except EvaluationError:
        return

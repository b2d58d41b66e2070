"""Which devices and places a plan's expressions speak of, so that nobody else's readings are looked up."""

import pytest

from editor.language.expressions.nodes import Constant, Expression, Located, Operation, Reading, Variable
from editor.language.plan.instructions import Branch, End, Instruction, Plan
from execution.machine.needs import needs_of

OVEN, DOCK, ROBOT = Located(device="oven"), Located(place="dock"), Located(role="robot")
NEAREST = Operation("nearest", (ROBOT, OVEN, DOCK))


def needs(condition: Expression):
    return needs_of(Plan((Instruction(Branch(condition, 1)), Instruction(End()))))


@pytest.mark.parametrize(
    ("condition", "things"),
    [
        (Constant(True), set()),
        (Reading(Constant("oven"), "temperature"), {"oven"}),
        (Operation(">", (Reading(OVEN, "temperature"), Reading(ROBOT, "battery"))), {"oven"}),
        (Operation("<", (Operation("distance", (ROBOT, DOCK)), Constant(2))), {"dock"}),
        (Operation("in", (OVEN, Located(zone="z"))), {"oven"}),
        (Operation("in", (Reading(OVEN, "object"), Constant(("box", "can")))), {"oven"}),
        (Reading(NEAREST, "temperature"), {"oven", "dock"}),
        (Operation("distance", (Located(point=(1.0, 2.0)), NEAREST)), {"oven", "dock"}),
    ],
)
def test_what_is_spoken_of_is_known_before_the_run(condition: Expression, things: set[str]) -> None:
    assert needs(condition).things == things


@pytest.mark.parametrize(
    "condition",
    [
        Reading(Variable("machine"), "temperature"),
        Operation("distance", (ROBOT, Variable("target"))),
        Reading(Operation("nearest", (ROBOT, OVEN, Variable("other"))), "temperature"),
        Operation("not in", (Reading(OVEN, "object"), Located(zone="z"))),
    ],
)
def test_what_only_the_run_tells_may_be_anything(condition: Expression) -> None:
    assert needs(condition).things is None


def test_what_the_plan_says_it_reads_counts_too() -> None:
    assert needs_of(Plan((Instruction(End()),), reads=(("oven", "temperature"),))).things == {"oven"}

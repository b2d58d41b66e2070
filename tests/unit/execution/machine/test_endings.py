"""How a run ends: `final` handlers, an early End, branches that are called off."""

from editor.language.expressions.nodes import Constant, PlaceRef
from editor.language.plan.instructions import (
    End,
    Fork,
    Instruction,
    Join,
    Jump,
    Move,
    Rethrow,
    TryBegin,
    TryEnd,
    Wait,
)
from execution.machine import machine
from execution.machine import messages as r
from tests.kit.programs import names, plan_of

OVEN, SHELF = PlaceRef(device="oven"), PlaceRef(device="shelf")


FINALLY = plan_of(
    Instruction(TryBegin(5, (), final=True), "t", enters=("t",)),
    Instruction(Move("robot", OVEN), "m"),
    TryEnd(),
    Instruction(Wait(Constant(1)), "f"),
    Jump(7),
    Instruction(Wait(Constant(1)), "f"),
    Rethrow(),
    Instruction(Jump(8), "t", leaves=("t",)),
    End(),
)


def test_what_stands_in_finally_is_carried_out_before_the_failure_goes_on():
    state, _ = machine.start(FINALLY, {})
    state, actions = machine.step(FINALLY, state, r.TaskFailed(1, "offline", "Gone."))
    assert names(actions) == [("StepFailed", "m"), ("StepEntered", "f"), ("SetTimer", 2)]
    state, actions = machine.step(FINALLY, state, r.TimerFired(2))
    assert names(actions) == [("StepLeft", "f"), ("StepFailed", "t"), ("Finished", "failed")]
    assert state.reason == "Gone."


def test_without_a_failure_the_ordinary_way_goes_on_behind_the_handler():
    state, _ = machine.start(FINALLY, {})
    state, _ = machine.step(FINALLY, state, r.TaskDone(1))
    state, actions = machine.step(FINALLY, state, r.TimerFired(2))
    assert names(actions) == [("StepLeft", "f"), ("StepLeft", "t"), ("Finished", "finished")]


def test_a_shared_handler_that_is_walked_into_goes_on_behind_its_rethrow():
    program = plan_of(TryBegin(2, (), final=True), TryEnd(), Instruction(Wait(Constant(1)), "f"), Rethrow(), End())
    state, _ = machine.start(program, {})
    state, actions = machine.step(program, state, r.TimerFired(1))
    assert names(actions) == [("StepLeft", "f"), ("Finished", "finished")]


def test_an_early_end_carries_out_all_finally_bodies_around_it_and_finishes():
    program = plan_of(
        TryBegin(6, (), final=True),
        TryBegin(4, (), final=True),
        TryBegin(8, ()),
        Instruction(End(early=True), "end"),
        Instruction(Wait(Constant(1)), "inner"),
        Rethrow(),
        Instruction(Wait(Constant(2)), "outer"),
        Rethrow(),
        Instruction(Move("robot", OVEN), "never"),
    )
    state, actions = machine.start(program, {})
    assert names(actions) == [
        ("StepEntered", "end"), ("StepLeft", "end"), ("StepEntered", "inner"), ("SetTimer", 1),
    ]  # fmt: skip
    state, actions = machine.step(program, state, r.TimerFired(1))
    assert names(actions) == [("StepLeft", "inner"), ("StepEntered", "outer"), ("SetTimer", 2)]
    state, actions = machine.step(program, state, r.TimerFired(2))
    assert names(actions) == [("StepLeft", "outer"), ("Finished", "finished")]


def test_a_failure_in_a_finally_body_of_an_early_end_fails_the_run_and_no_catch_takes_it():
    program = plan_of(
        TryBegin(5, ()),
        TryBegin(3, (), final=True),
        End(early=True),
        Move("robot", OVEN),
        Rethrow(),
        Instruction(Move("robot", SHELF), "never"),
        End(),
    )
    state, _ = machine.start(program, {})
    state, actions = machine.step(program, state, r.TaskFailed(1, "blocked", "No way."))
    assert actions == (r.Finished("failed", "No way."),)


def test_a_failure_that_is_caught_inside_a_finally_body_does_no_harm():
    program = plan_of(
        TryBegin(2, (), final=True),
        End(early=True),
        TryBegin(5, ()),
        Move("robot", OVEN),
        TryEnd(),
        Instruction(Wait(Constant(1)), "f"),
        Rethrow(),
    )
    state, _ = machine.start(program, {})
    state, actions = machine.step(program, state, r.TaskFailed(1, "blocked", "No way."))
    assert names(actions) == [("StepEntered", "f"), ("SetTimer", 2)]
    state, actions = machine.step(program, state, r.TimerFired(2))
    assert names(actions) == [("StepLeft", "f"), ("Finished", "finished")]


BRANCHES = plan_of(
    Fork((2, 4), 1),
    End(),
    Instruction(Move("a", SHELF), "a1"),
    Join(),
    TryBegin(7, (), final=True),
    Instruction(Move("b", OVEN), "b1"),
    TryEnd(),
    Instruction(Wait(Constant(5)), "f"),
    Rethrow(),
    Join(),
)


def test_a_branch_that_is_called_off_carries_out_its_finally_before_the_parallel_fails():
    state, _ = machine.start(BRANCHES, {})
    state, actions = machine.step(BRANCHES, state, r.TaskFailed(3, "offline", "Gone."))
    assert names(actions) == [("StepFailed", "a1"), ("Cancel", 4), ("StepFailed", "b1"), ("StepEntered", "f"),
                              ("SetTimer", 5)]  # fmt: skip
    state, actions = machine.step(BRANCHES, state, r.TimerFired(5))
    assert names(actions) == [("StepLeft", "f"), ("Finished", "failed")]
    assert state.reason == "Gone."


def test_a_person_who_cancels_does_not_wait_for_finally():
    state, _ = machine.start(BRANCHES, {})
    _, actions = machine.step(BRANCHES, state, r.CancelAsked("Ada cancelled it"))
    assert names(actions) == [("Cancel", 3), ("StepFailed", "a1"), ("Cancel", 4), ("StepFailed", "b1"),
                              ("Finished", "cancelled")]  # fmt: skip


def test_an_early_end_in_a_branch_ends_the_others_and_the_run():
    program = plan_of(Fork((2, 3), 1), Instruction(Move("a", SHELF), "never"), End(early=True),
                   Instruction(Move("b", OVEN), "b1"))  # fmt: skip
    _, actions = machine.start(program, {})
    assert actions == (r.Finished("finished", ""),)


def test_branches_that_are_forked_for_ever_rest_and_do_not_hang():
    program = plan_of(Fork((2, 2), 1), Jump(0), Join())
    state, actions = machine.start(program, {})
    assert (state.status, names(actions)) == ("running", [("SetTimer", 101)])


def test_failures_that_are_caught_for_ever_rest_and_do_not_hang():
    program = plan_of(TryBegin(0, ()), Wait(Constant(-1)))
    state, actions = machine.start(program, {})
    assert (state.status, names(actions)) == ("running", [("SetTimer", 1)])

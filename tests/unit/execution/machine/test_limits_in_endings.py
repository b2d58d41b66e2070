"""Time limits and final parts where a program or a branch is ending already."""

from editor.language.expressions.nodes import Constant, PlaceRef
from editor.language.plan.instructions import (
    End,
    Fail,
    Fork,
    Instruction,
    Join,
    Move,
    Notify,
    Rethrow,
    TryBegin,
    TryEnd,
    Wait,
)
from execution.machine import messages as r
from tests.kit.programs import carry, limit, over, plan_of

OVEN, SHELF = PlaceRef(device="oven"), PlaceRef(device="shelf")


def test_the_program_ends_although_a_limit_strikes_while_its_final_parts_run():
    plan = plan_of(
        limit(),
        TryBegin(4, (), final=True),
        Instruction(End(early=True), "e"),
        TryEnd(),
        Instruction(Wait(Constant(5)), "f"),
        Rethrow(),
        over(),
    )
    _, (_, struck, ended) = carry(plan, r.TimerFired(1), r.TimerFired(2))
    assert struck == []
    assert ended == [("StepLeft", "f"), ("StepLeft", "l"), ("CancelTimer", 1), ("Finished", "finished")]


def test_a_limit_in_a_final_part_of_an_early_end_fails_the_run():
    plan = plan_of(
        TryBegin(2, (), final=True),
        End(early=True),
        limit(),
        Instruction(Move("robot", OVEN), "m"),
        over(),
        Instruction(Notify(Constant("Tidy.")), "n"),
        Rethrow(),
    )
    state, (_, struck) = carry(plan, r.TimerFired(1))
    assert struck == [("Cancel", 2), ("StepFailed", "m"), ("StepFailed", "l"), ("Finished", "failed")]
    assert state.reason == "The time limit of 60 s was over."


def test_a_limit_in_a_final_part_of_an_early_end_may_be_caught_there():
    plan = plan_of(
        TryBegin(2, (), final=True),
        End(early=True),
        TryBegin(7, ()),
        limit(),
        Instruction(Move("robot", OVEN), "m"),
        over(),
        TryEnd(),
        Instruction(Notify(Constant("Tidy.")), "n"),
        Rethrow(),
    )
    state, (_, struck) = carry(plan, r.TimerFired(1))
    assert ("Tell", "Tidy.") in struck
    assert state.status == "finished"


def test_a_failure_in_a_final_part_within_one_by_which_the_program_ends_is_not_caught_outside_of_that():
    plan = plan_of(
        TryBegin(9, ()),
        TryBegin(3, (), final=True),
        End(early=True),
        TryBegin(6, (), final=True),
        Instruction(Fail(Constant("First.")), "x"),
        TryEnd(),
        Instruction(Fail(Constant("Second.")), "y"),
        Rethrow(),
        Rethrow(),
        Instruction(Notify(Constant("Caught.")), "c"),
        End(),
    )
    state, (begun,) = carry(plan)
    assert ("Tell", "Caught.") not in begun
    assert (state.status, state.reason) == ("failed", "Second.")


def test_a_failure_that_takes_the_place_of_a_limit_in_such_a_final_part_may_be_caught_there_too():
    plan = plan_of(
        TryBegin(2, (), final=True),
        End(early=True),
        TryBegin(11, ()),
        limit(),
        TryBegin(7, (), final=True),
        Instruction(Move("robot", OVEN), "m"),
        TryEnd(),
        Instruction(Move("robot", SHELF), "f"),
        Rethrow(),
        over(),
        TryEnd(),
        Instruction(Notify(Constant("Tidy.")), "n"),
        Rethrow(),
    )
    state, (_, _, ended) = carry(plan, r.TimerFired(1), r.TaskFailed(3, "offline", "Gone."))
    assert ("Tell", "Tidy.") in ended
    assert (state.status, state.reason) == ("finished", "")


def test_a_branch_that_is_called_off_in_a_final_part_carries_that_out_with_what_it_catches():
    plan = plan_of(
        Fork((2, 4), 1),
        End(),
        Instruction(Move("a", SHELF), "a"),
        Join(),
        TryBegin(7, (), final=True),
        Instruction(Fail(Constant("First.")), "x"),
        TryEnd(),
        TryBegin(13, ()),
        TryBegin(11, (), final=True),
        Instruction(Fail(Constant("Second.")), "y"),
        TryEnd(),
        Instruction(Move("b", OVEN), "b"),
        Rethrow(),
        Instruction(Notify(Constant("Tidy.")), "n"),
        Rethrow(),
        Join(),
    )
    state, (_, off, ended) = carry(plan, r.TaskFailed(3, "offline", "Gone."), r.TaskDone(4))
    assert ("Cancel", 4) not in off
    assert ("Tell", "Tidy.") in ended
    assert (state.status, state.reason) == ("failed", "Gone.")

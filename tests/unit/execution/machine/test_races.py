"""A Parallel that ends when some of its branches have: the others are called off, and the program goes on behind it."""

import pytest

from editor.language.expressions.nodes import AnswerSpec, Constant, Operation, PlaceRef, Reading
from editor.language.plan.instructions import (
    AskPerson,
    Assign,
    Caught,
    End,
    Fail,
    Fork,
    Instruction,
    Join,
    Jump,
    Move,
    Plan,
    Rethrow,
    TryBegin,
    TryEnd,
    Wait,
    WaitUntil,
)
from editor.language.plan.json_form import plan_from_json, plan_to_json
from execution.machine import machine
from execution.machine import messages as r
from tests.kit.programs import names, plan_of, reload

OVEN, SHELF = PlaceRef(device="oven"), PlaceRef(device="shelf")
HOT = Operation(">", (Reading(Constant("oven"), "heat"), Constant(50)))
TEXT = Constant("Wet.")


def play(plan: Plan, *events: r.Event) -> tuple[str, str, list[tuple[str, object]]]:
    """Return how a run stands after some events, kept and read back before each, and all that it did."""
    state, done = machine.start(plan, {}, {("oven", "heat"): 20})
    for event in events:
        state, actions = machine.step(plan, reload(state), event)
        done += actions
    return state.status, state.reason, names(done)


def race(*branches: tuple[object, ...], needed: int = 1) -> Plan:
    """Return a plan whose Parallel `p` has these branches, and after which the step `after` waits."""
    starts, instructions = [], list[object]()
    for branch in branches:
        starts.append(3 + len(instructions))
        instructions += [*branch, Join()]
    fork = Instruction(Fork(tuple(starts), 1, needed), enters=("p",), leaves=("p",))
    return plan_of(fork, Instruction(Wait(Constant(1)), "after"), End(), *instructions)


def test_the_first_branch_that_ends_calls_the_other_off_and_the_program_goes_on():
    plan = race((Instruction(Move("a", SHELF), "a1"),), (Instruction(Move("b", OVEN), "b1"),))
    assert play(plan, r.TaskDone(4)) == (
        "running",
        "",
        [("StepEntered", "p"), ("StepEntered", "a1"), ("Ask", 3), ("StepEntered", "b1"), ("Ask", 4),
         ("StepLeft", "b1"), ("Cancel", 3), ("StepFailed", "a1"), ("StepLeft", "p"),
         ("StepEntered", "after"), ("SetTimer", 5)],
    )  # fmt: skip


def test_two_of_three_end_it_and_what_comes_late_changes_nothing():
    waits = [(Instruction(Wait(Constant(60)), f"w{index}"),) for index in range(3)]
    plan = race(*waits, needed=2)
    status, _, one = play(plan, r.TimerFired(4))
    assert (status, one[-1]) == ("running", ("StepLeft", "w0"))
    _, _, two = play(plan, r.TimerFired(4), r.TimerFired(6))
    assert two[len(one) :] == [("StepLeft", "w2"), ("CancelTimer", 5), ("StepFailed", "w1"), ("StepLeft", "p"),
                               ("StepEntered", "after"), ("SetTimer", 7)]  # fmt: skip
    assert play(plan, r.TimerFired(4), r.TimerFired(6), r.TimerFired(5))[2] == two
    assert play(plan, r.TimerFired(4), r.TimerFired(6), r.TimerFired(7))[0] == "finished"


def test_of_two_that_end_in_one_turn_the_earlier_branch_is_first():
    plan = race(
        (Instruction(WaitUntil(HOT, None), "a1"), Assign("who", Constant("a"), shared=True)),
        (Instruction(WaitUntil(HOT, None), "b1"), Assign("who", Constant("b"), shared=True)),
    )
    state, _ = machine.start(plan, {}, {("oven", "heat"): 20})
    state, actions = machine.step(plan, reload(state), r.Facts({("oven", "heat"): 60}))
    assert state.frames[0]["who"] == "a"
    assert ("StepLeft", "a1") in names(actions)
    assert ("StepFailed", "b1") in names(actions)


def test_a_branch_that_is_over_at_once_leaves_no_task_of_those_behind_it():
    plan = race((Assign("who", Constant("a")),), (Instruction(Move("b", OVEN), "b1"),))
    assert play(plan)[2] == [("StepEntered", "p"), ("StepLeft", "p"), ("StepEntered", "after"), ("SetTimer", 3)]


def test_a_question_and_a_nested_parallel_are_called_off_with_their_branch():
    plan = race(
        (Instruction(Wait(Constant(5)), "w"),),
        (Fork((7, 9), 6),),
    )
    inner = (Instruction(AskPerson(TEXT, AnswerSpec()), "q"), Join(), Instruction(Move("b", OVEN), "m"), Join())
    plan = Plan((*plan.instructions, *(i if isinstance(i, Instruction) else Instruction(i) for i in inner)))
    state, _ = machine.start(plan, {})
    _, actions = machine.step(plan, reload(state), r.TimerFired(3))
    assert {r.CancelQuestion(6), r.Cancel(7)} <= set(actions)
    assert {("StepFailed", "q"), ("StepFailed", "m"), ("StepLeft", "p")} <= set(names(actions))


FINALLY = (
    TryBegin(11, (), final=True),
    Instruction(Move("robot", OVEN), "m"),
    TryEnd(),
    Jump(13),
    Jump(11),
)


def with_finally(*handler: object) -> Plan:
    """Return a race of a wait with a drive that has a `final` handler, which begins at 11."""
    plan = race((Instruction(Wait(Constant(5)), "w"),), FINALLY)
    padding = [Jump(0)] * (11 - len(plan.instructions))
    return plan_of(*plan.instructions, *padding, *handler, Rethrow(), Join())


def test_the_parallel_ends_when_the_finally_of_the_called_off_branch_is_done():
    plan = with_finally(Instruction(Wait(Constant(1)), "f"))
    status, _, done = play(plan, r.TimerFired(3))
    assert (status, done[-3:]) == ("running", [("StepFailed", "m"), ("StepEntered", "f"), ("SetTimer", 5)])
    assert ("Cancel", 4) in done
    assert ("StepLeft", "p") not in done
    _, _, more = play(plan, r.TimerFired(3), r.TimerFired(5))
    assert more[len(done) :] == [("StepLeft", "f"), ("StepLeft", "p"), ("StepEntered", "after"), ("SetTimer", 6)]


def test_a_failure_in_the_finally_of_a_called_off_branch_fails_the_parallel():
    status, reason, done = play(with_finally(Instruction(Fail(TEXT), "f")), r.TimerFired(3))
    assert (status, reason) == ("failed", "Wet.")
    assert ("StepFailed", "p") in done
    assert ("StepEntered", "after") not in done


def test_a_failure_in_the_finally_of_a_branch_within_the_called_off_branch_fails_the_parallel_too():
    plan = race((Instruction(Wait(Constant(5)), "w"),), (Fork((7,), 6),))
    inner = (TryBegin(9, (), final=True), Instruction(Wait(Constant(60)), "x"), Fail(TEXT), Rethrow(), Join())
    whole = plan_of(*plan.instructions, *inner)
    assert play(whole, r.TimerFired(3))[:2] == ("failed", "Wet.")


def test_a_catch_for_cancelled_is_not_for_who_is_called_off():
    plan = race(
        (Instruction(Wait(Constant(5)), "w"),),
        (TryBegin(9, ("cancelled",)), Instruction(Wait(Constant(60)), "x"), TryEnd(), Jump(10), Caught("t", "k")),
    )
    _, _, done = play(plan, r.TimerFired(3))
    assert done[-3:] == [("StepLeft", "p"), ("StepEntered", "after"), ("SetTimer", 5)]


def test_a_branch_that_fails_before_enough_have_ended_fails_it():
    plan = race((Instruction(Move("a", SHELF), "a1"),), (Instruction(Wait(Constant(9)), "b1"),))
    status, reason, done = play(plan, r.TaskFailed(3, "blocked", "No way."))
    assert (status, reason) == ("failed", "No way.")
    assert ("CancelTimer", 4) in done


@pytest.mark.parametrize("event", [r.PauseAsked("p"), r.CancelAsked("c")])
def test_a_pause_or_a_cancel_while_a_called_off_branch_winds_up(event):
    plan = with_finally(Instruction(Wait(Constant(1)), "f"))
    status, _, _ = play(plan, r.TimerFired(3), event)
    assert status == ("paused" if isinstance(event, r.PauseAsked) else "cancelled")
    if status == "paused":
        status, _, done = play(plan, r.TimerFired(3), event, r.TimerFired(5), r.Resumed())
        assert (status, done[-1]) == ("running", ("SetTimer", 6))


def test_a_plan_of_before_says_nothing_of_how_many_are_needed():
    plan = race((Wait(Constant(1)),), (Wait(Constant(1)),))
    kept = plan_to_json(plan)
    assert plan_from_json(kept) == plan
    assert kept["instructions"][0].pop("needed") == 1
    assert plan_from_json(kept).instructions[0].do == Fork((3, 5), 1)

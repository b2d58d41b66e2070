import pytest

from editor.language.expressions.nodes import Constant, Operation, PlaceRef, Reading, Variable
from editor.language.plan.instructions import (
    Assign,
    Branch,
    Call,
    Drop,
    End,
    Fork,
    Instruction,
    Invoke,
    Join,
    Jump,
    Move,
    Pick,
    Return,
    TryBegin,
    TryEnd,
    Wait,
    WaitUntil,
)
from execution.machine import machine
from execution.machine import messages as r
from execution.machine.floor_task import Target, TaskOrder
from tests.kit.programs import names, plan_of, reload

OVEN = PlaceRef(device="oven")
SHELF = PlaceRef(device="shelf")
ONE, BOX = Constant(1), Constant("box")


def test_a_pick_and_drop_is_asked_one_task_at_a_time():
    program = plan_of(
        Instruction(Move("robot", SHELF), "s1", 1),
        Instruction(Pick("robot", SHELF, BOX, ONE), "s1", 2),
        Instruction(Drop("robot", OVEN, BOX, Constant(2)), "s1", 3),
        End(),
    )
    state, actions = machine.start(program, {})
    assert actions == (r.StepEntered("s1"), r.Ask(1, TaskOrder("move", Target("shelf"), "robot", step="s1", line=1)))
    state, actions = machine.step(program, reload(state), r.TaskDone(1))
    assert actions == (r.Ask(2, TaskOrder("pick", Target("shelf"), "robot", "box", 1, step="s1", line=2)),)
    state, actions = machine.step(program, reload(state), r.TaskDone(2))
    assert actions == (r.Ask(3, TaskOrder("drop", Target("oven"), "robot", "box", 2, step="s1", line=3)),)
    state, actions = machine.step(program, reload(state), r.TaskDone(3))
    assert actions == (r.StepLeft("s1"), r.Finished("finished", ""))
    assert state.status == "finished"


def test_an_answer_that_comes_twice_or_to_nobody_changes_nothing():
    program = plan_of(Move("robot", SHELF), Move("robot", OVEN), End())
    state, _ = machine.start(program, {})
    state, _ = machine.step(program, state, r.TaskDone(1))
    assert machine.step(program, state, r.TaskDone(1)) == (state, ())
    assert machine.step(program, state, r.TaskFailed(99, "failed", "")) == (state, ())
    assert machine.step(program, state, r.TimerFired(2)) == (state, ())


def test_parallel_branches_go_on_by_themselves_and_meet():
    program = plan_of(
        Instruction(Fork((2, 4), 1), enters=("p",), leaves=("p",)),
        End(),
        Instruction(Move("a", SHELF), "a1"),
        Join(),
        Instruction(Move("b", OVEN), "b1"),
        Join(),
    )
    state, actions = machine.start(program, {})
    assert names(actions) == [
        ("StepEntered", "p"),
        ("StepEntered", "a1"),
        ("Ask", 3),
        ("StepEntered", "b1"),
        ("Ask", 4),
    ]
    state, actions = machine.step(program, reload(state), r.TaskDone(4))
    assert names(actions) == [("StepLeft", "b1")]
    state, actions = machine.step(program, reload(state), r.TaskDone(3))
    assert names(actions) == [("StepLeft", "a1"), ("StepLeft", "p"), ("Finished", "finished")]


def test_a_failing_branch_calls_the_others_off_and_fails_the_run():
    program = plan_of(Fork((2, 4), 1), End(), Instruction(Move("a", SHELF), "a1"), Join(),
                   Instruction(Wait(Constant(60)), "b1"), Join())  # fmt: skip
    state, _ = machine.start(program, {})
    state, actions = machine.step(program, state, r.TaskFailed(3, "offline", "robot01 is offline."))
    assert actions == (
        r.StepFailed("a1", "offline", "robot01 is offline."),
        r.CancelTimer(4),
        r.StepFailed("b1", "cancelled", "Another branch failed."),
        r.Finished("failed", "robot01 is offline."),
    )
    assert state.threads == {}


TRY = plan_of(
    Instruction(TryBegin(4, ("offline", "failed")), enters=("t",)),
    Instruction(Move("robot", OVEN), "m"),
    TryEnd(),
    Jump(5),
    Instruction(Move("robot", SHELF), "c"),
    Instruction(End(), leaves=("t",)),
)


def test_a_failure_of_a_kind_that_is_caught_goes_on_at_the_handler():
    state, _ = machine.start(TRY, {})
    state, actions = machine.step(TRY, state, r.TaskFailed(1, "offline", "Gone."))
    assert names(actions) == [("StepFailed", "m"), ("StepEntered", "c"), ("Ask", 2)]
    state, actions = machine.step(TRY, state, r.TaskDone(2))
    assert names(actions) == [("StepLeft", "c"), ("StepLeft", "t"), ("Finished", "finished")]


def test_a_failure_of_another_kind_is_not_caught():
    state, _ = machine.start(TRY, {})
    state, actions = machine.step(TRY, state, r.TaskFailed(1, "blocked", "No way."))
    assert names(actions) == [("StepFailed", "m"), ("StepFailed", "t"), ("Finished", "failed")]
    assert state.reason == "No way."


def test_a_handler_that_fails_is_not_caught_by_its_own_try():
    state, _ = machine.start(TRY, {})
    state, _ = machine.step(TRY, state, r.TaskFailed(1, "failed", "First."))
    state, _actions = machine.step(TRY, state, r.TaskFailed(2, "failed", "Second."))
    assert (state.status, state.reason) == ("failed", "Second.")


UNTIL = plan_of(
    WaitUntil(Operation("<", (Reading(Constant("oven"), "temperature"), Constant(40))), Constant(600)),
    End(),
)


def test_waiting_until_ends_when_the_reading_comes_and_not_before():
    state, actions = machine.start(UNTIL, {})
    assert actions == (r.SetTimer(1, 600),)
    state, actions = machine.step(UNTIL, reload(state), r.Facts({("oven", "temperature"): 80}))
    assert actions == ()
    state, actions = machine.step(UNTIL, reload(state), r.Facts({("oven", "temperature"): 39.5}))
    assert actions == (r.CancelTimer(1), r.Finished("finished", ""))


def test_waiting_until_past_its_limit_is_timed_out():
    state, _ = machine.start(UNTIL, {}, {("oven", "temperature"): 80})
    state, actions = machine.step(UNTIL, state, r.TimerFired(1))
    assert actions == (r.Finished("failed", "The condition did not come true in time."),)


def test_a_while_loop_counts_and_leaves_its_step():
    counting = Operation("<", (Variable("n"), Constant(2)))
    program = plan_of(
        Instruction(Branch(counting, 4), enters=("w",)),
        Instruction(Wait(Constant(1)), "body"),
        Assign("n", Operation("+", (Variable("n"), ONE))),
        Jump(0),
        Instruction(Jump(5), leaves=("w",)),
        End(),
        n=0,
    )
    state, actions = machine.start(program, {})
    told = names(actions)
    for timer in (1, 2):
        state, actions = machine.step(program, reload(state), r.TimerFired(timer))
        told += names(actions)
    assert told == [
        ("StepEntered", "w"), ("StepEntered", "body"), ("SetTimer", 1), ("StepLeft", "body"),
        ("StepEntered", "body"), ("SetTimer", 2), ("StepLeft", "body"), ("StepLeft", "w"), ("Finished", "finished"),
    ]  # fmt: skip


def test_a_loop_without_a_wait_rests_and_does_not_hang():
    program = plan_of(Jump(0))
    state, actions = machine.start(program, {})
    assert actions == (r.SetTimer(1, machine.YIELD_S),)
    state, actions = machine.step(program, state, r.TimerFired(1))
    assert actions == (r.SetTimer(2, machine.YIELD_S),)


def test_a_function_has_its_own_variables_and_its_call_is_left_at_its_return():
    program = plan_of(
        Instruction(Invoke(2, "mix", {"minutes": Constant(3)}, "out"), "c", enters=("c",), leaves=("c",)),
        Instruction(Wait(Variable("out")), "after"),
        Instruction(Call(OVEN, "mix", {"time": Variable("minutes")}), "inner"),
        Return(Operation("*", (Variable("minutes"), Constant(2)))),
    )
    state, actions = machine.start(program, {})
    assert actions[-1] == r.Ask(2, TaskOrder("call", Target("oven"), method="mix", arguments={"time": 3}, step="inner"))
    state, actions = machine.step(program, reload(state), r.TaskDone(2))
    assert actions == (r.StepLeft("inner"), r.StepLeft("c"), r.StepEntered("after"), r.SetTimer(3, 6))


def test_endless_recursion_fails_with_a_reason():
    program = plan_of(Invoke(0, "again", {}), End())
    state, _actions = machine.start(program, {})
    assert state.status == "failed"
    assert state.reason == "“again” calls itself more than 100 times deep."


def test_while_paused_nothing_new_is_asked_and_resuming_goes_on_at_the_same_place():
    program = plan_of(Move("robot", SHELF), Move("robot", OVEN), End())
    state, _ = machine.start(program, {})
    state, actions = machine.step(program, state, r.PauseAsked("Ada paused it"))
    assert (state.status, actions) == ("paused", ())
    state, actions = machine.step(program, reload(state), r.TaskDone(1))
    assert actions == ()
    state, actions = machine.step(program, reload(state), r.Resumed())
    assert actions == (r.Ask(2, TaskOrder("move", Target("oven"), "robot")),)
    assert state.status == "running"


def test_cancelling_calls_off_what_is_under_way():
    program = plan_of(Instruction(Move("robot", SHELF), "m"), End())
    state, _ = machine.start(program, {})
    state, actions = machine.step(program, state, r.CancelAsked("Ada cancelled it"))
    assert actions == (
        r.Cancel(1),
        r.StepFailed("m", "cancelled", "Ada cancelled it"),
        r.Finished("cancelled", "Ada cancelled it"),
    )
    assert machine.step(program, state, r.TaskDone(1)) == (state, ())


@pytest.mark.parametrize(
    ("condition", "why"),
    [
        (Operation("<", (Constant("a"), ONE)), "'a' stands where a number is needed."),
        (Operation("<", (Reading(Constant("oven"), "heat"), ONE)), "oven has not reported its heat yet."),
        (Operation("/", (ONE, Constant(0))), "A number is divided by zero."),
        (Constant(3), "The condition gives 3 where yes or no is needed."),
        (Variable("x"), "There is no value called “x” here."),
    ],
)
def test_a_condition_without_a_value_fails_the_step_with_the_reason(condition, why):
    state, _ = machine.start(plan_of(Branch(condition, 1), End()), {})
    assert (state.status, state.reason) == ("failed", why)


def test_a_quantity_of_nothing_is_refused():
    state, _actions = machine.start(plan_of(Pick("robot", SHELF, BOX, Constant(0)), End()), {})
    assert state.reason == "The quantity is 0; it must be more than nothing."


def test_and_does_not_look_further_than_it_must():
    unknown = Reading(Constant("oven"), "heat")
    condition = Operation("and", (Constant(False), Operation("<", (unknown, ONE))))
    state, _actions = machine.start(plan_of(Branch(condition, 1), End()), {})
    assert state.status == "finished"

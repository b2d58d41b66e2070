"""Time limits: what they end, what they leave alone, and what goes on afterwards."""

import pytest

from editor.language.expressions.nodes import AnswerSpec, Constant, PlaceRef, Variable
from editor.language.plan.instructions import (
    AskPerson,
    Assign,
    Caught,
    End,
    Fork,
    Instruction,
    Invoke,
    Join,
    Jump,
    Move,
    Notify,
    Rethrow,
    Return,
    TryBegin,
    TryEnd,
    Wait,
)
from execution.machine import machine
from execution.machine import messages as r
from tests.kit.programs import carry, limit, over, plan_of

OVEN, SHELF = PlaceRef(device="oven"), PlaceRef(device="shelf")
OVER = "The time limit of 60 s was over."


MOVING = plan_of(limit(), Instruction(Move("robot", OVEN), "m"), over(), Instruction(Notify(Constant("Here.")), "n"))


def test_what_is_under_way_is_called_off_and_the_run_fails_as_timed_out():
    state, (begun, struck) = carry(MOVING, r.TimerFired(1))
    assert begun == [("StepEntered", "l"), ("SetTimer", 1), ("StepEntered", "m"), ("Ask", 2)]
    assert struck == [("Cancel", 2), ("StepFailed", "m"), ("StepFailed", "l"), ("Finished", "failed")]
    assert state.reason == OVER


def test_the_failed_steps_say_that_they_have_timed_out():
    _, actions = machine.step(MOVING, machine.start(MOVING, {})[0], r.TimerFired(1))
    failed = [(a.step, a.kind, a.why) for a in actions if isinstance(a, r.StepFailed)]
    assert failed == [("m", "timed_out", OVER), ("l", "timed_out", OVER)]


def test_a_body_that_ends_in_time_needs_its_timer_no_more():
    state, (_, done) = carry(MOVING, r.TaskDone(2))
    assert done == [("StepLeft", "m"), ("CancelTimer", 1), ("StepLeft", "l"), ("StepEntered", "n"), ("Tell", "Here."),
                    ("StepLeft", "n"), ("Finished", "finished")]  # fmt: skip
    assert state.status == "finished"


def test_a_timer_that_fires_when_the_body_has_just_ended_changes_nothing():
    plan = plan_of(limit(), Instruction(Wait(Constant(5)), "w"), over(), Instruction(Wait(Constant(9)), "x"))
    state, (_, _, late) = carry(plan, r.TimerFired(2), r.TimerFired(1))
    assert (late, state.status) == ([], "running")


def test_a_failure_in_the_body_passes_through():
    state, (_, failed) = carry(MOVING, r.TaskFailed(2, "blocked", "No way."))
    assert failed == [("StepFailed", "m"), ("StepFailed", "l"), ("CancelTimer", 1), ("Finished", "failed")]
    assert state.reason == "No way."


def caught_by(*kinds):
    return plan_of(
        Instruction(TryBegin(5, kinds), "t", enters=("t",)),
        limit(),
        Instruction(Move("robot", OVEN), "m"),
        over(),
        Instruction(End(), "never"),
        Caught("text", "kind"),
        Instruction(Notify(Variable("kind")), "k"),
        Instruction(Notify(Variable("text")), "n"),
        End(),
    )


def test_a_try_around_it_catches_it_with_text_and_kind():
    state, (_, struck) = carry(caught_by("timed_out"), r.TimerFired(1))
    assert ("Tell", "timed_out") in struck
    assert ("Tell", OVER) in struck
    assert state.status == "finished"


def test_a_try_around_it_for_other_kinds_does_not_catch_it():
    state, (_, struck) = carry(caught_by("failed", "cancelled"), r.TimerFired(1))
    assert (state.status, state.reason) == ("failed", OVER)
    assert ("Tell", "timed_out") not in struck


def test_a_try_in_it_cannot_catch_it_and_its_finally_is_carried_out():
    plan = plan_of(
        limit(),
        Instruction(TryBegin(6, (), final=True), "t", enters=("t",)),
        TryBegin(8, ()),
        Instruction(Move("robot", OVEN), "m"),
        TryEnd(),
        TryEnd(),
        Instruction(Wait(Constant(5)), "f"),
        Rethrow(),
        Instruction(Notify(Constant("Caught.")), "c"),
        over(),
    )
    state, (_, struck, tidied) = carry(plan, r.TimerFired(1), r.TimerFired(3))
    assert struck == [("Cancel", 2), ("StepFailed", "m"), ("StepEntered", "f"), ("SetTimer", 3)]
    assert tidied == [("StepLeft", "f"), ("StepFailed", "t"), ("StepFailed", "l"), ("Finished", "failed")]
    assert state.reason == OVER


FINAL = plan_of(
    limit(),
    Instruction(TryBegin(4, (), final=True), "t", enters=("t",)),
    Instruction(Move("robot", OVEN), "m"),
    TryEnd(),
    Instruction(Move("robot", SHELF), "f"),
    Rethrow(),
    over(),
)


def test_a_final_part_behind_a_failure_is_carried_out_to_its_end_and_then_the_limit_has_struck():
    state, (_, _, struck, tidied) = carry(FINAL, r.TaskFailed(2, "blocked", "No way."), r.TimerFired(1), r.TaskDone(3))
    assert struck == []
    assert tidied == [("StepLeft", "f"), ("StepFailed", "t"), ("StepFailed", "l"), ("Finished", "failed")]
    assert state.reason == OVER


def test_a_failure_in_the_final_part_of_what_the_limit_ends_takes_the_place_of_the_limit():
    state, _ = carry(FINAL, r.TimerFired(1), r.TaskFailed(3, "offline", "Gone."))
    assert (state.status, state.reason) == ("failed", "Gone.")


def test_what_fails_in_that_final_part_is_not_caught_within_the_limit():
    plan = plan_of(
        TryBegin(12, ("offline",)),
        limit(),
        TryBegin(9, ()),
        TryBegin(6, (), final=True),
        Instruction(Move("robot", OVEN), "m"),
        TryEnd(),
        Instruction(Move("robot", SHELF), "f"),
        Rethrow(),
        TryEnd(),
        Instruction(Notify(Constant("Caught within.")), "i"),
        over(),
        End(),
        Instruction(Notify(Constant("Caught around.")), "o"),
        End(),
    )
    state, done = carry(plan, r.TimerFired(1), r.TaskFailed(3, "offline", "Gone."))
    said = [text for each in done for name, text in each if name == "Tell"]
    assert (said, state.status) == (["Caught around."], "finished")


def test_a_final_part_that_is_walked_into_belongs_to_the_body_and_is_cut_short():
    _, (_, _, struck) = carry(FINAL, r.TaskDone(2), r.TimerFired(1))
    assert struck == [("Cancel", 3), ("StepFailed", "f"), ("StepFailed", "t"), ("StepFailed", "l"),
                      ("Finished", "failed")]  # fmt: skip


NESTED = plan_of(
    TryBegin(9, ()),
    limit("outer", 60),
    TryBegin(7, ("timed_out",)),
    limit("inner", 30),
    Instruction(Move("robot", OVEN), "m"),
    over("inner"),
    TryEnd(),
    Instruction(Move("robot", SHELF), "c"),
    over("outer"),
    Instruction(Notify(Constant("Around.")), "n"),
    End(),
)


def test_the_inner_limit_is_caught_between_the_two_and_the_outer_one_goes_on():
    state, (_, inner, outer) = carry(NESTED, r.TimerFired(2), r.TimerFired(1))
    assert inner == [("Cancel", 3), ("StepFailed", "m"), ("StepFailed", "inner"), ("StepEntered", "c"), ("Ask", 4)]
    assert outer[:3] == [("Cancel", 4), ("StepFailed", "c"), ("StepFailed", "outer")]
    assert state.status == "finished"


def test_the_outer_limit_may_strike_first_and_nothing_between_catches_it():
    state, (_, outer, late) = carry(NESTED, r.TimerFired(1), r.TimerFired(2))
    assert outer == [("Cancel", 3), ("StepFailed", "m"), ("StepFailed", "inner"), ("CancelTimer", 2),
                     ("StepFailed", "outer"), ("StepEntered", "n"), ("Tell", "Around."), ("StepLeft", "n"),
                     ("Finished", "finished")]  # fmt: skip
    assert (late, state.status) == ([], "finished")


TWO_FINALS = plan_of(
    limit("outer", 60),
    TryBegin(9, ("timed_out",)),
    limit("inner", 30),
    TryBegin(6, (), final=True),
    Instruction(Move("robot", OVEN), "m"),
    TryEnd(),
    Instruction(Move("robot", SHELF), "f"),
    Rethrow(),
    over("inner"),
    Instruction(Notify(Constant("Caught.")), "c"),
    over("outer"),
)


@pytest.mark.parametrize(("first", "second"), [(1, 2), (2, 1)])
def test_two_limits_that_strike_while_a_final_part_runs_end_as_the_outer_one(first, second):
    state, (*_, ended) = carry(TWO_FINALS, r.TimerFired(first), r.TimerFired(second), r.TaskDone(4))
    assert (state.status, state.reason) == ("failed", OVER)
    assert ("Tell", "Caught.") not in ended
    ended = [each for each in ended if each[0] != "CancelTimer"]
    assert ended[-3:] == [
        ("StepFailed", "inner"),
        ("StepFailed", "outer"),
        ("Finished", "failed"),
    ]


BRANCHES = plan_of(
    limit(),
    Instruction(Fork((3, 5), 2), "p", enters=("p",), leaves=("p",)),
    over(),
    Instruction(Move("a", OVEN), "a"),
    Join(),
    TryBegin(8, (), final=True),
    Instruction(AskPerson(Constant("Dry?"), AnswerSpec(), timeout_s=Constant(600)), "q"),
    TryEnd(),
    Instruction(Wait(Constant(5)), "f"),
    Rethrow(),
    Join(),
)


def test_branches_in_it_are_called_off_and_the_limit_waits_for_their_final_parts():
    state, (_, struck, tidied) = carry(BRANCHES, r.TimerFired(1), r.TimerFired(6))
    assert struck == [("Cancel", 4), ("CancelQuestion",), ("CancelTimer", 5), ("StepFailed", "a"),
                      ("StepFailed", "q"), ("StepEntered", "f"), ("SetTimer", 6)]  # fmt: skip
    assert tidied == [("StepLeft", "f"), ("StepFailed", "p"), ("StepFailed", "l"), ("Finished", "failed")]
    assert state.reason == OVER


def test_branches_that_are_called_off_say_that_they_were_cancelled():
    _, actions = machine.step(BRANCHES, machine.start(BRANCHES, {})[0], r.TimerFired(1))
    failed = {a.step: (a.kind, a.why) for a in actions if isinstance(a, r.StepFailed)}
    assert failed == {"a": ("cancelled", OVER), "q": ("cancelled", OVER)}


def test_a_branch_that_has_failed_before_makes_no_difference_to_a_limit_that_strikes_while_others_tidy_up():
    state, _ = carry(BRANCHES, r.TaskFailed(4, "blocked", "No way."), r.TimerFired(1), r.TimerFired(6))
    assert (state.status, state.reason) == ("failed", OVER)


def test_a_limit_in_one_branch_fails_the_parallel_and_calls_the_other_off():
    plan = plan_of(
        Fork((2, 6), 1),
        End(),
        limit(),
        Instruction(Move("a", OVEN), "a"),
        over(),
        Join(),
        Instruction(Move("b", SHELF), "b"),
        Join(),
    )
    state, (_, struck) = carry(plan, r.TimerFired(3))
    assert struck == [("Cancel", 4), ("StepFailed", "a"), ("StepFailed", "l"), ("Cancel", 5), ("StepFailed", "b"),
                      ("Finished", "failed")]  # fmt: skip
    assert state.reason == OVER


def test_a_limit_of_a_branch_that_another_called_off_is_dropped():
    plan = plan_of(
        Fork((2, 6), 1),
        End(),
        limit(),
        Instruction(Move("a", OVEN), "a"),
        over(),
        Join(),
        Instruction(Move("b", SHELF), "b"),
        Join(),
    )
    state, (_, failed) = carry(plan, r.TaskFailed(5, "blocked", "No way."))
    assert failed.index(("CancelTimer", 3)) > failed.index(("Cancel", 4))
    assert state.reason == "No way."


def test_a_function_in_it_is_left_with_its_variables():
    plan = plan_of(
        TryBegin(5, ()),
        limit(),
        Instruction(Invoke(7, "f", {"n": Constant(1)}), "c", enters=("c",), leaves=("c",)),
        over(),
        End(),
        Instruction(Wait(Constant(9)), "after"),
        End(),
        Assign("own", Constant(3)),
        Instruction(Wait(Constant(500)), "w"),
        Return(),
    )
    state, (_, struck) = carry(plan, r.TimerFired(1))
    assert struck == [("CancelTimer", 3), ("StepFailed", "w"), ("StepFailed", "c"), ("StepFailed", "l"),
                      ("StepEntered", "after"), ("SetTimer", 4)]  # fmt: skip
    assert set(state.frames) == {0}
    assert len(state.threads[0].calls) == 1


def test_a_return_out_of_a_limit_drops_it():
    plan = plan_of(
        Instruction(Invoke(2, "f", {}), "c", enters=("c",), leaves=("c",)),
        Instruction(Wait(Constant(9)), "after"),
        limit(),
        Return(),
        over(),
        Return(),
    )
    state, ((*_, dropped, left, _, _, _),) = carry(plan)
    assert dropped == ("CancelTimer", 2)
    assert left == ("StepLeft", "l")
    assert state.threads[0].guards == ()


def test_a_limit_in_a_loop_begins_anew_each_round():
    plan = plan_of(limit(), Instruction(Wait(Constant(5)), "w"), over(), Jump(0))
    _, (first, second) = carry(plan, r.TimerFired(2))
    assert ("SetTimer", 1) in first
    assert second == [("StepLeft", "w"), ("CancelTimer", 1), ("StepLeft", "l"), ("StepEntered", "l"),
                      ("SetTimer", 3), ("StepEntered", "w"), ("SetTimer", 4)]  # fmt: skip


def test_a_body_that_turns_without_waiting_is_ended_too():
    plan = plan_of(limit(), Jump(1))
    state, (begun, struck) = carry(plan, r.TimerFired(1))
    assert begun == [("StepEntered", "l"), ("SetTimer", 1), ("SetTimer", 2)]
    assert struck == [("CancelTimer", 2), ("StepFailed", "l"), ("Finished", "failed")]
    assert state.reason == OVER


def test_time_counts_while_a_person_has_paused_the_run_and_the_failure_comes_when_it_goes_on():
    state, (_, _, struck, resumed) = carry(
        caught_by("timed_out"), r.PauseAsked("Ada paused it"), r.TimerFired(1), r.Resumed()
    )
    assert struck == [("Cancel", 2)]
    assert ("Tell", "timed_out") in resumed
    assert state.status == "finished"


def test_what_was_done_in_time_but_not_taken_up_while_the_run_was_paused_does_not_save_the_body():
    _, (*_, resumed) = carry(MOVING, r.PauseAsked("Ada paused it"), r.TaskDone(2), r.TimerFired(1), r.Resumed())
    assert resumed == [("StepFailed", "m"), ("StepFailed", "l"), ("Finished", "failed")]


def test_a_person_who_cancels_while_a_limit_tidies_up_ends_the_run_at_once():
    state, (*_, cancelled) = carry(FINAL, r.TimerFired(1), r.CancelAsked("Ada cancelled it"))
    assert cancelled == [("Cancel", 3), ("StepFailed", "f"), ("StepFailed", "t"), ("StepFailed", "l"),
                         ("CancelTimer", 1), ("Finished", "cancelled")]  # fmt: skip
    assert state.threads == {}


def test_a_person_who_cancels_drops_the_timers_of_the_limits():
    _, (_, cancelled) = carry(MOVING, r.CancelAsked("Ada cancelled it"))
    assert ("CancelTimer", 1) in cancelled


def test_a_negative_limit_is_refused_and_one_of_nothing_strikes_at_once():
    state, _ = carry(plan_of(limit(seconds=-5), over()))
    assert (state.status, state.reason) == ("failed", "The time limit is -5 s; it cannot be less than nothing.")
    plan = plan_of(limit(seconds=0), Instruction(Wait(Constant(5)), "w"), over())
    state, _ = carry(plan, r.TimerFired(1))
    assert state.reason == "The time limit of 0 s was over."


def test_a_limit_of_ages_is_one_that_a_calendar_can_hold():
    _, actions = machine.start(plan_of(limit(seconds=1e12), Wait(Constant(1e12)), over()), {})
    assert [action.seconds for action in actions if isinstance(action, r.SetTimer)] == [1e9, 1e9]


def test_a_state_that_was_kept_before_there_were_limits_is_read():
    state, _ = machine.start(FINAL, {})
    state, _ = machine.step(FINAL, state, r.TaskFailed(2, "blocked", "No way."))
    kept = machine.to_json(state)
    for thread in kept["threads"]:
        thread["guards"] = [{**guard, "limit": 0} for guard in thread["guards"] if not guard["limit"]]
        for guard in thread["guards"]:
            del guard["limit"], guard["seconds"]
        for item in thread["pending"]:
            del item["wake"]["limit"]
    state, _ = machine.step(FINAL, machine.from_json(kept), r.TaskDone(3))
    assert state.reason == "No way."


@pytest.mark.parametrize("depth", [30, 150])
def test_as_many_limits_in_each_other_as_one_likes_end_with_the_outermost(depth):
    plan = plan_of(*(limit(f"l{n}") for n in range(depth)), Instruction(Wait(Constant(5)), "w"))
    _, (_, struck) = carry(plan, r.TimerFired(1))
    assert struck.count(("Finished", "failed")) == 1
    assert len([name for name, _ in struck if name == "CancelTimer"]) == depth
    assert len([name for name, _ in struck if name == "StepFailed"]) == depth + 1

"""Questions, notices, variables, events and stored states of the run machine."""

from dataclasses import replace

from editor.language.expressions.nodes import AnswerSpec, Constant, Located, Operation, PlaceRef, Reading, Variable
from editor.language.plan.instructions import (
    AskPerson,
    Assign,
    Branch,
    End,
    EventEnd,
    EventEntry,
    Instruction,
    Invoke,
    Jump,
    Move,
    Notify,
    Return,
    RoleBinding,
    TryBegin,
    Wait,
)
from execution.machine import machine
from execution.machine import messages as r
from execution.machine.needs import needs_of
from execution.machine.places import ROLE
from tests.kit.programs import plan_of, reload

OVEN = PlaceRef(device="oven")
HOT = Operation(">", (Reading(Constant("oven"), "temperature"), Constant(80)))
ONE = Constant(1)


def heat(value):
    return r.Facts({("oven", "temperature"): value})


DRY = AskPerson(Constant("Is it dry?"), AnswerSpec("boolean"), "dry", True, Constant(600))


def test_a_question_waits_for_its_answer_and_the_variable_takes_it():
    program = plan_of(Instruction(DRY, "q"), Branch(Variable("dry"), 3), Instruction(Wait(ONE), "yes"), End())
    state, actions = machine.start(program, {})
    assert actions == (
        r.StepEntered("q"),
        r.SetTimer(1, 600),
        r.AskPeople(1, "Is it dry?", AnswerSpec("boolean"), "q"),
    )
    assert machine.step(program, state, r.Answered(9, True)) == (state, ())
    state, actions = machine.step(program, reload(state), r.Answered(1, True))
    assert actions == (r.CancelTimer(1), r.StepLeft("q"), r.StepEntered("yes"), r.SetTimer(2, 1))
    assert state.frames[0] == {"dry": True}


def test_a_question_that_nobody_answers_is_withdrawn_and_timed_out():
    program = plan_of(TryBegin(3, ("timed_out",)), Instruction(DRY, "q"), End(), Instruction(Wait(ONE), "late"), End())
    state, _ = machine.start(program, {})
    state, actions = machine.step(program, state, r.TimerFired(1))
    why = "Nobody answered in time."
    assert actions == (r.CancelQuestion(1), r.StepFailed("q", "timed_out", why), r.StepEntered("late"),
                       r.SetTimer(2, 1))  # fmt: skip
    assert machine.step(program, state, r.Answered(1, True)) == (state, ())


def test_an_answer_while_paused_counts_when_the_run_goes_on():
    program = plan_of(DRY, End())
    state, _ = machine.start(program, {})
    state, _ = machine.step(program, state, r.PauseAsked("Ada paused it"))
    state, actions = machine.step(program, reload(state), r.Answered(1, False))
    assert actions == ()
    state, actions = machine.step(program, reload(state), r.Resumed())
    assert actions == (r.CancelTimer(1), r.Finished("finished", ""))


def test_a_cancelled_run_withdraws_its_question():
    state, _ = machine.start(plan_of(DRY, End()), {})
    _, actions = machine.step(plan_of(DRY, End()), state, r.CancelAsked("x"))
    assert actions == (r.CancelQuestion(1), r.CancelTimer(1), r.Finished("cancelled", "x"))


def test_people_are_told_and_the_program_goes_on():
    program = plan_of(Instruction(Notify(Constant("Box done"), "warning"), "n"), End())
    _, actions = machine.start(program, {})
    told = r.Tell("Box done", "warning", "n")
    assert actions == (r.StepEntered("n"), told, r.StepLeft("n"), r.Finished("finished", ""))


def test_shared_variables_are_the_programs_others_are_of_the_call():
    program = plan_of(
        Invoke(2, "mix", {"n": Constant(2)}, "total", shared=True),
        Wait(Operation("+", (Variable("total"), Variable("count")))),
        Assign("count", Constant(10), shared=True),
        Assign("n", Operation("*", (Variable("n"), Constant(3)))),
        Return(Variable("n")),
        count=0,
    )
    state, actions = machine.start(program, {})
    assert actions == (r.SetTimer(2, 16),)
    assert state.frames == {0: {"count": 10, "total": 6}}


EVENT = EventEntry("e", 2, HOT)
WATCH = plan_of(Instruction(Move("robot", OVEN), "m"), End(), Instruction(Wait(ONE), "w"), EventEnd(), events=(EVENT,))


def test_an_event_runs_beside_the_program_each_time_its_condition_becomes_true():
    state, _ = machine.start(WATCH, {})
    state, actions = machine.step(WATCH, reload(state), heat(90))
    assert actions == (r.StepEntered("e"), r.StepEntered("w"), r.SetTimer(4, 1))
    state, actions = machine.step(WATCH, reload(state), heat(95))
    assert actions == ()
    state, actions = machine.step(WATCH, reload(state), r.TimerFired(4))
    assert actions == (r.StepLeft("w"), r.StepLeft("e"))
    assert machine.step(WATCH, state, heat(99))[1] == ()
    state, _ = machine.step(WATCH, reload(state), heat(20))
    state, actions = machine.step(WATCH, reload(state), heat(90))
    assert actions[0] == r.StepEntered("e")


def test_what_holds_at_the_beginning_is_no_becoming_true():
    state, actions = machine.start(WATCH, {}, {("oven", "temperature"): 90})
    assert actions == (r.StepEntered("m"), actions[1])
    assert state.truths == {0: True}


def test_events_end_with_the_program():
    state, _ = machine.start(WATCH, {})
    state, _ = machine.step(WATCH, state, heat(90))
    _, actions = machine.step(WATCH, state, r.TaskDone(1))
    over = "The program was over."
    assert actions == (r.StepLeft("m"), r.CancelTimer(4), r.StepFailed("w", "cancelled", over),
                       r.StepFailed("e", "cancelled", over), r.Finished("finished", ""))  # fmt: skip


def test_a_failure_in_an_events_body_fails_the_run():
    program = plan_of(Instruction(Move("robot", OVEN), "m"), End(), Wait(Constant(-1)), EventEnd(), events=(EVENT,))
    state, _ = machine.start(program, {})
    state, actions = machine.step(program, state, heat(90))
    why = "It is told to wait -1 s; a wait cannot be less than nothing."
    assert actions == (r.StepEntered("e"), r.StepFailed("e", "refused", why), r.Cancel(1),
                       r.StepFailed("m", "cancelled", why), r.Finished("failed", why))  # fmt: skip
    assert state.status == "failed"


def test_an_event_watches_variables_too_and_two_that_chase_each_other_rest():
    up = Operation("==", (Variable("n"), ONE))
    events = (EventEntry("a", 4, up), EventEntry("b", 6, Operation("not", (up,))))
    program = plan_of(Instruction(Wait(ONE), "w"), Assign("n", ONE, shared=True), Instruction(Wait(ONE), "x"), End(),
                   Assign("n", Constant(0), shared=True), EventEnd(),
                   Assign("n", ONE, shared=True), EventEnd(), events=events, n=0)  # fmt: skip
    state, _ = machine.start(program, {})
    state, actions = machine.step(program, state, r.TimerFired(1))
    told = [action for action in actions if isinstance(action, r.StepEntered)]
    assert told == [r.StepEntered("x"), r.StepEntered("a"), r.StepEntered("b"), r.StepEntered("a")]
    assert actions[-1] == r.SetTimer(9, machine.YIELD_S)
    assert state.status == "running"


def test_an_event_that_starts_runs_is_not_looked_at_and_a_run_can_begin_there():
    event = EventEntry("e", 2, HOT, "run")
    program = plan_of(
        Instruction(Move("robot", OVEN), "m"), End(), Instruction(Wait(ONE), "w"), EventEnd(), events=(event,)
    )
    state, _ = machine.start(program, {})
    assert machine.step(program, state, heat(90))[1] == ()
    state, actions = machine.start(program, {}, {("oven", "temperature"): 90}, entry=2)
    assert actions == (r.StepEntered("e"), r.StepEntered("w"), r.SetTimer(1, 1))
    _, actions = machine.step(program, state, r.TimerFired(1))
    assert actions == (r.StepLeft("w"), r.StepLeft("e"), r.Finished("finished", ""))


FORMAT_1 = {
    "format": 1, "status": "running", "reason": "", "next_id": 3, "facts": [["oven", "temperature", 20]],
    "frames": {"0": {"n": 1}, "1": {"minutes": 3}},
    "threads": [{"id": 0, "at": 2, "leaf": "w", "open": ["c"], "waits_for": "timer", "waits_id": 2, "wake": None,
                 "parent": None, "guards": [{"handler": 9, "kinds": ["failed"], "calls": 1, "open": 0}],
                 "calls": [{"frame": 0, "back_to": -1, "result": None, "open": 0},
                           {"frame": 1, "back_to": 1, "result": "n", "open": 1}]}],
}  # fmt: skip


def test_a_state_that_the_former_version_stored_goes_on():
    program = plan_of(Instruction(Invoke(2, "mix", {}), enters=("c",), leaves=("c",)), End(),
                   Instruction(Wait(Variable("minutes")), "w"), Return(Constant(7)))  # fmt: skip
    state = machine.from_json(FORMAT_1)
    assert machine.to_json(state)["format"] == 2
    state, actions = machine.step(program, state, r.TimerFired(2))
    assert actions == (r.StepLeft("w"), r.StepLeft("c"), r.Finished("finished", ""))
    assert state.frames[0]["n"] == 7


def test_recursion_through_branches_is_bounded_too():
    from editor.language.plan.instructions import Fork, Join

    program = plan_of(Fork((2,), 1), End(), Invoke(0, "again", {}), Join())
    state, _ = machine.start(program, {})
    for timer in range(1, 2000):
        state, _ = machine.step(program, state, r.TimerFired(timer))
    assert (state.status, state.reason) == ("failed", "“again” calls itself more than 100 times deep.")


def test_a_jump_into_nowhere_ends_the_run():
    assert machine.start(plan_of(Jump(77)), {})[0].status == "finished"


def test_an_event_whose_variable_is_unset_is_not_true_and_becomes_true_when_it_is_set():
    up = Operation("==", (Variable("n"), ONE))
    for condition, starts in ((up, ["e"]), (Operation("not", (up,)), [])):
        program = plan_of(
            Instruction(Wait(ONE), "w"), Assign("n", ONE, shared=True), Instruction(Wait(ONE), "x"), End(),
            Instruction(Wait(ONE), "y"), EventEnd(), events=(EventEntry("e", 4, condition),)
        )  # fmt: skip
        state, _ = machine.start(program, {})
        assert (state.status, state.truths) == ("running", {0: False})
        state, actions = machine.step(program, reload(state), r.TimerFired(1))
        entered = [action.step for action in actions if isinstance(action, r.StepEntered)]
        assert (entered, state.status) == (["x", *(each for one in starts for each in (one, "y"))], "running")


def test_an_event_whose_condition_is_wrong_still_fails_the_run():
    wrong = EventEntry("e", 2, Operation(">", (Variable("n"), ONE)))
    program = plan_of(Instruction(Wait(ONE), "w"), End(), EventEnd(), events=(wrong,), n="many")
    state, actions = machine.start(program, {})
    assert (state.status, actions[-1].status) == ("failed", "failed")


def test_where_the_robot_of_a_bound_role_is_can_be_asked_before_its_first_step():
    far = Operation(">", (Operation("distance", (Located(role="robot"), Located(device="oven"))), Constant(3)))
    program = replace(
        plan_of(Branch(far, 2), Instruction(Wait(ONE), "far"), End()),
        roles={"robot": RoleBinding("robot", "robot01"), "other": RoleBinding("other", "robot02")},
    )
    assert needs_of(program).things == {"robot01", "oven"}
    there = {("robot01", "$x"): 9, ("robot01", "$y"): 0, ("oven", "$x"): 1, ("oven", "$y"): 0}
    state, actions = machine.start(program, {}, there)
    assert actions == (r.StepEntered("far"), r.SetTimer(1, 1))
    assert (ROLE, "other") not in state.facts

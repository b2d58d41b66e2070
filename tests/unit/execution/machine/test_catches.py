"""Several catches of one Try, from the script to the end of the run, stored and read between all events."""

import pytest

from editor.language.plan.instructions import Caught, TryBegin, TryEnd
from execution.machine import machine
from execution.machine import messages as m
from tests.kit.programs import reload
from tests.unit.execution.machine.test_failures import begun, plan_of_script

WAITING = """
    try:
        self.curing_oven.cure_paint(quantity(1, "min"))
    except Offline as problem:
        self.wait(60)
        raise Failed("Still offline.")
    except (TimedOut, Blocked) as problem:
        self.wait(60)
        self.notify(problem.text, level="info")
    except TaskError as problem:
        self.wait(60)
        self.notify(problem.kind, level="info")
    finally:
        self.notify("over", level="info")
"""


def told(actions):
    return [action.text for action in actions if isinstance(action, m.Tell)]


def carry(plan, state, *events):
    """Carry on with events, stored and read before each; an event is made of the number that is waited for."""
    done = []
    for event in events:
        state, actions = machine.step(plan, reload(state), event(state.threads[0].waits_id))
        done += told(actions)
    return state, done


def fails(kind):
    return lambda task: m.TaskFailed(task, kind, "So it is.")


@pytest.mark.parametrize(
    ("kind", "text", "status"),
    [
        ("offline", ["over"], "failed"),
        ("timed_out", ["So it is.", "over"], "finished"),
        ("blocked", ["So it is.", "over"], "finished"),
        ("cancelled", ["cancelled", "over"], "finished"),
    ],
)
def test_a_catch_that_takes_time_goes_on_after_it_is_stored_and_what_fails_in_it_goes_to_no_other(kind, text, status):
    plan, state, _ = begun(WAITING)
    state, said = carry(plan, state, fails(kind), m.TimerFired)
    assert (said, state.status) == (text, status)
    assert state.reason == ("Still offline." if status == "failed" else "")


def test_while_a_catch_runs_no_guard_of_its_try_but_that_of_the_final_part_is_left():
    plan, state, _ = begun(WAITING)
    assert [guard.kinds for guard in state.threads[0].guards if not guard.final] == [
        (),
        ("timed_out", "blocked"),
        ("offline",),
    ]
    state, _ = carry(plan, state, fails("offline"))
    assert [guard.final for guard in state.threads[0].guards] == [True]


def test_a_run_that_is_stopped_in_a_catch_carries_out_no_other_catch():
    plan, state, _ = begun(WAITING)
    state, _ = carry(plan, state, fails("offline"))
    state, actions = machine.step(plan, reload(state), m.CancelAsked())
    assert (state.status, told(actions)) == ("cancelled", [])


def test_a_body_that_goes_well_leaves_all_guards_and_no_catch_runs():
    plan, state, _ = begun(WAITING)
    state, actions = machine.step(plan, reload(state), m.TaskDone(state.threads[0].waits_id))
    assert (told(actions), state.status) == (["over"], "finished")


@pytest.mark.parametrize(("leave", "expected"), [("break", ["1"]), ("continue", ["1", "2"])])
def test_a_loop_is_left_from_the_body_and_from_a_catch_through_the_final_part(leave, expected):
    for before in ("", 'raise Failed("x")'):
        body = f"""
            for n in [1, 2]:
                try:
                    {before or leave}
                except Offline as problem:
                    self.notify("offline", level="info")
                except Failed as problem:
                    {leave}
                finally:
                    self.notify(f"{{n}}", level="info")
        """
        _, state, actions = begun(body)
        assert (told(actions), state.status) == (expected, "finished")


def test_a_time_limit_around_ends_a_catch_and_no_catch_of_the_try_in_it_takes_that():
    body = """
        try:
            with self.limit(quantity(5, "min")):
                try:
                    self.curing_oven.cure_paint(quantity(1, "min"))
                except Offline as problem:
                    self.wait(3600)
                except TaskError as problem:
                    self.notify("inner", level="info")
        except Blocked as problem:
            self.notify("blocked", level="info")
        except TimedOut as problem:
            self.notify("outer", level="info")
    """
    plan, state, _ = begun(body)
    limit = next(guard.limit for guard in state.threads[0].guards if guard.limit)
    state, _ = carry(plan, state, fails("offline"))
    state, actions = machine.step(plan, reload(state), m.TimerFired(limit))
    assert (told(actions), state.status) == (["outer"], "finished")


def test_one_catch_has_the_plan_that_it_has_always_had():
    plan = plan_of_script(
        'try:\n    self.wait(60)\nexcept Failed as problem:\n    self.notify(problem.text, level="info")'
    )
    kinds = [type(each.do).__name__ for each in plan.instructions]
    assert kinds == ["TryBegin", "Wait", "TryEnd", "Jump", "Caught", "Notify", "Jump", "End"]


def test_what_a_catch_reads_of_the_failure_is_the_first_that_its_handler_does():
    plan = plan_of_script(WAITING)
    handlers = [each.do.handler for each in plan.instructions if isinstance(each.do, TryBegin) and not each.do.final]
    begins = [type(plan.instructions[at].do) for at in handlers]
    assert begins == [Caught, Caught, TryEnd]

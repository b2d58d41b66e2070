"""Programs that fail by themselves, from their script to the end of the run: who catches it, and what is still done."""

from textwrap import dedent, indent

import pytest

from editor.language import compile_document, parse_script, tree_to_document
from execution.machine import machine
from execution.machine import messages as m
from tests.kit.demo_site import factory
from tests.kit.programs import reload


def plan_of_script(body, functions=""):
    """Return the plan of these lines of new_task, beside these functions."""
    lines = indent(dedent(body), " " * 8) + "\n" + indent(dedent(functions), " " * 4)
    script = f"class Task(object):\n    def new_task(self):\n{lines}\n    def run(self, ctx):\n"
    bound = [f"        self.{name} = ctx.get({device!r})\n" for name, device in BOUND if f"self.{name}." in script]
    parsed = parse_script(f"{script}{''.join(bound)}        self.new_task()\n", factory())
    assert parsed.tree is not None, parsed.diagnostics
    compiled = compile_document(tree_to_document(parsed.tree, factory()), factory())
    assert compiled.plan is not None, compiled.diagnostics
    return compiled.plan


BOUND = (("curing_oven", "curingOven01"), ("robot", "robot01"))


def begun(body, functions=""):
    """Begin the run and return its plan, its state as the database gives it back, and what was done."""
    plan = plan_of_script(body, functions)
    state, actions = machine.start(plan, {})
    return plan, reload(state), actions


def ended(body, functions=""):
    """Return how the run of lines that wait for nothing ended: status, reason, and what people were told."""
    _, state, actions = begun(body, functions)
    return state.status, state.reason, [action.text for action in actions if isinstance(action, m.Tell)]


def test_a_program_that_fails_has_its_text_as_the_reason():
    assert ended('raise Failed("The box is wet.")') == ("failed", "The box is wet.", [])


def test_the_text_is_worked_out_where_it_fails_and_is_cut_to_a_reasonable_length():
    assert ended('self.n = 3\nraise Failed(f"{self.n} boxes are wet.")')[1] == "3 boxes are wet."
    assert ended(f'raise Failed("{"wet " * 400}")')[1] == ("wet " * 125).strip() + " "


def test_an_empty_text_says_so():
    assert ended('raise Failed("")')[:2] == ("failed", "The program failed here and does not say why.")


def test_a_text_without_a_value_fails_as_any_other_step_would():
    plan = plan_of_script('raise Failed(f"{self.curing_oven.temperature}")')
    state, _ = machine.start(plan, {})
    assert state.status == "failed"
    assert "temperature" in state.reason


def test_the_step_is_marked_as_failed():
    assert begun('raise Failed("Wet.")')[2][1:] == (
        m.StepFailed("s1", "failed", "Wet."),
        m.Finished("failed", "Wet."),
    )


def test_a_try_around_catches_it_and_goes_on_behind():
    body = """
        try:
            raise Failed("Wet.")
        except Failed as problem:
            self.notify("Caught.", level="info")
        self.notify("Behind.", level="info")
    """
    assert ended(body) == ("finished", "", ["Caught.", "Behind."])


def test_a_try_of_other_kinds_lets_it_pass_and_does_its_final_part():
    body = """
        try:
            raise Failed("Wet.")
        except (Blocked, Offline) as problem:
            self.notify("Caught.", level="info")
        finally:
            self.notify("At last.", level="info")
    """
    assert ended(body) == ("failed", "Wet.", ["At last."])


def test_it_is_caught_around_the_call_of_the_function_and_the_frame_is_left():
    body = """
        try:
            self.check_box()
        except Failed as problem:
            self.notify("Caught.", level="info")
        self.wait(1)
    """
    plan, state, actions = begun(body, 'def check_box(self):\n    n = 1\n    raise Failed(f"{n}")\n')
    assert [a.text for a in actions if isinstance(a, m.Tell)] == ["Caught."]
    assert list(state.frames) == [0]
    assert machine.step(plan, state, m.TimerFired(state.threads[0].waits_id))[0].status == "finished"


def test_a_failure_in_a_catch_goes_to_the_try_around():
    body = """
        try:
            try:
                raise Failed("First.")
            except TaskError as problem:
                raise Failed("Second.")
            finally:
                self.notify("Inner.", level="info")
        except Failed as problem:
            self.notify("Outer.", level="info")
    """
    assert ended(body) == ("finished", "", ["Inner.", "Outer."])


def test_a_failure_in_a_final_part_takes_the_place_of_the_one_before():
    body = """
        try:
            raise Failed("First.")
        finally:
            raise Failed("Second.")
    """
    assert ended(body)[:2] == ("failed", "Second.")


def test_a_branch_that_fails_calls_off_the_others_and_is_caught_around_the_parallel():
    body = """
        try:
            self.parallel(self.branch_a, self.branch_b)
        except Failed as problem:
            self.notify("Caught.", level="info")
    """
    branches = """
        def branch_a(self):
            self.curing_oven.cure_paint(quantity(1, "min"))
        def branch_b(self):
            self.wait(5)
            raise Failed("Wet.")
    """
    plan, state, _ = begun(body, branches)
    timer = next(thread.waits_id for thread in state.threads.values() if thread.waits_for == "timer")
    state, actions = machine.step(plan, state, m.TimerFired(timer))
    assert [type(action).__name__ for action in actions if not isinstance(action, m.StepLeft | m.StepFailed)] == [
        "StepEntered", "Cancel", "StepEntered", "Tell", "Finished",
    ]  # fmt: skip
    assert (state.status, state.reason) == ("finished", "")


def test_a_cancelled_run_carries_out_no_failure_of_its_own():
    plan, state, _ = begun('try:\n    self.wait(5)\nexcept Cancelled as problem:\n    raise Failed("Wet.")')
    state, _ = machine.step(plan, state, m.CancelAsked("Enough."))
    assert (state.status, state.reason) == ("cancelled", "Enough.")


def test_a_loop_of_failures_that_are_caught_rests_in_between():
    body = """
        while self.n < 1000:
            try:
                raise Failed("Again.")
            except Failed as problem:
                self.n = self.n + 1
    """
    _, state, _ = begun("self.n = 0\n" + dedent(body))
    assert state.threads[0].waits_for == "yield"


def test_a_catch_knows_the_text_and_the_kind_of_what_it_caught():
    body = """
        try:
            raise Failed("Wet.")
        except TaskError as problem:
            self.notify(f"{problem.kind}: {problem.text}", level="info")
    """
    assert ended(body) == ("finished", "", ["failed: Wet."])


def test_what_a_device_says_of_its_failure_can_be_told_and_decided_by():
    body = """
        try:
            self.curing_oven.cure_paint(quantity(1, "min"))
        except TaskError as problem:
            if problem.kind == "offline":
                self.notify(problem.text, level="warning")
            else:
                raise Failed(f"The oven: {problem.text}")
    """
    plan, state, _ = begun(body)
    task = state.threads[0].waits_id
    gone, actions = machine.step(plan, state, m.TaskFailed(task, "offline", "It is gone."))
    assert (gone.status, [a.text for a in actions if isinstance(a, m.Tell)]) == ("finished", ["It is gone."])
    broken, _ = machine.step(plan, state, m.TaskFailed(task, "failed", "No heat."))
    assert (broken.status, broken.reason) == ("failed", "The oven: No heat.")


def test_each_catch_knows_its_own_failure_also_behind_one_in_it():
    body = """
        try:
            raise Failed("Outer.")
        except TaskError as problem:
            try:
                raise Failed(f"Inner of {problem.text}")
            except TaskError as problem:
                self.notify(problem.text, level="info")
            self.notify(problem.text, level="info")
    """
    assert ended(body) == ("finished", "", ["Inner of Outer.", "Outer."])


def test_a_function_that_calls_itself_keeps_the_failure_of_each_call():
    body = "self.deeper(n=2)"
    functions = """
        def deeper(self, n: Number):
            try:
                raise Failed(f"call {n}")
            except Failed as problem:
                if n > 0:
                    self.deeper(n=n - 1)
                self.notify(problem.text, level="info")
    """
    assert ended(body, functions) == ("finished", "", ["call 0", "call 1", "call 2"])


def test_branches_in_a_catch_know_the_failure_while_the_run_is_kept_in_between():
    body = """
        try:
            raise Failed("Wet.")
        except Failed as why:
            self.parallel(self.branch_a, self.branch_b, why=why)
    """
    branches = """
        def branch_a(self, why):
            self.wait(5)
            self.notify(why.text, level="info")
        def branch_b(self, why):
            self.notify(why.kind, level="info")
    """
    plan, state, actions = begun(body, branches)
    assert [a.text for a in actions if isinstance(a, m.Tell)] == ["failed"]
    timer = next(thread.waits_id for thread in state.threads.values() if thread.waits_for == "timer")
    state, actions = machine.step(plan, state, m.TimerFired(timer))
    assert ([a.text for a in actions if isinstance(a, m.Tell)], state.status) == (["Wet."], "finished")


def test_a_second_time_round_the_newer_failure_is_known():
    body = """
        for n in [1, 2]:
            try:
                raise Failed(f"{n}")
            except Failed as problem:
                self.notify(problem.text, level="info")
    """
    assert ended(body) == ("finished", "", ["1", "2"])


SEVERAL = """
    try:
        self.curing_oven.cure_paint(quantity(1, "min"))
    except Offline as problem:
        self.notify("gone", level="info")
    except (Blocked, TimedOut) as why:
        self.notify(f"late: {why.text}", level="info")
        raise Failed("Too late.")
    except TaskError as problem:
        self.notify(problem.kind, level="info")
    finally:
        self.notify("over", level="info")
"""


@pytest.mark.parametrize(
    ("kind", "told", "status"),
    [
        ("offline", ["gone", "over"], "finished"),
        ("blocked", ["late: So it is.", "over"], "failed"),
        ("timed_out", ["late: So it is.", "over"], "failed"),
        ("failed", ["failed", "over"], "finished"),
        ("cancelled", ["cancelled", "over"], "finished"),
    ],
)
def test_of_several_excepts_the_first_that_fits_is_taken_and_no_other(kind, told, status):
    plan, state, _ = begun(SEVERAL)
    state, actions = machine.step(plan, state, m.TaskFailed(state.threads[0].waits_id, kind, "So it is."))
    assert ([a.text for a in actions if isinstance(a, m.Tell)], state.status) == (told, status)


def test_several_excepts_that_do_not_fit_let_it_pass():
    plan, state, _ = begun(SEVERAL.replace("TaskError", "Cancelled"))
    state, actions = machine.step(plan, state, m.TaskFailed(state.threads[0].waits_id, "refused", "No."))
    assert ([a.text for a in actions if isinstance(a, m.Tell)], state.reason) == (["over"], "No.")

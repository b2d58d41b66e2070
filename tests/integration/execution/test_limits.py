"""Time limits in runs: commands are called off, the run goes on after a restart, timers do not stay behind."""

import pytest

from editor.language.expressions.nodes import AnswerSpec, Constant, PlaceRef, Variable
from editor.language.plan.instructions import (
    AskPerson,
    Call,
    Caught,
    End,
    Instruction,
    Jump,
    LimitBegin,
    Move,
    Notify,
    Plan,
    RoleBinding,
    TryBegin,
    TryEnd,
)
from execution import services
from execution.models import Command, InboxEvent, Question, Run, RunEvent, Timer
from tests.kit.programs import OVEN, run_status

pytestmark = pytest.mark.django_db(transaction=True)
ANY = {"robot": RoleBinding("robot", None, ("move",))}
CURE = Call(PlaceRef(device=OVEN), "curePaint", {"time": Constant(30)})
DRIVE = Move("robot", PlaceRef(device=OVEN))


def limited(action, seconds=10):
    """Return a program that does something within a limit, and tells people why where it could not."""
    return Plan(
        (
            Instruction(TryBegin(5, ("timed_out",)), "t", 1, ("t",)),
            Instruction(LimitBegin(Constant(seconds)), "l", 2, ("l",)),
            Instruction(action, "s", 3),
            Instruction(TryEnd(), "l", 2, (), ("l",)),
            Instruction(Jump(7)),
            Instruction(Caught("text", "kind")),
            Instruction(Notify(Variable("text")), "n", 5),
            Instruction(Jump(8), "t", 1, (), ("t",)),
            Instruction(End()),
        ),
        ANY,
    )


def told(run):
    return list(RunEvent.objects.filter(run=run, kind="notice").values_list("text", flat=True))


@pytest.mark.parametrize(("action", "method"), [(CURE, "curePaint"), (DRIVE, "move")])
def test_what_a_device_does_is_called_off_and_the_run_goes_on_in_the_catch(factory, action, method):
    run = factory.start(limited(action))
    factory.go(lambda: run_status(run) == "finished", limit_s=120)
    statuses = list(Command.objects.filter(run=run, method=method).values_list("status", flat=True))
    assert statuses, "nothing was begun"
    assert "done" not in statuses[-1:]
    steps = Run.objects.get(id=run).steps
    assert {name: step["status"] for name, step in steps.items()} == {
        "t": "done", "l": "failed", "s": "failed", "n": "done",
    }  # fmt: skip
    assert told(run) == ["The time limit of 10 s was over."]
    assert Timer.objects.filter(run=run).count() == 0


def test_the_machine_is_free_for_the_next_run(factory):
    first = factory.start(limited(CURE))
    factory.go(lambda: run_status(first) == "finished", limit_s=120)
    second = factory.start(limited(Call(PlaceRef(device=OVEN), "curePaint", {"time": Constant(1)}), 600))
    factory.go(lambda: run_status(second) == "finished", limit_s=300)
    assert Run.objects.get(id=second).steps["s"]["status"] == "done"


def test_a_limit_goes_on_counting_while_everything_is_taken_in_once_more(factory):
    run = factory.start(limited(CURE))
    for _ in range(6):
        factory.work()
        factory.send()
        factory.pass_time(1)
        InboxEvent.objects.update(taken_at=None)
    assert Timer.objects.filter(run=run).count() == 1
    factory.go(lambda: run_status(run) == "finished", limit_s=60)
    assert Run.objects.get(id=run).steps["l"]["status"] == "failed"


def test_a_question_is_withdrawn_and_an_answer_comes_too_late(factory):
    run = factory.start(limited(AskPerson(Constant("Dry?"), AnswerSpec("boolean"), "dry", True)))
    factory.work()
    question = services.list_questions(site="painting-factory")[0].id
    factory.go(lambda: run_status(run) == "finished", limit_s=60)
    assert Question.objects.get(id=question).state == "withdrawn"
    assert services.list_questions(site="painting-factory") == ()


def test_time_counts_while_the_run_is_paused_and_the_failure_is_taken_up_when_it_goes_on(factory):
    run = factory.start(limited(CURE))
    factory.go(lambda: Command.objects.filter(run=run).exists(), limit_s=60)
    services.pause_run(run_id=run, by="Ada")
    factory.work()
    for _ in range(15):
        factory.pass_time(1)
        factory.work()
    assert run_status(run) == "paused"
    assert Run.objects.get(id=run).steps["l"]["status"] != "failed"
    services.resume_run(run_id=run, by="Ada")
    factory.go(lambda: run_status(run) == "finished", limit_s=60)
    assert Run.objects.get(id=run).steps["l"]["status"] == "failed"


def test_a_person_cancels_a_run_within_a_limit_and_no_timer_stays_behind(factory):
    run = factory.start(limited(CURE))
    factory.go(lambda: Command.objects.filter(run=run).exists(), limit_s=60)
    services.cancel_run(run_id=run, by="Ada")
    factory.work()
    assert run_status(run) == "cancelled"
    assert Timer.objects.filter(run=run).count() == 0

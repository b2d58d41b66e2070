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
    Wait,
)
from execution import services
from execution.engine.drive import advance_site
from execution.models import Command, InboxEvent, Question, Run, RunEvent, Timer
from tests.kit.programs import CARRY, OVEN, SITE, run_status

pytestmark = pytest.mark.django_db(transaction=True)


def whole_history(run):
    counts = (RunEvent.objects.count(), Command.objects.count())
    return counts, Run.objects.values("epoch", "state", "steps").get(id=run)


def test_a_box_is_carried_from_shelf_to_booth(factory):
    run = factory.start(CARRY)
    factory.go(lambda: run_status(run) == "finished")
    view = services.get_run(run_id=run).run
    assert (view.number, view.reason, view.roles) == (1, "", {"robot": "robot01"})
    assert view.steps["s1"]["status"] == "done"
    assert factory.world.robots()["robot01"].carrying == {}
    texts = [event.text for event in services.list_events(run_id=run)]
    assert texts[0] == "Ada started run 1."
    assert "Item Inventory: dispense(box, 1)" in texts
    assert "TurtleBot 1 is done: drop." in texts
    assert texts[-1] == "The run is finished."


def test_messages_that_come_twice_do_nothing_twice(factory):
    factory.deliveries = 2
    run = factory.start(CARRY)
    factory.go(lambda: run_status(run) == "finished")
    done = Command.objects.filter(run=run, piece=False).values_list("method", "status")
    assert sorted(done) == [("dispense", "done"), ("drop", "done"), ("pick", "done")]
    assert factory.world.readings()["itemInventory01"].get("stock", 23) == 23


def test_taking_the_same_inbox_in_again_changes_nothing(factory):
    run = factory.start(CARRY)
    factory.go(lambda: run_status(run) == "finished")
    before = whole_history(run)
    InboxEvent.objects.update(taken_at=None)
    factory.work()
    assert whole_history(run) == before


def test_a_paused_run_asks_for_nothing_until_it_is_resumed(factory):
    run = factory.start(CARRY)
    factory.go(lambda: Command.objects.filter(run=run).count() >= 2)
    services.pause_run(run_id=run, by="Ada")
    factory.go(lambda: run_status(run) == "paused")
    for _ in range(40):
        factory.work()
        factory.send()
        factory.pass_time(0.25)
    sent = Command.objects.filter(run=run).count()
    here = factory.world.robots()["robot01"]
    assert here.speed_m_s == 0
    factory.pass_time(5)
    factory.work()
    assert Command.objects.filter(run=run).count() == sent
    services.resume_run(run_id=run, by="Ada")
    factory.go(lambda: run_status(run) == "finished")


def test_a_cancelled_run_frees_its_robot_and_its_machines(factory):
    run = factory.start(CARRY)
    factory.go(lambda: Command.objects.filter(run=run, method="dispense").exists())
    services.cancel_run(run_id=run, by="Ada")
    factory.go(lambda: run_status(run) == "cancelled")
    assert Run.objects.get(id=run).reason == "Ada cancelled it"
    assert services.get_run(run_id=run).run.cause == {"code": "cancelled_by", "args": {"by": "Ada"}}
    second = factory.start(CARRY)
    factory.go(lambda: run_status(second) == "finished")
    assert services.get_run(run_id=second).run.roles == {"robot": "robot01"}


def test_two_runs_use_two_robots_and_one_booth_after_the_other(factory):
    runs = [factory.start(CARRY), factory.start(CARRY)]
    factory.go(lambda: {run_status(run) for run in runs} == {"finished"})
    robots = {services.get_run(run_id=run).run.roles["robot"] for run in runs}
    assert len(robots) == 2


def test_stop_all_holds_everything_until_it_is_reset_and_the_run_resumed(factory):
    run = factory.start(CARRY)
    factory.go(lambda: Command.objects.filter(run=run).count() >= 2)
    stop = services.press_stop(site="painting-factory", by="Otto")
    assert services.list_stops() == (stop,)
    factory.go(lambda: run_status(run) == "paused")
    assert Run.objects.get(id=run).reason == "Otto stopped all devices of the site"
    methods = {command.topic.rsplit("/", 1)[1] for command in factory.send()}
    assert methods <= {"pause"}
    before = factory.world.robots()["robot01"].pose
    factory.pass_time(5)
    factory.pass_time(5)
    after = factory.world.robots()["robot01"].pose
    assert abs(before.x - after.x) + abs(before.y - after.y) < 0.3
    with pytest.raises(services.NotPossibleNow, match="The site is stopped"):
        services.resume_run(run_id=run, by="Otto")
    with pytest.raises(services.NotPossibleNow, match="The site is stopped"):
        factory.start(CARRY)
    services.reset_stop(site="painting-factory", by="Ada")
    factory.work()
    factory.pass_time(5)
    assert run_status(run) == "paused"
    services.resume_run(run_id=run, by="Ada")
    factory.go(lambda: run_status(run) == "finished")


def test_a_robot_that_vanishes_fails_its_step_as_offline(factory, monkeypatch):
    from execution.traffic import floor
    from registry.models import Device

    monkeypatch.setattr(floor, "ABSENCE_S", 0.0)
    run = factory.start(CARRY)
    factory.go(lambda: Command.objects.filter(run=run).count() >= 2)
    factory.offline.add("robot01")
    Device.objects.filter(id="robot01").update(online=False)
    factory.go(lambda: run_status(run) == "failed")
    assert Run.objects.get(id=run).reason == "TurtleBot 1 went offline and did not come back."


def test_a_timer_is_a_row_and_fires_once(factory):
    run = factory.start(Plan((Instruction(Wait(Constant(30)), "w", 1), Instruction(End()))))
    factory.go(lambda: run_status(run) == "finished", limit_s=40)
    kinds = [event.code for event in services.list_events(run_id=run)]
    assert kinds == ["started", "step_entered", "step_done", "finished"]


def test_an_answer_for_another_devices_command_is_not_taken(factory):
    from datetime import UTC, datetime

    run = factory.start(CARRY)
    factory.work()
    command = Command.objects.filter(run=run).first()
    answer = {"command_id": str(command.id), "status": "DONE", "why": "", "result": {}, "at": datetime.now(UTC)}
    assert services.record_ack(device="robot03", **answer) is False
    assert services.record_ack(device=command.device, **{**answer, "command_id": "nonsense"}) is False
    assert services.record_ack(device=command.device, **answer) is True
    assert services.record_ack(device=command.device, **answer) is False


def test_a_run_that_is_over_is_not_advanced(factory):
    run = factory.start(Plan((Instruction(End()),)))
    factory.work()
    assert run_status(run) == "finished"
    before = whole_history(run)
    assert advance_site(SITE)
    assert whole_history(run) == before


# time limits: commands are called off, the run goes on after a restart, timers do not stay behind

MOVER = {"robot": RoleBinding("robot", None, ("move",))}
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
        MOVER,
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
    question = services.list_questions(site=SITE)[0].id
    factory.go(lambda: run_status(run) == "finished", limit_s=60)
    assert Question.objects.get(id=question).state == "withdrawn"
    assert services.list_questions(site=SITE) == ()


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

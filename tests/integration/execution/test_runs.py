import pytest

from editor.language.expressions.nodes import Constant
from editor.language.plan.instructions import End, Instruction, Plan, Wait
from execution import services
from execution.models import Command, InboxEvent, Run, RunEvent
from execution.runs.advance import advance_run
from tests.kit.programs import CARRY, run_status

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
    assert advance_run(run) is False

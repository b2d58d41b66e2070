"""What a run has told devices before it is over: nobody begins it later, and nobody waits for it."""

from datetime import UTC, datetime

import pytest

from editor.language.expressions.nodes import Constant, PlaceRef
from editor.language.plan.instructions import Call, End, Instruction, Plan
from execution import services
from execution.commands.outbox import end_commands_of_runs_over, resend_commands
from execution.models import Command, Run
from registry.models import Device
from tests.kit.programs import CARRY, SITE

pytestmark = pytest.mark.django_db(transaction=True)
OVEN = "curingOven01"
CURE = Plan((Instruction(Call(PlaceRef(device=OVEN), "curePaint", {"time": Constant(2)}), "cure"), Instruction(End())))


def told(device=OVEN):
    """What goes out now for a device, by method; the tries of before do not hold it back."""
    Command.objects.filter(status__in=Command.OPEN).update(send_after=datetime.now(UTC))
    return [each.topic.rpartition("/")[2] for each in services.claim_commands(limit=100) if each.device == device]


def cancel_while_stopped(factory, run):
    services.press_stop(site=SITE, by="Otto")
    factory.work()
    services.cancel_run(run_id=run, by="Ada")
    factory.work()
    assert services.get_run(run_id=run).run.status == "cancelled"
    services.reset_stop(site=SITE, by="Otto")
    factory.work()


def command(run):
    return Command.objects.get(run=run, method="curePaint")


def begins_at_once(factory):
    run = factory.start(CURE)
    factory.work()
    assert told() == ["curePaint"]
    assert command(run).tries == 1


def test_a_device_that_comes_back_after_the_reset_is_not_told_what_a_cancelled_run_wanted(factory):
    run = factory.start(CURE)
    factory.work()
    assert told() == ["curePaint"]
    Device.objects.filter(id=OVEN).update(online=False)
    cancel_while_stopped(factory, run)
    Command.objects.filter(method="cancel").update(status="timed_out")
    Device.objects.filter(id=OVEN).update(online=True)
    resend_commands(device=OVEN)
    assert told() == ["pause"]


def test_a_device_that_has_done_the_cancel_of_what_it_never_heard_is_free_at_once(factory):
    run = factory.start(CURE)
    factory.work()
    assert told() == ["curePaint"]
    cancel_while_stopped(factory, run)
    assert told() == ["pause", "cancel"]
    end_commands_of_runs_over(datetime.now(UTC))
    assert command(run).status == "pending"
    Command.objects.filter(method="cancel").update(status="done")
    end_commands_of_runs_over(datetime.now(UTC))
    assert command(run).status == "cancelled"
    Command.objects.filter(run=run).exclude(status="cancelled").update(status="done")
    begins_at_once(factory)


def test_what_never_went_out_is_ended_with_its_run_and_its_device_is_free_at_once(factory):
    run = factory.start(CURE)
    factory.work()
    cancel_while_stopped(factory, run)
    assert told() == ["pause", "cancel"]
    end_commands_of_runs_over(datetime.now(UTC))
    assert command(run).status == "cancelled"
    Command.objects.filter(run=run).exclude(status="cancelled").update(status="done")
    begins_at_once(factory)


def test_what_a_run_under_way_has_told_stays_as_it_is(factory):
    run = factory.start(CURE)
    factory.work()
    end_commands_of_runs_over(datetime.now(UTC))
    assert told() == ["curePaint"]
    assert command(run).status == "pending"


@pytest.mark.parametrize("stopped", [False, True])
def test_a_robot_settles_on_its_pieces_of_path_unless_all_was_stopped_since(factory, stopped):
    run = factory.start(CARRY)
    factory.go(lambda: Command.objects.filter(piece=True, status="pending").exists() or factory.pass_time(0.1))
    robot = Command.objects.filter(piece=True, status="pending").first().device
    Run.objects.filter(id=run).update(status="cancelled")
    if stopped:
        services.press_stop(site=SITE, by="Otto")
        services.reset_stop(site=SITE, by="Otto")
    assert set(told(robot)) == (set() if stopped else {"move"})


def test_the_resume_of_a_run_goes_out_when_a_person_has_resumed_it(factory):
    run = factory.start(CURE)
    factory.work()
    services.press_stop(site=SITE, by="Otto")
    services.reset_stop(site=SITE, by="Otto")
    row = command(run)
    row.pk, row.method, row.position = "00000000-0000-4000-8000-000000000009", "resume", 1000
    row.save(force_insert=True)
    assert "resume" not in told()
    services.resume_run(run_id=run, by="Ada")
    assert "resume" in told()

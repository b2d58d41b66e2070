"""What a run has told devices before it is over: nobody begins it later, and nobody waits for it."""

from datetime import UTC, datetime
from uuid import uuid4

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from editor.language.expressions.nodes import Constant, PlaceRef
from editor.language.plan.instructions import Call, End, Instruction, Plan
from execution import services
from execution.commands.outbox import end_commands_of_runs_over, resend_commands
from execution.models import Command, FloorState, Run
from execution.traffic.floor_state import from_json
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


def test_the_answer_to_a_cancel_frees_a_device_that_never_heard_what_it_cancels(factory):
    run = factory.start(CURE)
    factory.work()
    assert told() == ["curePaint"]
    cancel_while_stopped(factory, run)
    cancel = str(Command.objects.get(method="cancel").id)
    now = datetime.now(UTC)
    assert services.record_ack(device=OVEN, command_id=cancel, status="RUNNING", why="", result={}, at=now)
    assert command(run).status == "pending"
    mix = Instruction(Call(PlaceRef(device="paintMixer02"), "mixPaint", {"time": Constant(1)}), "mix")
    other = factory.start(Plan((mix, Instruction(End()))))
    factory.work()
    Run.objects.filter(id=other).update(status="cancelled")
    assert services.record_ack(device=OVEN, command_id=cancel, status="DONE", why="", result={}, at=now)
    statuses = (
        Command.objects.exclude(method__in=("pause", "cancel")).order_by("position").values_list("status", flat=True)
    )
    assert list(statuses) == ["cancelled", "pending"], "other runs are the ticker's"
    end_commands_of_runs_over(now)
    assert list(statuses.all()) == ["cancelled", "cancelled"]


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


def settling(factory, *, stopped):
    """The robot of a run that is over while a piece of its path has not gone out yet."""
    run = factory.start(CARRY)
    factory.go(lambda: Command.objects.filter(piece=True, tries=0).exists() or factory.pass_time(0.1))
    piece = Command.objects.filter(piece=True, tries=0).first()
    assert str(piece.run) == run
    Run.objects.filter(id=run).update(status="cancelled")
    if stopped:
        services.press_stop(site=SITE, by="Otto")
        services.reset_stop(site=SITE, by="Otto")
    return piece


@pytest.mark.parametrize("stopped", [False, True])
def test_a_robot_settles_on_its_pieces_of_path_unless_all_was_stopped_since(factory, stopped):
    piece = settling(factory, stopped=stopped)
    end_commands_of_runs_over(datetime.now(UTC))
    assert set(told(piece.device)) == (set() if stopped else {"move"})


def test_a_robot_whose_last_piece_of_path_a_stop_has_kept_back_drives_no_more_in_the_eyes_of_the_floor(factory):
    piece = settling(factory, stopped=True)
    factory.work()
    assert str(piece.id) in floor_state().sent
    end_commands_of_runs_over(datetime.now(UTC))
    factory.work()
    piece.refresh_from_db()
    assert piece.status == "cancelled"
    assert not [sent for sent in floor_state().sent.values() if sent.device == piece.device]


def floor_state():
    return from_json(FloorState.objects.get(site__slug=SITE).state)


def test_a_piece_of_path_that_went_out_once_is_ended_when_its_robot_has_done_the_cancel(factory):
    piece = settling(factory, stopped=True)
    Command.objects.filter(id=piece.id).update(tries=1)
    end_commands_of_runs_over(datetime.now(UTC))
    piece.refresh_from_db()
    assert piece.status == "pending"
    control = Command.objects.get(id=piece.id)
    control.pk, control.method, control.piece, control.position = uuid4(), "cancel", False, 1000
    control.arguments, control.status = {"command": str(piece.id)}, "done"
    control.save(force_insert=True)
    end_commands_of_runs_over(datetime.now(UTC))
    piece.refresh_from_db()
    assert piece.status == "cancelled"


def test_looking_for_what_runs_over_have_told_is_one_statement_where_there_is_nothing(factory):
    factory.start(CURE)
    factory.start(CARRY)
    factory.work()
    assert Command.objects.filter(status="pending").values("run").distinct().count() == 2
    with CaptureQueriesContext(connection) as asked:
        end_commands_of_runs_over(datetime.now(UTC))
    assert len(asked) == 1


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

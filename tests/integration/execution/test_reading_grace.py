"""A reading that comes just behind an answer still counts for the condition that follows."""

from datetime import UTC, datetime, timedelta

import pytest

from editor.language.expressions.nodes import Constant, Operation, PlaceRef, Reading
from editor.language.plan.instructions import Branch, Call, End, Instruction, Notify, Plan
from execution import services
from execution.models import Command, InboxEvent, Run, RunEvent
from execution.runs import reading_grace
from registry.models import Device

pytestmark = pytest.mark.django_db(transaction=True)
OVEN = "curingOven01"
HOT = Operation(">", (Reading(Constant(OVEN), "temperature"), Constant(50)))
PLAN = Plan(
    (
        Instruction(Call(PlaceRef(device=OVEN), "curePaint", {"time": Constant(1)}), "cure"),
        Instruction(Branch(HOT, 3)),
        Instruction(Notify(Constant("hot"))),
        Instruction(End()),
    ),
    reads=((OVEN, "temperature"),),
)


def say(value, at, *, done=True):
    Device.objects.filter(id=OVEN).update(properties={"temperature": value}, last_seen_at=at, done=done)


def answered(factory):
    """Start the run and let the oven answer that it is done, with nothing said since it was asked."""
    say(20, datetime.now(UTC) - timedelta(seconds=5))
    run = factory.start(PLAN)
    factory.work()
    command = Command.objects.get(run=run)
    Command.objects.filter(id=command.id).update(status="sent", sent_at=datetime.now(UTC))
    now = datetime.now(UTC)
    services.record_ack(device=OVEN, command_id=str(command.id), status="DONE", why="", result={}, at=now)
    factory.work_once()
    return run


def test_the_run_waits_for_the_state_behind_the_answer(factory, monkeypatch):
    monkeypatch.setattr(reading_grace, "AT_MOST", timedelta(minutes=5))  # which this test does not wait for
    run = answered(factory)
    assert Run.objects.get(id=run).status == "running"
    say(90, datetime.now(UTC))
    factory.work_once()
    assert Run.objects.get(id=run).status == "finished"
    assert RunEvent.objects.filter(run=run, kind="notice").count() == 1


def test_a_device_that_says_nothing_more_holds_the_run_up_only_for_a_moment(factory):
    run = answered(factory)
    InboxEvent.objects.filter(payload__type="mission_over").update(created_at=datetime.now(UTC) - timedelta(seconds=1))
    factory.work_once()
    assert Run.objects.get(id=run).status == "finished"
    assert RunEvent.objects.filter(run=run, kind="notice").count() == 0


def test_a_device_that_said_it_before_its_answer_is_not_waited_for(factory):
    say(20, datetime.now(UTC) - timedelta(seconds=5))
    run = factory.start(PLAN)
    factory.work()
    command = Command.objects.get(run=run)
    Command.objects.filter(id=command.id).update(status="sent", sent_at=datetime.now(UTC))
    say(90, datetime.now(UTC))
    now = datetime.now(UTC)
    services.record_ack(device=OVEN, command_id=str(command.id), status="DONE", why="", result={}, at=now)
    factory.work()
    assert Run.objects.get(id=run).status == "finished"
    assert RunEvent.objects.filter(run=run, kind="notice").count() == 1

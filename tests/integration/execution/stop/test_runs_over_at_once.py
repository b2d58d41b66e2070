"""A gateway claims a command that never went out when it is ended with its run: it goes out or is ended, never both."""

from datetime import UTC, datetime

import pytest
from django.db import transaction

from editor.language.expressions.nodes import Constant, PlaceRef
from editor.language.plan.instructions import Call, End, Instruction, Plan
from execution import services
from execution.commands.outbox import end_commands_of_runs_over
from execution.models import Command, Run
from tests.kit.databases import one_waits
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.servers
OVEN = PlaceRef(device="curingOven01")
CURE = Plan((Instruction(Call(OVEN, "curePaint", {"time": Constant(2)}), "cure"), Instruction(End())))


@pytest.fixture
def command(factory):
    """What a run under way has told a device, and what has not gone out yet."""
    run = factory.start(CURE)
    factory.work()
    return Command.objects.get(run=run)


def claimed():
    return [each.id for each in services.claim_commands(limit=100)]


def end_with_run(command):
    Run.objects.filter(id=command.run).update(status="cancelled")
    end_commands_of_runs_over(datetime.now(UTC))


def test_what_a_gateway_claims_at_this_moment_is_not_ended_with_its_run(command, aside):
    with transaction.atomic():
        assert claimed() == [str(command.id)]
        ending = aside(end_with_run, command)
        wait_for("who ends it waits for the claim", one_waits)
    ending.result(60)
    command.refresh_from_db()
    assert (command.status, command.tries) == ("pending", 1)


def test_what_is_ended_with_its_run_at_this_moment_no_gateway_claims(command, aside):
    with transaction.atomic():
        end_with_run(command)
        assert aside(claimed).result(60) == []
    assert claimed() == []
    command.refresh_from_db()
    assert (command.status, command.tries) == ("cancelled", 0)

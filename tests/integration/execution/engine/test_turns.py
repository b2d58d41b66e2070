"""One owner for a site: what a turn writes, and that nobody writes beside it."""

import re
from dataclasses import replace
from datetime import timedelta

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from bench.hall import OVEN, SITE, fill_hall
from editor.language import plan_from_json
from editor.language.expressions.nodes import Constant, PlaceRef
from editor.language.plan.instructions import Instruction, Jump, Move, Notify, Plan, RoleBinding, TryBegin, TryEnd
from execution import database, services
from execution.engine import drive, lease
from execution.engine.commit import commit
from execution.engine.history import History, replay
from execution.engine.inbox import read_news
from execution.engine.lease import LeaseLost
from execution.engine.memory import read_site
from execution.engine.turn import Turn
from execution.machine import machine
from execution.machine.messages import StepFailed
from execution.models import Command, FloorState, InboxEvent, Run, RunEvent, RunInput, SiteLease, Timer
from execution.runs.journal import Journal
from registry import services as registry
from tests.integration.execution.engine.hall import WAITS, answer, answer_open, heating, row, start, told

pytestmark = pytest.mark.django_db(transaction=True)


@pytest.fixture(autouse=True)
def hall():
    fill_hall(6)


def site_id():
    return registry.get_site_id(site=SITE)


def expire():
    SiteLease.objects.update(expires_at="2026-01-01T00:00:00Z")


def worked_out(held, memory, later=timedelta(0)):
    """Return a turn that is decided and not yet written, by a clock that has gone on by so much."""
    news = read_news(held.site, SITE, memory.last_number)
    news = replace(news, now=news.now + later)
    memory.add_started(news.runs)
    turn = Turn(memory, news, look=False)
    turn.work_out()
    return turn


def test_a_run_goes_from_answer_to_next_command_in_one_turn_and_to_its_end():
    run = start(heating(2))
    assert drive.advance_site(SITE)
    for count in (1, 2):
        assert [command.status for command in told(run)][count - 1] == "pending"
        assert answer_open(run)
        assert drive.advance_site(SITE, look=False)
    assert (row(run).status, len(told(run))) == ("finished", 2)
    codes = [event.code for event in RunEvent.objects.filter(run=run).order_by("seq")]
    step = ["step_entered", "command", "answer", "step_done"]
    assert codes == ["started", *step, *step, "finished"]


def test_a_turn_asks_the_database_for_little_and_one_that_changes_nothing_writes_nothing(monkeypatch):
    monkeypatch.setattr(database, "open_cursor", connection.cursor)  # Django hears of its own cursors alone
    run = start(heating(4))
    drive.advance_site(SITE)
    held = lease.take(site_id())
    for _ in range(2):
        answer_open(run)
        with CaptureQueriesContext(connection) as asked:
            drive._turn(SITE, held, look=False)
    statements = [each["sql"] for each in asked.captured_queries if not re.match("BEGIN|COMMIT", each["sql"])]
    assert len(statements) == 8, statements
    with CaptureQueriesContext(connection) as asked:
        assert drive._turn(SITE, held, look=False) is False
    assert len(asked.captured_queries) == 1
    assert asked.captured_queries[0]["sql"].lstrip().startswith("SELECT")


def test_of_two_owners_at_once_the_one_whose_lease_was_taken_writes_nothing():
    run = start(heating())
    first = lease.take(site_id(), "first")
    turn = worked_out(first, read_site(SITE, first.epoch))
    assert [command.method for command in turn.floor.commands] == ["heat"]
    assert lease.take(site_id(), "second") is None
    expire()
    second = lease.take(site_id(), "second")
    assert second.epoch == first.epoch + 1
    before = (row(run).state, FloorState.objects.values().get(), SiteLease.objects.values().get())
    with pytest.raises(LeaseLost):
        commit(turn, first)
    assert (row(run).state, FloorState.objects.values().get(), SiteLease.objects.values().get()) == before
    assert (Command.objects.count(), RunEvent.objects.count()) == (0, 0)
    assert commit(worked_out(second, read_site(SITE, second.epoch)), second)
    assert [command.fence for command in told(run)] == [second.epoch]


def test_who_owned_a_site_last_takes_it_again_under_the_same_epoch_and_remembers_it():
    run = start(heating())
    drive.advance_site(SITE)
    known = drive._memories[SITE]
    answer_open(run)
    drive.advance_site(SITE)
    assert drive._memories[SITE] is known
    lease.take(site_id(), "somebody else") and expire()
    expire()
    assert lease.take(site_id(), "somebody else").epoch == known.epoch + 1
    expire()
    answer_open(run)
    drive.advance_site(SITE)
    assert drive._memories[SITE] is not known
    assert len(told(run)) == 3


def test_fences_never_go_back_behind_what_a_floor_has_reached_before():
    from importlib import import_module

    from django.apps import apps

    floor, _ = FloorState.objects.update_or_create(site_id=site_id(), defaults={"epoch": 4711})
    run = start(heating())
    InboxEvent.objects.create(
        target=f"run:{run}", key="old", payload={"type": "resume", "by": ""}, created_at="2026-01-01T00:00Z"
    )
    SiteLease.objects.all().delete()
    import_module("execution.migrations.0009_one_owner_a_site").own_sites(apps, None)
    assert InboxEvent.objects.get(key="old").site == SITE
    drive.advance_site(SITE)
    assert told(run)[0].fence > floor.epoch
    assert InboxEvent.objects.get(key="old").taken_at is not None


def test_what_a_person_tells_a_device_by_hand_while_a_turn_is_decided_makes_it_decided_anew():
    run = start(heating())
    held = lease.take(site_id())
    drive._turn(SITE, held, look=True)
    memory = drive._memories[SITE]
    other = start(heating(1, "machine003"))
    turn = worked_out(held, memory)
    services.call_method(site=SITE, device_id="machine003", method="heat", arguments={"value": 1}, by="Otto")
    with pytest.raises(Exception, match="Somebody else has changed the floor"):
        commit(turn, held)
    lease.release(held)
    drive.forget_all()
    drive.advance_site(SITE)
    assert (len(told(run)), told(other)) == (1, [])
    by_hand = Command.objects.get(device="machine003")
    answer(by_hand)
    drive.advance_site(SITE)
    assert len(told(other)) == 1


def test_a_program_that_never_rests_leaves_the_others_their_turn():
    loop = Plan((Instruction(Notify(Constant("on")), "n", 1), Instruction(Jump(0))))
    endless = start(loop)
    run = start(heating(1))
    drive.advance_site(SITE)
    assert len(told(run)) == 1
    assert (row(endless).status, Timer.objects.filter(run=endless).count()) == ("running", 1)


def test_a_hundred_runs_of_one_site_are_one_turn():
    fill = [start(WAITS) for _ in range(100)]
    held = lease.take(site_id())
    with CaptureQueriesContext(connection) as asked:
        drive._turn(SITE, held, look=True)
    assert Run.objects.filter(id__in=fill, status="running").count() == 100
    assert Timer.objects.count() == 100
    assert sum(each["sql"].startswith("BEGIN") for each in asked.captured_queries) <= 2


def test_the_time_that_decides_is_the_databases_though_the_owners_clock_is_a_minute_off(monkeypatch):
    import time

    run = start(heating())
    real = time.time
    monkeypatch.setattr(time, "time", lambda: real() + 60)
    drive.advance_site(SITE)
    held = SiteLease.objects.get()
    floor = FloorState.objects.get().state
    assert abs(floor["now"] - real()) < 10
    assert abs(told(run)[0].send_after.timestamp() - real()) < 10
    assert abs(held.expires_at.timestamp() - real()) < 10
    assert timedelta(0) <= row(run).started_at - row(run).created_at < timedelta(seconds=10)


def test_a_real_runs_history_replays_to_the_same_state_byte_for_byte():
    import json

    run = start(heating(3))
    drive.advance_site(SITE)
    for _ in range(3):
        assert answer_open(run)
        drive.advance_site(SITE)
    whole = row(run)
    turns = list(RunInput.objects.filter(run=run).order_by("seq").values_list("taken", flat=True))
    assert (whole.status, len(turns)) == ("finished", whole.inputs_kept)
    history = History(plan_from_json(whole.plan), whole.parameters, whole.entry, turns)
    decisions = replay(history)
    assert decisions[-1].state == json.dumps(machine.to_json(machine.from_json(whole.state)))
    asked = [action.task for decision in decisions for action in decision.actions if type(action).__name__ == "Ask"]
    assert (len(asked), decisions) == (3, replay(history))
    assert type(decisions[-1].actions[-1]).__name__ == "Finished"
    assert OVEN in json.dumps(whole.plan)


def trying_again():
    """Return a program that drives to a place that there is not, again and again."""
    robot = RoleBinding("robot", "robot001", ("move",))
    body = (TryBegin(3), Move("robot", PlaceRef(place="nowhere")), TryEnd(), Jump(0))
    steps = ("", "m", "", "")
    return Plan(tuple(map(Instruction, body, steps, range(1, 5))), {"robot": robot})


def asked_so_far(run):
    """Return how many tasks a run has asked for; the tasks alone take numbers."""
    return row(run).state["next_id"] - 1


def test_a_run_that_tries_again_what_fails_at_once_asks_at_most_so_often_in_a_second():
    run, other = start(trying_again()), start(heating(1))
    held = lease.take(site_id())
    for look in (True, True, False, False, False):
        drive._turn(SITE, held, look=look)
    memory = drive._memories[SITE]
    assert (asked_so_far(run), memory.has_more, memory.wakes_at is not None) == (16, False, True)
    assert drive._turn(SITE, held, look=False) is False
    answer_open(other)
    drive._turn(SITE, held, look=False)
    assert (row(other).status, asked_so_far(run)) == ("finished", 16)
    for seconds in range(1, 10):
        for _ in range(3):
            turn = worked_out(held, memory, timedelta(seconds=seconds * 1.01))
            commit(turn, held)
        assert (asked_so_far(run), turn.has_more) == (16 + 16 * seconds, False)
    failed = RunEvent.objects.filter(run=run, code="step_blocked", step="m")
    assert row(run).steps["m"]["count"] == 160
    assert failed.count() == 100  # of so many only every hundredth is written down
    services.cancel_run(run_id=run, by="Ada")
    turn = worked_out(held, memory, timedelta(seconds=11))
    commit(turn, held)
    assert (row(run).status, memory.resting, InboxEvent.objects.filter(taken_at=None).count()) == ("cancelled", {}, 0)
    assert failed.model.objects.filter(run=run, step="m").last().code == "step_cancelled"


def test_the_failure_that_ends_a_run_is_written_down_however_often_its_step_was_carried_out():
    run = start(heating(1))
    drive.advance_site(SITE)
    steps = row(run).steps
    Run.objects.filter(id=run).update(steps={"s0": {**steps["s0"], "count": 150}})
    drive.forget_all()
    answer(told(run)[0], "FAILED")
    drive.advance_site(SITE)
    codes = [event.code for event in RunEvent.objects.filter(run=run).order_by("seq")]
    assert codes == ["started", "step_entered", "command", "answer", "step_failed", "failed"]


@pytest.mark.parametrize(("seconds", "wait", "told"), [(1, None, 0), (3, None, 1), (0, "It waits for a robot.", 1)])
def test_of_the_failures_in_a_long_loop_only_those_are_left_out_that_come_at_once(seconds, wait, told):
    now = database.now()
    mark = {"count": 150, "started_at": (now - timedelta(seconds=seconds)).isoformat(), "wait": wait, "robot": None}
    journal = Journal(Run(steps={"m": mark}, roles={}, next_seq=7), now, {})
    journal.mark(StepFailed("m", "blocked", "There is no way."))
    assert len(journal.close()) == told

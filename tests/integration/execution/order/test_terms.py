"""When a run may begin, by when it should be over, and how much it matters, on each database."""

from dataclasses import asdict
from datetime import UTC, datetime, timedelta
from uuid import uuid4

import pytest

from editor.language import plan_to_json
from editor.language.expressions.nodes import Constant
from editor.language.plan.instructions import End, Instruction, Plan, Wait
from execution import mailbox, services
from execution.engine import drive
from execution.engine.drive import advance_site
from execution.models import Run, RunEvent, Timer
from execution.runs.terms import CLOCKS_APART, FARTHEST, Terms, fit_terms
from execution.services import BadTerms
from execution.ticker import ticker
from registry import services as registry

pytestmark = pytest.mark.django_db(transaction=True)
SITE = "painting-factory"
PLAN = Plan((Instruction(Wait(Constant(5)), "main"), Instruction(End())))
HOUR = timedelta(hours=1)


def now():
    return datetime.now(UTC)


def start(**terms):
    prepared = services.Prepared(uuid4(), SITE, "Task", 1, {}, {}, plan_to_json(PLAN), {})
    return services.start_run(prepared=prepared, by="Ada", terms=Terms(**terms)).id


def bring(run, **columns):
    """Let time pass for a run: its times come nearer."""
    Run.objects.filter(id=run).update(**columns)
    drive.forget_all()


def codes(run):
    return [event.code for event in RunEvent.objects.filter(run=run).order_by("seq")]


@pytest.fixture
def said(monkeypatch):
    """What browsers are told, as it goes to the sockets."""
    told = []
    monkeypatch.setattr(
        registry, "publish_all", lambda messages, wakes=(): told.extend(message for _, message in messages)
    )
    return told


def test_a_run_for_later_waits_and_begins_when_the_ticker_sees_that_it_is_due(factory, monkeypatch):
    hints = []
    monkeypatch.setattr(mailbox, "hint_now", hints.append)
    at = now() + HOUR
    run = start(not_before=at)
    for _ in range(2):
        assert advance_site(SITE)
    row = Run.objects.get(id=run)
    assert (row.status, row.state, row.started_at, row.epoch, codes(run)) == ("pending", None, None, 0, [])
    hints.clear()
    ticker.sweep(now() + timedelta(minutes=59))
    assert hints == []
    ticker.sweep(at)
    assert hints == [SITE]
    bring(run, not_before=now())
    assert advance_site(SITE)
    assert Run.objects.get(id=run).status == "running"
    event = RunEvent.objects.filter(run=run).first()
    assert (event.code, event.text) == ("started_planned", "Run 1 began at its time; Ada has planned it.")
    factory.go(lambda: Run.objects.get(id=run).status == "finished", limit_s=20)


def test_it_begins_once_though_many_hints_come(factory):
    run = start(not_before=now() + HOUR)
    bring(run, not_before=now())
    for _ in range(3):
        advance_site(SITE)
    assert (codes(run).count("started_planned"), Timer.objects.filter(run=run).count()) == (1, 1)


def test_a_waiting_run_is_cancelled_and_never_begins(factory):
    run = start(not_before=now() + HOUR)
    services.cancel_run(run_id=run, by="Otto")
    factory.work()
    bring(run, not_before=now())
    ticker.sweep(now() + HOUR)
    advance_site(SITE)
    row = Run.objects.get(id=run)
    assert (row.status, row.reason, row.state) == ("cancelled", "Otto cancelled it", None)
    assert (row.ended_at is not None, codes(run)) == (True, ["cancelled"])
    with pytest.raises(services.NotPossibleNow, match="is over"):
        services.cancel_run(run_id=run, by="Ada")


def test_a_cancel_that_arrives_with_the_start_comes_before_it(factory):
    run = start(not_before=now() + HOUR)
    bring(run, not_before=now())
    services.cancel_run(run_id=run, by="Otto")
    services.cancel_run(run_id=run, by="Ada")
    advance_site(SITE)
    row = Run.objects.get(id=run)
    assert (row.status, row.reason, row.started_at, codes(run)) == (
        "cancelled",
        "Otto cancelled it",
        None,
        ["cancelled"],
    )


def test_a_cancel_behind_the_start_ends_a_run_as_ever(factory):
    run = start(not_before=now() + HOUR)
    bring(run, not_before=now())
    advance_site(SITE)
    services.cancel_run(run_id=run, by="Otto")
    advance_site(SITE)
    assert (Run.objects.get(id=run).status, codes(run)[0], codes(run)[-1]) == (
        "cancelled",
        "started_planned",
        "cancelled",
    )


def test_stop_all_holds_a_waiting_run_until_somebody_resumes_it(factory):
    run = start(not_before=now() + HOUR)
    services.press_stop(site=SITE, by="Otto")
    factory.work()
    row = Run.objects.get(id=run)
    assert (row.status, row.reason) == ("paused", "Otto stopped all devices of the site")
    bring(run, not_before=now())
    services.reset_stop(site=SITE, by="Otto")
    factory.work()
    advance_site(SITE)
    assert Run.objects.get(id=run).state is None
    services.resume_run(run_id=run, by="Ada")
    factory.work()
    assert Run.objects.get(id=run).status == "running"
    assert codes(run)[:3] == ["paused", "waits_again", "started_planned"]


def test_a_waiting_run_does_not_keep_an_armed_program_from_starting_and_a_due_one_does(factory):
    from execution.runs.triggers import _is_under_way

    run = start(not_before=now() + HOUR)
    program = Run.objects.get(id=run).program
    assert not _is_under_way(program, now())
    assert _is_under_way(program, now() + 2 * HOUR)


def test_two_planned_runs_of_a_program_begin_both(factory):
    runs = [start(not_before=now() + HOUR), start(not_before=now() + HOUR, priority="high")]
    for run in runs:
        bring(run, not_before=now())
    factory.work()
    assert [Run.objects.get(id=run).status for run in runs] == ["running", "running"]
    assert [view.priority for view in services.list_runs(site=SITE)[0]] == ["high", "normal"]


def test_people_are_told_once_that_a_deadline_has_passed_and_the_run_goes_on(factory, said):
    run = start(deadline=now() + HOUR)
    factory.work()
    ticker.sweep(now())
    factory.work()
    assert "deadline_passed" not in codes(run)
    bring(run, deadline=now() - timedelta(seconds=1))
    for _ in range(3):
        ticker.sweep(now())
        factory.work()
    assert codes(run).count("deadline_passed") == 1
    (notice,) = [message for message in said if message["type"] == "notice"]
    assert (notice["text"], notice["level"]) == ("Run 1 (Task) should be over by now.", "warning")
    assert (notice["code"], notice["args"]) == ("deadline_passed", {"number": 1, "program": "Task"})
    row = Run.objects.get(id=run)
    assert (row.status, row.late) == ("running", True)
    mailbox.forget_taken(now() + HOUR)
    ticker.sweep(now())
    factory.work()
    assert codes(run).count("deadline_passed") == 1


def test_a_run_that_is_held_before_its_start_is_late_too(factory):
    run = start(not_before=now() + HOUR, deadline=now() + 2 * HOUR)
    services.pause_run(run_id=run, by="Otto")
    factory.work()
    bring(run, not_before=now() - HOUR, deadline=now())
    ticker.sweep(now())
    factory.work()
    assert (codes(run), Run.objects.get(id=run).status) == (["paused", "deadline_passed"], "paused")


def test_a_run_that_is_over_in_time_is_never_late(factory):
    run = start(deadline=now() + HOUR)
    factory.go(lambda: Run.objects.get(id=run).status == "finished", limit_s=20)
    bring(run, deadline=now() - HOUR)
    ticker.sweep(now())
    factory.work()
    assert "deadline_passed" not in codes(run)


@pytest.mark.parametrize(
    ("start_s", "deadline_s", "why"),
    [
        (-CLOCKS_APART.total_seconds() - 1, None, "start_past"),
        (-1e9, None, "start_past"),
        (None, 0, "deadline_past"),
        (None, -1, "deadline_past"),
        (-30, -20, "deadline_past"),
        (FARTHEST.total_seconds() + 1, None, "too_far"),
        (None, FARTHEST.total_seconds() + 1, "too_far"),
        (3600, 3600, "deadline_first"),
        (3600, 1800, "deadline_first"),
    ],
)
def test_times_that_make_no_sense_are_refused_with_a_reason(start_s, deadline_s, why):
    at = datetime(2026, 11, 23, 7, tzinfo=UTC)
    times = [None if each is None else at + timedelta(seconds=each) for each in (start_s, deadline_s)]
    with pytest.raises(BadTerms) as refusal:
        fit_terms(Terms("normal", *times), at)
    assert (refusal.value.facts, refusal.value.status) == ({"why": why}, 422)


@pytest.mark.parametrize("apart_s", [0, 1, CLOCKS_APART.total_seconds()])
def test_a_start_that_a_slow_clock_calls_now_is_now(apart_s):
    at = datetime(2026, 11, 23, 7, tzinfo=UTC)
    given = Terms("high", at - timedelta(seconds=apart_s), at + HOUR)
    assert asdict(fit_terms(given, at)) == {"priority": "high", "not_before": None, "deadline": at + HOUR}


def test_nothing_is_planned_while_the_site_is_stopped(factory):
    services.press_stop(site=SITE, by="Otto")
    with pytest.raises(services.NotPossibleNow, match="The site is stopped"):
        start(not_before=now() + HOUR)
    assert Run.objects.count() == 0

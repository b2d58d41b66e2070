"""What raises is set aside with its error; its run is paused with the reason, and the others go on."""

import logging
from dataclasses import replace

import pytest
from django.db import connection

from bench.hall import HOT, OVEN, SITE, fill_hall
from editor.language.expressions.nodes import Constant
from editor.language.plan.instructions import AnswerSpec, AskPerson, End, Instruction, Plan, WaitUntil
from execution import database, services
from execution.engine import drive
from execution.errors import NotFound, NotPossibleNow
from execution.models import DeadLetter, FloorState, InboxEvent, Question, Run, Timer
from registry import services as registry
from registry.models import Device
from tests.integration.execution.engine.hall import WAITS, answer_open, heating, row, start, told
from vipo_device.kit.log_ids import bound_ids

pytestmark = pytest.mark.django_db(transaction=True)
NOW = "2026-01-01T00:00Z"
ODD_ZONE = {"id": ["no", "id"], "name": "Odd", "rule": "", "points": [], "speed_m_s": None}


@pytest.fixture(autouse=True)
def hall():
    fill_hall(6)


def put(target, payload, key="odd"):
    InboxEvent.objects.create(site=SITE, target=target, key=key, payload=payload, created_at=NOW)


def finish(run, steps):
    for _ in range(steps):
        drive.advance_site(SITE)
        answer_open(run)
    drive.advance_site(SITE)
    return row(run).status


def test_an_event_that_nobody_can_read_is_set_aside_and_another_run_goes_on():
    bad, good = start(heating()), start(heating(2, "machine003"))
    drive.advance_site(SITE)
    put(f"run:{bad}", {"type": "nonsense", "x": 1})
    answer_open(good)
    drive.advance_site(SITE)
    (letter,) = services.list_dead_letters(site=SITE)
    assert (str(letter.run), letter.event, letter.state) == (bad, {"type": "nonsense", "x": 1}, "open")
    assert (letter.target, letter.run_status) == ("run", "paused")
    assert letter.error.startswith("UnreadableMessage: There is no message of type 'nonsense'.")
    assert (row(bad).status, row(good).status, len(told(good))) == ("paused", "running", 2)
    assert services.get_run(run_id=bad).run.cause["code"] == "set_aside"
    assert InboxEvent.objects.filter(taken_at=None).count() == 0
    assert finish(good, 1) == "finished"


def test_an_event_that_the_machine_cannot_take_in_is_retried_when_its_cause_is_mended():
    run = start(heating(1))
    drive.advance_site(SITE)
    put(
        f"run:{run}",
        {"type": "answer", "device": "machine000", "method": "heat", "step": "s0", "status": "ODD", "why": ""},
    )
    drive.advance_site(SITE)
    (letter,) = services.list_dead_letters(site=SITE, state="open")
    assert (letter.error, row(run).status) == ("KeyError: 'ODD'", "paused")
    DeadLetter.objects.update(event={**letter.event, "status": "DONE"})
    retried = services.retry_dead_letter(letter_id=letter.id, by="Ada")
    assert (retried.state, retried.settled_by) == ("retried", "Ada")
    with pytest.raises(NotPossibleNow, match="Ada has retried it already"):
        services.retry_dead_letter(letter_id=letter.id, by="Otto")
    assert finish(run, 1) == "finished"
    assert services.list_dead_letters(site=SITE, state="open") == ()


def test_a_plan_that_cannot_be_read_pauses_its_run_which_can_be_cancelled():
    bad, good = start(heating()), start(heating(1, "machine003"))
    Run.objects.filter(id=bad).update(plan={"no": "plan"})
    assert finish(good, 1) == "finished"
    (letter,) = services.list_dead_letters(site=SITE)
    assert (str(letter.run), row(bad).status) == (bad, "paused")
    services.cancel_run(run_id=bad, by="Ada")
    drive.advance_site(SITE)
    assert (row(bad).status, row(bad).reason) == ("cancelled", "Ada cancelled it")


def test_a_plan_that_raises_when_it_begins_begins_when_it_is_resumed_and_mended():
    run = start(heating(1))
    Run.objects.filter(id=run).update(parameters=5)
    drive.advance_site(SITE)
    assert (row(run).status, row(run).started_at, told(run)) == ("paused", None, [])
    Run.objects.filter(id=run).update(parameters={})
    drive.forget_all()
    (letter,) = services.list_dead_letters(site=SITE, state="open")
    services.retry_dead_letter(letter_id=letter.id, by="Ada")
    assert finish(run, 1) == "finished"


@pytest.mark.parametrize("parameters", [5, {}], ids=["the cause stays", "the cause is gone"])
def test_a_run_that_could_not_begin_can_be_cancelled_and_never_begins(parameters):
    run = start(heating(1))
    Run.objects.filter(id=run).update(parameters=5)
    drive.advance_site(SITE)
    assert (row(run).status, row(run).started_at) == ("paused", None)
    Run.objects.filter(id=run).update(parameters=parameters)
    drive.forget_all()
    services.cancel_run(run_id=run, by="Ada")
    drive.advance_site(SITE)
    assert (row(run).status, row(run).reason, row(run).started_at) == ("cancelled", "Ada cancelled it", None)
    assert (row(run).ended_at is not None, told(run)) == (True, [])


def test_a_run_that_cannot_begin_ends_by_the_cancel_that_arrives_with_its_start():
    run = start(heating(1))
    Run.objects.filter(id=run).update(parameters=5)
    services.cancel_run(run_id=run, by="Ada")
    drive.advance_site(SITE)
    assert (row(run).status, row(run).started_at) == ("cancelled", None)


def test_a_run_that_is_cancelled_when_it_is_found_unreadable_is_over():
    run = start(heating())
    Run.objects.filter(id=run).update(plan={"no": "plan"})
    services.cancel_run(run_id=run, by="Ada")
    drive.advance_site(SITE)
    assert (row(run).status, [letter.event for letter in services.list_dead_letters(site=SITE)]) == (
        "cancelled", [{"type": "plan"}],
    )  # fmt: skip


def test_what_a_run_is_told_whose_machine_raises_at_everything_is_handed_over_once_that_is_mended():
    run = start(heating(1))
    drive.advance_site(SITE)
    plan = row(run).plan
    Run.objects.filter(id=run).update(plan={**plan, "zones": [ODD_ZONE]})
    drive.forget_all()
    services.pause_run(run_id=run, by="Ada")
    drive.advance_site(SITE)
    answer_open(run)
    drive.advance_site(SITE)
    letters = services.list_dead_letters(site=SITE)[::-1]
    types = [letter.event["type"] for letter in letters]
    assert types == ["step", "answer", "step", "mission_over", "step"]
    assert {letter.error for letter in letters} == {"TypeError: unhashable type: 'list'"}
    Run.objects.filter(id=run).update(plan=plan)
    drive.forget_all()
    services.retry_dead_letter(letter_id=letters[3].id, by="Ada")
    drive.advance_site(SITE)
    assert (row(run).status, len(told(run))) == ("finished", 1)


def test_what_a_run_is_told_that_cannot_begin_is_set_aside_beside_its_start():
    run = start(heating(1))
    Run.objects.filter(id=run).update(parameters=5)
    put(f"run:{run}", {"type": "deadline"})
    drive.advance_site(SITE)
    letters = services.list_dead_letters(site=SITE)[::-1]
    assert [letter.event for letter in letters] == [{"type": "deadline"}, {"type": "start"}]


def test_a_run_that_is_cancelled_past_its_machine_asks_nothing_more_and_waits_for_nothing():
    answer = AnswerSpec("boolean")
    ask = Instruction(AskPerson(Constant("Is it dry?"), answer, timeout_s=Constant(3600)), "q", 1)
    run = start(Plan((ask, Instruction(End()))))
    drive.advance_site(SITE)
    assert (Question.objects.get().state, Timer.objects.count()) == ("open", 1)
    Run.objects.update(state={"format": 99})
    drive.forget_all()
    services.cancel_run(run_id=run, by="Ada")
    drive.advance_site(SITE)
    assert (row(run).status, Question.objects.get().state, Timer.objects.count()) == ("cancelled", "withdrawn", 0)
    with pytest.raises(NotPossibleNow, match="not asked any more"):
        services.answer_question(question_id=Question.objects.get().id, value=True, by="Olga")


def test_a_floor_that_cannot_be_read_holds_only_those_who_need_it():
    drive.advance_site(SITE)
    FloorState.objects.update(state={"format": 99})
    drive.forget_all()
    needs, waits = start(heating()), start(WAITS)
    drive.advance_site(SITE)
    assert (row(needs).status, row(waits).status) == ("paused", "running")
    paused, letter = services.list_dead_letters(site=SITE)
    assert [(str(each.run), each.event["type"]) for each in (letter, paused)] == [
        (needs, "mission_asked"),
        (needs, "run_paused"),
    ]
    assert "format 99" in letter.error
    assert letter.target == "floor"
    FloorState.objects.update(state=None)
    drive.forget_all()
    services.retry_dead_letter(letter_id=letter.id, by="Ada")
    assert finish(needs, 3) == "finished"


def test_a_task_in_the_floor_that_raises_at_every_look_is_taken_out_with_its_run_alone():
    bad, good = start(heating()), start(heating(2, "machine003"))
    drive.advance_site(SITE)
    state = FloorState.objects.get().state
    (task,) = [job for job in state["jobs"] if job["run"] == bad]
    task["order"]["target"]["id"] = ["no", "device"]
    task["command"] = ""
    state["sent"] = [sent for sent in state["sent"] if sent["run"] != bad]
    FloorState.objects.update(state=state)
    drive.forget_all()
    answer_open(good)
    drive.advance_site(SITE)
    assert (row(bad).status, row(good).status, len(told(good))) == ("paused", "running", 2)
    (letter,) = services.list_dead_letters(site=SITE)
    assert (str(letter.run), letter.event["type"]) == (bad, "several")


def put_hard(run):
    """Put something into a run's inbox that the database does not take as a line of its journal; return what."""
    hard = {"device": "d" * 100} if connection.vendor == "postgresql" else {"why": "\ud800"}
    said = {"type": "answer", "device": "machine000", "method": "heat", "step": "s0", "status": "DONE", "why": ""}
    put(f"run:{run}", {**said, **hard})
    return {**said, **hard}


def test_a_message_that_the_database_does_not_take_keeps_its_run_paused_whatever_comes_next():
    run = start(heating(3))
    drive.advance_site(SITE)
    hard = put_hard(run)
    drive.advance_site(SITE)
    (letter,) = services.list_dead_letters(site=SITE)
    assert (row(run).status, letter.event) == ("paused", hard)
    assert row(run).state["status"] == "paused"  # its machine and the floor have heard it, though nobody said more
    answer_open(run)
    drive.advance_site(SITE)
    assert (row(run).status, row(run).state["status"], len(told(run))) == ("paused", "paused", 1)
    services.resume_run(run_id=run, by="Ada")
    assert finish(run, 2) == "finished"


def test_a_run_is_paused_before_it_hears_what_waits_behind_a_message_that_the_database_does_not_take():
    run = start(heating(3))
    drive.advance_site(SITE)
    put_hard(run)
    put(f"run:{run}", {"type": "mission_over", "mission": 1, "kind": "", "why": "", "result": {}}, key="behind")
    drive.advance_site(SITE)
    said = row(run)
    assert (said.status, said.state["status"], len(told(run))) == ("paused", "paused", 1)
    assert [thread["at"] for thread in said.state["threads"]] == [0]


def hard_step():
    """Return an id of a step that the database does not take as that of a line."""
    return "s" * 73 if connection.vendor == "postgresql" else "\ud800"


def renamed(plan, old, new):
    """Return a plan in which one step has another id."""
    return replace(plan, instructions=tuple(replace(i, step=new) if i.step == old else i for i in plan.instructions))


def test_a_run_whose_beginning_the_database_does_not_take_is_paused_and_what_others_are_told_is_taken_in(monkeypatch):
    heard = []
    good = [start(heating(2)), start(heating(2, "machine003"))]
    drive.advance_site(SITE)
    monkeypatch.setattr(registry, "publish_all", lambda messages, wakes=(): heard.extend(each for _, each in messages))
    bad = start(renamed(heating(1, "machine004"), "s0", hard_step()))
    late = start(heating(1, "machine005"))
    assert [answer_open(run) for run in good] == [True, True]
    drive.advance_site(SITE)
    assert [(row(run).status, len(told(run))) for run in good] == [("running", 2), ("running", 2)]
    assert (row(late).status, len(told(late))) == ("running", 1)
    assert (row(bad).status, row(bad).started_at, row(bad).state, told(bad)) == ("paused", None, None, [])
    (letter,) = services.list_dead_letters(site=SITE)
    assert (str(letter.run), letter.event) == (bad, {"type": "start"})
    assert letter.error.startswith(("StringDataRightTruncation", "UnicodeEncodeError"))
    assert letter.error in row(bad).reason
    assert [each["run"] for each in heard if each.get("code") == "set_aside"] == [bad]
    assert services.get_run(run_id=bad).run.cause["code"] == "set_aside"


def test_a_run_whose_beginning_the_database_does_not_take_can_be_resumed_for_nothing_and_cancelled():
    bad, good = start(renamed(heating(1), "s0", hard_step())), start(heating(2, "machine003"))
    drive.advance_site(SITE)
    services.resume_run(run_id=bad, by="Ada")
    answer_open(good)
    drive.advance_site(SITE)
    assert (row(bad).status, len(told(good))) == ("paused", 2)
    first = services.list_dead_letters(site=SITE)[-1]
    services.retry_dead_letter(letter_id=first.id, by="Ada")
    drive.advance_site(SITE)
    assert (row(bad).status, row(bad).started_at) == ("paused", None)
    letters = services.list_dead_letters(site=SITE)
    assert [(letter.event, letter.state) for letter in letters] == [
        ({"type": "start"}, "open"), ({"type": "start"}, "open"), ({"type": "start"}, "retried"),
    ]  # fmt: skip
    assert InboxEvent.objects.filter(taken_at=None).count() == 0
    services.cancel_run(run_id=bad, by="Ada")
    drive.advance_site(SITE)
    assert (row(bad).status, row(bad).started_at) == ("cancelled", None)
    assert finish(good, 1) == "finished"


def test_a_run_that_goes_on_by_itself_to_what_the_database_does_not_take_is_paused_and_no_other():
    wait = Instruction(WaitUntil(HOT, None), "wait", 1)
    bad = start(Plan((wait, *renamed(heating(1), "s0", hard_step()).instructions), reads=((OVEN, "temperature"),)))
    good = start(heating(2, "machine003"))
    drive.advance_site(SITE)
    assert row(bad).status == "running"
    Device.objects.filter(id=OVEN).update(properties={"temperature": 90}, last_seen_at=database.now())
    answer_open(good)
    drive.advance_site(SITE)
    drive.advance_site(SITE)
    assert (row(good).status, len(told(good))) == ("running", 2)
    assert (row(bad).status, row(bad).state["status"], told(bad)) == ("paused", "paused", [])
    (letter,) = services.list_dead_letters(site=SITE)
    assert (str(letter.run), letter.event) == (bad, {"type": "step"})
    assert finish(good, 1) == "finished"


def test_what_was_set_aside_is_dropped_and_its_run_stays_as_it_is():
    run = start(heating(1))
    drive.advance_site(SITE)
    put(f"run:{run}", ["no", "object"])
    drive.advance_site(SITE)
    (letter,) = services.list_dead_letters(site=SITE)
    assert services.drop_dead_letter(letter_id=letter.id, by="Ada").state == "dropped"
    drive.advance_site(SITE)
    assert row(run).status == "paused"
    services.resume_run(run_id=run, by="Ada")
    assert finish(run, 1) == "finished"
    with pytest.raises(NotFound):
        services.drop_dead_letter(letter_id=letter.id + 1, by="Ada")


def test_people_who_watch_the_site_are_told(monkeypatch):
    heard = []
    monkeypatch.setattr(registry, "publish_all", lambda messages, wakes=(): heard.extend(each for _, each in messages))
    run = start(heating(1))
    drive.advance_site(SITE)
    put(f"run:{run}", {"type": "nonsense"})
    drive.advance_site(SITE)
    (notice,) = [each for each in heard if each["type"] == "notice"]
    assert (notice["code"], notice["run"], notice["level"]) == ("set_aside", run, "warning")


def test_a_line_of_the_log_says_which_step_of_which_run_was_set_aside():
    run = start(heating(1))
    drive.advance_site(SITE)
    lines, handler = [], logging.Handler()
    handler.emit = lambda record: lines.append((record.levelname, record.getMessage(), dict(bound_ids())))
    log = logging.getLogger("execution.engine.turn")
    log.addHandler(handler)
    try:
        hostile = {"type": "answer", "device": "d" * 500, "method": "heat", "step": "s0", "status": "ODD", "why": ""}
        put(f"run:{run}", hostile)
        drive.advance_site(SITE)
    finally:
        log.removeHandler(handler)
    (said,) = [line for line in lines if line[0] == "WARNING"]
    assert said[1] == "Something was set aside for an admin: KeyError: 'ODD'"
    assert said[2] == {"run": run, "step": "s0", "device": "d" * 80}

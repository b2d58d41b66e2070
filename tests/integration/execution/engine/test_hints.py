"""How owners are called: hints that are lost or doubled, messages and tasks of the version before, several sites."""

from datetime import UTC, datetime, timedelta

import pytest

from bench.hall import SITE, fill_hall
from execution import mailbox, tasks
from execution.engine import drive
from execution.job_lease import LEASE_S
from execution.models import InboxEvent, SiteLease
from execution.ticker import ticker
from tests.integration.execution.engine.hall import answer_open, heating, row, start, told

pytestmark = pytest.mark.django_db(transaction=True)


@pytest.fixture(autouse=True)
def hall():
    fill_hall(4)


@pytest.fixture
def asked(monkeypatch):
    """Which tasks are sent to the workers, and for what."""
    sent = []
    monkeypatch.setattr(mailbox, "send_hint", lambda task, name: sent.append((task, name)))
    monkeypatch.setattr(mailbox, "_asked_at", {})
    return sent


def test_an_owner_is_asked_for_once_in_a_while_however_much_is_posted(asked):
    for _ in range(5):
        start(heating())
    assert asked == [(mailbox.DRIVE_SITE, SITE)]


def test_a_task_of_the_version_before_wakes_the_site_and_one_for_a_run_that_is_gone_does_nothing(asked):
    run = start(heating())
    mailbox._asked_at.clear()
    tasks.advance_run(run)
    mailbox._asked_at.clear()
    tasks.advance_site(SITE)
    tasks.advance_run("00000000-0000-0000-0000-000000000000")
    assert asked == [(mailbox.DRIVE_SITE, SITE)] * 3


def test_messages_between_run_and_floor_of_the_version_before_are_taken_in(asked):
    run = start(heating(1))
    drive.advance_site(SITE)
    command = told(run)[0]
    at = datetime.now(UTC) - timedelta(minutes=1)
    answered = {"type": "answered", "command": str(command.id), "status": "DONE", "why": "", "result": {}}
    InboxEvent.objects.create(target=f"site:{SITE}", key="old", payload=answered, created_at=at)
    ticker.sweep(datetime.now(UTC))
    drive.advance_site(SITE)
    assert row(run).status == "finished"
    assert InboxEvent.objects.filter(taken_at=None).count() == 0


def test_a_doubled_task_finds_the_site_owned_and_a_site_that_is_gone_is_nobodys():
    run = start(heating(1))
    assert drive.drive_site(SITE, stay_s=0.3, linger_s=0.1)
    assert len(told(run)) == 1
    SiteLease.objects.update(owner="somebody else", expires_at=datetime.now(UTC) + timedelta(seconds=LEASE_S))
    answer_open(run)
    assert drive.drive_site(SITE) is False
    assert row(run).status == "running"
    assert drive.drive_site("no-such-site") is False


def test_who_is_asked_to_leave_takes_no_site_and_calls_another_worker(asked):
    start(heating())
    asked.clear()
    drive.leave()
    assert drive.drive_site(SITE) is False
    assert (asked, SiteLease.objects.count()) == ([(mailbox.DRIVE_SITE, SITE)], 0)

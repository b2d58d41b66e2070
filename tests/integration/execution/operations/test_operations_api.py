"""What operators and admins are told of queues, overdue commands and processes, and with how many questions."""

from __future__ import annotations

from datetime import timedelta
from typing import Any
from uuid import uuid4

import pytest
from celery import current_app
from django.db import connection
from django.test import Client
from django.test.utils import CaptureQueriesContext
from django.utils import timezone

from execution import services
from execution.models import Command, DeadLetter, InboxEvent, Lease, Rehearsal, Run
from registry import services as registry
from registry.models import Heartbeat, Site
from tests.kit.sign_in import add_person, signed_in

pytestmark = pytest.mark.django_db


def make_command(site: str, seconds: float, **more: Any) -> Command:
    at = timezone.now() - timedelta(seconds=seconds)
    told = {"device": "mixer1", "method": "mix", "status": "sent", "position": Command.objects.count(), **more}
    return Command.objects.create(id=uuid4(), site=Site.objects.get(slug=site), send_after=at, created_at=at, **told)


def make_run(site: str, number: int = 1, **more: Any) -> Run:
    at = timezone.now()
    return Run.objects.create(
        site=Site.objects.get(slug=site), number=number, program=uuid4(), program_name="Mix", created_at=at, **more
    )


def make_process(kind: str, name: str = "p1", *, seconds: float = -60, **more: Any) -> None:
    at = timezone.now() - timedelta(seconds=seconds)
    Heartbeat.objects.create(kind=kind, name=name, machine="m1", process=7, version="1", since=at, at=at, **more)


def ask(client: Client, what: str, site: str = "hall") -> Any:
    answer = client.get(f"/api/sites/{site}/{what}")
    assert answer.status_code == 200, answer.content
    return answer.json()


def waiting(body: Any) -> dict[str, int]:
    """What waits, without the tasks of whatever ran before in this process."""
    queues = (queue for queue in body["queues"] if not queue["name"].startswith("tasks:"))
    return {queue["name"]: queue["waiting"] for queue in queues if queue["waiting"]}


@pytest.fixture
def other(hall: str) -> str:
    registry.create_site(name="Shed", slug="shed")
    return "shed"


def test_an_operator_sees_what_waits_at_the_own_site_alone(other: str) -> None:
    run = make_run("hall", status="running")
    foreign = make_run(other, status="paused")
    at = timezone.now() - timedelta(seconds=30)
    waits = (("hall", f"run:{run.pk}"), ("hall", "site:hall"), (other, f"run:{foreign.pk}"), (other, "site:shed"))
    for site, target in waits:
        InboxEvent.objects.create(site=site, target=target, key=target, payload={}, created_at=at)
    InboxEvent.objects.create(site="hall", target="site:hall", key="old", payload={}, created_at=at, taken_at=at)
    make_command("hall", -60, status="pending")
    make_command("hall", -60, status="running")
    make_command(other, 60)
    for site in ("hall", other):
        Rehearsal.objects.create(site=Site.objects.get(slug=site), program=uuid4(), created_at=at)
    told = ask(signed_in("operator"), "operations")
    assert waiting(told) == {"inbox": 2, "outbox": 1, "under_way": 1, "rehearsals": 1}
    assert told["runs"] == {"pending": 0, "running": 1, "paused": 0}
    assert (told["overdue_count"], told["overdue"], told["open_alerts"]) == (0, [], 0)
    (inbox,) = [queue for queue in told["queues"] if queue["name"] == "inbox"]
    assert 29 < inbox["oldest_s"] <= (timezone.now() - at).total_seconds() + 1
    everywhere = ask(signed_in("admin"), "processes")
    assert waiting(everywhere) == {"inbox": 4, "outbox": 1, "unanswered": 1, "under_way": 1, "rehearsals": 2}


def test_commands_are_overdue_after_ten_seconds_of_silence_the_oldest_first(hall: str) -> None:
    run = make_run(hall, number=7, status="running")
    make_command(hall, -60)
    make_command(hall, 90, status="accepted")
    of_run, by_hand = make_command(hall, 12, run=run.pk, tries=3), make_command(hall, 40, status="pending")
    told = ask(signed_in("operator"), "operations")
    found = [(each["id"], each["number"], each["status"], each["tries"]) for each in told["overdue"]]
    assert found == [(str(by_hand.pk), None, "pending", 0), (str(of_run.pk), 7, "sent", 3)]
    assert told["overdue"][1]["run"] == str(run.pk)
    for _ in range(30):
        make_command(hall, 20)
    told = ask(signed_in("operator"), "operations")
    assert (told["overdue_count"], len(told["overdue"])) == (32, 20)


def test_operators_are_told_what_stops_work_and_admins_which_process_it_is(hall: str) -> None:
    make_process("gateway", seconds=30)
    make_process("worker", clock_apart_s=-60.0)
    make_process("ticker", activity="leads")
    operator, admin = (ask(signed_in(role), "findings") for role in ("operator", "admin"))
    assert operator == [
        {"code": "no_gateway", "severity": "error", "args": {},
         "text": "No gateway is running: commands and what devices say wait."},
    ]  # fmt: skip
    assert [each["code"] for each in admin] == ["no_gateway", "clock_apart", "process_silent"]
    assert admin[1]["args"] == {"kind": "worker", "name": "p1", "machine": "m1", "seconds": -60.0}
    Heartbeat.objects.filter(kind="gateway").delete()
    make_process("gateway")
    assert ask(signed_in("operator"), "findings") == []


def test_what_was_set_aside_waits_for_admins_until_it_is_retried_or_dropped(other: str) -> None:
    letters = [set_aside(site, error) for site, error in (("hall", "one"), ("hall", "two"), (other, "three"))]
    operator, admin = signed_in("operator"), signed_in("admin")
    assert waiting(ask(operator, "operations")) == {"set_aside": 2}
    assert waiting(ask(admin, "processes")) == {"set_aside": 3}
    assert ask(operator, "findings") == []
    assert ask(admin, "findings") == [
        {"code": "set_aside", "severity": "error", "args": {"count": 2},
         "text": "Messages that could not be processed wait for an admin: 2."},
    ]  # fmt: skip
    for letter in letters:
        services.drop_dead_letter(letter_id=letter, by="Ada")
    assert waiting(ask(operator, "operations")) == {}
    assert ask(admin, "findings") == []


def set_aside(site: str, error: str, run: Run | None = None) -> int:
    at, place = timezone.now(), Site.objects.get(slug=site)
    event = {"type": "run_over", "run": "r"}
    return DeadLetter.objects.create(site=place, run=run, target=f"site:{site}", event=event, error=error, at=at).pk


def post(client: Client, letter: int, what: str) -> tuple[int, Any]:
    answer = client.post(f"/api/dead-letters/{letter}/{what}", content_type="application/json")
    return answer.status_code, answer.json()


def test_of_two_admins_the_second_is_told_what_the_first_has_done(hall: str) -> None:
    letter = set_aside(hall, "Broken.", make_run(hall, number=7, status="paused"))
    add_person("other")
    registry.set_member(site=hall, email="other@vipo.example", role="admin")
    first, second = signed_in("admin"), signed_in("other")
    status, told = post(first, letter, "drop")
    assert (status, told["state"], told["run_number"], told["run_status"]) == (200, "dropped", 7, "paused")
    for what in ("retry", "drop"):
        status, told = post(second, letter, what)
        assert (status, told["code"], told["args"]["why"]) == (409, "not_possible_now", "settled_dropped")
        assert told["detail"] == "Admin Person has dropped it already."
    assert InboxEvent.objects.count() == 0


def test_what_belongs_to_a_run_that_is_over_is_dropped_and_not_retried(hall: str) -> None:
    letter = set_aside(hall, "Broken.", make_run(hall, number=8, status="failed"))
    admin = signed_in("admin")
    status, told = post(admin, letter, "retry")
    assert (status, told["args"]) == (409, {"why": "run_over", "run": 8})
    (listed,) = ask(admin, "dead-letters?state=open")
    assert (listed["state"], listed["run_status"], listed["settled_by"]) == ("open", "failed", "")
    assert post(admin, letter, "drop")[0] == 200


def test_what_is_settled_is_listed_by_itself_the_last_first(hall: str) -> None:
    run = make_run(hall, number=9, status="paused")
    first, second, still_open = (set_aside(hall, error, run) for error in ("One.", "Two.", "Three."))
    admin = signed_in("admin")
    assert ask(admin, "dead-letters?state=settled") == []
    assert [post(admin, second, "retry")[0], post(admin, first, "drop")[0]] == [200, 200]
    settled = ask(admin, "dead-letters?state=settled")
    assert [(each["error"], each["state"], each["settled_by"]) for each in settled] == [
        ("One.", "dropped", "Admin Person"),
        ("Two.", "retried", "Admin Person"),
    ]
    assert settled[0]["settled_at"] >= settled[1]["settled_at"]
    assert [each["id"] for each in ask(admin, "dead-letters?state=open")] == [still_open]
    assert [each["id"] for each in ask(admin, "dead-letters")] == [still_open, second, first]


def test_strangers_and_operators_cannot_tell_what_was_set_aside(other: str) -> None:
    letter = set_aside(other, "Broken.")
    stranger = post(signed_in("admin"), letter, "retry")
    nothing = post(signed_in("admin"), letter + 1, "retry")
    assert stranger == nothing
    assert stranger[0] == 404
    mine = set_aside("hall", "Broken.")
    assert [post(signed_in("operator"), mine, what)[0] for what in ("retry", "drop")] == [403, 403]
    assert DeadLetter.objects.filter(state="open").count() == 2


def test_an_admin_sees_each_process_and_who_leads(hall: str) -> None:
    began = timezone.now()
    make_process("ticker", "t1", activity="leads", clock_apart_s=0.01)
    make_process("web", "w1", seconds=20)
    make_process("gateway", "g1", seconds=60, ended_at=timezone.now())
    Lease.objects.create(name="ticker", holder="m1:7", until=timezone.now() + timedelta(seconds=4))
    told = ask(signed_in("admin"), "processes")
    assert [(each["kind"], each["state"], each["activity"]) for each in told["processes"]] == [
        ("gateway", "ended", ""),
        ("ticker", "beats", "leads"),
        ("web", "silent", ""),
    ]
    assert 20 <= told["processes"][2]["age_s"] <= (timezone.now() - began).total_seconds() + 21
    ((job, holder, held_s),) = [each.values() for each in told["leases"]]
    assert (job, holder, 2 < held_s <= 4) == ("ticker", "m1:7", True)


@pytest.mark.parametrize("what", ["operations", "findings", "processes"])
def test_a_hundred_sites_and_a_thousand_commands_cost_no_question_more(hall: str, what: str) -> None:
    client = signed_in("admin")

    def questions() -> int:
        with CaptureQueriesContext(connection) as asked:
            ask(client, what)
        return len(asked)

    ask(client, what)
    make_command(hall, 60, run=make_run(hall).pk)
    make_process("web")
    few = questions()
    for number in range(100):
        registry.create_site(name=f"Site {number}", slug=f"site-{number}")
    for number in range(500):
        make_process("worker", f"w{number}")
    for number in range(200):
        make_command(hall, 60, run=make_run(hall, number=number + 2).pk)
    assert questions() <= few + 1  # how many are overdue is counted once there are more than are shown


def test_tasks_that_wait_are_counted_in_the_tasks_own_broker(hall: str) -> None:
    before = services.read_task_queues()["runs"]
    assert sorted(services.read_task_queues()) == ["rehearsals", "runs", "upkeep"]
    current_app.send_task("execution.tasks.advance_site", args=["nowhere"])
    assert services.read_task_queues()["runs"] == before + 1
    with current_app.connection_for_write() as link:
        link.default_channel.queue_purge("runs")
    assert services.read_task_queues()["runs"] == 0


def test_every_answer_has_the_id_of_its_request_and_no_other_text(hall: str) -> None:
    client = signed_in("viewer")
    assert client.get("/api/me", headers={"X-Request-ID": "line-7.a_B"}).headers["X-Request-ID"] == "line-7.a_B"
    for odd in ("", "a b", "x" * 65, "a\tb", "<script>", "é"):
        given = client.get("/api/me", headers={"X-Request-ID": odd}).headers["X-Request-ID"]
        assert given != odd
        assert len(given) == 32

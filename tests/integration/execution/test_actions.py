"""Actions of the Web of Things: a device's method invoked over HTTP, with its result, by the rules of a call."""

from contextlib import suppress
from datetime import UTC, datetime
from threading import Thread
from uuid import uuid4

import pytest
from django.db import OperationalError, connections
from django.test import Client

from execution.commands import invocations
from execution.commands.outbox import record_ack
from execution.models import Command
from registry import services as registry
from registry.models import Device
from tests.kit.programs import SITE
from tests.kit.sign_in import EVERYBODY, ROLES, find_person, from_role, join_and_sign_in, post_json
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.django_db(transaction=True)
THING = f"/api/sites/{SITE}/things/urn:vipo:device:paintMixer01"
MIX = f"{THING}/actions/mixPaint"


@pytest.fixture(autouse=True)
def impatient(monkeypatch):
    monkeypatch.setattr(invocations, "MOST_WAIT_S", 0.1)


def program(*scopes):
    """Return a client with a token of the operator's, and no cookie."""
    join_and_sign_in("operator", SITE)
    now = datetime.now(UTC)
    _, text = registry.create_token(
        user=find_person("operator"), site=SITE, name="A program", scopes=scopes, days=1, now=now
    )
    return Client(enforce_csrf_checks=True, headers={"Authorization": f"Bearer {text}"})


def answer_meanwhile(monkeypatch, status, **more):
    """Let the device answer the next command while its caller waits."""
    monkeypatch.setattr(invocations, "MOST_WAIT_S", 30.0)
    said = {"status": status, "why": "", "result": {}, "at": datetime.now(UTC), **more}

    def answer():
        command = wait_for("the command", Command.objects.first, 30, every_s=0.05)
        wait_for("the answer to be taken", lambda: is_taken(command), 30, every_s=0.05)
        connections.close_all()

    def is_taken(command):
        with suppress(OperationalError):  # SQLite is written to by one alone
            return record_ack(device="paintMixer01", command_id=str(command.id), **said)

    thread = Thread(target=answer)
    thread.start()
    return thread


def test_an_action_answers_with_what_the_device_said(factory, monkeypatch):
    thread = answer_meanwhile(monkeypatch, "DONE", result={"shade": "red"})
    answer = post_json(program("operate"), MIX, {"time": 2})
    thread.join()
    command = Command.objects.get()
    assert (command.by, command.arguments) == ("Operator Person", {"time": 2})
    assert answer.status_code == 200
    assert answer["Location"] == f"{MIX}/{command.id}"
    body = answer.json()
    assert (body["status"], body["output"], body["href"]) == ("completed", {"shade": "red"}, answer["Location"])
    assert body.keys() == {"status", "output", "href", "timeRequested", "timeEnded"}


def test_an_action_that_failed_is_a_refusal_in_the_devices_words(factory, monkeypatch):
    thread = answer_meanwhile(monkeypatch, "FAILED", why="The lid is open.")
    client = program("operate")
    answer = post_json(client, MIX, {"time": 2})
    thread.join()
    body = answer.json()
    assert (answer.status_code, body["code"], body["detail"]) == (409, "action_failed", "The lid is open.")
    assert body["args"] == {"call": str(Command.objects.get().id), "status": "failed"}
    asked = client.get(f"{MIX}/{body['args']['call']}").json()
    assert (asked["status"], asked["error"]["detail"]) == ("failed", "The lid is open.")


def test_an_action_that_takes_longer_is_asked_for_and_can_be_ended(factory):
    client = program("operate")
    answer = post_json(client, MIX, {"time": 2})
    assert (answer.status_code, answer.json()["status"]) == (202, "pending")
    assert client.get(answer["Location"]).json() == answer.json()
    ended = client.delete(answer["Location"])
    assert (ended.status_code, ended.json()["href"]) == (202, answer["Location"])
    factory.go(lambda: Command.objects.get(method="mixPaint").status not in Command.OPEN, dt_s=1.0)
    assert client.get(answer["Location"]).json()["status"] == "failed"


def test_an_action_without_arguments_needs_no_body(factory):
    client = program("operate")
    assert client.generic("POST", MIX).json()["detail"] == "time: give a value, mixPaint needs it."


@pytest.mark.parametrize(
    ("body", "status", "code"),
    [
        ({"time": 61}, 422, "bad_arguments"),
        ({"time": "2"}, 422, "bad_arguments"),
        ({"time": 2, "nonsense": True}, 422, "bad_arguments"),
        ({"time": "\0"}, 422, "bad_request"),
        ([1], 422, "bad_request"),
        ("2", 422, "bad_request"),
    ],
)
def test_arguments_that_do_not_fit_are_refused_before_anything_moves(factory, body, status, code):
    answer = post_json(program("operate"), MIX, body)
    assert (answer.status_code, answer.json()["code"]) == (status, code)
    assert Command.objects.count() == 0


@pytest.mark.parametrize("role", EVERYBODY)
def test_operators_and_above_may_invoke_and_members_may_ask(factory, role):
    client = join_and_sign_in(role, SITE)
    allowed = role in from_role("operator")
    refused = 202 if allowed else {"stranger": 404, "nobody": 401}.get(role, 403)
    assert post_json(client, MIX, {"time": 2}).status_code == refused
    assert Command.objects.count() == (1 if allowed else 0)
    if not allowed:
        post_json(program("operate"), MIX, {"time": 2})
    there = f"{MIX}/{Command.objects.get().id}"
    assert client.get(there).status_code == (200 if role in ROLES else refused)
    assert client.delete(there).status_code == refused


def test_a_token_for_reading_invokes_nothing(factory):
    answer = post_json(program("read"), MIX, {"time": 2})
    assert (answer.status_code, answer.json()["code"]) == (403, "insufficient_scope")


def test_an_action_is_found_under_its_own_thing_and_name_alone(factory):
    client = program("operate")
    call = post_json(client, MIX, {"time": 2})["Location"].rsplit("/", 1)[1]
    for elsewhere in (
        f"{THING}/actions/dispense/{call}",
        f"/api/sites/{SITE}/things/paintMixer02/actions/mixPaint/{call}",
        f"{MIX}/{uuid4()}",
    ):
        assert (client.get(elsewhere).status_code, client.delete(elsewhere).status_code) == (404, 404)


def test_a_stopped_site_and_a_busy_or_absent_device_refuse(factory):
    client = program("operate")
    assert post_json(client, MIX, {"time": 2}).status_code == 202
    assert "still carries out mixPaint" in post_json(client, MIX, {"time": 2}).json()["detail"]
    Device.objects.filter(pk="paintMixer02").update(online=False)
    other = f"/api/sites/{SITE}/things/paintMixer02/actions/mixPaint"
    assert "is offline" in post_json(client, other, {"time": 2}).json()["detail"]
    post_json(client, f"/api/sites/{SITE}/stop")
    stopped = post_json(client, MIX, {"time": 2})
    assert (stopped.status_code, stopped.json()["detail"]) == (409, "The site is stopped. Reset the stop first.")
    assert Command.objects.filter(method="mixPaint").count() == 1


def test_an_action_with_a_key_is_done_once(factory):
    client = program("operate")
    first, second = (
        client.post(MIX, {"time": 2}, content_type="application/json", headers={"Idempotency-Key": "a"})
        for _ in range(2)
    )
    assert (first.json(), first["Location"]) == (second.json(), second["Location"])
    assert Command.objects.count() == 1


def test_who_finds_no_place_to_wait_has_moved_nothing(factory, monkeypatch):
    monkeypatch.setattr(invocations, "_slots", registry.Slots(in_all=0, of_site=0, of_person=0))
    answer = post_json(program("operate"), MIX, {"time": 2})
    assert (answer.status_code, answer.json()["code"], answer["Retry-After"]) == (429, "too_many_waiting", "5")
    assert Command.objects.count() == 0

"""Every operation of the API with a token of each scope: what it may do, and that it does nothing anywhere else."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any
from uuid import uuid4

import pytest
from django.db import transaction
from django.test import Client

from editor import services as editor
from execution.models import Question, Rehearsal, Run
from registry import services
from registry.models import ApiToken, Device, DeviceAlert, Site
from registry.people.access import SCOPES
from registry.thing_directory import property_values
from tests.kit.files import ROOT
from tests.kit.sign_in import find_person
from tests.kit.sites import MIXER, describe, make_mixers

NOW = datetime.now(UTC)
ANSWER = {"type": "boolean", "unit": "", "minimum": None, "maximum": None, "options": []}
OPERATIONS = json.loads((ROOT / "docs" / "openapi.json").read_text())["paths"]
NEEDED = {
    name: scope
    for scope, names in {
        "anybody": "show_me sign_in",
        "session": "sign_out change_my_password sign_out_everywhere upload_site list_tokens create_token revoke_token",
        "read": """search_library show_function show_function_version show_program show_compiled show_document
            read_expression list_versions get_rehearsal get_run list_events list_sites list_armed get_call
            list_questions plan_route plan_routes list_runs show_site list_alerts look_at_description list_devices
            export_devices show_device list_device_events show_property_history show_robot_map download_robot_pgm
            download_robot_yaml show_robot_cells show_difference show_rdf show_map download_pgm download_yaml
            show_cells list_map_versions current probe sample current_of_device probe_device sample_of_device
            list_programs ask post_query list_things watch_things show_thing
            show_values show_value watch_value await_next_value query_action""",
        "operate": "mark_seen mark_all_seen call_method cancel_call invoke_action cancel_action press_stop reset_stop",
        "run": """start_rehearsal start_run pause_run resume_run cancel_run answer_question arm_program delete_program
            rename_program draw_script pin_version save_function create_program""",
        "admin": """edit_device approve_device reject_device retire_device readmit_device rotate_credential
            revoke_credential confirm_topic withdraw_topic renew_enrolment_key reserve_device use_robot_map
            restore_map patch_thing""",
    }.items()
    for name in names.split()
}
"""What each operation asks of a token; whoever adds an operation adds it here."""
BODIES: dict[str, Any] = {
    "rename_program": {"name": "Other"},
    "arm_program": {"on": False},
    "read_expression": {"value": None, "step": ""},
    "draw_script": {"text": ""},
    "answer_question": {"value": True},
    "call_method": {"method": "none"},
    "plan_route": {"from": [1, 1], "to": [2, 2]},
    "plan_routes": {"pairs": []},
    "look_at_description": {"text": ""},
    "confirm_topic": {"topic": "a"},
    "withdraw_topic": {"topic": "a"},
    "save_function": {"program": str(uuid4()), "function": "f", "name": "F"},
    "use_robot_map": {"device": "a", "version": 1, "replaces": 1},
    "restore_map": {"version": 1, "replaces": 1},
    "reserve_device": {"id": "mixer-9"},
    "create_program": {"name": "New"},
    "create_token": {"name": "Other", "scopes": ["read"]},
}


@pytest.fixture(autouse=True)
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(property_values, "MOST_POLL_S", 0.0)


@pytest.fixture
def ids(hall: str) -> dict[str, str]:
    """What stands in the addresses: one of each thing at the hall."""
    make_mixers("a", "b")
    services.create_site(name="Shed", slug="shed")
    services.set_member(site="shed", email="admin@vipo.example", role="admin")
    methods = (replace(MIXER.methods[0], topic="vipo/v1/dev/there/down/mix"),)
    describe(replace(MIXER, id="there", site="shed", methods=methods))
    Device.objects.filter(pk="there").update(lifecycle="approved")
    site = Site.objects.get(slug="hall")
    program = editor.create_program(site="hall", name="Mix").id
    run = Run.objects.create(site=site, number=1, program=program, program_name="Mix", created_at=NOW)
    question = Question.objects.create(run=run, number=1, step="a", text="Go?", answer=ANSWER, asked_at=NOW)
    rehearsal = Rehearsal.objects.create(site=site, program=program, job={}, created_at=NOW)
    alert = DeviceAlert.objects.create(device_id="a", code="offline", first_at=NOW, last_at=NOW)
    names = {"program": program, "run": run.pk, "question": question.pk, "rehearsal": rehearsal.pk}
    here = {"alert_id": alert.pk, "device_id": "a", "device": "a", "thing": "a", "slug": "hall", "site": "hall"}
    here |= {"name": "jobStatus", "action": "mix"}
    absent = {"call": uuid4(), "function": uuid4(), "number": 1, "token_id": "0" * 16}
    return {name: str(value) for name, value in {**names, **here, **absent}.items()}


def make_token(*scopes: str, site: str = "hall", person: str = "admin", days: int = 1) -> str:
    made = services.create_token(
        user=find_person(person), site=site, name="A program", scopes=scopes, days=days, now=datetime.now(UTC)
    )
    return made[1]


@contextmanager
def undone() -> Iterator[None]:
    """Take back what happens in it."""
    with transaction.atomic():
        yield
        transaction.set_rollback(True)


def answers(token: str, ids: dict[str, str]) -> dict[str, Any]:
    """Return what each operation answers a token, each asked as if it were the first."""
    client, found = Client(enforce_csrf_checks=True, headers={"Authorization": f"Bearer {token}"}), {}
    for path, calls in OPERATIONS.items():
        for method, call in calls.items():
            with undone():
                found[call["operationId"]] = ask(client, method, path.format(**ids), call)
    return found


def ask(client: Client, method: str, path: str, call: dict[str, Any]) -> Any:
    name = call["operationId"]
    if name == "post_query":
        return client.post(path, "ASK {}", content_type="application/sparql-query")
    if name == "upload_site":
        return client.post(path, {"name": "New"})
    if name == "sign_in":
        return client.post(path, {"email": "a", "password": "b"}, content_type="application/json")
    if name == "patch_thing":
        return client.patch(path, {}, content_type="application/merge-patch+json")
    if name == "show_property_history":
        path += "?property=jobStatus"
    if method == "get":
        return client.get(path)
    return getattr(client, method)(path, BODIES.get(name, {}), content_type="application/json")


def test_every_operation_stands_in_the_table_once() -> None:
    assert {call["operationId"] for calls in OPERATIONS.values() for call in calls.values()} == set(NEEDED)


@pytest.mark.parametrize("scopes", [*((scope,) for scope in SCOPES), ("operate", "run")])
def test_a_token_does_what_its_scopes_say_and_no_more(ids: dict[str, str], scopes: tuple[str, ...]) -> None:
    odd = {}
    for name, answer in answers(make_token(*scopes), ids).items():
        needed = NEEDED[name]
        if needed == "session":
            fits = (answer.status_code, answer.json()["code"]) == (403, "not_for_tokens")
        elif needed in ("anybody", "read", *scopes) or "admin" in scopes:
            fits = needed == "anybody" or answer.status_code not in (401, 403, 500)
        else:
            fits = (answer.status_code, answer.json()["code"]) == (403, "insufficient_scope")
            fits = fits and answer["WWW-Authenticate"] == 'Bearer error="insufficient_scope"'
        if not fits:
            odd[name] = (needed, answer.status_code, answer.content[:200])
    assert odd == {}


@pytest.mark.parametrize(("role", "most"), [("viewer", "read"), ("operator", "operate"), ("author", "run")])
def test_a_token_may_no_more_than_its_person_may_at_that_moment(ids: dict[str, str], role: str, most: str) -> None:
    token = make_token("admin")
    services.set_member(site="hall", email="admin@vipo.example", role=role)
    seen = answers(token, ids)
    refused = {name for name in seen if NEEDED[name] != "anybody" and seen[name].status_code == 403}
    runs = {"start_rehearsal", "start_run", "pause_run", "resume_run", "cancel_run", "answer_question", "arm_program"}
    allowed = {"read": {"press_stop"}, "operate": runs, "run": set()}[most]
    beyond = SCOPES[SCOPES.index(most) + 1 :]
    expected = {name for name, needed in NEEDED.items() if needed in (*beyond, "session")} - allowed
    assert refused == expected


def test_at_other_sites_of_its_person_a_token_is_a_strangers(ids: dict[str, str]) -> None:
    token = make_token("admin", site="shed")
    seen = answers(token, ids)
    listed = {name for name, answer in seen.items() if answer.status_code == 200}
    assert listed == {"show_me", "list_sites", "search_library"}
    assert [site["slug"] for site in seen["list_sites"].json()] == ["shed"]
    assert {a.status_code for n, a in seen.items() if n not in listed and NEEDED[n] not in ("session", "anybody")} == {
        404
    }
    client = Client(headers={"Authorization": f"Bearer {token}"})
    assert [thing["id"] for thing in client.get("/things").json()] == ["urn:vipo:device:there"]
    assert (client.get("/things/a").status_code, client.get("/things/there").status_code) == (404, 200)


@pytest.mark.parametrize("end", ["expired", "revoked", "removed", "closed", "another secret"])
def test_a_token_that_has_ended_opens_nothing(ids: dict[str, str], end: str) -> None:
    token = make_token("admin")
    if end == "expired":
        ApiToken.objects.update(expires_at=datetime.now(UTC))
    elif end == "revoked":
        services.revoke_token(token_id=token.split("_")[1])
    elif end == "removed":
        services.remove_member(site="hall", email="admin@vipo.example")
        services.set_member(site="hall", email="admin@vipo.example", role="admin")
    elif end == "closed":
        person = find_person("admin")
        person.is_active = False
        person.save()
    else:
        token = token[:-1] + ("a" if token[-1] != "a" else "b")
    odd = {}
    for name, answer in answers(token, ids).items():
        if NEEDED[name] not in ("anybody", "session") and (
            answer.status_code,
            answer["Content-Type"],
            answer.json()["code"],
            answer.get("WWW-Authenticate"),
        ) != (401, "application/problem+json", "invalid_token", 'Bearer error="invalid_token"'):
            odd[name] = (answer.status_code, answer.content[:100])
    assert odd == {}

"""Who may do what over HTTP; strangers do not learn what exists."""

import json
from uuid import uuid4

import pytest
from django.test import Client

from editor import services as editor
from editor.documents.shared_document import empty_document, encode_document
from editor.documents.store import Change, append_changes
from execution import services
from execution.models import Rehearsal, Run
from registry.models import Device
from tests.kit.programs import SITE, TASK
from tests.kit.sign_in import ROLES, below_role, join_and_sign_in, post_json
from tests.kit.sites import NOW

pytestmark = pytest.mark.django_db(transaction=True)


@pytest.fixture
def program(factory):
    return editor.create_program(site=SITE, name="Task", document=TASK).id


def post(client, path, body=None):
    return post_json(client, f"/api{path}", body).status_code


def all_calls(program, run, rehearsal):
    here = {"from": [2.3, -8.0], "to": {"device": "paintMachine01"}}
    return {
        ("get", f"/sites/{SITE}/runs"): "viewer",
        ("get", f"/runs/{run}"): "viewer",
        ("get", f"/runs/{run}/events"): "viewer",
        ("get", f"/runs/{run}/timeline"): "viewer",
        ("get", f"/rehearsals/{rehearsal}"): "viewer",
        ("get", f"/sites/{SITE}/rehearsals"): "viewer",
        ("post", f"/sites/{SITE}/route", json.dumps(here)): "viewer",
        ("post", f"/sites/{SITE}/routes", json.dumps({"pairs": [here]})): "viewer",
        ("get", f"/programs/{program}/version-runs?oldest=1&newest=9"): "viewer",
        ("post", f"/programs/{program}/rehearsals"): "operator",
        ("post", f"/rehearsals/{rehearsal}/cancel"): "operator",
        ("post", f"/programs/{program}/runs"): "operator",
        ("post", f"/runs/{run}/pause"): "operator",
        ("post", f"/runs/{run}/resume"): "operator",
        ("post", f"/runs/{run}/cancel"): "operator",
        ("get", f"/sites/{SITE}/questions"): "viewer",
        ("get", f"/sites/{SITE}/armed"): "viewer",
        ("post", f"/programs/{program}/arm", '{"on": false}'): "operator",
        ("post", f"/sites/{SITE}/stop/reset"): "operator",
        ("post", f"/sites/{SITE}/stop"): "viewer",
    }


@pytest.mark.parametrize("role", ["stranger", *ROLES])
def test_each_call_is_open_to_its_role_and_above(program, role):
    operator = join_and_sign_in("operator", SITE) if role != "operator" else None
    client = join_and_sign_in(role, SITE)
    starter = operator or client
    run = post_json(starter, f"/api/programs/{program}/runs").json()["id"]
    rehearsal = post_json(starter, f"/api/programs/{program}/rehearsals").json()["id"]
    runs, rehearsals = Run.objects.count(), Rehearsal.objects.count()
    seen = {}
    for call, needed in all_calls(program, run, rehearsal).items():
        method, path, body = (*call, None)[:3]
        status = post(client, path, json.loads(body) if body else None) if method == "post" else client.get(
            f"/api{path}"
        ).status_code  # fmt: skip
        granted = 202 if path.endswith(("/rehearsals", "/runs")) and method == "post" else 200
        allowed = role in ROLES and ROLES.index(role) >= ROLES.index(needed)
        seen[call[:2]] = (status, granted if allowed else 404 if role == "stranger" else 403)
    assert {call: status for call, (status, _) in seen.items()} == {call: wanted for call, (_, wanted) in seen.items()}
    if role in {"stranger", *below_role("operator")}:
        assert (Run.objects.count(), Rehearsal.objects.count()) == (runs, rehearsals)
    assert services.is_stopped(site=SITE) is (role != "stranger")


def test_nobody_who_is_not_signed_in_gets_an_answer(program):
    assert Client().get(f"/api/sites/{SITE}/runs").status_code == 401
    assert post(Client(), f"/sites/{SITE}/stop") == 401
    assert services.is_stopped(site=SITE) is False


def test_what_does_not_exist_is_not_found(factory):
    client = join_and_sign_in("admin", SITE)
    for path in (f"/runs/{uuid4()}", f"/rehearsals/{uuid4()}", f"/runs/{uuid4()}/events", "/sites/nowhere/runs"):
        assert client.get(f"/api{path}").status_code == 404
    assert post(client, f"/programs/{uuid4()}/runs") == 404


def test_a_program_with_errors_is_not_started_and_the_answer_says_why(factory):
    program = editor.create_program(site=SITE, name="Empty").id
    client = join_and_sign_in("operator", SITE)
    answer = client.post(f"/api/programs/{program}/runs", "{}", content_type="application/json")
    assert (answer.status_code, answer.json()["code"]) == (422, "not_ready")
    assert answer.json()["detail"].startswith("The program has one error and cannot be carried out.")
    args = answer.json()["args"]
    assert (args["why"], args["count"], args["first"].keys()) == ("errors", 1, {"en", "de"})
    assert Run.objects.count() == 0


def test_a_version_of_before_is_run_and_one_that_is_not_there_is_absent(factory, program):
    client = join_and_sign_in("operator", SITE)
    version = editor.pin_version(program_id=program, user=None)
    assert (version.number, version.cause) == (1, "")
    later = encode_document({**empty_document(), "steps": {"later": {"kind": "wait", "place": None, "params": {}}}})
    append_changes(program, [Change(None, later)], NOW)
    run = post_json(client, f"/api/programs/{program}/runs", {"version": 1}).json()
    assert client.get(f"/api/runs/{run['id']}").json()["document"]["steps"].keys() == {"s1"}
    assert [each.number for each in editor.list_versions(program_id=program)] == [1]
    post_json(client, f"/api/programs/{program}/rehearsals")
    assert [(each.number, each.cause) for each in editor.list_versions(program_id=program)] == [
        (2, "rehearsal"),
        (1, ""),
    ]
    absent = client.post(f"/api/programs/{program}/runs", '{"version": 9}', content_type="application/json")
    assert (absent.status_code, absent.json()["detail"]) == (404, "The program has no version 9.")


def test_routes_that_do_not_exist_are_null_among_others(factory):
    client = join_and_sign_in("viewer", SITE)
    pairs = [
        {"from": {"device": "itemInventory01"}, "to": {"device": "paintMachine01"}},
        {"from": [2.3, -8.0], "to": {"device": "nothing"}},
        {"from": [2.3, -8.0], "to": {"point": ["a", None]}},
    ]
    answer = client.post(f"/api/sites/{SITE}/routes", json.dumps({"pairs": pairs}), content_type="application/json")
    assert answer.json() == [
        {"path": [[2.3, -2.93], [2.3, -7.65], [20.9, -7.65], [20.9, -4.23]], "length_m": 26.74, "seconds": 13},
        None,
        None,
    ]


def test_routes_are_told_though_a_stored_description_has_a_speed_that_is_refused_today(factory):
    row = Device.objects.get(id="robot01")
    Device.objects.filter(id="robot01").update(
        description={**row.description, "speed_m_s": 1e-310}, description_hash="of before"
    )
    client = join_and_sign_in("viewer", SITE)
    pairs = [{"from": {"device": "itemInventory01"}, "to": {"device": "paintMachine01"}}]
    answer = client.post(f"/api/sites/{SITE}/routes", json.dumps({"pairs": pairs}), content_type="application/json")
    assert answer.json()[0]["length_m"] == 26.74


def test_a_run_over_http_reaches_its_end(factory, program):
    client = join_and_sign_in("operator", SITE)
    run = post_json(client, f"/api/programs/{program}/runs").json()
    assert (run["status"], run["program"]["name"], run["version"]) == ("pending", "Task", 1)
    factory.go(lambda: client.get(f"/api/runs/{run['id']}").json()["status"] == "finished")
    view = client.get(f"/api/runs/{run['id']}").json()
    assert view["steps"]["s1"]["status"] == "done"
    assert view["document"]["steps"].keys() == {"s1"}
    assert "class Task(object):" in view["compiled"]["script"]
    events = client.get(f"/api/runs/{run['id']}/events").json()
    later = client.get(f"/api/runs/{run['id']}/events?after={events[2]['seq']}").json()
    assert later == events[3:]

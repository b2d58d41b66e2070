"""What a run is given for its parameters is held against its program before anything starts; so is a rehearsal."""

from __future__ import annotations

import json
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from django.test import Client

from editor import services as editor
from execution.models import Rehearsal, Run
from tests.kit.programs import OVEN, SITE, TASK, step
from tests.kit.sign_in import join_and_sign_in

pytestmark = pytest.mark.django_db(transaction=True)
PARAMETERS = {
    "p1": {"name": "minutes", "type": "number", "unit": "MIN", "default": 5},
    "p2": {"name": "is paint dry", "type": "boolean", "default": True},
    "p3": {"name": "colour", "type": "object", "default": "red"},
    "p4": {"name": "oven", "type": "device", "default": OVEN},
    "p5": {"name": "where", "type": "place", "default": OVEN},
    "p6": {"name": "note", "type": "text", "default": ""},
    "p7": {"name": "count", "type": "number"},
}
FITTING = {"minutes": 2.5, "is paint dry": False, "colour": "blue", "oven": OVEN, "where": OVEN, "count": 3}


@pytest.fixture
def program(factory: Any) -> str:
    document = {**TASK, "parameters": PARAMETERS}
    return str(editor.create_program(site=SITE, name="Task", document=document).id)


def send(client: Client, path: str, body: str) -> Any:
    return client.post(f"/api{path}", body, content_type="application/json")


@pytest.mark.parametrize("kind", ["runs", "rehearsals"])
@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("minutes", "two", "The parameter “minutes” must be a number in min, at most 1e+15."),
        ("minutes", True, "The parameter “minutes” must be a number in min, at most 1e+15."),
        ("count", 2e15, "The parameter “count” must be a number, at most 1e+15."),
        ("is paint dry", 1, "The parameter “is paint dry” must be true or false."),
        ("colour", " ", "The parameter “colour” must name a kind of object, in one line of 1 to 500 characters."),
        ("oven", "toaster", "The parameter “oven” must be the id of a device that takes part at this site."),
        ("where", "nowhere", "The parameter “where” must be the id of a place or device of this site."),
        ("note", "x" * 501, "The parameter “note” must be a text of at most 500 characters."),
        ("count", None, "The parameter “count” needs a value."),
        ("speed", 1, "The program has no parameter called “speed”. It has: minutes, is paint dry, colour, oven, where, "
         "note, count."),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_refused_by_name(program: str, kind: str, name: str, value: Any, told: str) -> None:
    body = json.dumps({"parameters": {**FITTING, name: value}})
    answer = send(join_and_sign_in("operator", SITE), f"/programs/{program}/{kind}", body)
    assert (answer.status_code, answer.json()["code"], answer.json()["detail"]) == (422, "not_ready", told)
    assert (Run.objects.count(), Rehearsal.objects.count()) == (0, 0)


def test_what_is_left_out_has_its_default_and_names_are_those_of_the_document(program: str) -> None:
    answer = send(join_and_sign_in("operator", SITE), f"/programs/{program}/runs", json.dumps({"parameters": FITTING}))
    assert answer.status_code == 202, answer.json()
    kept = Run.objects.get().parameters
    assert kept == {
        "minutes": 2.5, "is_paint_dry": False, "colour": "blue", "oven": OVEN, "where": OVEN, "note": "", "count": 3,
    }  # fmt: skip


def cooking_program() -> str:
    """Return a program that heats in whatever is chosen, and watches it."""
    chosen = {"param": "oven"}
    wait = step("wait", order="2V", until={"op": ">", "args": [{"property": [chosen, "temperature"]}, 20]})
    steps = {"s1": step("operate", device=chosen, method="curePaint", args={"time": 3}), "s2": wait}
    document = {**TASK, "steps": steps, "parameters": {"p4": PARAMETERS["p4"]}}
    return str(editor.create_program(site=SITE, name="Cook", document=document).id)


@pytest.mark.parametrize("kind", ["runs", "rehearsals"])
def test_a_device_that_cannot_do_what_the_program_does_with_it_is_refused_by_name(factory: Any, kind: str) -> None:
    program, client = cooking_program(), join_and_sign_in("operator", SITE)
    answer = send(client, f"/programs/{program}/{kind}", json.dumps({"parameters": {"oven": "paintMachine01"}}))
    told = "The device “Painting Machine” does not fit the parameter “oven”. "
    cannot = "Painting Machine cannot curePaint. It can: paint."
    assert (answer.status_code, answer.json()["code"], answer.json()["detail"]) == (422, "not_ready", told + cannot)
    args = answer.json()["args"]
    assert (args["why"], args["name"], args["device"]) == ("parameter_cannot", "oven", "Painting Machine")
    assert args["first"] == {"en": cannot, "de": "Painting Machine kann curePaint nicht. Es kann: paint."}
    assert (Run.objects.count(), Rehearsal.objects.count()) == (0, 0)
    answer = send(client, f"/programs/{program}/{kind}", json.dumps({"parameters": {"oven": OVEN}}))
    assert answer.status_code == 202, answer.json()


def test_a_planned_run_is_refused_when_it_is_planned_and_a_program_when_it_is_armed(factory: Any) -> None:
    client = join_and_sign_in("operator", SITE)
    later = (datetime.now(UTC) + timedelta(hours=1)).isoformat()
    body = json.dumps({"parameters": {"oven": "paintMachine01"}, "not_before": later})
    answer = send(client, f"/programs/{cooking_program()}/runs", body)
    assert (answer.status_code, answer.json()["args"]["why"]) == (422, "parameter_cannot")
    chosen = {"p4": {**PARAMETERS["p4"], "default": "paintMachine01"}}
    hot = {"op": ">", "args": [{"property": [OVEN, "temperature"]}, 60]}
    event = step("on_event", ("program", "events"), starts="run", condition=hot)
    cook = step("operate", ("e1", "body"), device={"param": "oven"}, method="curePaint", args={"time": 3})
    document = {**TASK, "steps": {**TASK["steps"], "e1": event, "s2": cook}, "parameters": chosen}
    program = editor.create_program(site=SITE, name="Armed", document=document).id
    answer = send(client, f"/programs/{program}/arm", json.dumps({"on": True}))
    assert (answer.status_code, answer.json()["args"]["why"]) == (422, "parameter_cannot"), answer.json()


@pytest.mark.parametrize(
    ("body", "status", "named"),
    [
        ('{"parameters": {"count": NaN}}', 400, "NaN"),
        ('{"parameters": {"count": 1e999}}', 400, "1e999"),
        ('{"parameters": {"count": 10000000000000000000000}}', 400, "10000000000000000000000"),
        ('{"parameters": {"count": 1, "count": 2}}', 400, "'count'"),
        ('{"parameters": {"note": "a\\u0000"}}', 422, "body.parameters.note"),
        ('{"parameters": {"note": "\\ud800"}}', 422, "body.parameters.note"),
        ('{"seed": -1}', 422, "body.seed"),
        ('{"seed": 2147483648}', 422, "body.seed"),
        ('{"seed": true}', 422, "body.seed"),
        ('{"seed": 1.5}', 422, "body.seed"),
        ('{"driver": "teleport"}', 422, "body.driver"),
        ('{"speed": 3}', 422, "body.speed"),
    ],
)
def test_what_a_rehearsal_is_asked_with_is_read_with_suspicion(
    program: str, body: str, status: int, named: str
) -> None:
    answer = send(join_and_sign_in("operator", SITE), f"/programs/{program}/rehearsals", body)
    assert (answer.status_code, named in answer.json()["detail"]) == (status, True), answer.json()
    assert Rehearsal.objects.count() == 0

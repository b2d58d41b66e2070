"""A program into which somebody wrote what has no business there: every call answers, and lists show it."""

from __future__ import annotations

from typing import Any

import pytest
from django.test import Client
from django.utils import timezone
from pycrdt import Doc, Map

from editor import services
from editor.documents.shared_document import ROOTS
from editor.documents.store import Change, append_changes, compact_document
from editor.models import Program
from registry import services as registry
from tests.kit.sign_in import find_person, join_and_sign_in

pytestmark = pytest.mark.django_db
ODD: dict[str, dict[str, Any]] = {
    "a step that is a text": {"steps": {"k": "zzz"}},
    "a step that is a list": {"steps": {"k": [1, 2]}},
    "a step of odd parts": {"steps": {"k": {"kind": [], "place": "x", "pos": "left", "params": [1]}}},
    "a call with odd parameters": {"steps": {"k": {"kind": "call", "place": ["program", "body"], "params": "f"}}},
    "a function that is a number": {"functions": {"f": 7}},
    "a function of odd parts": {"functions": {"f": {"name": [], "parameters": "n", "source": [], "result": 3}}},
    "parameters that are none": {"functions": {"f": {"name": "f", "parameters": [7, {"name": {}}]}}},
    "a role that is a list": {"roles": {"r": []}},
    "a parameter that is a text": {"parameters": {"p": "n"}},
    "a zone that is a number": {"zones": {"z": 1.5}},
    "a start that is a word": {"meta": {"start_pos": "left"}},
    "a format that is a list": {"meta": {"format": [2]}},
}


@pytest.fixture
def client() -> Client:
    registry.create_site(name="Hall", slug="hall")
    return join_and_sign_in("author", "hall")


def program_with(odd: dict[str, Any]) -> str:
    author = find_person("author")
    program = str(services.create_program(site="hall", name="Odd", user=author).id)
    theirs = Doc[Any]()
    for root in ROOTS:
        for key, value in odd.get(root, {}).items():
            theirs.get(root, type=Map)[key] = value
    append_changes(program, [Change(author.pk, theirs.get_update())], timezone.now())
    Program.objects.filter(pk=program).update(checked_against="")
    return program


@pytest.mark.parametrize("odd", ODD.values(), ids=ODD.keys())
def test_every_call_of_an_odd_program_answers(odd: dict[str, Any], client: Client) -> None:
    program = program_with(odd)
    at = f"/api/programs/{program}"
    (listed,) = client.get("/api/sites/hall/programs").json()
    assert (listed["id"], listed["errors"] + listed["warnings"] > 0) == (program, True)
    compiled = client.get(f"{at}/compiled").json()
    assert all(set(found["messages"]) == {"en", "de"} for found in compiled["diagnostics"])
    read = client.get(f"{at}/document")
    script = client.get(f"{at}/script")
    answers = {
        "document": read.status_code,
        "script": script.status_code,
        "draw": client.post(f"{at}/script", {"text": script.content.decode()}, "application/json").status_code,
        "pin": client.post(f"{at}/versions", {"message": "odd"}, "application/json").status_code,
        "version": client.get(f"{at}/versions/1").status_code,
        "expression": client.post(f"{at}/expression", {"text": "1 + 1", "step": "k"}, "application/json").status_code,
    }
    assert answers == {**dict.fromkeys(answers, 200), "pin": 201}
    written = client.put(f"{at}/script", script.content, "text/plain", headers={"If-Match": script.headers["ETag"]})
    assert written.status_code in {204, 422}
    saved = {"program": program, "function": "f", "name": "f"}
    kept = client.post("/api/sites/hall/library", saved, "application/json")
    assert kept.status_code == (201 if "f" in odd.get("functions", {}) else 422)
    assert client.get("/api/library?site=hall").status_code == 200
    assert client.get("/api/sites/hall/programs").status_code == 200
    compact_document(program)
    assert client.get(f"{at}/compiled").status_code == 200


def test_a_document_is_mended_by_writing_what_was_read_without_the_odd_part(client: Client) -> None:
    program = program_with({"steps": {"k": "zzz"}, "roles": {"r": 7}})
    at = f"/api/programs/{program}/document"
    read = client.get(at)
    refused = client.put(at, read.content, "application/json", headers={"If-Match": read.headers["ETag"]})
    assert (refused.status_code, "does not fit" in refused.json()["detail"]) == (422, True)
    mended = {**read.json(), "steps": {}, "roles": {}}
    written = client.put(at, mended, "application/json", headers={"If-Match": read.headers["ETag"]})
    assert written.status_code == 204
    assert client.get(at).json()["roles"] == {}


def test_a_step_whose_id_no_line_of_a_run_has_room_for_is_refused_and_an_error_where_somebody_drew_it(
    client: Client,
) -> None:
    wait = {"kind": "wait", "place": ["program", "body", "V"], "pos": [1, 1], "params": {"duration": 5}}
    program = program_with({"steps": {"s" * 65: wait}})
    at = f"/api/programs/{program}"
    found = client.get(f"{at}/compiled").json()["diagnostics"]
    assert [(each["code"], each["severity"], each["step"]) for each in found] == [("long_id", "error", "s" * 65)]
    read = client.get(f"{at}/document")
    answers = []
    for length in (65, 64):
        body = {**read.json(), "steps": {"s" * length: wait}}
        body["functions"], body["roles"], body["parameters"], body["zones"] = {}, {}, {}, {}
        tag = {"If-Match": read.headers["ETag"]}
        answers.append(client.put(f"{at}/document", body, "application/json", headers=tag))
    assert [each.status_code for each in answers] == [422, 204]
    assert "at most 64 characters" in answers[0].json()["detail"]

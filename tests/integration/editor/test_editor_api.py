"""The editor's HTTP calls, for each role and for strangers."""

from __future__ import annotations

from uuid import uuid4

import pytest

from tests.integration.editor.node_clients import node_clients
from tests.kit.web import Web

EVERYBODY = ("viewer", "operator", "author", "admin")


@pytest.fixture(scope="module")
def program(web: Web) -> str:
    return web.new_program("Carry")


@pytest.mark.parametrize("path", ["", "/document", "/compiled", "/versions"])
def test_members_may_look_and_strangers_learn_nothing(web: Web, program: str, path: str) -> None:
    for person in EVERYBODY:
        with web.client(person) as client:
            assert client.get(f"/programs/{program}{path}").status_code == 200
    with web.client("stranger") as client:
        refused, missing = client.get(f"/programs/{program}{path}"), client.get(f"/programs/{uuid4()}{path}")
    assert refused.status_code == missing.status_code == 404
    assert refused.json() == missing.json()
    assert refused.headers["content-type"] == "application/problem+json"
    with web.client(None) as client:
        assert client.get(f"/programs/{program}{path}").status_code == 401


def test_lists_are_for_members(web: Web, program: str) -> None:
    for person in EVERYBODY:
        with web.client(person) as client:
            assert program in [each["id"] for each in client.get("/sites/hall/programs").json()]
    with web.client("stranger") as client:
        assert client.get("/sites/hall/programs").status_code == 404
        assert client.get("/sites/no-such-site/programs").status_code == 404
    with web.client(None) as client:
        assert client.get("/sites/hall/programs").status_code == 401


def test_only_authors_and_admins_make_name_pin_and_delete_programs(web: Web) -> None:
    for person, allowed in {"viewer": False, "operator": False, "author": True, "admin": True}.items():
        with web.client(person) as client:
            made = client.post("/sites/hall/programs", json={"name": f"By {person}"})
            assert made.status_code == (201 if allowed else 403)
            target = made.json()["id"] if allowed else web.program
            named = client.patch(f"/programs/{target}", json={"name": "  Two   words "})
            assert named.status_code == (200 if allowed else 403)
            pinned = client.post(f"/programs/{target}/versions", json={"message": "First"})
            assert pinned.status_code == (201 if allowed else 403)
            assert client.delete(f"/programs/{target}").status_code == (204 if allowed else 403)
            if allowed:
                assert named.json()["name"] == "Two words"
                assert client.get(f"/programs/{target}").status_code == 404
    with web.client("author") as client:
        assert client.get(f"/programs/{web.program}").json()["name"] == "Shared"


def test_strangers_cannot_change_anything(web: Web, program: str) -> None:
    with web.client("stranger") as client:
        assert client.post("/sites/hall/programs", json={"name": "x"}).status_code == 404
        assert client.patch(f"/programs/{program}", json={"name": "x"}).status_code == 404
        assert client.delete(f"/programs/{program}").status_code == 404
        assert client.post(f"/programs/{program}/versions", json={}).status_code == 404
    with web.client("author") as client:
        assert client.get(f"/programs/{program}").json()["name"] == "Carry"


def test_a_change_without_the_token_is_refused(web: Web) -> None:
    with web.client("author") as client:
        del client.headers["X-CSRFToken"]
        assert client.post("/sites/hall/programs", json={"name": "x"}).status_code == 403


def test_a_program_needs_a_name(web: Web) -> None:
    with web.client("author") as client:
        answer = client.post("/sites/hall/programs", json={"name": "   "})
    assert (answer.status_code, answer.json()["code"]) == (422, "bad_request")
    assert answer.json()["detail"] == "A program's name has 1 to 120 characters. Enter one."


def test_a_version_holds_what_was_just_drawn_and_is_not_made_twice(web: Web) -> None:
    program = web.new_program("Pinned")
    with node_clients(web, program) as clients, web.client("author") as client:
        clients.open("ada")
        clients.tell("add", name="ada", id="s1")
        clients.tell("saved", name="ada")
        first = client.post(f"/programs/{program}/versions", json={}).json()
        again = client.post(f"/programs/{program}/versions", json={}).json()
        clients.tell("add", name="ada", id="s2")
        clients.tell("saved", name="ada")
        second = client.post(f"/programs/{program}/versions", json={"message": "Two waits"}).json()
        listed = client.get(f"/programs/{program}/versions").json()
    assert (first["number"], again["number"], second["number"]) == (1, 1, 2)
    assert [version["message"] for version in listed] == ["Two waits", ""]
    assert first["script"].count("self.wait(5)") == 1
    assert second["script"].count("self.wait(5)") == 2


def test_compiled_names_what_is_wrong_and_the_list_counts_it(web: Web) -> None:
    program = web.new_program("Faulty")
    with node_clients(web, program) as clients, web.client("viewer") as client:
        clients.open("ada")
        clients.tell("add", name="ada", id="s1", kind="move")
        clients.tell("saved", name="ada")
        compiled = client.get(f"/programs/{program}/compiled").json()
        listed = next(each for each in client.get("/sites/hall/programs").json() if each["id"] == program)
    errors = [diagnostic for diagnostic in compiled["diagnostics"] if diagnostic["severity"] == "error"]
    assert errors[0]["step"] == "s1"
    assert compiled["numbers"] == {"s1": "1"}
    assert (listed["errors"], listed["kinds"]) == (len(errors), ["move"])
    assert listed["edited_by"]["name"] == "Ada author"


def test_a_function_goes_into_the_library_under_version_numbers(web: Web) -> None:
    program = web.new_program("With a function")
    with node_clients(web, program) as clients, web.client("author") as client:
        clients.open("ada")
        clients.tell("function", name="ada", id="f1", label="Rest", calls="f2")
        clients.tell("function", name="ada", id="f2", label="Nap")
        clients.tell("saved", name="ada")
        body = {"program": program, "function": "f1", "name": "Rest", "description": "Waits a while"}
        first = client.post("/sites/hall/library", json=body)
        second = client.post("/sites/hall/library", json={**body, "description": "Waits longer"})
        found = client.get("/library", params={"q": "longer rest"}).json()
        old = client.get(f"/library/{first.json()['id']}/versions/1").json()
        none = client.get(f"/library/{first.json()['id']}/versions/9")
    assert (first.status_code, second.json()["version"], none.status_code) == (201, 2, 404)
    assert [(each["name"], each["version"]) for each in found] == [("Rest", 2)]
    assert old["version"] == 1
    assert sorted(old["definition"]["steps"]) == ["f1-call", "f1-wait", "f2-wait"]
    assert list(old["definition"]["functions"]) == ["f2"]
    assert "def rest(self)" in old["script"]


def test_the_library_is_for_members_and_filled_by_authors(web: Web) -> None:
    program = web.new_program("Shares a function")
    with node_clients(web, program) as clients:
        clients.open("ada")
        clients.tell("function", name="ada", id="f1", label="Shared rest")
        clients.tell("saved", name="ada")
    body = {"program": program, "function": "f1", "name": "Shared rest"}
    for person, status in {"viewer": 403, "operator": 403, "stranger": 404, "author": 201, "admin": 201}.items():
        with web.client(person) as client:
            answer = client.post("/sites/hall/library", json=body)
            assert answer.status_code == status, person
    function = answer.json()["id"]
    for person, status in {**dict.fromkeys(EVERYBODY, 200), "stranger": 404}.items():
        with web.client(person) as client:
            assert client.get(f"/library/{function}").status_code == status
            assert client.get(f"/library/{function}/versions/1").status_code == status
            names = [each["name"] for each in client.get("/library", params={"q": "Shared rest"}).json()]
            assert names == (["Shared rest"] if status == 200 else [])
            assert client.get("/library", params={"site": "hall"}).status_code == status
    with web.client("author") as client:
        gone = client.post("/sites/hall/library", json={**body, "function": "no-such"})
    assert gone.status_code == 422


def test_only_its_author_and_admins_save_the_next_version_of_a_function(web: Web) -> None:
    program = web.new_program("Two with one name")
    with node_clients(web, program) as clients:
        clients.open("ada")
        clients.tell("function", name="ada", id="f1", label="Ours")
        clients.tell("saved", name="ada")
    body = {"program": program, "function": "f1", "name": "Ours"}
    with web.client("admin") as admin, web.client("author") as author:
        first = admin.post("/sites/hall/library", json=body)
        refused = author.post("/sites/hall/library", json=body)
        own = author.post("/sites/hall/library", json={**body, "name": "Ours too"})
        again = author.post("/sites/hall/library", json={**body, "name": "Ours too"})
        by_admin = admin.post("/sites/hall/library", json={**body, "name": "Ours too"})
        left = author.get(f"/library/{first.json()['id']}").json()
    assert (refused.status_code, refused.json()["code"]) == (409, "name_taken")
    assert refused.json()["detail"] == (
        "The library of this site has a function “Ours” of somebody else. Save yours under another name."
    )
    assert left["version"] == 1
    assert [answer.json()["version"] for answer in (own, again, by_admin)] == [1, 2, 3]

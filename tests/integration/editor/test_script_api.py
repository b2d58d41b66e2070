"""Scripts over HTTP: what drawing one would make of a program, for each role and for strangers."""

from __future__ import annotations

from typing import Any
from uuid import uuid4

import pytest

from tests.kit.web import Web

WAITS = """class Task(object):
    def new_task(self):
        self.wait(60)
        self.wait(5)

    def run(self, ctx):
        self.new_task()
"""


@pytest.fixture(scope="module")
def program(web: Web) -> str:
    return web.new_program("Script")


def drawn(web: Web, program: str, **body: Any) -> dict[str, Any]:
    with web.client("author") as client:
        answer = client.post(f"/programs/{program}/script", json=body)
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def test_a_script_becomes_a_document_and_changes_nothing_by_itself(web: Web, program: str) -> None:
    found = drawn(web, program, text=WAITS)
    assert (found["ok"], found["stale"], found["diagnostics"]) == (True, False, [])
    assert [step["params"] for step in found["document"]["steps"].values()] == [{"duration": 60}, {"duration": 5}]
    assert found["script"] == WAITS
    assert found["lines"] == ["", "", "s1", "s2", "", "", ""]
    with web.client("viewer") as client:
        assert client.get(f"/programs/{program}/document").json()["steps"] == {}


def test_a_base_document_keeps_its_steps(web: Web, program: str) -> None:
    base = drawn(web, program, text=WAITS)["document"]
    base["steps"]["s1"]["pos"] = [7, -7]
    found = drawn(web, program, text=WAITS.replace("60", "61"), base=base, shown=WAITS)
    base["steps"]["s1"]["params"] = {"duration": 61}
    assert found["document"] == base


def test_a_script_adds_and_removes_zones(web: Web, program: str) -> None:
    zone = 'self.wet = ctx.zone("wet", [(1, 2), (4, 2), (4, 5)], rule="keep out")'
    with_zone = WAITS.replace("        self.new_task()", f"        {zone}\n        self.new_task()")
    found = drawn(web, program, text=with_zone)
    points = [[1, 2], [4, 2], [4, 5]]
    assert found["document"]["zones"] == {"wet": {"name": "wet", "rule": "keep_out", "points": points}}
    assert found["script"] == with_zone
    without = drawn(web, program, text=WAITS, base=found["document"], shown=with_zone)
    assert without["document"]["zones"] == {}


def test_a_base_that_prints_otherwise_than_was_shown_is_stale(web: Web, program: str) -> None:
    base = drawn(web, program, text=WAITS)["document"]
    shown = WAITS.replace("self.wait(5)", "self.wait(6)")
    found = drawn(web, program, text=shown, base=base, shown=shown)
    assert (found["ok"], found["stale"], found["document"], found["script"]) == (False, True, None, WAITS)


def test_what_leaves_the_language_is_told_with_line_and_column(web: Web, program: str) -> None:
    found = drawn(web, program, text=WAITS.replace("self.wait(5)", "print(5)"))
    assert (found["ok"], found["stale"], found["document"]) == (False, False, None)
    [problem] = found["diagnostics"]
    assert (problem["line"], problem["column"], problem["end_line"], problem["end_column"]) == (4, 9, 4, 17)
    assert problem["message"].startswith("Line 4")
    assert problem["found"]
    assert problem["expected"]


def test_only_authors_draw_scripts(web: Web, program: str) -> None:
    allowed = {"viewer": 403, "operator": 403, "author": 200, "admin": 200, "stranger": 404, None: 401}
    for person, status in allowed.items():
        with web.client(person) as client:
            assert client.post(f"/programs/{program}/script", json={"text": WAITS}).status_code == status
    with web.client("stranger") as client:
        refused = client.post(f"/programs/{program}/script", json={"text": WAITS})
        assert refused.json() == client.post(f"/programs/{uuid4()}/script", json={"text": WAITS}).json()


def test_a_script_without_the_token_is_refused(web: Web, program: str) -> None:
    with web.client("author") as client:
        del client.headers["X-CSRFToken"]
        assert client.post(f"/programs/{program}/script", json={"text": WAITS}).status_code == 403


def test_what_is_too_long_is_refused(web: Web, program: str) -> None:
    with web.client("author") as client:
        long = client.post(f"/programs/{program}/script", json={"text": "#" * 400_001})
        assert (long.status_code, long.json()["code"]) == (413, "script_too_long")
        assert client.post(f"/programs/{program}/script", json={"text": "#" * 5_000_000}).status_code in {400, 413}


@pytest.mark.parametrize("base", [{}, {"steps": 5}, {"steps": {"a": 1}, "functions": {"a": []}}, {"roles": {"": {}}}])
def test_a_base_that_is_no_document_does_no_harm(web: Web, program: str, base: dict[str, Any]) -> None:
    assert drawn(web, program, text=WAITS, base=base)["ok"] is True


@pytest.mark.parametrize("body", [{}, {"text": 5}, {"text": "x", "base": []}, {"text": "x", "shown": {}}])
def test_a_body_that_does_not_fit_is_refused(web: Web, program: str, body: dict[str, Any]) -> None:
    with web.client("author") as client:
        assert client.post(f"/programs/{program}/script", json=body).status_code == 422

"""Values as one line over HTTP, for each role and for strangers."""

from __future__ import annotations

from typing import Any
from uuid import uuid4

import pytest

from tests.kit.web import Web


@pytest.fixture(scope="module")
def program(web: Web) -> str:
    return web.new_program("Lines")


@pytest.mark.parametrize(
    ("person", "reads", "prints"),
    [
        ("viewer", 403, 200),
        ("operator", 403, 200),
        ("author", 200, 200),
        ("admin", 200, 200),
        ("stranger", 404, 404),
        (None, 401, 401),
    ],
)
def test_authors_read_lines_and_all_members_print_them(
    web: Web, program: str, person: str | None, reads: int, prints: int
) -> None:
    with web.client(person) as client:
        assert client.post(f"/programs/{program}/expression", json={"text": "1 + 2"}).status_code == reads
        assert client.post(f"/programs/{program}/expression", json={"value": 3}).status_code == prints


def test_a_stranger_learns_nothing_of_programs_that_exist(web: Web, program: str) -> None:
    with web.client("stranger") as client:
        refused = client.post(f"/programs/{program}/expression", json={"text": "1"})
        missing = client.post(f"/programs/{uuid4()}/expression", json={"text": "1"})
    assert refused.json() == missing.json()


def test_a_line_is_read_and_its_value_printed_again(web: Web, program: str) -> None:
    value = {"op": "<", "args": [{"quantity": [90, "SEC"]}, {"quantity": [2, "MIN"]}]}
    with web.client("author") as client:
        read = client.post(f"/programs/{program}/expression", json={"text": "90s < 2 minutes"})
        printed = client.post(f"/programs/{program}/expression", json={"value": value})
    expected: dict[str, Any] = {"value": value, "type": "boolean", "unit": "", "problem": None, "names": []}
    assert read.json() == {**expected, "text": "90s < 2 minutes"}
    assert printed.json() == {**expected, "text": "90 s < 2 min"}


def test_a_line_that_means_nothing_says_where_and_why(web: Web, program: str) -> None:
    with web.client("author") as client:
        answer = client.post(f"/programs/{program}/expression", json={"text": "1 + no_such_thing"})
    problem = answer.json()["problem"]
    assert (answer.status_code, answer.json()["value"], problem["column"]) == (200, None, 5)
    assert problem["messages"]["en"] == problem["message"] == "There is nothing called “no_such_thing” here."
    assert problem["messages"]["de"] == "Hier gibt es nichts mit dem Namen „no_such_thing“."


def test_nonsense_for_a_value_is_printed_as_nothing(web: Web, program: str) -> None:
    with web.client("viewer") as client:
        nonsense: list[Any] = [None, {}, {"op": "boom", "args": []}, {"param": "gone"}, [[]], {"quantity": "x"}]
        for value in nonsense:
            answer = client.post(f"/programs/{program}/expression", json={"value": value})
            assert (answer.status_code, answer.json()["text"]) == (200, "")

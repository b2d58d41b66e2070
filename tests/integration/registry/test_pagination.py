"""Long lists over HTTP are given in pages, which `Link` joins: nothing is missed, nothing comes twice."""

from __future__ import annotations

import re
from collections.abc import Callable
from datetime import timedelta
from typing import Any

import pytest
from django.test import Client

from editor import services as editor
from editor.documents.shared_document import encode_document
from editor.documents.store import Change, append_changes
from registry.models import DeviceAlert
from tests.kit.programs import document, step
from tests.kit.sign_in import signed_in
from tests.kit.sites import NOW, make_mixers

pytestmark = pytest.mark.django_db
COUNT = 7


def next_of(answer: Any) -> str:
    found = re.fullmatch(r'<(.+)>; rel="next"', answer.headers.get("Link", ""))
    return found[1] if found else ""


def read_pages(client: Client, address: str, meanwhile: Callable[[], object] = lambda: None) -> list[list[Any]]:
    pages = []
    while address:
        answer = client.get(address)
        assert answer.status_code == 200, answer.content
        pages.append(answer.json())
        address = next_of(answer)
        meanwhile()
    return pages


def make_programs(site: str) -> None:
    for number in range(COUNT):
        editor.create_program(site=site, name=f"Program {number}")


def make_versions(site: str) -> str:
    program = str(editor.create_program(site=site, name="Pinned").id)
    for number in range(COUNT):
        drawn = document({f"s{number}": step("wait", duration=number)})
        append_changes(program, [Change(None, encode_document(drawn))], NOW)
        editor.pin_version(program_id=program, user=None, message=f"Version {number}")
    return program


def make_functions(site: str) -> None:
    drawn = document({}, functions={"f": {"name": "Greet", "parameters": []}})
    program = editor.create_program(site=site, name="Source", document=drawn).id
    for number in range(COUNT):
        editor.save_function(site=site, program_id=program, function="f", said=editor.Said(f"F{number}"), user=None)


def make_alerts() -> None:
    make_mixers("mixer1", "mixer2")
    for number in range(COUNT):
        # Two of each moment: the order is that of the rows then.
        at = NOW + timedelta(minutes=number // 2)
        DeviceAlert.objects.create(device_id="mixer1", code="offline", first_at=at, last_at=at, over_at=at)
    DeviceAlert.objects.create(device_id="mixer2", code="offline", first_at=NOW, last_at=NOW, over_at=NOW)


def test_programs_come_in_parts_and_one_that_is_made_meanwhile_moves_nothing(hall: str) -> None:
    make_programs("hall")
    client = signed_in("viewer")
    pages = read_pages(
        client,
        "/api/sites/hall/programs?limit=3&q=program",
        lambda: editor.create_program(site="hall", name="New program"),
    )
    assert [[each["name"] for each in page] for page in pages] == [
        ["Program 6", "Program 5", "Program 4"],
        ["Program 3", "Program 2", "Program 1"],
        ["Program 0"],
    ]
    assert [each["name"] for each in client.get("/api/sites/hall/programs?q=6%20PROG").json()] == ["Program 6"]


def test_versions_of_a_program_come_in_parts(hall: str) -> None:
    program = make_versions("hall")
    pages = read_pages(signed_in("viewer"), f"/api/programs/{program}/versions?limit=3")
    assert [[each["number"] for each in page] for page in pages] == [[7, 6, 5], [4, 3, 2], [1]]


def test_the_library_comes_in_parts_by_name(hall: str) -> None:
    make_functions("hall")
    pages = read_pages(signed_in("viewer"), "/api/library?limit=4&site=hall")
    assert [[each["name"] for each in page] for page in pages] == [["F0", "F1", "F2", "F3"], ["F4", "F5", "F6"]]


def test_alerts_of_one_moment_are_neither_missed_nor_doubled(hall: str) -> None:
    make_alerts()
    client = signed_in("viewer")
    pages = read_pages(client, "/api/sites/hall/alerts?state=over&device=mixer1&limit=2")
    keys = [each["id"] for page in pages for each in page]
    assert [len(page) for page in pages] == [2, 2, 2, 1]
    assert keys == sorted(keys, reverse=True)
    assert len(client.get("/api/sites/hall/alerts?state=over").json()) == COUNT + 1


def test_a_mark_that_was_made_up_or_is_another_lists_is_refused(hall: str) -> None:
    make_programs("hall")
    program = make_versions("hall")
    client = signed_in("viewer")
    other = next_of(client.get("/api/sites/hall/programs?limit=1")).partition("before=")[2]
    for mark in ("a", "WyJhIl0:x:y", other):
        answer = client.get(f"/api/programs/{program}/versions?before={mark}")
        assert (answer.status_code, answer.json()["code"]) == (422, "bad_mark")


@pytest.mark.parametrize("limit", ["0", "201", "-1", "x"])
def test_a_part_has_its_bounds(hall: str, limit: str) -> None:
    assert signed_in("viewer").get(f"/api/sites/hall/programs?limit={limit}").status_code == 422

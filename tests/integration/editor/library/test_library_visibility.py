"""Who sees a function of the library and who changes it: each role, a member of another site, a stranger, tokens."""

from __future__ import annotations

from datetime import UTC, datetime
from importlib import import_module
from typing import Any

import pytest
from django.apps import apps
from django.test import Client

from editor import services as editor
from editor.models import LibraryFunction, LibraryUse, LibraryVersion
from editor.programs.checking import build_surroundings
from registry import services as registry
from tests.kit.programs import document
from tests.kit.sign_in import ROLES, add_person, find_person, patch_json, post_json, signed_in
from tests.kit.sites import make_hall

pytestmark = pytest.mark.django_db
AT_HALL = (*ROLES, "second")
"""Everybody at the site; `second` is another author of it."""


@pytest.fixture
def hall(db: None) -> str:
    return make_hall()


@pytest.fixture
def program(hall: str) -> str:
    """A program with a function at a site with its people; `elsewhere` is admin of another one."""
    registry.create_site(name="Shed", slug="shed")
    for person in ("second", "elsewhere"):
        add_person(person)
    registry.set_member(site=hall, email="second@vipo.example", role="author")
    registry.set_member(site="shed", email="elsewhere@vipo.example", role="admin")
    drawn = document({}, functions={"f": {"name": "Greet", "parameters": []}})
    return str(editor.create_program(site=hall, name="Source", document=drawn).id)


def save(person: str, program: str, **said: Any) -> Any:
    return post_json(
        signed_in(person), "/api/sites/hall/library", {"program": program, "function": "f", "name": "Greet", **said}
    )


def who_sees(function: str) -> set[str]:
    """Return who finds a function, after asking in all three ways, which must agree."""
    seen = set()
    for person in (*AT_HALL, "elsewhere", "stranger"):
        client = signed_in(person)
        shown = client.get(f"/api/library/{function}").status_code
        version = client.get(f"/api/library/{function}/versions/1").status_code
        listed = [each["id"] for each in client.get("/api/library").json()]
        assert (shown, version, listed) in [(200, 200, [function]), (404, 404, [])], person
        if shown == 200:
            seen.add(person)
    assert Client().get(f"/api/library/{function}").status_code == 401
    return seen


@pytest.mark.parametrize(
    ("visibility", "seen"),
    [
        ("me", {"author"}),
        ("site", {*AT_HALL}),
        ("everyone", {*AT_HALL, "elsewhere", "stranger"}),
    ],
)
def test_a_function_is_seen_by_whom_it_is_for(program: str, visibility: str, seen: set[str]) -> None:
    saved = save("author", program, visibility=visibility).json()
    assert who_sees(saved["id"]) == seen
    assert saved["visibility"] == visibility


@pytest.mark.parametrize(
    ("visibility", "answers"),
    [
        ("me", {"author": 200, "admin": 404, "second": 404, "operator": 404, "elsewhere": 404, "stranger": 404}),
        ("site", {"author": 200, "admin": 200, "second": 409, "operator": 403, "elsewhere": 404, "stranger": 404}),
        ("everyone", {"author": 200, "admin": 200, "second": 409, "operator": 403, "elsewhere": 404, "stranger": 404}),
    ],
)
def test_its_author_and_the_admins_of_its_site_change_it(
    program: str, visibility: str, answers: dict[str, int]
) -> None:
    function = save("author", program, visibility=visibility).json()["id"]
    for person, status in answers.items():
        answer = patch_json(signed_in(person), f"/api/library/{function}", {"description": f"By {person}"})
        assert answer.status_code == status, person
        if status == 409:
            assert answer.json()["code"] == "not_yours"
        shown = signed_in(person).get(f"/api/library/{function}")
        assert shown.status_code == 404 or shown.json()["mine"] is (status == 200), person
    row = LibraryFunction.objects.get()
    assert (row.visibility, row.last_version) == (visibility, 1)


def test_an_admin_makes_no_next_version_of_what_is_not_seen(program: str) -> None:
    save("author", program, visibility="me")
    assert save("admin", program).status_code == 409
    assert save("author", program).json()["version"] == 2
    assert LibraryFunction.objects.get().visibility == "me"


def test_who_is_author_no_more_does_not_change_what_was_theirs(program: str, hall: str) -> None:
    function = save("author", program, visibility="everyone").json()["id"]
    registry.set_member(site=hall, email="author@vipo.example", role="operator")
    assert patch_json(signed_in("author"), f"/api/library/{function}", {"visibility": "me"}).status_code == 403


def test_what_an_author_left_behind_is_seen_by_the_admins(program: str) -> None:
    function = save("author", program, visibility="me").json()["id"]
    LibraryFunction.objects.update(author=None)
    assert who_sees(function) == {"admin"}
    changed = patch_json(signed_in("admin"), f"/api/library/{function}", {"visibility": "site"})
    assert changed.json()["visibility"] == "site"


def test_a_token_sees_its_site_alone(program: str) -> None:
    save("author", program, visibility="everyone")
    wanted = {"site": "shed", "name": "Reads", "scopes": ["read"], "days": 1}
    _, token = registry.create_token(user=find_person("elsewhere"), now=datetime.now(UTC), **wanted)
    assert Client().get("/api/library", headers={"Authorization": f"Bearer {token}"}).json() == []


def test_a_list_costs_the_same_however_many_functions_there_are(
    program: str, django_assert_num_queries: Any, hall: str
) -> None:
    author = find_person("author")
    for number in range(3):
        said = editor.Said(f"F{number}", visibility="everyone")
        editor.save_function(site=hall, program_id=program, function="f", said=said, user=author)
    with django_assert_num_queries(7):
        editor.search_library(user=author)
    editor.save_function(site=hall, program_id=program, function="f", said=editor.Said("F9"), user=author)
    with django_assert_num_queries(7):
        assert len(editor.search_library(user=author)) == 4


def test_programs_are_told_of_newer_versions_of_what_their_site_sees(program: str) -> None:
    function = save("author", program, visibility="everyone").json()["id"]
    assert build_surroundings(site="shed").library == {}
    borrower = editor.create_program(site="shed", name="Borrows")
    LibraryUse.objects.create(function_id=function, program_id=borrower.id)
    assert list(build_surroundings(site="shed").library or {}) == [function]
    patch_json(signed_in("author"), f"/api/library/{function}", {"visibility": "site"})
    assert build_surroundings(site="shed").library == {}
    patch_json(signed_in("author"), f"/api/library/{function}", {"visibility": "me"})
    assert build_surroundings(site="hall").library == {}


def test_functions_from_before_keep_their_site_and_are_their_first_savers(program: str) -> None:
    save("author", program)
    LibraryVersion.objects.create(
        function=LibraryFunction.objects.get(),
        number=2,
        author=find_person("admin"),
        definition={},
        script="",
        signature={"parameters": []},
    )
    LibraryFunction.objects.update(author=None)
    import_module("editor.migrations.0009_library_visibility").name_authors(apps, None)
    row = LibraryFunction.objects.get()
    assert (row.author, row.visibility) == (find_person("author"), "site")

"""Versions: made only when something has changed, named, opened, compared, copied, exported and restored."""

from __future__ import annotations

import json
from collections.abc import Callable
from datetime import UTC, datetime
from typing import Any

import pytest
from django.test import Client

from editor import services
from editor.documents.shared_document import SharedDocument
from editor.documents.store import Change, append_changes, load_document
from editor.models import Program, Version
from editor.programs.packing import Content, UnknownPacking, pack, pack_difference, unpack
from registry import services as registry
from registry.models import Site, User
from tests.kit.programs import document, step
from tests.kit.sign_in import add_person, signed_in

NOW = datetime(2026, 1, 2, 3, 4, tzinfo=UTC)
pytestmark = pytest.mark.django_db
Json = dict[str, Any]
WAIT = step("wait", order="A", duration=1)


@pytest.fixture
def author() -> User:
    registry.create_site(name="Hall", slug="hall")
    return add_person("author", "hall")


@pytest.fixture
def program(author: User) -> str:
    return str(services.create_program(site="hall", name="Carry", document=document({"a": WAIT}), user=author).id)


@pytest.fixture
def client(author: User) -> Client:
    return signed_in("author")


def draw(program: str, who: User | None, change: Callable[[Json], Json]) -> None:
    """Let somebody change the program, as a room stores it."""
    shared = SharedDocument(load_document(program).updates)
    before, now = shared.state(), shared.to_json()
    shared.change_to(change(now))
    append_changes(program, [Change(who.pk if who else None, shared.encode(before))], NOW)


def set_step(name: str, body: Json) -> Callable[[Json], Json]:
    return lambda now: {**now, "steps": {**now["steps"], name: body}}


def post(client: Client, path: str, body: Json) -> Any:
    return client.post(f"/api/programs/{path}", json.dumps(body), content_type="application/json")


def steps(program: str) -> Json:
    return dict(services.get_document(program_id=program)["steps"])


def test_no_version_is_made_when_nothing_has_changed_and_a_name_goes_to_the_last_that_has_none(
    client: Client, program: str
) -> None:
    first = post(client, f"{program}/versions", {"cause": "import"})
    again = post(client, f"{program}/versions", {"name": "Before the oven check", "message": "Checked by Ada"})
    third = post(client, f"{program}/versions", {"name": "Another name"})
    assert [answer.status_code for answer in (first, again, third)] == [201, 200, 200]
    said = [
        (answer.json()["number"], answer.json()["name"], answer.json()["cause"]) for answer in (first, again, third)
    ]
    assert said == [(1, "", "import"), (1, "Before the oven check", "import"), (1, "Before the oven check", "import")]
    named = client.patch(
        f"/api/programs/{program}/versions/1", json.dumps({"name": "Later"}), content_type="application/json"
    )
    assert (named.status_code, named.json()["name"], named.json()["message"]) == (200, "Later", "")
    assert Version.objects.count() == 1


def test_a_version_names_all_who_had_drawn_since_the_one_before(client: Client, program: str, author: User) -> None:
    other = add_person("admin", "hall")
    post(client, f"{program}/versions", {})
    draw(program, other, set_step("b", WAIT))
    draw(program, author, set_step("c", WAIT))
    post(client, f"{program}/versions", {})
    draw(program, other, set_step("d", WAIT))
    post(client, f"{program}/versions", {})
    listed = client.get(f"/api/programs/{program}/versions").json()
    assert [(each["number"], sorted(person["id"] for person in each["authors"])) for each in listed] == [
        (3, [other.pk]),
        (2, sorted([author.pk, other.pk])),
        (1, [author.pk]),
    ]
    assert "document" not in listed[0]
    assert "script" not in listed[0]


def test_every_version_opens_as_it_was_and_takes_the_bytes_of_its_difference(program: str, author: User) -> None:
    many = {f"s{number}": step("wait", order=f"{number:04d}V", duration=number) for number in range(300)}
    draw(program, author, lambda now: {**now, "steps": many})
    pinned = [services.pin_version(program_id=program, user=author)]
    for number in range(12):
        draw(program, author, set_step(f"s{number}", step("wait", order=f"{number:04d}V", duration=-number - 1)))
        pinned.append(services.pin_version(program_id=program, user=author))
    draw(program, author, lambda now: {**now, "steps": {"other": WAIT}})
    pinned.append(services.pin_version(program_id=program, user=author))
    for version in pinned:
        opened = services.find_version(program_id=program, number=version.number)
        assert (opened.document, opened.script) == (version.document, version.script)
    rows = Version.objects.order_by("number").values_list("base__number", flat=True)
    assert list(rows) == [None, *[1] * 12, None]
    sizes = [len(content) for content in Version.objects.order_by("number").values_list("content", flat=True)]
    assert max(sizes[1:13]) < sizes[0] / 2


def test_what_differs_too_much_is_kept_whole() -> None:
    one, other = Content(document({"a": WAIT}), "a"), Content(document({"b": WAIT, "c": WAIT}), "b")
    assert pack_difference(other, one, len(pack(one))) is None
    assert unpack(pack(other)) == other
    with pytest.raises(UnknownPacking):
        unpack(b"nothing that was packed")
    packed = pack_difference(one, one, 10_000)
    assert packed is not None
    with pytest.raises(UnknownPacking, match="differs from is missing"):
        unpack(packed)


def test_two_versions_are_compared_and_a_version_with_what_is_drawn(client: Client, program: str, author: User) -> None:
    post(client, f"{program}/versions", {"name": "First"})
    draw(program, author, set_step("a", {**WAIT, "params": {"duration": 5}}))
    answer = client.get(f"/api/programs/{program}/comparison?old=1&new=draft").json()
    assert (answer["old"]["version"]["name"], answer["new"]["version"]) == ("First", None)
    (change,) = answer["difference"]["constructs"]
    assert change == {
        "root": "steps",
        "id": "a",
        "kind": "changed",
        "moved": False,
        "changes": [{"path": ["steps", "a", "params", "duration"], "old": 1, "new": 5}],
    }
    assert answer["new"]["compiled"]["numbers"] == {"a": "1"}
    same = client.get(f"/api/programs/{program}/comparison?old=1&new=1").json()["difference"]
    assert (same["constructs"], same["tidied"], same["same"]) == ([], [], 1)


def test_a_side_that_is_not_there_or_cannot_be_read_is_told_beside_the_other(client: Client, program: str) -> None:
    post(client, f"{program}/versions", {})
    missing = client.get(f"/api/programs/{program}/comparison?old=7&new=1").json()
    assert (missing["old"]["problem"], missing["old"]["document"], missing["difference"]) == ("missing", None, None)
    assert missing["new"]["document"]["steps"].keys() == {"a"}
    Version.objects.update(content=b"of another time")
    damaged = client.get(f"/api/programs/{program}/comparison?old=1&new=draft").json()
    assert (damaged["old"]["problem"], damaged["new"]["problem"]) == ("unreadable", "")
    opened = client.get(f"/api/programs/{program}/versions/1")
    assert (opened.status_code, opened.json()["code"]) == (409, "unreadable_version")
    assert client.get(f"/api/programs/{program}/comparison?old=first").status_code == 422


def test_a_version_is_copied_as_a_new_program_and_exported_as_a_file(
    client: Client, program: str, author: User
) -> None:
    post(client, f"{program}/versions", {})
    draw(program, author, set_step("b", WAIT))
    copied = post(client, f"{program}/versions/1/copy", {"name": "Carry again"})
    assert (copied.status_code, copied.json()["name"], steps(copied.json()["id"]).keys()) == (201, "Carry again", {"a"})
    sent = client.get(f"/api/programs/{program}/versions/1/export")
    assert sent["Content-Disposition"] == 'attachment; filename="carry-v1.json"'
    assert json.loads(sent.content)["steps"].keys() == {"a"}
    script = client.get(f"/api/programs/{program}/versions/1/export?form=script")
    assert (script["Content-Type"], b"self.wait(1)" in script.content) == ("text/plain; charset=utf-8", True)


def test_a_construct_is_restored_with_what_it_needs_and_taken_back(client: Client, program: str, author: User) -> None:
    draw(program, author, lambda now: {**now, "steps": {"w": step("while"), "in": step("wait", ("w", "body"))}})
    post(client, f"{program}/versions", {})
    draw(program, author, lambda now: {**now, "steps": {"other": WAIT}})
    asked = {"constructs": [["steps", "in"]]}
    look = post(client, f"{program}/versions/1/restore/look", asked).json()
    assert (look["needs"], steps(program).keys()) == ([["steps", "w"]], {"other"})
    done = post(client, f"{program}/versions/1/restore", asked)
    assert (done.status_code, steps(program).keys()) == (200, {"other", "w", "in"})
    kept = services.list_versions(program_id=program)
    assert [(each.number, each.cause) for each in kept] == [(2, "restore"), (1, "")]
    assert Program.objects.get(pk=program).edited_by == author
    back = [
        {name: value for name, value in (("path", each["path"]), ("old", each.get("new"))) if value is not None}
        for each in done.json()["changes"]
    ]
    undone = post(client, f"{program}/changes", {"changes": back})
    assert (undone.status_code, undone.json()["skipped"], steps(program).keys()) == (200, [], {"other"})


def test_undo_leaves_what_somebody_has_changed_since(client: Client, program: str, author: User) -> None:
    other = add_person("admin", "hall")
    post(client, f"{program}/versions", {})
    draw(program, author, set_step("a", {**WAIT, "params": {"duration": 5, "until": True}}))
    done = post(client, f"{program}/versions/1/restore", {"everything": True}).json()
    draw(program, other, set_step("a", {**WAIT, "params": {"duration": 9}}))
    back = [{"path": each["path"], "old": each["new"], "new": each["old"]} for each in done["changes"] if "new" in each]
    undone = post(client, f"{program}/changes", {"changes": back}).json()
    assert (undone["changes"], [each["path"] for each in undone["skipped"]]) == (
        [],
        [["steps", "a", "params", "duration"]],
    )
    assert steps(program)["a"]["params"] == {"duration": 9}


@pytest.mark.parametrize("body", [{}, {"constructs": [["steps"]]}, {"constructs": "all"}, {"everything": "perhaps"}])
def test_a_restore_of_nothing_that_is_something_is_refused(client: Client, program: str, body: Json) -> None:
    post(client, f"{program}/versions", {})
    assert post(client, f"{program}/versions/1/restore", body).status_code == 422
    assert post(client, f"{program}/versions/8/restore", {"everything": True}).status_code == 404
    refused = post(client, f"{program}/changes", {"changes": [{"path": ["meta", "format"], "old": 2, "new": 9}]})
    assert (refused.status_code, refused.json()["code"]) == (422, "bad_request")


def test_the_versions_of_another_site_are_absent(program: str) -> None:
    registry.create_site(name="Yard", slug="yard")
    services.pin_version(program_id=program, user=None)
    add_person("operator", "yard")
    stranger = signed_in("operator")
    assert Site.objects.count() == 2
    for path in ("versions", "versions/1", "versions/1/export", "comparison?old=1"):
        assert stranger.get(f"/api/programs/{program}/{path}").status_code == 404
    for path in ("versions/1/restore", "versions/1/restore/look"):
        assert post(stranger, f"{program}/{path}", {"everything": True}).status_code == 404

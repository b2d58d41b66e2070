"""Places that admins make, change and remove on a site's map."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from django.test import Client

from editor import services as editor
from registry import services
from registry.floorplan.plan import Grid
from registry.maps import places
from tests.kit.programs import document, step
from tests.kit.sign_in import patch_json, post_json, signed_in
from tests.kit.sites import MIXER, describe

PLACES = "/api/sites/hall/places"
TABLE = {"name": "Quality table", "kind": "point", "x": 1.5, "y": 0.5}


@pytest.fixture
def admin(hall: str) -> Client:
    return signed_in("admin")


def told(client: Client) -> list[tuple[str, str, str, float, float]]:
    shown = client.get("/api/sites/hall/map").json()["places"]
    return [(each["id"], each["name"], each["kind"], each["x"], each["y"]) for each in shown]


def refused(answer: Any) -> tuple[int, str]:
    body = answer.json()
    return answer.status_code, body.get("args", {}).get("why") or body["code"]


def test_a_place_is_made_moved_renamed_and_removed(
    admin: Client, heard: list[Any], django_capture_on_commit_callbacks: Any
) -> None:
    with django_capture_on_commit_callbacks(execute=True):
        made = post_json(admin, PLACES, {**TABLE, "theta": 7.0})
        assert (made.status_code, made["Location"]) == (201, f"{PLACES}/quality_table")
        assert made.json() == {**TABLE, "id": "quality_table", "theta": 0.7168, "label": None}
        changed = patch_json(admin, made["Location"], {"name": "Bench", "x": 2.25})
        assert (changed.status_code, changed.json()["name"], changed.json()["x"]) == (200, "Bench", 2.25)
        assert told(admin) == [("quality_table", "Bench", "point", 2.25, 0.5)]
        assert admin.delete(made["Location"]).status_code == 204
    assert told(admin) == []
    done = [(line["code"], line["facts"]) for line in admin.get("/api/sites/hall/audit?kind=map").json()]
    names = (("place_removed", "Bench"), ("place_changed", "Bench"), ("place_added", "Quality table"))
    assert done[:3] == [(code, {"place": name}) for code, name in names]
    assert heard == [("hall", {"type": "map", "version": 1})] * 3
    gone = made["Location"]
    for answer in (admin.get(gone), admin.delete(gone), patch_json(admin, gone, {})):
        assert refused(answer) == (404, "no_such_place")


@pytest.mark.parametrize(
    ("change", "answer"),
    [
        ({"name": " "}, (422, "name")),
        ({"name": "x" * 61}, (422, "name")),
        ({"x": 4.0}, (422, "off")),
        ({"y": -0.01}, (422, "off")),
        ({"y": 2.5}, (422, "wall")),
        ({"x": 1e300}, (422, "bad_request")),
        ({"kind": "heap"}, (422, "bad_request")),
        ({"id": "a b"}, (422, "id")),
        ({"id": "quality_table"}, (409, "taken_id")),
        ({"name": "QUALITY  table"}, (409, "taken_name")),
    ],
)
def test_a_place_that_cannot_be_is_refused_and_nothing_is_made(
    admin: Client, change: dict[str, Any], answer: tuple[int, str]
) -> None:
    assert post_json(admin, PLACES, TABLE).status_code == 201
    before = told(admin)
    assert refused(post_json(admin, PLACES, {**TABLE, "name": "Other", **change})) == answer
    assert told(admin) == before


def test_a_place_keeps_what_a_refused_change_would_have_made_of_it(admin: Client) -> None:
    place = post_json(admin, PLACES, TABLE)["Location"]
    assert refused(patch_json(admin, place, {"name": "Bench", "y": 2.5})) == (422, "wall")
    assert told(admin) == [("quality_table", "Quality table", "point", 1.5, 0.5)]


def test_the_name_of_a_room_may_stand_anywhere_on_the_map(admin: Client) -> None:
    answer = post_json(admin, PLACES, {"name": "Halle Süd", "kind": "room", "x": 0.5, "y": 2.5})
    assert (answer.status_code, answer.json()["id"]) == (201, "halle_sud")


def test_ids_are_made_of_names_in_any_letters_and_never_twice(admin: Client) -> None:
    names = ["Prüf-Tisch", "Pruf Tisch", "机台", "倉庫"]
    made = [post_json(admin, PLACES, {**TABLE, "name": name}).json()["id"] for name in names]
    assert made == ["pruf_tisch", "pruf_tisch_2", "place", "place_2"]


def test_a_place_gets_no_id_that_a_device_of_the_site_has(admin: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(places, "MOST_PLACES", 2)
    for name in ("mixer", "mixer_2", "mixer_4"):
        describe(replace(MIXER, id=name, methods=()))
    made = [post_json(admin, PLACES, {**TABLE, "name": name}).json()["id"] for name in ("Mixer", "MIXER!")]
    assert made == ["mixer_3", "mixer_5"]
    admin.delete(f"{PLACES}/mixer_5")
    wished = post_json(admin, PLACES, {**TABLE, "name": "Bench", "id": "mixer_2"})
    assert refused(wished) == (409, "taken_device")
    assert wished.json()["detail"].startswith("A device of this site has the id 'mixer_2'.")


def test_ids_of_another_sites_devices_are_free_for_places(admin: Client) -> None:
    services.create_site(name="Shed", slug="shed")
    services.expect_device(site="shed", device_id="quality_table", credential="k" * 32)
    assert post_json(admin, PLACES, TABLE).json()["id"] == "quality_table"


def test_a_device_with_the_id_of_a_place_is_not_approved_until_the_place_has_another(admin: Client) -> None:
    post_json(admin, PLACES, TABLE)
    describe(replace(MIXER, id="quality_table", methods=()))
    approval = "/api/sites/hall/devices/quality_table/approve"
    answer = post_json(admin, approval)
    assert refused(answer) == (422, "bad_device")
    assert answer.json()["args"]["faults"][0]["code"] == "id_of_place"
    assert answer.json()["detail"] == (
        "quality_table has the id of the place “Quality table”, so robots that are sent to one would drive to the "
        "other. Remove the place and add it anew, which gives it another id, or give the device another id."
    )
    assert [(d.id, d.lifecycle) for d in services.list_devices(site="hall")] == [("quality_table", "pending")]
    admin.delete(f"{PLACES}/quality_table")
    assert refused(post_json(admin, PLACES, {**TABLE, "id": "quality_table"})) == (409, "taken_device")
    assert post_json(admin, PLACES, TABLE).json()["id"] == "quality_table_2"
    assert post_json(admin, approval).json()["lifecycle"] == "approved"


def test_a_removed_place_comes_back_under_its_id(admin: Client) -> None:
    made = post_json(admin, PLACES, TABLE).json()
    admin.delete(f"{PLACES}/{made['id']}")
    again = post_json(admin, PLACES, {name: made[name] for name in ("id", "name", "kind", "x", "y", "theta")})
    assert (again.status_code, again.json()) == (201, made)


def test_a_site_has_so_many_places_and_no_more(admin: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(places, "MOST_PLACES", 2)
    answers = [post_json(admin, PLACES, {**TABLE, "name": name}) for name in ("A", "B", "C")]
    assert [refused(answer) if answer.status_code != 201 else "" for answer in answers] == ["", "", (422, "many")]


def test_a_site_without_a_map_has_no_places(admin: Client) -> None:
    services.create_site(name="Shed", slug="shed")
    services.set_member(site="shed", email="admin@vipo.example", role="admin")
    assert refused(post_json(admin, "/api/sites/shed/places", TABLE)) == (404, "no_map")


def codes(program: Any) -> set[str]:
    found: Any = editor.get_compiled(program_id=program)["diagnostics"]
    return {each["code"] for each in found}


def test_what_names_a_removed_place_says_so_and_lists_tell_which_programs_do(admin: Client) -> None:
    services.save_map(site="hall", grid=Grid(100, 100, 0.1, 0.0, 0.0, bytes(10_000)))
    place = post_json(admin, PLACES, {**TABLE, "x": 5, "y": 5}).json()["id"]
    drawn = document({"s": step("move", to={"place": place})})
    program = editor.create_program(site="hall", name="Go", document=drawn).id
    listed = admin.get("/api/sites/hall/programs").json()
    assert [(each["name"], each["places"]) for each in listed] == [("Go", [place])]
    assert "unknown_place" not in codes(program)
    admin.delete(f"{PLACES}/{place}")
    assert "unknown_place" in codes(program)

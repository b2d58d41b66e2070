"""A site as a WoT directory: listing, one Thing, and its patch."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import pytest

from registry import services
from registry.models import DeviceEvent
from tests.kit.sign_in import ROLES, signed_in
from tests.kit.sites import MIXER, approve, make_mixers
from vipo_device.descriptions.td_schema import check_thing
from vipo_device.protocol.description import Pose

ADDRESS = "/api/sites/hall/things"
URN = "urn:vipo:device:"


@pytest.fixture
def things(hall: str) -> str:
    make_mixers("c", "a", "b")
    return hall


def test_approved_devices_are_listed_as_valid_things_a_page_at_a_time(things: str) -> None:
    answer = signed_in("viewer").get(ADDRESS, {"limit": 2})
    assert answer["Content-Type"] == "application/ld+json"
    assert [thing["id"] for thing in answer.json()] == [f"{URN}a", f"{URN}b"]
    for thing in answer.json():
        check_thing(thing)
    following, rest = answer["Link"].removeprefix("<").split('>; rel="next", ')
    assert rest.startswith(f'<{ADDRESS}>; rel="canonical"; etag="')
    last = signed_in("viewer").get(following)
    assert [thing["title"] for thing in last.json()] == ["Mixer c"]
    assert last["Link"] == rest


def test_a_collection_names_its_total_and_the_next_page(things: str) -> None:
    body = signed_in("viewer").get(ADDRESS, {"format": "collection", "limit": 1, "sort_order": "desc"}).json()
    assert (body["@type"], body["total"], [t["id"] for t in body["members"]]) == ("ThingCollection", 3, [f"{URN}c"])
    assert signed_in("viewer").get(body["next"]).json()["members"][0]["id"] == f"{URN}b"
    assert signed_in("viewer").get(ADDRESS, {"limit": 101}).status_code == 422


@pytest.mark.parametrize("thing", ["a", f"{URN}a"])
def test_a_thing_is_found_by_either_id(things: str, thing: str) -> None:
    answer = signed_in("viewer").get(f"{ADDRESS}/{thing}")
    assert (answer.status_code, answer["Content-Type"]) == (200, "application/td+json")
    assert answer.json()["title"] == "Mixer a"
    check_thing(answer.json())


@pytest.mark.django_db(transaction=True)  # to close a stream closes the connection to the database
@pytest.mark.parametrize("role", [*ROLES, "stranger", "nobody"])
def test_members_look_and_admins_change(things: str, role: str) -> None:
    client = signed_in(role)
    outside = {"stranger": 404, "nobody": 401}.get(role)
    for path in (ADDRESS, f"{ADDRESS}/a", f"{ADDRESS}/events"):
        answer = client.get(path)
        assert answer.status_code == (outside or 200)
        answer.close()
    patched = client.patch(f"{ADDRESS}/a", {"title": "Mine"}, content_type="application/merge-patch+json")
    assert patched.status_code == (outside or (204 if role == "admin" else 403))
    device = services.get_device(site="hall", device_id="a")
    assert device.name == ("Mine" if role == "admin" else "Mixer a")


def test_a_patch_moves_and_renames_and_null_gives_back_the_own_name_and_place(things: str) -> None:
    admin = signed_in("admin")
    own = services.get_device(site="hall", device_id="a").pose

    def patch(body: Any) -> Any:
        return admin.patch(f"{ADDRESS}/{URN}a", json.dumps(body), content_type="application/merge-patch+json")

    assert patch({"title": "Left", "vipo:location": [1.5, 2.5, 0, 1]}).status_code == 204
    body = admin.get(f"{ADDRESS}/a").json()
    assert (body["title"], body["vipo:location"]) == ("Left", [1.5, 2.5, 0.0, 1.0])
    assert patch({"title": None}).status_code == 204
    device = services.get_device(site="hall", device_id="a")
    assert (device.name, device.pose) == ("Mixer a", Pose(1.5, 2.5, 0.0, 1.0))
    assert patch({"vipo:location": None}).status_code == 204
    assert services.get_device(site="hall", device_id="a").pose == own
    edits = DeviceEvent.objects.filter(device_id="a", kind="edited").values_list("by__display_name", flat=True)
    assert set(edits) == {"Admin Person"}


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ("{", "The patch is not JSON: a key in double quotes is expected here."),
        ("[" * 10_000, "The patch is nested more than 16 levels deep."),
        ("[]", "A merge patch is a JSON object with at least one field."),
        ("{}", "A merge patch is a JSON object with at least one field."),
        ('{"actions": {}}', "'actions' cannot be changed here: the device says it itself."),
        ('{"title": "\\u0000"}', "The patch holds a character that is not text"),
        ('{"title": 3}', "`title` must be a text, or null for the device's own."),
        ('{"vipo:location": [1]}', "`vipo:location` must be [x, y, z, theta]"),
        ('{"vipo:location": [1, NaN]}', "The patch holds NaN, which is not a number of JSON."),
    ],
)
def test_what_is_not_for_people_to_change_is_refused(things: str, body: str, told: str) -> None:
    before = DeviceEvent.objects.count()
    answer = signed_in("admin").patch(f"{ADDRESS}/a", body, content_type="application/merge-patch+json")
    assert (answer.status_code, answer.json()["code"]) == (400, "bad_thing_patch")
    assert answer.json()["detail"].startswith(told)
    assert DeviceEvent.objects.count() == before


def test_a_thing_is_told_as_simulated_while_a_stand_in_speaks_for_it(hall: str) -> None:
    approve(replace(MIXER, simulated=False))
    client = signed_in("viewer")
    asked = "ASK { ?device vipo:simulated true }"

    def told() -> tuple[bool, str, bool]:
        thing = client.get(f"{ADDRESS}/{MIXER.id}")
        answer = client.get("/api/sites/hall/sparql", {"query": asked, "format": "json"})
        return thing.json()["vipo:simulated"], thing["ETag"], answer.json()["boolean"]

    before = told()
    services.switch_stand_in(site="hall", device_id=MIXER.id, simulated=True, by=None, at=datetime.now(UTC))
    during = told()
    assert (before[0], before[2], during[0], during[2]) == (False, False, True, True)
    assert before[1] != during[1]
    services.switch_stand_in(site="hall", device_id=MIXER.id, simulated=False, by=None, at=datetime.now(UTC))
    assert told() == before

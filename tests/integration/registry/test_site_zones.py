"""Zones that admins draw, change and remove on a site's map."""

from __future__ import annotations

from typing import Any

import pytest
from django.test import Client

from editor import services as editor
from execution.floor.layouts import get_layout
from registry import services
from registry.floorplan.plan import Grid
from registry.maps import zones
from tests.kit.programs import document, step
from tests.kit.sign_in import patch_json, post_json, signed_in

ZONES = "/api/sites/hall/zones"
SQUARE = [[0.5, 0.5], [1.5, 0.5], [1.5, 1.5], [0.5, 1.5]]
AISLE = {"name": "Service aisle", "rule": "keep_out", "points": SQUARE}
UNSAID = {"speed_m_s": None, "robots": None, "heading_deg": None, "open_until": None}


@pytest.fixture
def admin(hall: str) -> Client:
    return signed_in("admin")


def told(client: Client) -> list[tuple[str, str, str, float | None]]:
    shown = client.get("/api/sites/hall/map").json()["zones"]
    return [(each["id"], each["name"], each["rule"], each["speed_m_s"]) for each in shown]


def refused(answer: Any) -> tuple[int, str]:
    body = answer.json()
    return answer.status_code, body.get("args", {}).get("why") or body["code"]


def test_a_zone_is_drawn_changed_and_removed(
    admin: Client, heard: list[Any], django_capture_on_commit_callbacks: Any
) -> None:
    with django_capture_on_commit_callbacks(execute=True):
        made = post_json(admin, ZONES, AISLE)
        assert (made.status_code, made["Location"]) == (201, f"{ZONES}/service_aisle")
        assert made.json() == {**AISLE, **UNSAID, "id": "service_aisle"}
        slow = patch_json(admin, made["Location"], {"rule": "slow", "speed_m_s": 0.25, "name": "Aisle"})
        changed = {"name": "Aisle", "rule": "slow", "speed_m_s": 0.25}
        assert slow.json() == {**made.json(), **changed}
        assert told(admin) == [("service_aisle", "Aisle", "slow", 0.25)]
        shut = patch_json(admin, made["Location"], {"rule": "one_at_a_time"})
        assert (shut.json()["speed_m_s"], shut.json()["robots"]) == (None, 1)
        assert patch_json(admin, made["Location"], {"robots": 3}).json()["robots"] == 3
        assert admin.delete(made["Location"]).status_code == 204
    assert told(admin) == []
    done = [(line["code"], line["facts"]) for line in admin.get("/api/sites/hall/audit?kind=map").json()]
    names = (
        ("zone_removed", "Aisle"),
        ("zone_changed", "Aisle"),
        ("zone_changed", "Aisle"),
        ("zone_changed", "Aisle"),
        ("zone_added", "Service aisle"),
    )
    assert done[:5] == [(code, {"zone": name}) for code, name in names]
    assert heard == [("hall", {"type": "map", "version": 1})] * 5
    gone = made["Location"]
    for answer in (admin.get(gone), admin.delete(gone), patch_json(admin, gone, {})):
        assert refused(answer) == (404, "no_such_zone")


def test_a_zone_is_made_one_way_turned_and_made_preferred(admin: Client) -> None:
    made = post_json(admin, ZONES, {**AISLE, "rule": "one_way", "heading_deg": -90})
    assert (made.status_code, made.json()["heading_deg"]) == (201, 270)
    at = made["Location"]
    assert refused(patch_json(admin, at, {"heading_deg": 400})) == (422, "bad_request")
    assert patch_json(admin, at, {"heading_deg": 359.96}).json()["heading_deg"] == 0
    layout = get_layout("hall")
    assert [(zone.rule, zone.heading_deg) for zone in layout.zones] == [("one_way", 0)]
    assert layout.against
    preferred = patch_json(admin, at, {"rule": "preferred"}).json()
    assert (preferred["rule"], preferred["heading_deg"]) == ("preferred", None)
    assert get_layout("hall").preferred
    assert refused(patch_json(admin, at, {"rule": "one_way"})) == (422, "no_heading")


@pytest.mark.parametrize(
    ("change", "answer"),
    [
        ({"name": " "}, (422, "name")),
        ({"name": "x" * 61}, (422, "name")),
        ({"points": [[0, 0], [1, 1]]}, (422, "corners")),
        ({"rule": "one_at_a_time", "robots": 21}, (422, "robots")),
        *(({"rule": "one_at_a_time", "robots": none}, (422, "bad_request")) for none in (0, -1, 1.5, "2", True, 1e9)),
        ({"points": [[x / 100, (x % 2) / 100] for x in range(101)]}, (422, "corners")),
        ({"points": [[0, 0], [4.01, 0], [1, 1]]}, (422, "off")),
        ({"points": [[0, 0], [1, 1], [1, 0], [0, 1]]}, (422, "crossing")),
        ({"points": [[0, 0], [1, 0], [2, 0]]}, (422, "crossing")),
        ({"points": [[0, 0], [0.1, 0], [0.1, 0.1]]}, (422, "small")),
        ({"points": [[0, 0], [1e300, 0], [1, 1]]}, (422, "bad_request")),
        ({"points": [[0, 0], [1], [1, 1]]}, (422, "bad_request")),
        ({"rule": "slow"}, (422, "no_speed")),
        ({"rule": "one_way"}, (422, "no_heading")),
        *(({"rule": "one_way", "heading_deg": odd}, (422, "bad_request")) for odd in (361, -1e9, "left", True, [0])),
        ({"rule": "slow", "speed_m_s": 0.04}, (422, "speed")),
        ({"rule": "slow", "speed_m_s": 0}, (422, "bad_request")),
        ({"rule": "door"}, (422, "bad_request")),
        ({"id": "a b"}, (422, "id")),
        ({"id": "service_aisle"}, (409, "taken_id")),
        ({"name": "SERVICE  aisle"}, (409, "taken_name")),
    ],
)
def test_a_zone_that_cannot_be_is_refused_and_nothing_is_made(
    admin: Client, change: dict[str, Any], answer: tuple[int, str]
) -> None:
    assert post_json(admin, ZONES, AISLE).status_code == 201
    before = told(admin)
    assert refused(post_json(admin, ZONES, {**AISLE, "name": "Other", **change})) == answer
    assert told(admin) == before


def test_a_refused_change_leaves_a_zone_as_it_is(admin: Client) -> None:
    at = post_json(admin, ZONES, AISLE)["Location"]
    assert refused(patch_json(admin, at, {"name": "Other", "points": [[0, 0], [1, 1], [1, 0], [0, 1]]})) == (
        422,
        "crossing",
    )
    assert admin.get(at).json() == {**AISLE, **UNSAID, "id": "service_aisle"}


def test_two_admins_who_change_different_things_of_a_zone_both_have_their_way(admin: Client) -> None:
    at = post_json(admin, ZONES, AISLE)["Location"]
    other = signed_in("admin")
    assert patch_json(admin, at, {"name": "Aisle"}).status_code == 200
    moved = [[x + 0.5, y] for x, y in SQUARE]
    changed = {"name": "Aisle", "points": moved}
    assert patch_json(other, at, {"points": moved}).json() == {**AISLE, **UNSAID, "id": "service_aisle", **changed}


def test_a_zone_that_is_asked_for_twice_with_one_key_is_made_once(admin: Client) -> None:
    key = {"HTTP_IDEMPOTENCY_KEY": "3c1f4d0e-0000-4000-8000-000000000001"}
    first = admin.post(ZONES, AISLE, content_type="application/json", **key)
    again = admin.post(ZONES, AISLE, content_type="application/json", **key)
    assert (first.status_code, again.status_code, again.json()) == (201, 201, first.json())
    assert len(told(admin)) == 1


def test_a_site_has_so_many_zones_and_no_more(admin: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zones, "MOST_ZONES", 2)
    answers = [post_json(admin, ZONES, {**AISLE, "name": name}) for name in ("A", "B", "C")]
    assert [refused(answer) if answer.status_code != 201 else "" for answer in answers] == ["", "", (422, "many")]


def test_a_site_without_a_map_has_no_zones(admin: Client) -> None:
    services.create_site(name="Shed", slug="shed")
    services.set_member(site="shed", email="admin@vipo.example", role="admin")
    assert refused(post_json(admin, "/api/sites/shed/zones", AISLE)) == (404, "no_map")


def test_a_program_that_goes_into_a_zone_to_keep_out_of_says_so_until_it_is_gone(admin: Client) -> None:
    services.save_map(site="hall", grid=Grid(100, 100, 0.1, 0.0, 0.0, bytes(10_000)))
    drawn = document({"s": step("move", to={"point": [5.0, 5.0]})})
    program = editor.create_program(site="hall", name="Go", document=drawn).id

    def zones_told() -> list[Any]:
        found: Any = editor.get_compiled(program_id=program)["diagnostics"]
        return [each["args"]["zone"] for each in found if each["code"] == "place_in_keep_out"]

    assert zones_told() == []
    at = post_json(admin, ZONES, {**AISLE, "points": [[4, 4], [6, 4], [6, 6], [4, 6]]})["Location"]
    assert zones_told() == ["Service aisle"]
    patch_json(admin, at, {"rule": "slow", "speed_m_s": 0.2})
    assert zones_told() == []


def test_a_floor_at_work_has_a_changed_zone_at_its_next_look_and_keeps_its_lattice(admin: Client) -> None:
    services.save_map(site="hall", grid=Grid(100, 100, 0.1, 0.0, 0.0, bytes(10_000)))
    before = get_layout("hall")
    post_json(admin, ZONES, AISLE)
    after = get_layout("hall")
    assert (before.zones, [(zone.key, zone.rule) for zone in after.zones]) == ((), [("site/service_aisle", "keep_out")])
    assert after.lattice is before.lattice
    assert get_layout("hall") is after


def test_a_route_on_the_drawing_goes_round_a_zone_to_keep_out_of_and_there_is_none_into_it(admin: Client) -> None:
    services.save_map(site="hall", grid=Grid(100, 100, 0.1, 0.0, 0.0, bytes(10_000)))

    def route(to: list[float]) -> Any:
        return post_json(admin, "/api/sites/hall/routes", {"pairs": [{"from": [2.25, 5.25], "to": to}]}).json()[0]

    straight = route([8.25, 5.25])["length_m"]
    post_json(admin, ZONES, {**AISLE, "points": [[4, 4], [6, 4], [6, 6], [4, 6]]})
    round_it = route([8.25, 5.25])
    assert round_it["length_m"] > straight + 1
    assert not any(3.8 < x < 6.2 and 3.8 < y < 6.2 for x, y in round_it["path"])
    assert route([5.25, 5.25]) is None


def test_a_route_on_the_drawing_goes_round_a_zone_that_people_let_robots_into_and_leads_into_it(admin: Client) -> None:
    services.save_map(site="hall", grid=Grid(100, 100, 0.1, 0.0, 0.0, bytes(10_000)))
    post_json(admin, ZONES, {**AISLE, "rule": "release", "points": [[4, 4], [6, 4], [6, 6], [4, 6]]})

    def path(start: list[float], to: list[float]) -> Any:
        found = post_json(admin, "/api/sites/hall/routes", {"pairs": [{"from": start, "to": to}]}).json()[0]
        return [3.8 < x < 6.2 and 3.8 < y < 6.2 for x, y in found["path"]]

    assert not any(path([2.25, 5.25], [8.25, 5.25]))
    assert any(path([2.25, 5.25], [5.25, 5.25]))
    assert any(path([5.25, 5.25], [8.25, 5.25]))


def test_a_route_on_the_drawing_goes_round_a_zone_that_leads_against_it(admin: Client) -> None:
    services.save_map(site="hall", grid=Grid(100, 100, 0.1, 0.0, 0.0, bytes(10_000)))

    def length_m(start: list[float], to: list[float]) -> float:
        found = post_json(admin, "/api/sites/hall/routes", {"pairs": [{"from": start, "to": to}]}).json()[0]
        return float(found["length_m"])

    west, east = [2.25, 5.25], [8.25, 5.25]
    straight = length_m(west, east)
    at = post_json(
        admin,
        ZONES,
        {**AISLE, "rule": "one_way", "heading_deg": 180, "points": [[4, 4], [6, 4], [6, 6], [4, 6]]},
    )["Location"]
    assert length_m(west, east) > straight + 1
    assert length_m(east, west) == straight
    patch_json(signed_in("admin"), at, {"heading_deg": 0})
    assert length_m(west, east) == straight
    assert length_m(east, west) > straight + 1

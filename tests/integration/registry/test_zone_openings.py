"""Zones that an operator opens to all robots for a time: who may, for how long, and what the floor makes of it."""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import Any

import pytest
from django.test import Client
from django.utils import timezone

from editor import services as editor
from execution.floor.layouts import get_layout
from tests.kit.sign_in import below_role, from_role, patch_json, post_json, signed_in

ZONES = "/api/sites/hall/zones"
GATE = {"name": "Gate", "rule": "release", "points": [[0.5, 0.5], [1.5, 0.5], [1.5, 1.5], [0.5, 1.5]]}
OPENING = f"{ZONES}/gate/opening"


@pytest.fixture
def admin(hall: str) -> Client:
    client = signed_in("admin")
    assert post_json(client, ZONES, GATE).status_code == 201
    return client


def put(client: Client, minutes: Any, path: str = OPENING) -> Any:
    return client.put(path, {"minutes": minutes}, content_type="application/json")


def minutes_left(shown: Any) -> float:
    return (datetime.fromisoformat(shown["open_until"]) - timezone.now()) / timedelta(minutes=1)


def shown(client: Client) -> Any:
    (zone,) = client.get("/api/sites/hall/map").json()["zones"]
    return zone


@pytest.mark.parametrize("role", from_role("operator"))
def test_who_may_run_programs_opens_a_zone_for_a_time_and_closes_it(admin: Client, role: str) -> None:
    client = signed_in(role)
    opened = put(client, 90)
    assert opened.status_code == 200
    assert minutes_left(opened.json()) == pytest.approx(90, abs=1)
    assert shown(admin) == opened.json()
    assert client.delete(OPENING).status_code == 204
    assert shown(admin)["open_until"] is None


@pytest.mark.parametrize("role", below_role("operator"))
def test_who_may_not_sees_that_it_is_open_and_neither_opens_nor_closes_it(admin: Client, role: str) -> None:
    client = signed_in(role)
    assert put(client, 10).status_code == 403
    assert shown(client)["open_until"] is None
    until = put(admin, 10).json()["open_until"]
    assert client.delete(OPENING).status_code == 403
    assert shown(client)["open_until"] == until


def test_a_stranger_learns_nothing_and_opens_nothing(admin: Client) -> None:
    stranger = signed_in("stranger")
    assert (put(stranger, 10).status_code, stranger.delete(OPENING).status_code) == (404, 404)
    assert shown(admin)["open_until"] is None


def test_the_floor_has_it_at_its_next_look_and_programs_are_checked_as_before(admin: Client) -> None:
    before = get_layout("hall")
    facts = editor.find_zones(site="hall")
    until = datetime.fromisoformat(put(admin, 5).json()["open_until"]).timestamp()
    after = get_layout("hall")
    assert after.lattice is before.lattice
    assert [zone.open_until for zone in after.zones] == [pytest.approx(until, abs=0.01)]
    assert [after.zones[0].is_open(until + late) for late in (-1, 1)] == [True, False]
    assert editor.find_zones(site="hall") == facts
    admin.delete(OPENING)
    assert get_layout("hall").zones == before.zones


def test_it_is_told_to_browsers_and_kept_in_the_record(
    admin: Client, heard: list[Any], django_capture_on_commit_callbacks: Any
) -> None:
    heard.clear()
    with django_capture_on_commit_callbacks(execute=True):
        put(admin, 60)
        put(admin, 15)
        admin.delete(OPENING)
        admin.delete(OPENING)  # closed already: nothing happens, and nothing is told
    assert heard == [("hall", {"type": "map", "version": 1})] * 3
    done = [(line["code"], line["facts"]) for line in admin.get("/api/sites/hall/audit?kind=runs").json()]
    assert done[:3] == [
        ("zone_closed", {"zone": "Gate"}),
        ("zone_opened", {"zone": "Gate", "minutes": 15}),
        ("zone_opened", {"zone": "Gate", "minutes": 60}),
    ]


@pytest.mark.parametrize("minutes", [0, -1, 1441, 10**12, 1.5, "10", True, None, [10]])
def test_a_time_that_cannot_be_is_refused(admin: Client, minutes: Any) -> None:
    assert put(admin, minutes).status_code == 422
    assert shown(admin)["open_until"] is None


def test_a_time_of_more_than_a_day_is_refused_with_how_long_it_may_be(admin: Client) -> None:
    refused = put(admin, 1441).json()
    assert (refused["code"], refused["args"]) == ("bad_zone", {"why": "minutes", "most": 1440})


def test_what_is_no_such_zone_is_neither_opened_nor_closed(admin: Client) -> None:
    assert put(admin, 10, f"{ZONES}/gone/opening").json()["code"] == "no_such_zone"
    assert post_json(admin, ZONES, {**GATE, "name": "Aisle", "rule": "keep_out"}).status_code == 201
    for answer in (put(admin, 10, f"{ZONES}/aisle/opening"), admin.delete(f"{ZONES}/aisle/opening")):
        assert (answer.status_code, answer.json()["code"], answer.json()["args"]) == (
            409,
            "not_a_released_zone",
            {"why": "rule", "zone": "Aisle"},
        )


def test_a_zone_with_another_rule_is_open_no_more_also_when_it_has_the_old_one_again(admin: Client) -> None:
    put(admin, 60)
    assert patch_json(admin, f"{ZONES}/gate", {"name": "Door"}).json()["open_until"] is not None
    assert patch_json(admin, f"{ZONES}/gate", {"rule": "keep_out"}).json()["open_until"] is None
    assert patch_json(admin, f"{ZONES}/gate", {"rule": "release"}).json()["open_until"] is None


def test_it_is_opened_by_one_while_another_moves_it_and_both_have_their_way(admin: Client) -> None:
    operator = signed_in("operator")
    until = put(operator, 60).json()["open_until"]
    moved = [[0.5, 0.5], [2, 0.5], [2, 1.5]]
    after = patch_json(admin, f"{ZONES}/gate", {"points": moved}).json()
    assert (after["points"], after["open_until"]) == (moved, until)

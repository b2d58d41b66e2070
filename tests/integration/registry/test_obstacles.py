"""Obstacles that people put in the way of simulated robots: who may, which, and who hears of it."""

from __future__ import annotations

from typing import Any

import pytest
from django.test import Client

from execution.floor.layouts import get_layout
from simulation.site_facts import read_obstacles
from simulation.world import Obstacle
from tests.kit.sign_in import below_role, from_role, post_json, signed_in

OBSTACLES = "/api/sites/hall/obstacles"
BOX = {"x": 1.5, "y": 1.25, "size_m": 0.4}


def shown(client: Client) -> Any:
    return client.get("/api/sites/hall/map").json()["obstacles"]


def put(client: Client, obstacle: int, fields: dict[str, Any]) -> Any:
    return client.put(f"{OBSTACLES}/{obstacle}", fields, content_type="application/json")


@pytest.mark.parametrize("role", from_role("operator"))
def test_who_may_run_programs_puts_moves_and_takes_away(
    hall: str, role: str, heard: list[tuple[str, Any]], django_capture_on_commit_callbacks: Any
) -> None:
    client = signed_in(role)
    with django_capture_on_commit_callbacks(execute=True):
        made = post_json(client, OBSTACLES, BOX).json()
    assert made == {"id": made["id"], **BOX}
    assert [message for site, message in heard if site == "hall"] == [{"type": "obstacles"}]
    assert read_obstacles("hall") == (Obstacle(1.5, 1.25, 0.4),)
    moved = put(client, made["id"], {"x": 0.5, "y": 0.5})
    assert moved.json() == {"id": made["id"], "x": 0.5, "y": 0.5, "size_m": BOX["size_m"]}, "it stays as wide as it was"
    moved = put(client, made["id"], {"x": 0.5, "y": 0.5, "size_m": 0.6})
    assert moved.json()["size_m"] == 0.6
    assert shown(client) == [moved.json()]
    assert client.delete(f"{OBSTACLES}/{made['id']}").status_code == 204
    assert shown(client) == []


@pytest.mark.parametrize("role", below_role("operator"))
def test_who_may_not_sees_them_and_changes_nothing(hall: str, role: str) -> None:
    made = post_json(signed_in("operator"), OBSTACLES, BOX).json()
    client = signed_in(role)
    refused = [
        post_json(client, OBSTACLES, BOX), put(client, made["id"], BOX),
        client.delete(f"{OBSTACLES}/{made['id']}"), client.delete(OBSTACLES),
    ]  # fmt: skip
    assert [answer.status_code for answer in refused] == [403] * 4
    assert shown(client) == [made]


def test_a_stranger_learns_nothing_and_another_site_is_not_touched(hall: str) -> None:
    made = post_json(signed_in("operator"), OBSTACLES, BOX).json()
    stranger = signed_in("stranger")
    assert post_json(stranger, OBSTACLES, BOX).status_code == 404
    assert stranger.delete(OBSTACLES).status_code == 404
    assert read_obstacles("elsewhere") == ()
    assert len(read_obstacles("hall")) == 1
    assert put(stranger, made["id"], BOX).status_code == 404


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"x": 900, "y": 1}, "off the map at 900.00, 1.00"),
        ({"x": 1, "y": 1, "size_m": 5}, "0.1 to 2 m wide"),
        ({"x": 1, "y": 1, "size_m": 0.01}, "0.1 to 2 m wide"),
        ({"x": 1}, "y"),
        ({"x": 1, "y": "one"}, "y"),
        ({"x": 1, "y": 1, "colour": "red"}, "colour"),
    ],
)
def test_what_cannot_lie_there_is_refused_in_words(hall: str, fields: dict[str, Any], words: str) -> None:
    answer = post_json(signed_in("operator"), OBSTACLES, fields)
    assert answer.status_code == 422
    assert words in answer.content.decode()
    assert read_obstacles("hall") == ()


def test_a_site_has_at_most_fifty_and_all_go_at_once(hall: str) -> None:
    client = signed_in("operator")
    for _ in range(50):
        assert post_json(client, OBSTACLES, BOX).status_code == 201
    refused = post_json(client, OBSTACLES, BOX)
    assert (refused.status_code, refused.json()["code"]) == (422, "bad_obstacle")
    assert client.delete(OBSTACLES).status_code == 204
    assert client.delete(OBSTACLES).status_code == 204
    assert shown(client) == []


@pytest.mark.parametrize("number", [1, 2**63, 2**80])
def test_one_that_is_gone_is_named(hall: str, number: int) -> None:
    client = signed_in("operator")
    for answer in (put(client, number, BOX), client.delete(f"{OBSTACLES}/{number}")):
        assert answer.status_code == 404
        assert answer.json()["code"] == "no_such_obstacle"


def test_paths_are_planned_as_if_nothing_lay_there(hall: str) -> None:
    before = get_layout("hall")
    post_json(signed_in("operator"), OBSTACLES, BOX)
    assert get_layout("hall") is before


def test_the_record_says_who_put_and_took_what(hall: str) -> None:
    admin = signed_in("admin")
    post_json(admin, OBSTACLES, BOX)
    admin.delete(OBSTACLES)
    lines = admin.get("/api/sites/hall/audit?kind=runs").json()
    assert [(line["code"], line["facts"]) for line in lines] == [
        ("obstacles_removed", {"count": 1}),
        ("obstacle_added", {"x": 1.5, "y": 1.25, "size_m": 0.4}),
    ]

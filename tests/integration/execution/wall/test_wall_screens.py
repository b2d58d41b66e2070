"""A wall screen shows one site to whatever holds its link, tells no name of a person, and goes dark when it ends."""

from __future__ import annotations

import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from datetime import UTC, datetime, timedelta
from typing import Any
from uuid import uuid4

import pytest
from channels.db import database_sync_to_async
from channels.routing import URLRouter
from channels.testing import WebsocketCommunicator
from django.test import Client
from django.urls import path
from pytest_django import Settings

from execution import services as execution
from execution.models import Run
from execution.wall.socket import WallSocket
from registry import services
from registry.floorplan.plan import Grid
from registry.models import AuditLine, Device, DeviceAlert, Site, User, WallScreen
from registry.people import throttle
from registry.people.wall_screens import COOKIE, find_wall, key_of, make_wall_screen, prune_wall_screens
from tests.kit.sign_in import post_json
from tests.kit.sites import MIXER, describe

WALLS = "/api/sites/hall/wall-screens"
pytestmark = pytest.mark.django_db(transaction=True)
NAMES = ("Zephyrine", "Quillon", "zq-")
"""What stands in every name and address of a person of these tests, and in nothing else."""


@pytest.fixture
def hall() -> str:
    """A site with a map, a device, and people whose names can be told from everything else."""
    services.create_site(name="Hall", slug="hall")
    services.save_map(site="hall", grid=Grid(4, 3, 1.0, 0.0, 0.0, bytes([0, 100, 255] * 4)))
    for role in ("viewer", "operator", "author", "admin"):
        user = services.create_user(
            email=f"zq-{role}@vipo.example", password="correct-horse-9", display_name=f"Zephyrine Quillon {role}"
        )
        services.set_member(site="hall", email=user.email, role=role)
    describe(MIXER)
    Device.objects.update(lifecycle="approved", online=True, properties={"jobStatus": 40})
    return "hall"


def person(role: str) -> User:
    return User.objects.get(email=f"zq-{role}@vipo.example")


def as_person(role: str) -> Client:
    client = Client()
    client.force_login(person(role))
    return client


def make(role: str = "admin", **wanted: Any) -> Any:
    return post_json(as_person(role), WALLS, {"name": "Hall 1, east wall", **wanted})


def code_of(answer: Any) -> str:
    return str(answer.json()["link"]).partition("#")[2]


def open_link(code: str, client: Client | None = None) -> Any:
    return post_json(client or Client(), "/api/wall/open", {"code": code})


@asynccontextmanager
async def showing(key: str) -> AsyncIterator[WebsocketCommunicator]:
    socket = WebsocketCommunicator(URLRouter([path("ws/wall", WallSocket.as_asgi())]), "/ws/wall")
    socket.scope["cookies"] = {COOKIE: key} if key else {}
    connected, _ = await socket.connect(timeout=5)
    assert connected
    try:
        yield socket
    finally:
        await socket.disconnect(timeout=5)


async def close_code(socket: WebsocketCommunicator) -> int:
    while (event := await socket.receive_output(timeout=10))["type"] != "websocket.close":
        pass
    code: int = event["code"]
    return code


async def until(socket: WebsocketCommunicator, wanted: Any, heard: list[dict[str, Any]]) -> dict[str, Any]:
    """Return the first message that is wanted; all that came are kept in `heard`."""
    for _ in range(20):
        heard.append(await socket.receive_json_from(30))
        if wanted(heard[-1]):
            return heard[-1]
    raise AssertionError([each["type"] for each in heard])


def test_a_link_is_told_once_and_neither_it_nor_its_cookie_is_kept(hall: str) -> None:
    made = make(days=30)
    code = code_of(made)
    assert made.json()["link"] == f"http://testserver/wall#{code}"
    assert (made.status_code, made["Cache-Control"], len(code)) == (201, "no-store", 43)
    kept = " ".join(map(str, WallScreen.objects.values_list().get()))
    listed = as_person("admin").get(WALLS).content.decode()
    record = str(list(AuditLine.objects.values()))
    for secret in (code, key_of(code)):
        assert secret not in kept + listed + record
    assert [(each["name"], each["seen_at"], each["expired"]) for each in json.loads(listed)] == [
        ("Hall 1, east wall", None, False)
    ]


def test_the_code_becomes_a_cookie_that_no_script_reads_and_that_goes_to_the_socket_alone(
    hall: str, settings: Settings
) -> None:
    settings.SESSION_COOKIE_SECURE = True
    code, screen = code_of(make()), Client()
    answer = open_link(code, screen)
    cookie = answer.cookies[COOKIE]
    assert (answer.status_code, answer["Cache-Control"]) == (204, "no-store")
    assert (cookie["path"], cookie["httponly"], cookie["samesite"], cookie["secure"]) == (
        "/ws/wall",
        True,
        "Strict",
        True,
    )
    assert code not in cookie.value
    assert 364 * 86400 < int(cookie["max-age"]) <= 365 * 86400


def test_wrong_codes_are_refused_alike_and_held_up(hall: str) -> None:
    code = code_of(make())
    with_past = make_wall_screen(
        site="hall", by=person("admin"), name="Old", days=1, now=datetime(2020, 1, 1, tzinfo=UTC)
    )
    for wrong in (with_past[1], "nonsense", key_of(code)):
        answer = open_link(wrong)
        assert (answer.status_code, answer.json()["code"], COOKIE in answer.cookies) == (404, "unknown_link", False)
    for _ in range(throttle.MOST_FOR_PAIR):
        last = open_link("nonsense")
    assert last.status_code == 429
    assert open_link(code).status_code == 429


def test_what_cannot_be_is_said(hall: str, monkeypatch: pytest.MonkeyPatch) -> None:
    assert make(name="  ").status_code == 422
    assert make(days=0).status_code == 422
    monkeypatch.setattr("registry.people.wall_screens.MOST_OF_SITE", 1)
    assert make().status_code == 201
    assert make().json()["code"] == "too_many_wall_screens"
    assert as_person("admin").delete(f"{WALLS}/999").status_code == 404


def test_making_and_turning_off_are_in_the_record(hall: str) -> None:
    made = make(days=7).json()
    assert as_person("admin").delete(f"{WALLS}/{made['id']}").status_code == 204
    lines = AuditLine.objects.filter(kind="wall_screens").order_by("pk")
    assert [(line.code, line.actor, line.facts) for line in lines] == [
        ("wall_screen_made", "Zephyrine Quillon admin", {"name": "Hall 1, east wall", "days": 7}),
        ("wall_screen_revoked", "Zephyrine Quillon admin", {"name": "Hall 1, east wall"}),
    ]


def test_those_that_ended_long_ago_are_forgotten(hall: str) -> None:
    now = datetime.now(UTC)
    _, code = make_wall_screen(site="hall", by=person("admin"), name="Wall", days=1, now=now)
    assert find_wall(key=key_of(code), now=now + timedelta(days=1)) is None
    assert prune_wall_screens(now=now + timedelta(days=30)) == 0
    assert prune_wall_screens(now=now + timedelta(days=32)) == 1


@pytest.mark.parametrize("key", ["", "short", "0" * 64, "\u00e4" * 64])
async def test_without_a_standing_link_nothing_is_shown(hall: str, key: str) -> None:
    async with showing(key) as socket:
        assert await close_code(socket) == 4401


def make_key() -> str:
    return key_of(make_wall_screen(site="hall", by=person("admin"), name="Wall", days=1, now=datetime.now(UTC))[1])


async def test_it_shows_the_map_and_everything_that_happens(hall: str) -> None:
    key = await database_sync_to_async(make_key)()
    heard: list[dict[str, Any]] = []
    async with showing(key) as socket:
        drawn = await until(socket, lambda each: each["type"] == "map", heard)
        picture = await until(socket, lambda each: each["type"] == "picture", heard)
        assert (drawn["width"], drawn["height"], drawn["version"]) == (4, 3, 1)
        assert drawn["tag"] == (await database_sync_to_async(services.get_map)(site="hall")).tag
        assert picture["site"] == "Hall"
        assert [(each["id"], each["status"]) for each in picture["devices"]] == [(MIXER.id, "idle")]
        change = {"id": MIXER.id, "location": {"x": 3.0, "y": 1.0, "z": 0.0, "theta": 0.5}, "doing": "Working"}
        services.publish("hall", {"type": "device", "device": change})
        moved = await until(socket, lambda each: each["type"] == "devices", heard)
        assert moved["devices"] == [{"id": MIXER.id, "location": {"x": 3.0, "y": 1.0, "theta": 0.5}}]
        services.publish("hall", {"type": "device", "device": {"id": MIXER.id, "stand_in": True, "doing": ""}})
        switched = await until(socket, lambda each: each["type"] == "devices", heard)
        assert switched["devices"] == [{"id": MIXER.id, "stand_in": True}]
        await database_sync_to_async(execution.press_stop)(site="hall", by="Zephyrine Quillon")
        stopped = await until(socket, lambda each: each["type"] == "picture" and each["stop"]["active"], heard)
        assert stopped["stop"].keys() == {"active", "at"}
    seen = await database_sync_to_async(lambda: WallScreen.objects.get().seen_at)()
    assert seen is not None


async def test_it_goes_dark_when_it_is_turned_off(hall: str) -> None:
    key = await database_sync_to_async(make_key)()
    async with showing(key) as socket:
        await socket.receive_json_from(10)
        answer = await database_sync_to_async(turn_off_all)()
        assert answer == [204]
        assert await close_code(socket) == 4401


def turn_off_all() -> list[int]:
    admin = as_person("admin")
    return [admin.delete(f"{WALLS}/{each['id']}").status_code for each in admin.get(WALLS).json()]


def do_everything() -> None:
    """Leave names of people wherever the product keeps them beside what a wall screen shows."""
    site, by = Site.objects.get(slug="hall"), "Zephyrine Quillon operator"
    steps = {
        "s1": {
            "status": "done",
            "started_at": "2026-01-01T00:00:00",
            "wait": None,
            "why": None,
            "robot": None,
            "count": 1,
        },
        "s2": {
            "status": "waiting",
            "started_at": "2026-01-01T00:01:00",
            "wait": by,
            "why": {"code": "offline", "args": {"device": MIXER.id, "by": by}},
            "robot": None,
            "count": 1,
        },
    }
    compiled = {"order": ["s1", "s2", "s2a", "e"], "numbers": {"e": "e1"}, "depth": {"s2a": 1}}
    for number, status in enumerate(("running", "paused", "pending", "finished"), 1):
        Run.objects.create(
            site=site,
            number=number,
            program=uuid4(),
            program_name="Paint",
            created_at=datetime.now(UTC),
            status=status,
            reason=f"{by} paused it",
            started_by=by,
            steps=steps,
            compiled=compiled,
            permit={"needed": 1, "approved_by": [by], "emergency": by},
        )
    for code in ("error", "newcomer_waits", "command_failed"):
        DeviceAlert.objects.create(
            device_id=MIXER.id, code=code, args={"why": by, "method": by}, first_at=datetime.now(UTC),
            last_at=datetime.now(UTC), seen_by=person("operator"), seen_at=datetime.now(UTC),
        )  # fmt: skip
    Device.objects.update(properties={"jobStatus": 40, "error": f"Ask {by}", "operator": by})
    execution.press_stop(site="hall", by=by)
    made = as_person("author").post("/api/sites/hall/programs", {"name": "New"}, content_type="application/json")
    assert made.status_code == 201


def publish_names() -> None:
    """Send every kind of live message with a name of a person in each of its texts."""
    by = "Zephyrine Quillon operator"
    for kind in ("run", "run_event", "question", "notice", "alert", "alerts", "armed", "rehearsal", "stop", "traffic",
                 "programs", "review", "role", "checked", "members", "robot_map", "device_removed", "map"):  # fmt: skip
        body = {"by": by, "text": by, "id": by, "version": 1, "device": by, "alert": {"role": "viewer", "seen_by": by}}
        services.publish("hall", {"type": kind, **body})
    said = {"code": "said", "args": {"text": by}}
    properties = [{"name": "operator", "value": by}, {"name": "jobStatus", "value": 41}]
    change = {"id": MIXER.id, "doing": by, "activity": said, "properties": properties, "status": "error"}
    services.publish("hall", {"type": "device", "device": change})


async def test_no_frame_and_no_answer_tells_the_name_of_a_person(hall: str) -> None:
    key = await database_sync_to_async(make_key)()
    await database_sync_to_async(do_everything)()
    heard: list[dict[str, Any]] = []
    async with showing(key) as socket:
        picture = await until(socket, lambda each: each["type"] == "picture", heard)
        publish_names()
        await until(socket, lambda each: each["type"] == "map", heard)
        changed = await until(socket, lambda each: each["type"] == "devices", heard)
    assert changed["devices"][0] == {
        "id": MIXER.id, "status": "error", "activity": None, "properties": [{"name": "jobStatus", "value": 41}],
    }  # fmt: skip
    assert [(run["number"], run["status"], run["done"], run["total"]) for run in picture["runs"]] == [
        (1, "running", 1, 2),
        (3, "pending", 1, 2),
        (2, "paused", 1, 2),
    ]
    assert picture["runs"][1]["wait"] == {"code": "offline", "args": {"device": MIXER.id}}
    assert sorted(alert["code"] for alert in picture["alerts"]) == ["command_failed", "error"]
    answer = await database_sync_to_async(lambda: open_link(code_of(make())))()
    told = json.dumps(heard) + answer.content.decode() + str(answer.headers)
    assert [name for name in NAMES if name in told] == []

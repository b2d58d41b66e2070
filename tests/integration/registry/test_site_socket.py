from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any

import pytest
from channels.db import database_sync_to_async
from channels.routing import URLRouter
from channels.testing import WebsocketCommunicator
from django.contrib.auth.models import AnonymousUser
from django.contrib.sessions.backends.db import SessionStore
from django.test import Client
from django.urls import path

from registry import services
from registry.api import site_socket
from registry.api.site_socket import SiteSocket
from registry.bounds.slots import Slots
from registry.live import fanout
from registry.models import Membership, User
from tests.kit.sign_in import ROLES, signed_in

pytestmark = pytest.mark.django_db(transaction=True)
PATIENCE_S = 30
"""On a busy machine; where one gives up within, the loop waits for what it has cancelled."""


@pytest.fixture(autouse=True)
def no_beats(monkeypatch: pytest.MonkeyPatch) -> None:
    """On a busy machine more than five seconds may lie between two messages."""
    monkeypatch.setattr(site_socket, "BEAT_S", 3600.0)


@asynccontextmanager
async def opened(user: Any, site: str = "hall", **scope: Any) -> AsyncIterator[WebsocketCommunicator]:
    socket = WebsocketCommunicator(URLRouter([path("ws/site/<slug:slug>", SiteSocket.as_asgi())]), f"/ws/site/{site}")
    if user.is_authenticated and "session" not in scope:
        scope["session"] = await database_sync_to_async(begin_session)(user)
    socket.scope |= {"user": user, **scope}
    connected, _ = await socket.connect(timeout=PATIENCE_S)
    assert connected
    yield socket
    await socket.disconnect(timeout=PATIENCE_S)


def begin_session(user: User) -> SessionStore:
    browser = Client()
    browser.force_login(user)
    return SessionStore(browser.cookies["sessionid"].value)


async def close_code(socket: WebsocketCommunicator) -> int:
    while (event := await socket.receive_output(timeout=PATIENCE_S))["type"] != "websocket.close":
        pass
    code: int = event["code"]
    return code


@pytest.mark.parametrize("role", ROLES)
async def test_members_hear_their_site_and_no_other(person: Callable[[str], User], role: str) -> None:
    async with opened(await database_sync_to_async(person)(role)) as socket:
        assert await socket.receive_json_from(PATIENCE_S) == {"type": "hello", "site": "hall"}
        fanout.publish("other", {"type": "programs"})
        fanout.publish("hall", {"type": "run", "run": {"id": 1}})
        assert await socket.receive_json_from(PATIENCE_S) == {"type": "run", "run": {"id": 1}}


@pytest.mark.parametrize("role", ROLES)
async def test_what_only_concerns_admins_is_told_to_admins_alone(person: Callable[[str], User], role: str) -> None:
    told = [{"type": "alert", "alert": {"id": n, "role": least}} for n, least in enumerate(("admin", "viewer"))]
    async with opened(await database_sync_to_async(person)(role)) as socket:
        await socket.receive_json_from(PATIENCE_S)
        for message in told:
            fanout.publish("hall", message)
        expected = told if role == "admin" else told[1:]
        assert [await socket.receive_json_from(PATIENCE_S) for _ in expected] == expected


async def test_strangers_and_the_signed_out_are_closed_with_a_code(person: Callable[[str], User]) -> None:
    stranger, admin = await database_sync_to_async(person)("stranger"), await database_sync_to_async(person)("admin")
    for user, site, code in ((AnonymousUser(), "hall", 4401), (stranger, "hall", 4404), (admin, "missing", 4404)):
        async with opened(user, site) as socket:
            assert await close_code(socket) == code


async def test_a_device_is_sent_at_most_ten_times_a_second_and_the_latest_wins(person: Callable[[str], User]) -> None:
    async with opened(await database_sync_to_async(person)("viewer")) as socket:
        await socket.receive_json_from(PATIENCE_S)
        began = time.monotonic()
        for number in range(200):
            fanout.publish("hall", {"type": "device", "device": {"id": "r1", "location": {"x": number}}})
            if number == 7:
                fanout.publish("hall", {"type": "device", "device": {"id": "r1", "status": "busy"}})
            await asyncio.sleep(0.003)
        merged: dict[str, Any] = {}
        count = 0
        while merged.get("location") != {"x": 199}:
            merged |= (await socket.receive_json_from(PATIENCE_S))["device"]
            count += 1
        assert merged == {"id": "r1", "location": {"x": 199}, "status": "busy"}
        assert count <= (time.monotonic() - began) / 0.1 + 2, "the first and the last come besides"


async def test_of_where_copies_are_only_the_newest_waits(person: Callable[[str], User]) -> None:
    async with opened(await database_sync_to_async(person)("viewer")) as socket:
        await socket.receive_json_from(PATIENCE_S)
        for number in range(5000):  # far more than may wait of what counts one by one
            fanout.publish("hall", {"type": "copies", "copies": [{"device": "r1", "x": number, "y": 0, "theta": 0}]})
            if number % 500 == 0:
                await asyncio.sleep(0.001)
        count, x = 0, -1
        while x != 4999:
            x, count = (await socket.receive_json_from(PATIENCE_S))["copies"][0]["x"], count + 1
        assert count < 50


async def test_a_device_that_was_removed_is_not_heard_of_again(person: Callable[[str], User]) -> None:
    async with opened(await database_sync_to_async(person)("viewer")) as socket:
        await socket.receive_json_from(PATIENCE_S)
        fanout.publish("hall", {"type": "device", "device": {"id": "r1", "status": "busy"}})
        fanout.publish("hall", {"type": "device_removed", "id": "r1"})
        messages = [await socket.receive_json_from(PATIENCE_S)]
        while messages[-1]["type"] != "device_removed":
            messages.append(await socket.receive_json_from(PATIENCE_S))
        assert await socket.receive_nothing(0.3)


async def test_somebody_who_is_no_member_any_more_is_closed_out(person: Callable[[str], User]) -> None:
    async with opened(await database_sync_to_async(person)("viewer")) as leaving:
        await leaving.receive_json_from(PATIENCE_S)
        async with opened(await database_sync_to_async(person)("author")) as staying:
            await staying.receive_json_from(PATIENCE_S)
            await database_sync_to_async(services.remove_member)(site="hall", email="viewer@vipo.example")
            assert await close_code(leaving) == 4403
            fanout.publish("hall", {"type": "programs"})
            assert await staying.receive_json_from(PATIENCE_S) == {"type": "programs"}


async def test_somebody_whose_role_is_changed_is_told_and_others_are_not(person: Callable[[str], User]) -> None:
    async with opened(await database_sync_to_async(person)("viewer")) as changed:
        await changed.receive_json_from(PATIENCE_S)
        async with opened(await database_sync_to_async(person)("author")) as other:
            await other.receive_json_from(PATIENCE_S)
            await database_sync_to_async(services.set_member)(site="hall", email="viewer@vipo.example", role="operator")
            assert await changed.receive_json_from(PATIENCE_S) == {"type": "role", "role": "operator"}
            fanout.publish("hall", {"type": "programs"})
            assert await other.receive_json_from(PATIENCE_S) == {"type": "programs"}


async def test_that_somebody_looks_at_the_site_is_noted(person: Callable[[str], User]) -> None:
    async with opened(await database_sync_to_async(person)("viewer")) as socket:
        await socket.receive_json_from(PATIENCE_S)
        seen = Membership.objects.filter(site__slug="hall", seen_at__isnull=False)
        assert [each async for each in seen.values_list("user__email", flat=True)] == ["viewer@vipo.example"]


async def test_who_signs_out_is_closed_out_everywhere_and_others_stay(person: Callable[[str], User]) -> None:
    browsers = {role: await database_sync_to_async(signed_in)(role) for role in ("viewer", "author")}
    sessions = {role: SessionStore(browser.cookies["sessionid"].value) for role, browser in browsers.items()}
    async with (
        opened(await database_sync_to_async(person)("viewer"), session=sessions["viewer"]) as leaving,
        opened(await database_sync_to_async(person)("author"), session=sessions["author"]) as staying,
    ):
        for socket in (leaving, staying):
            await socket.receive_json_from(PATIENCE_S)
        answer = await database_sync_to_async(browsers["viewer"].post)("/api/sign-out")
        assert answer.status_code == 200
        assert await close_code(leaving) == 4401
        fanout.publish("hall", {"type": "programs"})
        assert await staying.receive_json_from(PATIENCE_S) == {"type": "programs"}


async def test_a_browser_that_reads_too_slowly_is_closed(
    person: Callable[[str], User], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(site_socket, "MOST_WAITING", 5)
    async with opened(await database_sync_to_async(person)("viewer")) as socket:
        await socket.receive_json_from(PATIENCE_S)
        for number in range(50):
            fanout.publish("hall", {"type": "run_event", "event": {"n": number}})
        assert await close_code(socket) == 4503


async def test_what_a_browser_sends_is_not_listened_to(person: Callable[[str], User]) -> None:
    async with opened(await database_sync_to_async(person)("viewer")) as socket:
        await socket.receive_json_from(PATIENCE_S)
        await socket.send_to(text_data="{" * 1000)
        await socket.send_to(bytes_data=b"\xff" * 1000)
        fanout.publish("hall", {"type": "programs"})
        assert await socket.receive_json_from(PATIENCE_S) == {"type": "programs"}


async def test_a_quiet_site_still_sends_a_beat(person: Callable[[str], User], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(site_socket, "BEAT_S", 0.05)
    async with opened(await database_sync_to_async(person)("viewer")) as socket:
        await socket.receive_json_from(PATIENCE_S)
        assert [await socket.receive_json_from(PATIENCE_S) for _ in range(2)] == [{"type": "beat"}, {"type": "beat"}]


async def test_the_sockets_of_one_person_are_bounded_and_leave_room_for_others(
    person: Callable[[str], User], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(site_socket, "_slots", Slots(in_all=9, of_site=3, of_person=2))
    viewer, admin = await database_sync_to_async(person)("viewer"), await database_sync_to_async(person)("admin")
    async with opened(viewer) as first, opened(viewer), opened(viewer) as third:
        assert await close_code(third) == 4429
        async with opened(admin) as other, opened(admin) as full:
            assert (await other.receive_json_from(PATIENCE_S))["type"] == "hello"
            assert await close_code(full) == 4429
        await first.disconnect(timeout=PATIENCE_S)
        async with opened(viewer) as again:
            assert (await again.receive_json_from(PATIENCE_S))["type"] == "hello"
    assert site_socket._slots.taken == 0

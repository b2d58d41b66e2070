"""The stream of what becomes of Things: what is told, what is told again to who was away, and who hears no more."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from contextlib import aclosing
from dataclasses import replace
from typing import Any

import pytest
from asgiref.sync import sync_to_async
from django.contrib.auth import BACKEND_SESSION_KEY, HASH_SESSION_KEY, SESSION_KEY
from django.contrib.sessions.backends.db import SessionStore
from django.test import Client

from registry import services
from registry.devices.things import EVENTS, newest_news
from registry.models import ThingEvent, User
from registry.people.sessions import Session
from registry.thing_directory import event_stream
from registry.thing_directory.event_stream import Listener, stream_events
from tests.kit.sign_in import PASSWORD, find_person, signed_in
from tests.kit.sites import NOW, ROBOT, come, describe, make_mixers, say
from vipo_device.descriptions.td_schema import check_thing
from vipo_device.protocol.description import PropertySpec

URN = "urn:vipo:device:"
pytestmark = pytest.mark.django_db(transaction=True)


@pytest.fixture
def things(hall: str) -> str:
    make_mixers("a", "b")
    return hall


def session(person: str = "viewer") -> Session:
    user = User.objects.get(email=f"{person}@vipo.example")
    store = SessionStore()
    store[SESSION_KEY], store[HASH_SESSION_KEY] = str(user.pk), user.get_session_auth_hash()
    store[BACKEND_SESSION_KEY] = "django.contrib.auth.backends.ModelBackend"
    store.create()
    assert store.session_key
    return Session(store.session_key, user.pk)


@sync_to_async
def stream(
    site: str | None = "hall", kinds: tuple[str, ...] = EVENTS, diff: bool = False, last_id: str = "", **who: str
) -> AsyncIterator[bytes]:
    return stream_events(Listener(session(**who), site, kinds, diff), last_id)


@sync_to_async
def rename(name: str, device: str = "a") -> None:
    services.update_device(site="hall", device_id=device, name=name, by=None, at=NOW)


async def heard(events: AsyncIterator[bytes]) -> dict[str, Any]:
    """Return the next event's fields."""
    text = (await asyncio.wait_for(anext(events), 60)).decode()
    fields = dict(line.split(": ", 1) for line in text.strip().splitlines())
    return {**fields, "data": json.loads(fields["data"])} if "data" in fields else fields


async def told(events: AsyncIterator[bytes]) -> tuple[str, Any]:
    fields = await heard(events)
    return fields["event"], fields["data"]


async def test_what_becomes_of_things_is_sent_and_readings_are_not(things: str) -> None:
    async with aclosing(await stream()) as events:
        assert set(await heard(events)) == {"id", "retry"}
        await sync_to_async(come)("a")
        await sync_to_async(say)("a", props={"jobStatus": 40}, loc=[3, 2, 0, 0])
        await rename("Left")
        assert await told(events) == ("thing_updated", {"id": f"{URN}a"})
        await sync_to_async(services.approve_device)(site="hall", device_id="new_robot", by=None, at=NOW)
        assert await told(events) == ("thing_created", {"id": f"{URN}new_robot"})
        await sync_to_async(say)("new_robot", loc=[1, 2, 0, 0])
        more = replace(ROBOT, id="new_robot", properties=(PropertySpec("heat", "number"),))
        await sync_to_async(describe)(more)
        assert await told(events) == ("thing_updated", {"id": f"{URN}new_robot"})
        await sync_to_async(services.retire_device)(site="hall", device_id="new_robot", by=None, at=NOW)
        assert await told(events) == ("thing_deleted", {"id": f"{URN}new_robot"})


async def test_a_diff_is_a_new_thing_whole_and_a_change_as_a_merge_patch(things: str) -> None:
    async with aclosing(await stream(diff=True)) as events:
        await heard(events)
        await sync_to_async(services.approve_device)(site="hall", device_id="new_robot", by=None, at=NOW)
        name, thing = await told(events)
        assert (name, thing["title"], thing["vipo:location"][:2]) == ("thing_created", "Robot One", [2.0, 2.0])
        check_thing(thing)
        await sync_to_async(describe)(replace(ROBOT, id="new_robot", properties=()))
        assert await told(events) == (
            "thing_updated",
            {"properties": {"jobStatus": None}, "id": f"{URN}new_robot"},
        )


async def test_a_listener_may_ask_for_some_events_of_all_its_sites(things: str) -> None:
    async with aclosing(await stream(site=None, kinds=("thing_created",))) as events:
        await heard(events)
        await rename("Left")
        await sync_to_async(services.approve_device)(site="hall", device_id="new_robot", by=None, at=NOW)
        assert await told(events) == ("thing_created", {"id": f"{URN}new_robot"})


async def test_who_comes_again_misses_nothing(things: str) -> None:
    async with aclosing(await stream(site=None)) as events:
        await heard(events)
        await rename("Left")
        last = (await heard(events))["id"]
    await rename("Right")
    await rename("Middle", "b")
    async with aclosing(await stream(site=None, diff=True, last_id=last)) as events:
        assert (await heard(events))["id"] == last
        assert await told(events) == ("thing_updated", {"title": "Right", "id": f"{URN}a"})
        assert await told(events) == ("thing_updated", {"title": "Middle", "id": f"{URN}b"})


@pytest.mark.parametrize("last_id", ["1", "999999999", "x", "9" * 30])
async def test_who_was_away_for_too_long_is_told_to_read_all_again(
    things: str, monkeypatch: pytest.MonkeyPatch, last_id: str
) -> None:
    monkeypatch.setattr("registry.devices.things.MOST_KEPT", 2)
    for number in range(4):
        await rename(f"n{number}")
    assert await sync_to_async(ThingEvent.objects.count)() == 2
    async with aclosing(await stream(last_id=last_id)) as events:
        newest = str(await sync_to_async(newest_news)())
        opening = (await anext(events)).decode()
        assert opening == f"id: {newest}\nretry: 2000\n\nid: {newest}\nevent: reset\ndata: {{}}\n\n"
        await rename("after")
        assert await told(events) == ("thing_updated", {"id": f"{URN}a"})


async def test_who_loses_a_site_hears_no_more_of_it(things: str) -> None:
    async with aclosing(await stream()) as one, aclosing(await stream(site=None)) as all_sites:
        await heard(one)
        await heard(all_sites)
        await sync_to_async(services.remove_member)(site="hall", email="viewer@vipo.example")
        assert [text async for text in one] == []
        assert (await heard(all_sites))["event"] == "reset"
    assert event_stream._open.total() == 0


async def test_who_signs_out_hears_no_more(things: str) -> None:
    client = Client()
    await sync_to_async(client.login)(username="viewer@vipo.example", password=PASSWORD)
    user = await sync_to_async(User.objects.get)(email="viewer@vipo.example")
    key = client.cookies["sessionid"].value
    async with aclosing(stream_events(Listener(Session(key, user.pk), None, EVENTS, False), "")) as events:
        await heard(events)
        assert (await sync_to_async(client.post)("/api/sign-out")).status_code == 200
        assert [text async for text in events] == []


async def test_a_stream_ends_when_it_has_sent_enough_and_goes_on_from_there(
    things: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(event_stream, "MOST_BYTES", 1)
    first = str(await sync_to_async(newest_news)())
    await rename("Left")
    await rename("Right")
    async with aclosing(await stream(last_id=first, diff=True)) as events:
        await heard(events)
        assert (await told(events))[1]["title"] == "Left"


async def test_only_so_many_streams_are_open_at_once(things: str, monkeypatch: pytest.MonkeyPatch) -> None:
    viewer = await sync_to_async(find_person)("viewer")
    client = await sync_to_async(signed_in)("viewer")
    for path, person in (("/events", viewer.pk), ("/api/sites/hall/things/events", 0)):
        monkeypatch.setattr(event_stream, "_open", event_stream.Counter({person: event_stream.MOST_STREAMS}))
        answer = await sync_to_async(client.get)(path)
        assert (answer.status_code, answer.json()["code"]) == (429, "too_many_streams")


async def test_a_browser_that_knows_the_last_event_names_it_in_the_header(things: str) -> None:
    last = await sync_to_async(newest_news)()
    await rename("Left")
    client = Client()
    await sync_to_async(client.login)(username="viewer@vipo.example", password=PASSWORD)
    answer = await sync_to_async(client.get)("/events/thing_updated?diff=true", headers={"Last-Event-ID": str(last)})
    assert answer["Content-Type"] == "text/event-stream"
    async with aclosing(aiter(answer)) as events:
        await heard(events)
        assert await told(events) == ("thing_updated", {"title": "Left", "id": f"{URN}a"})

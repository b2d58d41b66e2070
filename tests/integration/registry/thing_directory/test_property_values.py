"""What a Thing's properties are, for programs: read one by one, all at once, and each time that they change."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import AsyncIterator
from contextlib import aclosing
from dataclasses import replace
from datetime import UTC, datetime
from threading import Event, Thread
from typing import Any

import pytest
from asgiref.sync import sync_to_async
from django.conf import settings
from django.db import connections
from django.test import Client

from registry import services
from registry.devices.thing_forms import CONTEXTS
from registry.models import Device
from registry.people.sessions import Session
from registry.people.tokens import find_bearer
from registry.thing_directory import event_stream, property_values
from registry.thing_directory.property_values import Observer, stream_values
from tests.kit.sign_in import ROLES, find_person, signed_in
from tests.kit.sites import MIXER, NOW, ROBOT, describe, say
from tests.kit.waiting import PATIENCE_S
from vipo_device.descriptions.td_schema import check_thing
from vipo_device.protocol.description import PropertySpec

pytestmark = pytest.mark.django_db(transaction=True)
MADE_OF = (
    PropertySpec("heat", "number", "DEG_C", minimum=0, maximum=100),
    PropertySpec("lid", "text", options=("open", "shut")),
    PropertySpec("hot", "boolean"),
    PropertySpec("at", "location"),
)
HERE = "/api/sites/hall/things/urn:vipo:device:mixer1/properties"


@pytest.fixture
def mixer(hall: str) -> str:
    describe(replace(MIXER, properties=MADE_OF))
    Device.objects.update(lifecycle="approved")
    say(props={"heat": 40, "lid": "shut"})
    return hall


def token(*scopes: str, person: str = "admin") -> tuple[str, str]:
    view, text = services.create_token(
        user=find_person(person), site="hall", name="A program", scopes=scopes, days=1, now=datetime.now(UTC)
    )
    return view.id, text


def test_a_value_is_sent_alone_and_as_its_schema_says(mixer: str) -> None:
    client = Client(headers={"Authorization": f"Bearer {token('read')[1]}"})
    read = client.get(f"{HERE}/heat")
    assert (read.status_code, read["Content-Type"], read["Cache-Control"]) == (200, "application/json", "no-store")
    assert read.json() == 40
    assert client.get(f"{HERE}/lid").content == b'"shut"'
    assert client.get(HERE).json() == {"heat": 40, "lid": "shut"}
    thing = client.get("/api/sites/hall/things/mixer1").json()
    check_thing(thing)
    assert (thing["base"], thing["security"], thing["@context"][:2]) == ("http://testserver/", ["token"], [*CONTEXTS])
    assert {name: spec["type"] for name, spec in thing["properties"].items()} == {
        "heat": "number",
        "lid": "string",
        "hot": "boolean",
        "at": "string",
    }
    assert [form.get("subprotocol") for form in thing["properties"]["heat"]["forms"]] == [
        *(None, "longpoll", "sse"),
        None,
    ]
    by_mqtt = thing["properties"]["heat"]["forms"][3]
    assert (by_mqtt["op"], by_mqtt["security"]) == (["observeproperty", "unobserveproperty"], ["broker_token"])
    assert by_mqtt["href"] == settings.VIPO_BROKER_URL + by_mqtt["mqv:filter"]
    assert by_mqtt["mqv:filter"] == "vipo/v1/site/hall/things/mixer1/properties/heat"
    assert client.get(thing["properties"]["heat"]["forms"][0]["href"]).json() == 40


@pytest.mark.parametrize(
    ("name", "said", "status", "code"),
    [
        ("hot", None, 404, "no_value"),
        ("none", 1, 404, "no_such_property"),
        ("heat", "warm", 409, "unfit_value"),
        ("heat", True, 409, "unfit_value"),
        ("heat", 100.5, 409, "unfit_value"),
        ("lid", "ajar", 409, "unfit_value"),
        ("lid", 3, 409, "unfit_value"),
        ("hot", 1, 409, "unfit_value"),
        ("at", 1, 409, "unfit_value"),
    ],
)
def test_what_is_not_known_or_does_not_fit_is_never_told_as_a_value(
    mixer: str, name: str, said: Any, status: int, code: str
) -> None:
    say(seq=2, props={name: said} if said is not None else {})
    answer = signed_in("viewer").get(f"{HERE}/{name}")
    assert (answer.status_code, answer.json()["code"]) == (status, code)
    assert name not in signed_in("viewer").get(HERE).json()


@pytest.mark.parametrize("role", [*ROLES, "stranger", "nobody"])
def test_members_read_and_others_learn_nothing(mixer: str, role: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(property_values, "MOST_POLL_S", 0.1)
    client, outside = signed_in(role), {"stranger": 404, "nobody": 401}.get(role)
    for path in (HERE, f"{HERE}/heat", f"{HERE}/heat/next", f"{HERE}/heat/events"):
        answer = client.get(path)
        assert answer.status_code == (outside or 200)
        answer.close()
    assert client.head(f"{HERE}/heat/next").status_code == (outside or 200)


def test_a_thing_that_waits_for_approval_or_is_out_has_no_values(mixer: str) -> None:
    describe(replace(ROBOT, properties=MADE_OF))
    say("robot1", props={"heat": 1})
    there = "/api/sites/hall/things/robot1/properties/heat"
    absent = signed_in("admin").get("/api/sites/hall/things/robot9/properties/heat").json()
    for lifecycle in ("pending", "retired"):
        Device.objects.filter(pk="robot1").update(lifecycle=lifecycle)
        for path in (there, f"{there}/next", f"{there}/events"):
            refused = signed_in("admin").get(path).json()
            assert (refused["code"], refused["detail"]) == (absent["code"], absent["detail"].replace("9", "1"))


def test_who_polls_hears_the_next_value_or_after_a_while_the_same(mixer: str, monkeypatch: pytest.MonkeyPatch) -> None:
    client, look, looked = signed_in("viewer"), property_values._look, Event()

    def look_and_say_so(*asked: Any) -> Any:
        found = look(*asked)
        looked.set()
        return found

    def change() -> None:
        assert looked.wait(PATIENCE_S)
        time.sleep(0.3)
        say(seq=2, props={"lid": "open"})
        say(seq=3, props={"heat": 41})
        connections.close_all()

    monkeypatch.setattr(property_values, "_look", look_and_say_so)
    monkeypatch.setattr(property_values, "MOST_POLL_S", PATIENCE_S)
    thread = Thread(target=change)
    began = time.monotonic()
    thread.start()
    assert client.get(f"{HERE}/heat/next").json() == 41
    assert time.monotonic() - began < PATIENCE_S, "it heard of the change, and did not just look at last"
    thread.join()
    monkeypatch.setattr(property_values, "MOST_POLL_S", 0.2)
    assert client.get(f"{HERE}/heat/next").json() == 41
    assert client.get(f"{HERE}/hot/next").json()["code"] == "no_value"


@sync_to_async
def stream(name: str, text: str) -> AsyncIterator[bytes]:
    person = find_bearer(token=text, now=datetime.now(UTC))
    assert person.grant
    return stream_values(Observer(Session("", person.pk, person.grant.token_id), "hall", "mixer1", name))


async def heard(events: AsyncIterator[bytes]) -> Any:
    text = (await asyncio.wait_for(anext(events), 60)).decode()
    return json.loads(text.removeprefix("data: ")) if text.startswith("data: ") else text


@pytest.fixture
def no_heartbeat(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let streams say nothing between two values, and look only when they hear of something, however long it takes."""
    monkeypatch.setattr(property_values, "HEARTBEAT_S", 600.0)
    monkeypatch.setattr(event_stream, "HEARTBEAT_S", 600.0)


@pytest.mark.usefixtures("no_heartbeat")
async def test_a_stream_tells_what_is_and_each_change_that_fits_until_the_token_ends(mixer: str) -> None:
    made, text = await sync_to_async(token)("read")
    async with aclosing(await stream("heat", text)) as events:
        assert await heard(events) == "retry: 2000\n\n"
        assert await heard(events) == 40
        await sync_to_async(say)(seq=2, props={"lid": "open"})
        await sync_to_async(say)(seq=3, props={"heat": 500})
        await sync_to_async(say)(seq=4, props={"heat": 42})
        assert await heard(events) == 42
        await sync_to_async(services.revoke_token)(token_id=made)
        with pytest.raises(StopAsyncIteration):
            await asyncio.wait_for(anext(events), 60)


@pytest.mark.usefixtures("no_heartbeat")
async def test_a_stream_ends_with_its_thing(mixer: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(event_stream, "HEARTBEAT_S", 600.0)  # so seldom it looks by itself
    _, text = await sync_to_async(token)("read")
    async with aclosing(await stream("heat", text)) as events:
        assert [await heard(events), await heard(events)] == ["retry: 2000\n\n", 40]
        await sync_to_async(services.retire_device)(site="hall", device_id="mixer1", by=None, at=NOW)
        with pytest.raises(StopAsyncIteration):
            await asyncio.wait_for(anext(events), 60)


def test_streams_and_polls_of_one_person_are_bounded(mixer: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(event_stream, "MOST_FOR_PERSON", 0)
    for end in ("next", "events"):
        refused = signed_in("viewer").get(f"{HERE}/heat/{end}")
        assert (refused.status_code, refused.json()["code"]) == (429, "too_many_streams")
        assert int(refused["Retry-After"]) > 0

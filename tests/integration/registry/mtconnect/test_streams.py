"""MTConnect documents one after another over one answer: when they come, and when they end."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import aclosing
from typing import Any

import pytest
from asgiref.sync import sync_to_async
from django.contrib.sessions.models import Session as Kept
from django.utils import timezone
from lxml import etree

from registry import services
from registry.devices import samples
from registry.devices.samples import SampleBuffer
from registry.models import Device, Membership
from registry.mtconnect import agent, streams
from registry.mtconnect.agent import Question
from registry.mtconnect.streams import BOUNDARY, Listener, Rhythm, stream_documents
from registry.people.sessions import Session
from tests.kit.sign_in import find_person, signed_in
from tests.kit.sites import come, describe, say

pytestmark = pytest.mark.django_db(transaction=True)
ADDRESS = "/api/sites/hall/mtconnect"


@pytest.fixture
def mixer(hall: str, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setattr(samples, "_buffer", SampleBuffer())
    monkeypatch.setattr(streams, "LEAST_PAUSE_S", 0.02)
    describe()
    Device.objects.update(lifecycle="approved")
    come(at=timezone.now())
    tell(10)
    return hall


def tell(progress: float) -> None:
    now = timezone.now()
    say(at=now, seq=int(progress), props={"jobStatus": progress})
    services.flush_samples(all_of_it=True)


def listen(*, is_sample: bool = True, heartbeat_s: float = 30.0, device: str = "") -> AsyncIterator[bytes]:
    client, question = signed_in("viewer"), Question(device)
    session = Session(client.cookies["sessionid"].value, int(client.session["_auth_user_id"]))
    write = agent.sample_of_site if is_sample else agent.current_of_site
    listener = Listener(session, "hall", write, question, is_sample=is_sample)
    first = write(agent.agent_of(site="hall", now=timezone.now()), question)
    return stream_documents(listener, Rhythm(0.02, heartbeat_s), first)


async def heard(parts: AsyncIterator[bytes]) -> Any:
    """Return the next part's document; its head tells how long it is."""
    head, _, rest = (await asyncio.wait_for(anext(parts), 60)).partition(b"\r\n\r\n")
    mark, kind, length = head.decode().splitlines()
    assert (mark, kind) == (f"--{BOUNDARY}", "Content-type: text/xml")
    assert rest.endswith(b"\r\n")
    assert len(rest) - 2 == int(length.removeprefix("Content-length: "))
    return etree.fromstring(rest)


def loads(root: Any) -> list[str]:
    return [element.text for element in root.iter("{*}Load")]


async def test_what_is_told_comes_as_it_is_told_and_a_heartbeat_when_nothing_is(mixer: str) -> None:
    async with aclosing(await sync_to_async(listen)()) as parts:
        assert loads(await heard(parts)) == ["10.0"]
        await sync_to_async(tell)(20)
        assert loads(await heard(parts)) == ["20.0"]
    async with aclosing(await sync_to_async(listen)(heartbeat_s=0.1)) as parts:
        await heard(parts)
        empty = await heard(parts)
        assert empty.find(".//{*}ComponentStream") is None
        assert empty.find("{*}Header").get("nextSequence") == str(await sync_to_async(agent.next_number)())
    assert not streams._open


async def test_current_comes_again_and_again(mixer: str) -> None:
    async with aclosing(await sync_to_async(listen)(is_sample=False)) as parts:
        assert loads(await heard(parts)) == ["10.0"]
        await sync_to_async(tell)(11)
        while loads(await heard(parts)) != ["11.0"]:
            pass


@pytest.mark.parametrize("rows", [Membership.objects.filter(user__email="viewer@vipo.example"), Kept.objects.all()])
async def test_a_stream_ends_when_its_listener_is_no_member_any_more_or_signs_out(mixer: str, rows: Any) -> None:
    async with aclosing(await sync_to_async(listen)()) as parts:
        await heard(parts)
        await sync_to_async(rows.all().delete)()
        assert [part async for part in parts] == [f"--{BOUNDARY}--\r\n".encode()]


async def test_a_stream_of_a_device_that_is_retired_says_so_and_ends(mixer: str) -> None:
    async with aclosing(await sync_to_async(listen)(heartbeat_s=0.1, device="mixer1")) as parts:
        await heard(parts)
        await sync_to_async(services.retire_device)(site="hall", device_id="mixer1", by=None, at=timezone.now())
        last = None
        async for part in parts:
            if not part.startswith(f"--{BOUNDARY}--".encode()):
                last = etree.fromstring(part.partition(b"\r\n\r\n")[2])
        assert [error.get("errorCode") for error in last.iter("{*}Error")] == ["NO_DEVICE"]


async def test_a_stream_ends_when_it_has_sent_enough(mixer: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(streams, "MOST_BYTES", 100)
    async with aclosing(await sync_to_async(listen)(is_sample=False)) as parts:
        assert len([part async for part in parts]) == 2


@pytest.mark.parametrize(
    ("key", "most", "told"),
    [
        ("person", "MOST_OF_PERSON", "4 streams are open for you."),
        ("site hall", "MOST_OF_SITE", "16 streams are open at this site."),
        ("all", "MOST_IN_PROCESS", "32 streams are open at this server."),
    ],
)
def test_only_so_many_streams_are_open_at_once(
    mixer: str, monkeypatch: pytest.MonkeyPatch, key: str, most: str, told: str
) -> None:
    client = signed_in("viewer")
    key = f"person {find_person('viewer').pk}" if key == "person" else key
    monkeypatch.setitem(streams._open, key, getattr(streams, most))
    answer = client.get(f"{ADDRESS}/sample?interval=100")
    error = etree.fromstring(answer.content).find(".//{*}Error")
    assert (answer.status_code, error.get("errorCode")) == (429, "TOO_MANY")
    assert error.text.startswith(told)
    assert client.get(f"{ADDRESS}/sample").status_code == 200

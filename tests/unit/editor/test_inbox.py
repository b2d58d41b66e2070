"""A connection's messages beside others': large ones are acted on piece by piece, and what waits is bounded."""

from __future__ import annotations

import asyncio
import time

from pycrdt import Map

from editor.compiling.compilers import CutFailed
from editor.documents.slices import SLICE_CHANGES, Cutting, CutUpdate
from editor.rooms import yjs_protocol
from editor.rooms.inbox import Inbox
from editor.rooms.member import BURST_WORK_S, WORK_PER_S, Close, Person
from editor.rooms.receiver import MOST_STEPS
from tests.unit.editor.people import Client, room

LARGE, LARGER = 3000, 10_000
"""The second is more than a quick processor applies in one stretch."""


async def cut_here(cutting: Cutting) -> CutUpdate:
    return cutting.cut()


def many(client: Client, count: int) -> bytes:
    """Return the frame of an update with so many entries."""
    before = client.document.get_state()
    with client.document.transaction():
        for number in range(count):
            client.document.get("parameters", type=Map)[f"p{client.number}-{number}"] = number
    return yjs_protocol.encode_update(client.document.get_update(before))


def inbox(client: Client, turns: asyncio.Lock | None = None) -> Inbox:
    client.read()
    return Inbox(client.room, client.member, cut_here, turns or asyncio.Lock(), lambda _: None)


async def test_others_have_their_turns_between_the_pieces_of_a_large_message() -> None:
    flooder = Client(room(), number=2)
    entrance, seen = inbox(flooder), set()

    async def look() -> None:
        while True:
            seen.add(sum(flooder.room.document.clocks().values()))
            await asyncio.sleep(0)

    looking = asyncio.create_task(look())
    entrance.take(many(flooder, LARGER))
    assert sum(flooder.room.document.clocks().values()) == 0
    await entrance.finish(20)
    looking.cancel()
    await asyncio.sleep(0)
    assert flooder.room.document.to_json()["parameters"] == {f"p2-{number}": number for number in range(LARGER)}
    assert len(seen) > 1
    assert max(b - a for a, b in zip(sorted(seen), sorted(seen)[1:], strict=False)) < LARGER


async def test_an_honest_member_is_acted_on_at_once_while_a_large_message_waits_to_be_cut() -> None:
    flooder = Client(room(), number=2)
    honest = Client(flooder.room, Person(2, "Bob", "B"), number=3)
    cutting = asyncio.Event()

    async def cut_later(asked: Cutting) -> CutUpdate:
        await cutting.wait()
        return asked.cut()

    flooder.read()
    entrance = Inbox(flooder.room, flooder.member, cut_later, asyncio.Lock(), lambda _: None)
    entrance.take(many(flooder, LARGE))
    inbox(honest).take(yjs_protocol.encode_update(honest.edit("s1", 1)))
    assert list(flooder.room.document.to_json()["steps"]) == ["s1"]
    cutting.set()
    await entrance.finish(20)
    assert len(flooder.room.document.to_json()["parameters"]) == LARGE


async def test_what_follows_a_large_message_waits_and_comes_after_it() -> None:
    client = Client(room(), number=2)
    entrance = inbox(client)
    entrance.take(many(client, LARGE))
    entrance.take(yjs_protocol.encode_update(client.edit("s1", 1)))
    assert (entrance.is_busy, client.member.frames) == (True, 2)
    await entrance.finish(20)
    assert (entrance.is_busy, client.member.frames) == (False, 3)
    document = client.room.document.to_json()
    assert (len(document["parameters"]), list(document["steps"])) == (LARGE, ["s1"])
    assert client.member.unsaved[-1] == (3, client.room.ledger.place)


async def test_who_has_had_much_done_waits_and_others_do_not() -> None:
    client = Client(room(), number=2)
    other = Client(client.room, Person(2, "Bob", "B"), number=3)
    entrance, beside = inbox(client), inbox(other)
    client.member.allowance.spend_work(BURST_WORK_S + 0.2 * WORK_PER_S, time.monotonic())
    entrance.take(yjs_protocol.encode_update(client.edit("s1", 1)))
    beside.take(yjs_protocol.encode_update(other.edit("s2", 1)))
    assert list(client.room.document.to_json()["steps"]) == ["s2"]
    await entrance.finish(20)
    assert sorted(client.room.document.to_json()["steps"]) == ["s1", "s2"]


async def test_more_than_may_wait_ends_the_connection() -> None:
    client = Client(room(), number=2)
    entrance = inbox(client)
    client.member.allowance.let_wait(24 * 1024 * 1024)
    client.member.allowance.spend_work(60, time.monotonic())
    entrance.take(yjs_protocol.encode_update(client.edit("s1", 1)))
    assert client.member.closing is not None
    assert client.member.closing.code == Close.ABUSE


async def test_an_update_that_nobody_can_cut_ends_the_connection_and_changes_nothing() -> None:
    client = Client(room(), number=2)
    client.read()

    async def fail(_: Cutting) -> CutUpdate:
        raise CutFailed

    entrance = Inbox(client.room, client.member, fail, asyncio.Lock(), lambda _: None)
    entrance.take(many(client, LARGE))
    await entrance.finish(20)
    assert client.member.closing is not None
    assert client.member.closing.code == Close.TOO_LARGE
    assert client.room.document.to_json()["parameters"] == {}


async def test_who_loses_the_right_meanwhile_changes_nothing_more() -> None:
    client = Client(room(), number=2)
    entrance = inbox(client)
    entrance.take(many(client, LARGE))
    client.member.can_write = False
    await entrance.finish(20)
    assert client.member.closing is not None
    assert client.member.closing.code == Close.COME_AGAIN
    assert client.room.document.to_json()["parameters"] == {}


async def test_a_document_with_too_many_steps_takes_no_more_of_a_large_message() -> None:
    client = Client(room(), number=2)
    entrance, before = inbox(client), client.document.get_state()
    with client.document.transaction():
        for number in range(2 * MOST_STEPS):
            client.document.get("steps", type=Map)[f"s{number}"] = 1
    entrance.take(yjs_protocol.encode_update(client.document.get_update(before)))
    await entrance.finish(20)
    assert client.member.closing is not None
    assert client.member.closing.code == Close.TOO_LARGE
    assert MOST_STEPS < client.room.document.step_count() <= MOST_STEPS + SLICE_CHANGES

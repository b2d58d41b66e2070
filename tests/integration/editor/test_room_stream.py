"""One suite for both streams: in the process, and over a real Redis."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path

import pytest
from redis.asyncio import Redis as RedisClient

from editor.rooms.stream import BEGINNING, FORMAT, Batch, MemoryStream, Note, RedisStream, RoomStream, StreamLost
from tests.kit.servers import Redis, run_redis

KEPT_BYTES = 20_000


@pytest.fixture(params=["memory", "redis"])
async def stream(request: pytest.FixtureRequest) -> AsyncIterator[RoomStream]:
    made: RoomStream = (
        MemoryStream(kept=50, kept_bytes=KEPT_BYTES)
        if request.param == "memory"
        else RedisStream(request.getfixturevalue("shared_redis").url, kept=50, kept_bytes=KEPT_BYTES)
    )
    yield made
    await made.close()


def notes(*texts: str) -> list[Note]:
    return [Note("update", text.encode()) for text in texts]


def texts(batch: Batch) -> list[str]:
    return [entry.note.data.decode() for entry in batch.entries]


async def test_notes_are_read_in_the_order_of_writing(stream: RoomStream, request: pytest.FixtureRequest) -> None:
    room = request.node.name
    await stream.append(room, "a", notes("1", "2"))
    await stream.append(room, "b", notes("3"))
    batch = await stream.read(room, BEGINNING, 0.1)
    assert texts(batch) == ["1", "2", "3"]
    assert [entry.origin for entry in batch.entries] == ["a", "a", "b"]
    assert texts(await stream.read(room, batch.entries[1].id, 0.1)) == ["3"]


async def test_a_reader_waits_for_what_comes(stream: RoomStream, request: pytest.FixtureRequest) -> None:
    room = request.node.name
    await stream.append(room, "a", notes("1"))
    first = await stream.read(room, BEGINNING, 0.1)
    reading = asyncio.create_task(stream.read(room, first.entries[-1].id, 5))
    await asyncio.sleep(0.05)
    await stream.append(room, "a", notes("2"))
    assert texts(await reading) == ["2"]


async def test_nothing_comes_and_the_reader_is_let_go(stream: RoomStream, request: pytest.FixtureRequest) -> None:
    batch = await stream.read(request.node.name, BEGINNING, 0.02)
    assert batch == Batch(())


async def test_rooms_do_not_hear_each_other(stream: RoomStream, request: pytest.FixtureRequest) -> None:
    await stream.append(f"{request.node.name}-one", "a", notes("1"))
    assert texts(await stream.read(f"{request.node.name}-two", BEGINNING, 0.02)) == []


async def test_whoever_was_away_too_long_is_told(shared_redis: Redis) -> None:
    for stream in (MemoryStream(kept=50), RedisStream(shared_redis.url, kept=50)):
        await stream.append("gap", "a", notes("first"))
        seen = (await stream.read("gap", BEGINNING, 0.1)).entries[-1].id
        await stream.append("gap", "a", notes(*map(str, range(700))))
        batch = await stream.read("gap", seen, 0.1)
        await stream.close()
        assert batch.gap
        assert "first" not in texts(batch)


async def test_a_room_keeps_little_more_than_its_bytes_and_who_was_away_is_told_of_the_gap(
    stream: RoomStream, request: pytest.FixtureRequest
) -> None:
    room = request.node.name
    await stream.append(room, "a", notes("first"))
    away = after = (await stream.read(room, BEGINNING, 0.1)).entries[-1].id
    for number in range(100):
        await stream.append(room, "a", notes(f"{number:02}" + "x" * 2000))
        batch = await stream.read(room, after, 0.1)
        assert (len(batch.entries), batch.gap) == (1, False)
        after = batch.entries[-1].id
    late = await stream.read(room, away, 0.1)
    kept = [text[:2] for text in texts(late)]
    assert late.gap
    assert kept == [f"{number:02}" for number in range(100)][-len(kept) :]
    assert KEPT_BYTES * 0.8 < sum(map(len, texts(late))) < KEPT_BYTES * 1.3


async def test_what_a_closed_room_has_in_its_rows_is_forgotten_and_the_next_one_misses_nothing(
    stream: RoomStream, request: pytest.FixtureRequest
) -> None:
    room = request.node.name
    await stream.append(room, "a", notes("1", "2", "3"))
    second = (await stream.read(room, BEGINNING, 0.1)).entries[1].id
    await stream.forget(room, second)
    assert await stream.known(room, second) == second
    rest = await stream.read(room, second, 0.1)
    assert (texts(rest), rest.gap) == (["3"], False)
    assert texts(await stream.read(room, BEGINNING, 0.1)) == ["2", "3"]


async def test_a_redis_that_is_gone_is_said_to_be(tmp_path: Path) -> None:
    with run_redis(tmp_path) as server:
        stream = RedisStream(server.url)
        await stream.append("room", "a", notes("1"))
        server.process.kill()
        server.process.wait()
        with pytest.raises(StreamLost, match="Redis does not answer"):
            await stream.append("room", "a", notes("2"))
        with pytest.raises(StreamLost, match="Redis does not answer"):
            await stream.read("room", BEGINNING, 0.1)
        await stream.close()


async def test_within_a_process_a_room_keeps_no_more_bytes_than_its_bound_and_says_what_is_missing() -> None:
    stream = MemoryStream(kept_bytes=1000)
    await stream.append("room", "a", notes("x" * 600))
    first = (await stream.read("room", BEGINNING, 0.1)).entries[-1].id
    for text in ("y", "z"):
        await stream.append("room", "a", notes(text * 600))
    batch = await stream.read("room", first, 0.1)
    assert (texts(batch), batch.gap) == (["z" * 600], True)
    await stream.append("room", "a", notes("v" * 2000, "w" * 2000))
    assert texts(await stream.read("room", batch.entries[-1].id, 0.1)) == ["v" * 2000, "w" * 2000]


async def test_within_a_process_a_room_of_which_nothing_is_said_any_more_is_forgotten() -> None:
    stream = MemoryStream(kept_s=0.05)
    await stream.append("old", "a", notes("1"))
    told = (await stream.read("old", BEGINNING, 0.1)).entries[-1].id
    assert await stream.known("old", told) == told
    await asyncio.sleep(0.1)
    await stream.append("new", "a", notes("2"))
    assert await stream.known("old", told) == BEGINNING
    assert await stream.read("old", BEGINNING, 0.01) == Batch(())
    assert texts(await stream.read("new", BEGINNING, 0.1)) == ["2"]


async def test_what_a_process_of_another_version_tells_is_not_heard(shared_redis: Redis) -> None:
    stream, redis = RedisStream(shared_redis.url), RedisClient.from_url(shared_redis.url)
    for other in (FORMAT - 1, FORMAT + 1):
        await redis.xadd(f"vipo:room:{other}:versions", {"o": "other", "k": "update", "d": b"not of this version"})
    await stream.append("versions", "a", notes("1"))
    assert texts(await stream.read("versions", BEGINNING, 0.1)) == ["1"]
    await redis.aclose()
    await stream.close()

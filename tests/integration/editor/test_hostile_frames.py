"""What a client may send that it should not: each is refused with its code, and nobody else notices."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable
from contextlib import suppress
from typing import Any

import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from editor.documents.shared_document import SharedDocument, empty_document, encode_document
from editor.documents.yjs_encoding import encode_integer
from editor.programs.compiled_patch import apply_patch
from editor.rooms import yjs_protocol
from tests.kit.drawn.frames import read_frame, read_update
from tests.kit.waiting import PATIENCE_S
from tests.kit.web import Web


def join(web: Web, person: str | None = "author", program: str | None = None) -> connect:
    return connect(web.socket_url(program), additional_headers=web.headers(person), max_size=None)


async def code_of_close(socket: ClientConnection) -> int | None:
    """Read until the server closes; tell its code."""
    try:
        async with asyncio.timeout(PATIENCE_S):
            while True:
                await socket.recv()
    except ConnectionClosed as closed:
        return closed.rcvd.code if closed.rcvd else None


async def read_until(socket: ClientConnection, kind: bytes) -> bytes:
    async with asyncio.timeout(PATIENCE_S):
        while True:
            frame = await socket.recv()
            assert isinstance(frame, bytes)
            if frame.startswith(kind):
                return frame


def step(name: str) -> bytes:
    return encode_document({**empty_document(), "steps": {name: {"kind": "wait", "place": None, "params": {}}}})


MALFORMED = {
    "an empty frame": b"",
    "0xff without end": b"\xff" * 200_000,
    "a number that is cut off": b"\x00\x00\x80",
    "a length beyond the end": b"\x00\x02\x7f\x01",
    "a type that does not exist": b"\x63\x00",
    "a sync step that does not exist": b"\x00\x09\x00",
    "a state vector that is none": b"\x00\x00\x02\xff\xff",
    "something after the end": b"\x03\x00\x00",
    "awareness that is not JSON": b"\x01\x05\x01\x01\x01\x01{",
    "awareness with a number that browsers cannot read": b"\x01\x0f\x01\x01\x01\x0b" + b'{"x":1e999}',
    "awareness for ever": b"\x01\x04\xff\xff\xff\x7f",
    "step 2 with noise": b"\x00\x01\x04\x01\xff\xff\xff",
    "a message of the server": b"\x64\x00\x01\x00",
    "a revision that is none": b"\x65\xff\xff\xff\xff\xff\xff\xff\xff\xff",
    "a compiled form of its own": b"\x65\x02{}",
}


@pytest.mark.parametrize("frame", MALFORMED.values(), ids=MALFORMED.keys())
async def test_what_is_not_the_protocol_closes_with_4400(web: Web, frame: bytes) -> None:
    async with join(web) as socket:
        await socket.send(frame)
        assert await code_of_close(socket) == 4400


async def test_text_closes_with_4400_and_says_why(web: Web) -> None:
    async with join(web) as socket:
        await socket.send("hello")
        refusal = await read_until(socket, b"\x02")
        assert b"The protocol has no text messages." in refusal
        assert await code_of_close(socket) == 4400


async def test_a_frame_above_the_limit_closes_with_4413(web: Web) -> None:
    async with join(web) as socket:
        await socket.send(yjs_protocol.encode_update(bytes(yjs_protocol.MOST_FRAME_BYTES + 1)))
        assert await code_of_close(socket) == 4413


async def test_noise_instead_of_a_change_harms_nobody(web: Web) -> None:
    program = web.new_program()
    async with join(web, "second", program) as good, join(web, "author", program) as bad:
        await good.send(yjs_protocol.encode_step_2(step("kept")))
        await bad.send(yjs_protocol.encode_step_2(b"\x00\x00"))
        for position in range(4, 12):
            noise = bytearray(step("broken"))
            noise[position] ^= 0x55
            await bad.send(yjs_protocol.encode_update(bytes(noise)))
        await bad.send(yjs_protocol.encode_update(b"\x05\xff\xff\xff\x0f"))
        assert await code_of_close(bad) == 4400
        await good.send(yjs_protocol.encode_update(step("later")))
        await good.send(yjs_protocol.encode_step_1(b"\x00"))
        answer = await read_until(good, b"\x00\x01")
    steps = SharedDocument([read_update(answer)]).to_json()["steps"]
    assert {"kept", "later"} <= set(steps)


async def test_changes_that_never_follow_a_step_2_are_held_and_then_refused(web: Web) -> None:
    program = web.new_program()
    async with join(web, "admin", program) as socket:
        for number in range(500):
            await socket.send(yjs_protocol.encode_update(step(f"s{number}")))
        await socket.send(yjs_protocol.encode_step_1(b"\x00"))
        answer = await read_until(socket, b"\x00\x01")
        assert SharedDocument([read_update(answer)]).to_json()["steps"] == {}
        closing = asyncio.create_task(code_of_close(socket))
        with suppress(ConnectionClosed):
            for number in range(600):
                await socket.send(yjs_protocol.encode_update(step(f"t{number}")))
                await asyncio.sleep(0)
        assert await closing in {4400, 4429}


async def test_a_flood_closes_with_4429_and_who_comes_back_at_once_is_held_off(web: Web) -> None:
    async with join(web, "author") as honest:
        async with join(web, "admin") as socket:
            with suppress(ConnectionClosed):
                for _ in range(2000):
                    await socket.send(b"\x03")
            assert await code_of_close(socket) == 4429
        for _ in range(3):
            async with join(web, "admin") as again:
                refusal = await read_until(again, b"\x02")
                assert b"try again in" in refusal
                assert await code_of_close(again) == 4429
        await honest.send(yjs_protocol.encode_step_1(b"\x00"))
        await read_until(honest, b"\x00\x01")
    async with join(web, "viewer") as other:
        await read_until(other, b"\x00\x00")


async def test_a_connection_that_goes_on_after_its_close_is_cut(web: Web) -> None:
    reader, writer = await asyncio.open_connection("127.0.0.1", web.port)
    key = "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n"
    told = "".join(f"{name}: {value}\r\n" for name, value in web.headers("operator").items())
    path = web.socket_url().split(str(web.port), 1)[1]
    head = f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{web.port}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    writer.write(f"{head}{key}{told}\r\n".encode())
    assert b" 101 " in await reader.readline()
    masked = b"\x82\x82" + bytes(4) + b"\x63\x00"
    with suppress(ConnectionError):
        async with asyncio.timeout(30):  # a ping without an answer would end it after 50 s
            while not reader.at_eof():
                writer.write(masked)
                await writer.drain()
                with suppress(TimeoutError):
                    await asyncio.wait_for(reader.read(65536), 0.1)
    writer.close()


async def test_nobody_speaks_for_another_client(web: Web) -> None:
    program = web.new_program()
    async with join(web, "second", program) as good, join(web, "author", program) as bad:
        await good.send(yjs_protocol.encode_awareness([yjs_protocol.AwarenessEntry(7, 1, {"cursor": [1, 1]})]))
        await read_until(bad, b"\x01")
        await bad.send(yjs_protocol.encode_awareness([yjs_protocol.AwarenessEntry(7, 99, None)]))
        await bad.send(yjs_protocol.encode_awareness([yjs_protocol.AwarenessEntry(8, 1, {"user": {"name": "Root"}})]))
        seen = read_frame(await read_until(good, b"\x01"))
        await bad.send(b"\x03")
        clocks: dict[int, int] = {}
        while 8 not in clocks:  # the good client's own frame may still be on its way to the bad one
            everybody = read_frame(await read_until(bad, b"\x01"))
            assert isinstance(everybody, yjs_protocol.Awareness)
            clocks |= {e.client: e.clock for e in everybody.entries}
    assert isinstance(seen, yjs_protocol.Awareness)
    assert [(e.client, e.state["user"]["name"]) for e in seen.entries if e.state] == [(8, "Ada author")]
    assert clocks == {7: 1, 8: 1}


async def test_awareness_above_four_kilobytes_closes_with_4413(web: Web) -> None:
    async with join(web) as socket:
        await socket.send(yjs_protocol.encode_awareness([yjs_protocol.AwarenessEntry(1, 1, {"text": "x" * 5000})]))
        assert await code_of_close(socket) == 4413


async def test_each_standing_has_its_code(web: Web) -> None:
    codes = {}
    for person in ("stranger", None):
        async with join(web, person) as socket:
            codes[person] = await code_of_close(socket)
    async with join(web, "author", "00000000-0000-4000-8000-000000000000") as socket:
        codes["no program"] = await code_of_close(socket)
    assert codes == {"stranger": 4404, None: 4401, "no program": 4404}


async def test_deleting_a_program_closes_it_for_everybody(web: Web) -> None:
    program = web.new_program()
    async with join(web, "second", program) as socket:
        await read_until(socket, b"\x00\x00")
        await in_thread(lambda: delete(web, program))
        assert await code_of_close(socket) == 4404


def delete(web: Web, program: str) -> None:
    with web.client("author") as client:
        assert client.delete(f"/programs/{program}").status_code == 204


def in_thread(act: Callable[[], None]) -> Awaitable[None]:
    return asyncio.to_thread(act)


async def test_who_asks_is_told_how_a_program_is_compiled_and_nobody_else_is(web: Web) -> None:
    program = web.new_program()
    site = f"ws://127.0.0.1:{web.port}/ws/site/hall"
    async with (
        connect(site, additional_headers=web.headers("viewer")) as watcher,
        join(web, "viewer", program) as looks,
        join(web, "second", program) as draws,
        join(web, program=program) as author,
    ):
        await looks.send(encode_integer(yjs_protocol.COMPILED) + encode_integer(0))
        first = await read_compiled(looks)
        await author.send(yjs_protocol.encode_step_2(step("s1")))
        change = await read_compiled(looks)
        assert (first["order"], apply_patch(first, change)["order"]) == ([], ["s1"])
        assert await read_all(draws) == {bytes([yjs_protocol.SYNC])}
        assert '"compiled"' not in await read_all(watcher)


async def read_compiled(socket: ClientConnection) -> dict[str, Any]:
    frame = await read_until(socket, encode_integer(yjs_protocol.COMPILED))
    form: dict[str, Any] = json.loads(frame[frame.index(b"{") :])
    return form


async def read_all(socket: ClientConnection) -> set[Any]:
    """Return the kinds of all that came, of texts their types, until nothing has come for half a second."""
    kinds: set[Any] = set()
    with suppress(TimeoutError):
        while True:
            frame = await asyncio.wait_for(socket.recv(), 0.5)
            kinds.add(frame[:1] if isinstance(frame, bytes) else json.dumps(json.loads(frame)["type"]))
    return kinds - {bytes([yjs_protocol.SAVED]), bytes([yjs_protocol.AWARENESS])}

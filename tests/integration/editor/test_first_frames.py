"""The first frame that somebody sends who is let in, made to do harm: a code or nothing, and nobody else notices.

Against the served form, with raw sockets; beside each hostile one sit an author who draws and one who looks.
"""

from __future__ import annotations

import asyncio
import json
import re
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from editor.documents.shared_document import empty_document, encode_document
from editor.documents.yjs_encoding import encode_integer, encode_sized
from editor.rooms import yjs_protocol
from tests.cases.hostile_updates import HOSTILE
from tests.integration.editor.node_clients import node_clients
from tests.kit.served import served_without_broker
from tests.kit.servers import Redis
from tests.kit.web import Web, prepare

pytestmark = pytest.mark.servers
Frame = str | bytes
TOLD = {0, 4400, 4413, 4429}
"""The codes of docs/shapes/program-socket.md with which a frame may end; 0: nothing was made of it."""
HEARD_WITHIN_S, NEVER_LATER_S = 1.0, 60.0
MOST_KEPT_MIB = 200
LOGGED = re.compile(r"Traceback|ERROR|CRITICAL|panicked")
NUMBER = b"\xff\xff\xff\xff\xff\xff\xff\x0f"
"""2^53 - 1."""


def awareness(state: bytes, client: int = 7, clock: int = 1) -> bytes:
    """Return a frame in which a client shows this of itself."""
    shown = b"\x01" + encode_integer(client) + encode_integer(clock) + encode_sized(state)
    return b"\x01" + encode_sized(shown)


FRAMES: dict[str, Frame] = {
    "text": "hello",
    "no text": "",
    "JSON": '{"type": "hello"}',
    "nested JSON": "[" * 100_000 + "]" * 100_000,
    "NUL as text": "\0",
    "half of JSON in bytes": b'{"type": "hel',
    "nothing": b"",
    "NUL": b"\0",
    "a number that is cut off": b"\x00\x00\x80",
    "a number without end": b"\xff" * 200_000,
    "a length of 2^53": b"\x00\x02" + NUMBER,
    "a length of 2^53 of awareness": b"\x01" + NUMBER,
    "a state vector of 2^53": b"\x00\x00" + encode_sized(NUMBER),
    "ten MiB and one": yjs_protocol.encode_update(bytes(yjs_protocol.MOST_FRAME_BYTES + 1)),
    "awareness that is none": awareness(b"{"),
    "awareness of nested JSON": awareness(b'{"a":' + b"[" * 30_000 + b"]" * 30_000 + b"}"),
    "awareness of a list": awareness(b"[]"),
    "awareness of NUL": awareness(b"\0"),
    "awareness of NaN": awareness(b'{"cursor": [NaN, 1]}'),
    "awareness of a long number": awareness(b'{"cursor": ' + b"9" * 50_000 + b"}"),
    "awareness of half a character": awareness(b'{"editing": "\\ud800"}'),
    "awareness of bytes": awareness(b"\xff\xfe"),
    "awareness of 2^53 clients": b"\x01" + encode_sized(NUMBER),
    "awareness of client 2^53": awareness(b"{}", 2**53),
    "awareness of clock 2^53": awareness(b"{}", 8, 2**53),
    **{f"type {kind}": bytes([kind, 1, 1, 1]) for kind in (2, 3, 4, 5, 9, 99, 100, 101, 127, 128, 200, 255)},
    **{f"sync {kind}": bytes([0, kind, 1, 1]) for kind in (0, 1, 2, 3, 4, 99, 127, 255)},
    **{f"step 2: {name}": yjs_protocol.encode_step_2(sent) for name, sent in HOSTILE.items()},
    **{f"update: {name}": yjs_protocol.encode_update(sent) for name, sent in HOSTILE.items()},
}


@pytest.fixture(scope="module")
def web(tmp_path_factory: pytest.TempPathFactory, module_database_url: str, shared_redis: Redis) -> Iterator[Web]:
    folder = tmp_path_factory.mktemp("served")
    told = served_without_broker(folder, module_database_url, shared_redis.url)
    extra = {name: value for name, value in told.items() if name.startswith("VIPO_")}
    server = Web(folder, **prepare(folder, extra), extra=extra)
    server.start()
    try:
        yield server
    finally:
        server.kill()


def resident_mib(web: Web) -> float:
    """Return how much memory the server holds."""
    assert web.process is not None
    status = Path(f"/proc/{web.process.pid}/status").read_text()
    return int(re.findall(r"VmRSS:\s+(\d+)", status)[0]) / 1024


def join(web: Web, person: str, program: str) -> connect:
    return connect(web.socket_url(program), additional_headers=web.headers(person), max_size=None, ping_interval=None)


@dataclass
class Beside:
    """Two honest people in the room: one draws, one hears of it."""

    drawing: ClientConnection
    hearing: ClientConnection
    took_s: list[float] = field(default_factory=list)

    async def draw(self) -> None:
        """Draw a step, and wait until the other has heard of it."""
        name, began = f"s{len(self.took_s)}", time.monotonic()
        drawn = encode_document({**empty_document(), "steps": {name: {"kind": "wait", "place": None}}})
        await self.drawing.send(yjs_protocol.encode_update(drawn))
        async with asyncio.timeout(NEVER_LATER_S):
            while True:
                heard = await self.hearing.recv()
                assert isinstance(heard, bytes)
                if heard[:2] == b"\x00\x02" and name.encode() in heard:
                    break
        self.took_s.append(time.monotonic() - began)


@asynccontextmanager
async def beside(web: Web, program: str) -> AsyncIterator[Beside]:
    """Let two honest people sit in the room."""
    async with join(web, "second", program) as drawing, join(web, "viewer", program) as hearing:
        await drawing.send(yjs_protocol.encode_step_2(b"\x00\x00"))
        await hearing.send(yjs_protocol.encode_step_1(b"\x00"))
        async with asyncio.timeout(NEVER_LATER_S):  # who has its answer is in the room, and hears what comes after
            while (await hearing.recv())[:2] != b"\x00\x01":
                pass
        draining = asyncio.create_task(drain(drawing))
        people = Beside(drawing, hearing)
        await people.draw()
        yield people
        await people.draw()
        draining.cancel()


async def drain(socket: ClientConnection) -> None:
    async for _ in socket:
        pass


async def code_after(web: Web, program: str, frame: Frame) -> int:
    """Send a frame as the first; return the code of the close, or 0 if the room still answers afterwards."""
    async with join(web, "author", program) as socket, asyncio.timeout(NEVER_LATER_S):
        try:
            await socket.send(frame)
            await socket.send(yjs_protocol.encode_step_1(b"\x00"))
            while (await socket.recv())[:2] != b"\x00\x01":
                pass
        except ConnectionClosed as closed:
            return closed.rcvd.code if closed.rcvd else -1
    return 0


async def test_a_hostile_first_frame_ends_its_own_connection_alone(web: Web) -> None:
    program = await asyncio.to_thread(web.new_program)
    odd: dict[str, int] = {}
    found: dict[str, int] = {}
    async with beside(web, program) as people:
        for _ in range(10):
            await people.draw()
        calm_s = people.took_s[-10:]
        before = resident_mib(web)
        for name, frame in FRAMES.items():
            found[name] = await code_after(web, program, frame)
            if found[name] not in TOLD:
                odd[name] = found[name]
            await people.draw()
    assert odd == {}
    assert {code for name, code in found.items() if name.startswith("step 2: ")} == {4400}
    assert (found["ten MiB and one"], found["text"], found["type 99"]) == (4413, 4400, 4400)
    took_s = people.took_s[-len(FRAMES) - 1 :]
    late = [each for each in took_s if each > max(HEARD_WITHIN_S, 5 * max(calm_s))]
    assert len(late) <= len(took_s) / 20, (calm_s, took_s)
    assert resident_mib(web) - before < MOST_KEPT_MIB
    story = web.story()
    assert LOGGED.findall(story) == [], story[-6000:]


def frames() -> st.SearchStrategy[Frame]:
    """Make frames of noise, and of parts of the protocol put together wrongly."""
    numbers = st.sampled_from([0, 1, 2, 100, 127, 2**31, 2**32 - 1, 2**53 - 1]).map(encode_integer)
    words = st.sampled_from([b"\x05steps", b"\x01a", b"\x28", b"\x27", b"\x75", b"\x76", b"\x7e", b"\x80", b"\xff"])
    noise = st.one_of(st.binary(max_size=100), st.lists(st.one_of(numbers, words), max_size=30).map(b"".join))
    heads = st.sampled_from([b"\x00\x00", b"\x00\x01", b"\x00\x02", b"\x01", b"\x03", b"\x64"])
    whole = st.builds(lambda head, body: head + encode_sized(body), heads, noise)
    states = st.dictionaries(st.text(max_size=5), st.none() | st.text(max_size=5), max_size=3)
    shown = states.map(lambda state: awareness(json.dumps(state).encode()))
    return st.one_of(st.text(max_size=50), noise, whole, st.builds(bytes.__add__, heads, noise), shown)


@given(frame=frames())
def test_no_first_frame_ends_with_a_code_that_is_not_told(web: Web, frame: Frame) -> None:
    program = web.program
    assert asyncio.run(code_after(web, program, frame)) in TOLD
    story = web.story()
    assert LOGGED.findall(story) == [], story[-6000:]


async def test_the_site_socket_leaves_aside_whatever_is_sent(web: Web) -> None:
    url = f"ws://127.0.0.1:{web.port}/ws/site/hall"
    async with connect(url, additional_headers=web.headers("viewer"), max_size=None) as socket, asyncio.timeout(60):
        assert json.loads(await socket.recv()) == {"type": "hello", "site": "hall"}
        for frame in FRAMES.values():
            await socket.send(frame)
        program = await asyncio.to_thread(web.new_program, "Afterwards")
        while json.loads(await socket.recv())["type"] != "programs":
            pass
    assert program
    story = web.story()
    assert LOGGED.findall(story) == [], story[-6000:]


def test_plain_clients_of_y_websocket_go_on_beside_hostile_ones(web: Web) -> None:
    program = web.new_program("Plain")
    with node_clients(web, program) as clients:
        clients.open("ada")
        clients.open("bob", "second")
        clients.tell("add", name="ada", id="s1", x=4, y=-2.5)
        for frame in [*FRAMES.values()][::5]:
            assert asyncio.run(code_after(web, program, frame)) in TOLD
        clients.tell("add", name="bob", id="s2", x=5, y=-2.5)
        clients.tell("saved", name="bob")
        clients.tell("converged")
        assert set(clients.tell("steps", name="ada")["steps"]) == {"s1", "s2"}
        assert clients.tell("problems")["problems"] == []

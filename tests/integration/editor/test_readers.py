"""Many who only look, of whom some read late: a real process, plain sockets, and documents of their own."""

from __future__ import annotations

import asyncio
from contextlib import AsyncExitStack
from dataclasses import dataclass, field
from typing import Any

from pycrdt import Doc, Map
from websockets.asyncio.client import ClientConnection, connect

from editor.rooms import yjs_protocol
from editor.rooms.member import BYTES_PER_S
from editor.rooms.room import MOST_OF_PERSON, MOST_READERS
from tests.kit.drawn.frames import read_frame
from tests.kit.web import Web, make_people

EDITS, PER_S = 60, 20
LATE, WRITERS, TEXTS, TEXT_BYTES = 5, 5, 20, 300_000
MOST_KEPT_BYTES = 10_000_000
"""Of the 30 MB that are sent to who reads all."""
PATIENCE_S = 90


@dataclass
class Peer:
    """A Yjs client on a socket; it reads only while it is told to."""

    socket: ClientConnection
    document: Doc[Any] = field(default_factory=Doc)
    read_bytes: int = 0

    async def draw(self, root: str, key: str, value: object) -> None:
        before = self.document.get_state()
        self.document.get(root, type=Map)[key] = value
        await self.socket.send(yjs_protocol.encode_update(self.document.get_update(before)))

    def content(self, root: str) -> dict[str, Any]:
        return dict(self.document.get(root, type=Map).to_py() or {})

    async def read_until(self, root: str, wanted: dict[str, Any]) -> None:
        """Apply what comes, and answer what is asked, until the content is this."""
        async with asyncio.timeout(PATIENCE_S):
            while self.content(root) != wanted:
                await self.take(await self.socket.recv())

    async def take(self, frame: str | bytes) -> None:
        assert isinstance(frame, bytes)
        self.read_bytes += len(frame)
        if frame[0] in (yjs_protocol.SYNC, yjs_protocol.AWARENESS):
            message = read_frame(frame)
            if isinstance(message, yjs_protocol.SyncStep1):
                await self.socket.send(yjs_protocol.encode_step_2(self.document.get_update(message.state)))
            elif isinstance(message, yjs_protocol.SyncStep2 | yjs_protocol.Update):
                self.document.apply_update(message.update)


async def join(stack: AsyncExitStack, web: Web, program: str, session: str) -> Peer:
    headers = {**web.headers(None), "Cookie": f"sessionid={session}"}
    opening = connect(web.socket_url(program), additional_headers=headers, max_size=None, open_timeout=PATIENCE_S,
                      ping_interval=None, compression=None)  # fmt: skip
    peer = Peer(await stack.enter_async_context(opening))
    await peer.take(await peer.socket.recv())
    await peer.socket.send(yjs_protocol.encode_step_1(peer.document.get_state()))
    return peer


async def test_three_hundred_readers_see_every_step_that_an_editor_draws(web: Web) -> None:
    viewers, program = make_people(web.folder, {}, "viewer", MOST_READERS // MOST_OF_PERSON), web.new_program("Watched")
    wanted = {f"s{number}": {"kind": "wait", "pos": [number, 1]} for number in range(EDITS)}
    async with AsyncExitStack() as stack:
        author = await join(stack, web, program, web.sessions["author"])
        readers = [await join(stack, web, program, viewers[n // MOST_OF_PERSON]) for n in range(MOST_READERS)]
        reading = [asyncio.create_task(reader.read_until("steps", wanted)) for reader in readers]
        for name, step in wanted.items():
            await author.draw("steps", name, step)
            await asyncio.sleep(1 / PER_S)
        await asyncio.gather(*reading)
        assert [reader.content("steps") == wanted for reader in readers] == [True] * MOST_READERS


async def test_little_is_kept_for_who_does_not_read_and_it_has_all_once_it_reads(web: Web) -> None:
    program = web.new_program("Late")
    async with AsyncExitStack() as stack:
        writers = [await join(stack, web, program, web.sessions["author"]) for _ in range(WRITERS)]
        late = [await join(stack, web, program, web.sessions["viewer"]) for _ in range(LATE)]
        for number in range(TEXTS):
            wanted = {f"p{name}": f"{number % 10}" * TEXT_BYTES for name in range(WRITERS)}
            for writer, (name, text) in zip(writers, wanted.items(), strict=True):
                await writer.draw("parameters", name, text)
            await asyncio.gather(*(writer.read_until("parameters", wanted) for writer in writers))
            await asyncio.sleep(TEXT_BYTES / BYTES_PER_S)  # who sends more is closed, and that is another test
        await asyncio.gather(*(reader.read_until("parameters", wanted) for reader in late))
        assert [reader.content("parameters") == wanted for reader in late] == [True] * LATE
        assert max(reader.read_bytes for reader in late) < MOST_KEPT_BYTES
        assert [reader.socket.close_code for reader in late] == [None] * LATE

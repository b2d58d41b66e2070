"""Somebody who draws and looks at how a program is compiled."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from typing import Any

import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from editor.documents.shared_document import SharedDocument, empty_document, encode_document
from editor.documents.yjs_encoding import encode_integer
from editor.programs.compiled_patch import apply_patch
from editor.rooms import yjs_protocol
from tests.kit.drawn.frames import read_frame
from tests.kit.waiting import PATIENCE_S
from tests.kit.web import Web

AGAIN_AFTER_S = 0.3
Json = dict[str, Any]


class Looker:
    """Somebody who looks at the compiled form, and who comes again when sent away.

    `frames` are the bytes of each form that came, `ends` tell why connections ended. What was added is sent again with
    each connection, as Yjs clients do.
    """

    def __init__(self, web: Web, program: str, person: str) -> None:
        self.connecting = connect(
            web.socket_url(program), additional_headers=web.headers(person), max_size=None, ping_interval=None
        )
        self.socket: ClientConnection | None = None
        self.document = SharedDocument()
        self.added: list[bytes] = []
        self.form: Json = {}
        self.frames: list[int] = []
        self.ends: list[str] = []
        self.news = asyncio.Condition()

    async def stay(self) -> None:
        """Read, and connect again whenever the connection ends."""
        while True:
            try:
                async with self.connecting as socket:
                    await socket.send(encode_integer(yjs_protocol.COMPILED) + encode_integer(0))
                    await socket.send(yjs_protocol.encode_step_1(self.document.state()))
                    for update in self.added:
                        await socket.send(yjs_protocol.encode_step_2(update))
                    self.socket = socket
                    while True:
                        await self._take(await socket.recv())
            except ConnectionClosed as error:
                self.ends.append(str(error))
            self.socket = None
            await asyncio.sleep(AGAIN_AFTER_S)

    async def _take(self, frame: str | bytes) -> None:
        assert isinstance(frame, bytes)
        if frame.startswith(encode_integer(yjs_protocol.COMPILED)):
            told = json.loads(frame[frame.index(b"{") :])
            self.form = apply_patch(self.form, told) if "base" in told else told
            self.frames.append(len(frame))
        elif frame[0] == yjs_protocol.SYNC:
            message = read_frame(frame)
            if isinstance(message, yjs_protocol.Update | yjs_protocol.SyncStep2):
                self.document.apply(message.update)
        async with self.news:
            self.news.notify_all()

    async def add(self, *names: str) -> None:
        params = {"duration": 5}
        await self.draw(
            {name: {"kind": "wait", "place": ["program", "body", name], "params": params} for name in names}
        )

    async def draw(self, steps: Json) -> None:
        self.added.append(encode_document({**empty_document(), "steps": steps}))
        if self.socket is not None:
            with suppress(ConnectionClosed):
                await self.socket.send(yjs_protocol.encode_step_2(self.added[-1]))

    async def sees(self, *steps: str) -> None:
        await self._wait(lambda: sorted(self.form.get("order", ["?"])) == sorted(steps), f"the form of {steps}")

    async def finds(self, is_there: Callable[[], bool]) -> None:
        await self._wait(is_there, "what is looked for")

    async def has(self, step: str) -> None:
        await self._wait(lambda: step in self.document.to_json()["steps"], step)

    async def _wait(self, is_there: Callable[[], bool], what: str) -> None:
        try:
            async with asyncio.timeout(PATIENCE_S), self.news:
                await self.news.wait_for(is_there)
        except TimeoutError:
            has = sorted(self.document.to_json()["steps"])
            pytest.fail(f"{what} did not come: the form has {self.form.get('order')}, the document {has}")


@asynccontextmanager
async def looking(web: Web, program: str, person: str = "author") -> AsyncIterator[Looker]:
    looker = Looker(web, program, person)
    staying = asyncio.create_task(looker.stay())
    try:
        yield looker
    finally:
        staying.cancel()
        await asyncio.gather(staying, return_exceptions=True)

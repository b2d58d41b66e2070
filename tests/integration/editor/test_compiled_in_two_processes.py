"""Two web processes show one compiled form: checked once, sent as what changed, and never left behind an edit."""

from __future__ import annotations

import asyncio
import json
import signal
import time
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import Any

import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from editor.documents.shared_document import SharedDocument, empty_document, encode_document
from editor.documents.yjs_encoding import encode_integer
from editor.programs.compiled_patch import apply_patch
from editor.rooms import yjs_protocol
from editor.rooms.checks import LEFT_TO_OTHERS_S
from tests.kit.served import served_without_broker
from tests.kit.servers import Redis
from tests.kit.waiting import PATIENCE_S
from tests.kit.web import Web, prepare

pytestmark = pytest.mark.servers
AGAIN_AFTER_S = 0.3
Json = dict[str, Any]


@pytest.fixture(scope="module")
def pair(
    tmp_path_factory: pytest.TempPathFactory, module_database_url: str, shared_redis: Redis
) -> Iterator[tuple[Web, Web]]:
    folder: Path = tmp_path_factory.mktemp("pair")
    extra = served_without_broker(folder, module_database_url, shared_redis.url)
    extra = {name: value for name, value in extra.items() if name.startswith("VIPO_")}
    made = prepare(folder, extra)
    one, two = (Web(folder, **made, extra=extra) for _ in range(2))
    one.start()
    two.start()
    try:
        yield one, two
    finally:
        one.kill()
        two.kill()


class Looker:
    """Somebody who looks at the compiled form, and who comes again when sent away; `frames` are the bytes it was told.

    What was added is sent again with each connection, as Yjs clients do.
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
        self.news = asyncio.Condition()

    async def stay(self) -> None:
        """Read, and connect again whenever the connection ends."""
        while True:
            with suppress(ConnectionClosed):
                async with self.connecting as socket:
                    await socket.send(encode_integer(yjs_protocol.COMPILED) + encode_integer(0))
                    await socket.send(yjs_protocol.encode_step_1(self.document.state()))
                    for update in self.added:
                        await socket.send(yjs_protocol.encode_step_2(update))
                    self.socket = socket
                    while True:
                        await self._take(await socket.recv())
            self.socket = None
            await asyncio.sleep(AGAIN_AFTER_S)

    async def _take(self, frame: str | bytes) -> None:
        assert isinstance(frame, bytes)
        if frame.startswith(encode_integer(yjs_protocol.COMPILED)):
            told = json.loads(frame[frame.index(b"{") :])
            self.form = apply_patch(self.form, told) if "base" in told else told
            self.frames.append(len(frame))
        elif frame[0] == yjs_protocol.SYNC:
            message = yjs_protocol.decode_frame(frame)
            if isinstance(message, yjs_protocol.Update | yjs_protocol.SyncStep2):
                self.document.apply(message.update)
        async with self.news:
            self.news.notify_all()

    async def add(self, *names: str) -> None:
        steps = {
            name: {"kind": "wait", "place": ["program", "body", name], "params": {"duration": 5}} for name in names
        }
        self.added.append(encode_document({**empty_document(), "steps": steps}))
        if self.socket is not None:
            with suppress(ConnectionClosed):
                await self.socket.send(yjs_protocol.encode_step_2(self.added[-1]))

    async def sees(self, *steps: str) -> None:
        await self._wait(lambda: sorted(self.form.get("order", ["?"])) == sorted(steps), f"the form of {steps}")

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


async def quiet(*lookers: Looker) -> None:
    """Wait until nothing has been sent for longer than one process waits for the other to check; forget the frames."""
    while any(looker.frames for looker in lookers):
        for looker in lookers:
            looker.frames.clear()
        await asyncio.sleep(LEFT_TO_OTHERS_S + 0.5)


async def test_both_show_one_form_and_an_edit_costs_one_check_and_few_bytes(pair: tuple[Web, Web]) -> None:
    program = pair[0].new_program()
    async with looking(pair[0], program) as ada, looking(pair[1], program, "viewer") as eve:
        await ada.add(*(f"s{number:03}" for number in range(300)))
        await ada.sees(*(names := [f"s{number:03}" for number in range(300)]))
        await eve.sees(*names)
        await quiet(ada, eve)
        began = time.monotonic()
        await ada.add("s000a")
        await ada.sees(*names, "s000a")
        await eve.sees(*names, "s000a")
        took_s = time.monotonic() - began
        await asyncio.sleep(LEFT_TO_OTHERS_S + 1)
    assert (len(ada.frames), len(eve.frames)) == (1, 1) or took_s > LEFT_TO_OTHERS_S  # then both may have checked
    assert max(ada.frames + eve.frames) < 1000
    assert ada.form == eve.form
    assert ada.form["numbers"]["s299"] == "301"


async def test_edits_at_both_at_once_are_all_shown_at_both(pair: tuple[Web, Web]) -> None:
    program = pair[0].new_program()
    async with looking(pair[0], program) as ada, looking(pair[1], program, "second") as bob:
        names = []
        for number in range(30):
            await asyncio.gather(ada.add(f"a{number}"), bob.add(f"b{number}"))
            names += [f"a{number}", f"b{number}"]
            await asyncio.sleep(0.01 * (number % 5))
        await ada.sees(*names)
        await bob.sees(*names)
        await quiet(ada, bob)
        assert ada.form == bob.form


async def test_an_edit_whose_process_stops_before_it_has_checked_is_shown_by_the_other(pair: tuple[Web, Web]) -> None:
    program, process = pair[0].new_program(), pair[0].process
    assert process is not None
    names: list[str] = []
    async with looking(pair[0], program) as ada, looking(pair[1], program, "second") as bob:
        for number in range(5):
            names.append(f"s{number}")
            await ada.add(names[-1])
            await bob.has(names[-1])
            process.send_signal(signal.SIGSTOP)
            try:
                await bob.sees(*names)
            finally:
                process.send_signal(signal.SIGCONT)
            await ada.sees(*names)
            await quiet(ada, bob)
            assert ada.form == bob.form

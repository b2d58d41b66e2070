"""Two web processes show one compiled form: checked once, sent as what changed, and never left behind an edit."""

from __future__ import annotations

import asyncio
import json
import signal
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import Any

import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from editor.documents.shared_document import empty_document, encode_document
from editor.documents.yjs_encoding import encode_integer
from editor.programs.compiled_patch import apply_patch
from editor.rooms import yjs_protocol
from tests.kit.served import served_without_broker
from tests.kit.servers import Redis
from tests.kit.web import Web, prepare

pytestmark = pytest.mark.servers
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
    """Somebody who looks at the compiled form; `frames` counts what they were sent, in bytes."""

    def __init__(self, socket: ClientConnection) -> None:
        self.socket = socket
        self.form: Json = {}
        self.frames: list[int] = []
        self.updates = 0
        self.news = asyncio.Condition()

    async def read(self) -> None:
        while True:
            frame = await self.socket.recv()
            assert isinstance(frame, bytes)
            if frame.startswith(encode_integer(yjs_protocol.COMPILED)):
                told = json.loads(frame[frame.index(b"{") :])
                self.form = apply_patch(self.form, told) if "base" in told else told
                self.frames.append(len(frame))
            self.updates += frame.startswith(bytes([yjs_protocol.SYNC, yjs_protocol.UPDATE]))
            async with self.news:
                self.news.notify_all()

    async def sees(self, *steps: str) -> None:
        async with asyncio.timeout(30), self.news:
            await self.news.wait_for(lambda: sorted(self.form.get("order", ["?"])) == sorted(steps))

    async def has_updates(self, count: int, within_s: float) -> bool:
        try:
            async with asyncio.timeout(within_s), self.news:
                return await self.news.wait_for(lambda: self.updates >= count)
        except TimeoutError:
            return False


@asynccontextmanager
async def looking(web: Web, program: str, person: str = "author") -> AsyncIterator[Looker]:
    headers = web.headers(person)
    async with connect(web.socket_url(program), additional_headers=headers, max_size=None) as socket:
        looker = Looker(socket)
        reading = asyncio.create_task(looker.read())
        await socket.send(encode_integer(yjs_protocol.COMPILED) + encode_integer(0))
        try:
            yield looker
        finally:
            reading.cancel()


async def add(looker: Looker, *names: str) -> None:
    steps = {name: {"kind": "wait", "place": ["program", "body", name], "params": {"duration": 5}} for name in names}
    await looker.socket.send(yjs_protocol.encode_step_2(encode_document({**empty_document(), "steps": steps})))


async def quiet(*lookers: Looker) -> None:
    """Wait until nothing has been sent for longer than one process waits for the other to check; forget the frames."""
    while any(looker.frames for looker in lookers):
        for looker in lookers:
            looker.frames.clear()
        await asyncio.sleep(2.5)


async def test_both_show_one_form_and_an_edit_costs_one_check_and_few_bytes(pair: tuple[Web, Web]) -> None:
    program = pair[0].new_program()
    async with looking(pair[0], program) as ada, looking(pair[1], program, "viewer") as eve:
        await add(ada, *(f"s{number:03}" for number in range(300)))
        await ada.sees(*(names := [f"s{number:03}" for number in range(300)]))
        await eve.sees(*names)
        await quiet(ada, eve)
        await add(ada, "s000a")
        await ada.sees(*names, "s000a")
        await eve.sees(*names, "s000a")
        await asyncio.sleep(3)  # longer than one process waits for the other to check
    assert (len(ada.frames), len(eve.frames)) == (1, 1)
    assert max(ada.frames + eve.frames) < 1000
    assert ada.form == eve.form
    assert ada.form["numbers"]["s299"] == "301"


async def test_edits_at_both_at_once_are_all_shown_at_both(pair: tuple[Web, Web]) -> None:
    program = pair[0].new_program()
    async with looking(pair[0], program) as ada, looking(pair[1], program, "second") as bob:
        names = []
        for number in range(30):
            await asyncio.gather(add(ada, f"a{number}"), add(bob, f"b{number}"))
            names += [f"a{number}", f"b{number}"]
            await asyncio.sleep(0.01 * (number % 5))
        await ada.sees(*names)
        await bob.sees(*names)
        await asyncio.sleep(0.5)
        assert ada.form == bob.form


async def test_an_edit_whose_process_stops_before_it_has_checked_is_shown_by_the_other(pair: tuple[Web, Web]) -> None:
    program, process = pair[0].new_program(), pair[0].process
    assert process is not None
    async with looking(pair[1], program, "second") as bob:
        for number in range(5):
            names = [f"s{each}" for each in range(number + 1)]
            before = bob.updates
            for _ in range(6):  # who was frozen for long asks its people to come again, who then say it again
                with suppress(ConnectionClosed):
                    async with looking(pair[0], program) as ada:
                        await add(ada, names[-1])
                        if await bob.has_updates(before + 1, within_s=10):
                            process.send_signal(signal.SIGSTOP)
                            try:
                                await bob.sees(*names)
                            finally:
                                process.send_signal(signal.SIGCONT)
                            break
            else:
                pytest.fail("no edit came through the process that had been frozen")
        async with looking(pair[0], program) as ada:
            await ada.sees(*names)
            await quiet(ada, bob)
            assert ada.form == bob.form

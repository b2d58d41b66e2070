"""`python -m bench.rooms_inside <steps> <tail> <place>`: a room of a large program, opened and edited in this process.

The program has changes after its first form: `tail` of them, in the room's `stream` or as `rows` of the database.

Prints how long its event loop stood still at longest, and what an edit costs it and the child processes that check.
"""

from __future__ import annotations

import asyncio
import json
import os
import sys
import time
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

Json = dict[str, Any]
EDITS = 20
EDIT_EVERY_S = 0.25
EDITORS = 10


class Stalls:
    """The longest time that the event loop did not come back from a sleep of a millisecond.

    `computed_ms` is what this process computed in the meantime at most, which other processes' work does not lengthen.
    """

    longest_ms = computed_ms = 0.0

    async def watch(self) -> None:
        while True:
            began, computed = time.perf_counter(), time.process_time()
            await asyncio.sleep(0.001)
            self.computed_ms = max(self.computed_ms, (time.process_time() - computed) * 1000)
            self.longest_ms = max(self.longest_ms, (time.perf_counter() - began) * 1000 - 1)


@asynccontextmanager
async def _stalls() -> AsyncIterator[Stalls]:
    stalls = Stalls()
    watching = asyncio.create_task(stalls.watch())
    try:
        yield stalls
    finally:
        watching.cancel()


async def measure(steps: int, tail: int, place: str) -> Json:
    """Open a program of so many steps, with so many changes in that place; then ten people edit it, ten look on."""
    from asgiref.sync import sync_to_async
    from django.contrib.auth import get_user_model

    from bench.compiled_frames import _steps
    from editor import services as editor
    from editor.documents.shared_document import SharedDocument, empty_document
    from editor.documents.store import load_document
    from editor.rooms.hub import hub_of_this_loop
    from editor.rooms.member import Member, Person

    document = {**empty_document(), "steps": _steps(steps)}
    made = await sync_to_async(editor.create_program)(site="hall", name=f"{steps} steps", document=document)
    program, hub = str(made.id), hub_of_this_loop()
    shared = SharedDocument((await sync_to_async(load_document)(program)).updates)
    fill = {"stream": _fill_stream(hub.stream, program), "rows": _fill_rows(program)}[place]
    await fill(_changes(shared, tail))
    author: int = (await sync_to_async(get_user_model().objects.get)(display_name="Ada author")).pk
    members = [Member(Person(author, "A", "A"), can_write=True, wake=lambda: None) for _ in range(EDITORS)]
    await _warm(hub)
    async with _stalls() as opening:
        began = time.perf_counter()
        room = await hub.enter(program, members[0])
        opened_ms = (time.perf_counter() - began) * 1000
        for member in members[1:]:
            await hub.enter(program, member)
        for member in members:
            member.synced, member.shown = True, 0
        room.touched = True
        room.wake()
        while room.form.now is None:  # noqa: ASYNC110 - as whoever looks on waits
            await asyncio.sleep(0.01)
        await asyncio.sleep(1)
    edited = await _edit(hub, room, members, shared)
    await hub.close()
    return {"opened_ms": opened_ms, **_told("opening", opening), **edited}


def _told(what: str, stalls: Stalls) -> Json:
    return {f"{what}_stall_ms": stalls.longest_ms, f"{what}_stall_computed_ms": stalls.computed_ms}


async def _warm(hub: Any) -> None:
    """Open a small program first, as in a process that has been at work for a while."""
    from asgiref.sync import sync_to_async

    from editor import services as editor
    from editor.rooms.member import Member, Person

    made = await sync_to_async(editor.create_program)(site="hall", name="small")
    room = await hub.enter(str(made.id), Member(Person(1, "B", "B"), can_write=True, wake=lambda: None))
    room.touched = True
    room.wake()
    while room.form.now is None:  # noqa: ASYNC110
        await asyncio.sleep(0.01)


def _changes(shared: Any, count: int) -> Iterator[bytes]:
    steps = shared._document["steps"]
    for number in range(1, count + 1):
        before = shared.state()
        steps[f"s{number % len(steps)}"]["pos"] = [float(number), 0.0]
        yield shared.encode(before)


Fill = Callable[[Iterator[bytes]], Awaitable[None]]


def _fill_stream(stream: Any, program: str) -> Fill:
    from editor.documents.store import Change
    from editor.rooms.ledger import encode_change

    async def fill(changes: Iterator[bytes]) -> None:
        for number, update in enumerate(changes, 1):
            await stream.append(program, "dead", [encode_change(number, Change(None, update))])

    return fill


def _fill_rows(program: str) -> Fill:
    from asgiref.sync import sync_to_async

    from editor.models import DocumentUpdate, Program

    def fill(rows: list[bytes]) -> None:
        DocumentUpdate.objects.bulk_create(
            DocumentUpdate(program_id=program, seq=seq, data=data) for seq, data in enumerate(rows, 2)
        )
        Program.objects.filter(pk=program).update(last_seq=len(rows) + 1)

    async def fill_in_thread(changes: Iterator[bytes]) -> None:
        await sync_to_async(fill)(list(changes))

    return fill_in_thread


async def _edit(hub: Any, room: Any, members: list[Any], shared: Any) -> Json:
    from editor.rooms import yjs_protocol

    compilers = getattr(getattr(hub, "_shared", None), "compilers", None)
    pids = compilers.pids if compilers else []
    steps = shared._document["steps"]
    from pycrdt import Map

    busy_s, children_ms, frames = time.process_time(), _cpu_ms(pids), 0
    async with _stalls() as stalls:
        making_s = 0.0
        for number in range(EDITS * EDITORS):
            began = time.process_time()
            before = shared.state()
            place = [f"s{number * 7 // 10 * 10}", "body", f"zz{number}"]
            steps[f"new{number}"] = Map({"kind": "wait", "place": place, "params": Map({"duration": 5})})
            frame = yjs_protocol.encode_update(shared.encode(before))
            making_s += time.process_time() - began
            member = members[number % EDITORS]
            room.receiver.receive(member, frame, time.monotonic())
            for each in members:
                frames += len(each.outbox)
                each.outbox.clear()
                each._unread = 0
            await asyncio.sleep(EDIT_EVERY_S / EDITORS)
        await asyncio.sleep(1)
    count = EDITS * EDITORS
    return {
        **_told("edit", stalls),
        "cpu_ms": (time.process_time() - busy_s - making_s) * 1000 / count,
        "children_cpu_ms": (_cpu_ms(compilers.pids if compilers else []) - children_ms) / count,
    }


def _cpu_ms(pids: list[int]) -> float:
    ticks = 0
    for pid in pids:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        ticks += int(fields[11]) + int(fields[12])
    return ticks * 1000 / os.sysconf("SC_CLK_TCK")


if __name__ == "__main__":
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "tests.settings")
    import django

    django.setup()
    from vipo_site.http.gc_pause import leave_out_what_stays

    leave_out_what_stays()  # as the web process does
    sys.stdout.write(json.dumps(asyncio.run(measure(int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]))))

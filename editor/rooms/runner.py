"""A room at work: its changes go to the database and to the other processes, and theirs come in."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Awaitable, Callable, Coroutine
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from django.db import DatabaseError
from django.utils import timezone

from editor.compiling.compilers import Compilers
from editor.documents.shared_document import BadUpdate
from editor.documents.store import (
    COMPACT_AFTER_ROWS,
    Change,
    SnapshotDiffers,
    Stored,
    append_changes,
    compact_document,
    load_document,
    note_stored_to,
)
from editor.documents.tasks import Comparing, Differences, Folded, Folding
from editor.documents.yjs_encoding import BadFrame
from editor.errors import DocumentHole, NoSuchProgram
from editor.rooms.checks import Checks
from editor.rooms.ledger import last_numbers
from editor.rooms.member import Close
from editor.rooms.refusals import INTERRUPTED
from editor.rooms.room import Room
from editor.rooms.stream import Entry, RoomStream, StreamLost
from editor.rooms.threads import in_database

log = logging.getLogger(__name__)
SAVE_EVERY_S = 0.25
PUBLISH_EVERY_S = 0.01
READ_FOR_S = 5.0
"""So long a question after news waits for an answer: each is work, in a room where nothing happens too."""
SPREAD_EVERY_S, SPREAD_AT_LEAST_EVERY_S = 0.006, 0.2
ADOPT_EVERY_S = 0.5
LOST_FOR_S = 20.0
"""So long a room goes on by itself while the other processes cannot be reached."""
AWARENESS_EVERY_S, AWARENESS_BYTES_PER_S = 0.033, 8_000_000
COMPARE_EVERY_S = 30.0
BEAT_EVERY_S = 10.0
SILENT_AFTER_S = 75.0
RETRY_AFTER_S = 1.0
FOLD_AGAIN_AFTER_S = 30.0
LARGE_BYTES = 50_000
PAUSE_EVERY_S = 0.005
HASHED_AT_ONCE = 200


_EVENTS = ("spread", "save", "keep", "publish", "awareness", "fold")


@dataclass(frozen=True, slots=True)
class Shared:
    """What the rooms of a process have in common: the stream to the other processes, and who checks."""

    stream: RoomStream
    compilers: Compilers


class OpenRoom:
    """The tasks around one room. `on_end` is called once when it must be opened anew."""

    def __init__(
        self, room: Room, shared: Shared, after: str, stored: Stored, on_end: Callable[[OpenRoom], None]
    ) -> None:
        self.room = room
        self._stream = shared.stream
        self._compilers = shared.compilers
        self._after = after
        self._compacted, self._row = stored.compacted, stored.seq
        self._compared_place = 0
        self._paused_at = 0.0
        self._on_end = on_end
        self._lost_at: float | None = None
        self._ended = False
        self._saving = asyncio.Lock()
        self._publishing = asyncio.Lock()
        self._folding = asyncio.Lock()
        self._heard_at: dict[str, float] = {}
        self._events = {name: asyncio.Event() for name in _EVENTS}
        self._tasks: list[asyncio.Task[None]] = []
        self.checks = Checks(
            room,
            shared.compilers,
            heard_to=lambda: self._after,
            others=lambda: self._heard_at,
            publish=self._publish_if_possible,
        )
        room.wake = self.wake

    def wake(self) -> None:
        """Have the tasks look at the queues."""
        waits = {"keep": self.room.must_keep, "awareness": self.room.board.has_news, "fold": self._is_long}
        for name, event in self._events.items():
            if waits.get(name, True):
                event.set()
        self.checks.wake()

    @property
    def _is_long(self) -> bool:
        """Whether there are many rows since the last snapshot."""
        return self._row - self._compacted >= COMPACT_AFTER_ROWS

    def start(self) -> None:
        """Start the tasks."""
        loops: tuple[Coroutine[Any, Any, None], ...] = (
            self._spread_often(),
            self._when("publish", PUBLISH_EVERY_S, self._publish),
            self._when("save", SAVE_EVERY_S, self.save),
            self._when("keep", 0, self._keep),
            self._when("fold", 0, self._compact),
            self._every(ADOPT_EVERY_S, self._events["save"].set),
            self._when("awareness", AWARENESS_EVERY_S, self._spread_awareness),
            self._compare_often(),
            self._every(BEAT_EVERY_S, self._beat),
            self._read(),
            *self.checks.loops(),
        )
        self._tasks = [asyncio.create_task(loop) for loop in loops]
        self.room.say_state()

    async def stop(self) -> None:
        """Save and publish what is left, and end the tasks."""
        was_whole, self._ended = not self._ended, True
        await self.save()
        await self._compare_with_database()
        await self.checks.store()
        self.room.spread_awareness()
        with suppress(StreamLost, DatabaseError):
            await self._publish()
            if was_whole:
                await self._empty_stream()
        async with self._folding:  # its thread waits for this event loop, which may end
            for task in self._tasks:
                task.cancel()
            await asyncio.gather(*self._tasks, return_exceptions=True)
        self._compilers.forget(self.room.program)

    async def _empty_stream(self) -> None:
        """Leave nothing between the processes that is in the rows, if no other one has the room open."""
        stored_to = self.room.ledger.stored_to
        if stored_to and not self._heard_at:
            await in_database(note_stored_to)(self.room.program, stored_to)
            await self._stream.forget(self.room.program, stored_to)

    async def _when(self, name: str, pause_s: float, act: Callable[[], Awaitable[None]]) -> None:
        """Act a little after each wake-up, so that what comes in a burst goes in one batch."""
        while True:
            await self._events[name].wait()
            await asyncio.sleep(pause_s)
            self._events[name].clear()
            try:
                await act()
            except StreamLost as error:
                self._note_lost(error, name)

    async def _spread_often(self) -> None:
        """Send changes on at once; those that follow each other go together, the more the longer sending took.

        That is counted as the event loop's work, not as time: who is held up by other processes shall not rest, too.
        """
        while True:
            await self._events["spread"].wait()
            self._events["spread"].clear()
            began = time.thread_time()
            self.room.spread()
            await asyncio.sleep(SPREAD_EVERY_S)
            took = time.thread_time() - began
            if took > SPREAD_EVERY_S:
                await asyncio.sleep(min(took, SPREAD_AT_LEAST_EVERY_S))

    def _note_lost(self, error: StreamLost, name: str) -> None:
        """Go on for a while without the other processes, who are told later; then end."""
        now = time.monotonic()
        self._lost_at = self._lost_at or now
        if now - self._lost_at > LOST_FOR_S:
            self._end(error)
        else:
            asyncio.get_running_loop().call_later(RETRY_AFTER_S, self._events[name].set)

    async def _every(self, pause_s: float, act: Callable[[], None]) -> None:
        while True:
            await asyncio.sleep(pause_s)
            act()

    def _end(self, error: Exception) -> None:
        """Send everybody away to come again: better no room than one that differs from the others."""
        if not self._ended:
            self._ended = True
            log.warning("The room of program %s begins anew: %s", self.room.program, error)
            self.room.close_all(Close(Close.COME_AGAIN, INTERRUPTED))
            self._on_end(self)

    async def _publish(self) -> None:
        async with self._publishing:
            notes = list(self.room.to_publish)
            if notes:
                await self._stream.append(self.room.program, self.room.origin, notes)
                for _ in notes:
                    self.room.to_publish.popleft()

    async def _publish_if_possible(self) -> None:
        try:
            await self._publish()
        except StreamLost as error:
            self._note_lost(error, "publish")

    async def _spread_awareness(self) -> None:
        """Tell who shows what; the more it is, the seldomer, so that nobody makes endless work for all others."""
        await asyncio.sleep(self.room.spread_awareness() / AWARENESS_BYTES_PER_S)

    async def _read(self) -> None:
        while not self._ended:
            try:
                batch = await self._stream.read(self.room.program, self._after, READ_FOR_S)
                self._lost_at = None
                if batch.gap:
                    await self._reload()
                for entry in batch.entries:
                    if entry.note.kind == "state" and entry.origin != self.room.origin:
                        await self._hash()
                    self._after = entry.id
                    self._hear(entry)
                    await self._pause()
            except StreamLost as error:
                self._note_lost(error, "publish")
                await asyncio.sleep(RETRY_AFTER_S / 4)
            except (BadUpdate, BadFrame, DatabaseError, DocumentHole, NoSuchProgram) as error:
                self._end(error)

    async def _pause(self) -> None:
        """Let others have their turn after a while of hearing."""
        if time.monotonic() - self._paused_at > PAUSE_EVERY_S:
            await asyncio.sleep(0)
            self._paused_at = time.monotonic()

    def _hear(self, entry: Entry) -> None:
        if entry.origin != self.room.origin:
            self._heard_at[entry.origin] = time.monotonic()
        self.room.hear(entry, time.monotonic())

    def _beat(self) -> None:
        self.room.beat()
        for origin, heard_at in list(self._heard_at.items()):
            if time.monotonic() - heard_at > SILENT_AFTER_S:
                del self._heard_at[origin]
                self.room.board.forget_process(origin)
                self._events["awareness"].set()

    async def _reload(self) -> None:
        stored = await in_database(load_document)(self.room.program)
        self.room.take_over(list(stored.updates), time.monotonic())

    async def _keep(self) -> None:
        if self.room.must_keep:
            self.room.must_keep = False
            await self.save()

    async def save(self) -> None:
        """Write what waits into the database, others' changes too that they should have written; then tell all."""
        async with self._saving:
            ledger = self.room.ledger
            waiting = [*ledger.adoptable(time.monotonic()), *ledger.own()]
            if waiting:
                changes, at = [each.change for each in waiting], ledger.stored_to
                try:
                    rows = await in_database(append_changes)(self.room.program, changes, timezone.now(), at)
                except NoSuchProgram as error:
                    for origin, number in last_numbers(waiting).items():
                        ledger.note_stored(origin, number)
                    self.room.close_all(Close(Close.NOT_FOUND, error.detail))
                    return
                except DatabaseError as error:
                    self._try_later(error)
                    return
                self._row = rows[-1]
                self.room.say_stored(last_numbers(waiting), rows)
                ledger.see_row(rows[-1], time.monotonic())

    def _try_later(self, error: Exception) -> None:
        log.warning("Program %s could not be saved; it is tried again: %s", self.room.program, error)
        asyncio.get_running_loop().call_later(RETRY_AFTER_S, self._events["save"].set)

    async def _compare_often(self) -> None:
        """Now and then tell the other processes what is here; see whether the database holds it, sooner in doubt."""
        told_at = time.monotonic()
        while True:
            await asyncio.sleep(ADOPT_EVERY_S)
            is_due = time.monotonic() - told_at >= COMPARE_EVERY_S
            if is_due:
                told_at = time.monotonic()
                await self._hash()
                self.room.say_state()
            if self.room.ledger.doubts or (is_due and self.room.ledger.place != self._compared_place):
                await self._compare_with_database()

    async def _hash(self) -> None:
        """Work out what the document's digest needs, a little at a time."""
        while self.room.document.hash_some(HASHED_AT_ONCE):  # noqa: ASYNC110 - it is this that does it
            await asyncio.sleep(0.002)

    def see_row(self, number: int) -> None:
        """Take in the number of the program's last row: nobody may have told of it."""
        self.room.ledger.see_row(number, time.monotonic())

    async def _compare_with_database(self) -> None:
        """Give the database what it lacks of the document, and the document what it lacks of the database."""
        room, place, doubts = self.room, self.room.ledger.place, self.room.ledger.last_doubt
        here = room.document.encode()
        while room.ledger.is_stored_later(place) and not self._ended:  # noqa: ASYNC110 - by whom, nobody knows
            await asyncio.sleep(SAVE_EVERY_S)
        try:
            stored = await in_database(load_document)(room.program)
            found = await self._differences(Comparing(here, stored.updates, stored.appended))
            if found.lacking_there:
                log.warning("The database lacked a part of program %s, which the room has added.", room.program)
                added = [Change(None, found.lacking_there)]
                rows = await in_database(append_changes)(room.program, added, timezone.now())
                room.say_stored({}, rows)
        except (DatabaseError, BadUpdate) as error:
            self._try_later(error)
            return
        except (DocumentHole, NoSuchProgram) as error:
            self._end(error)
            return
        if found.has_hole:
            self._end(DocumentHole(f"A part of program {room.program} is missing in the database."))
            return
        if found.lacking_here:
            room.take_over([found.lacking_here], time.monotonic())
        room.ledger.know_rows(range(room.ledger.rows_to + 1, stored.seq + 1))
        room.settle(doubts)
        self._compared_place = place

    async def _differences(self, comparing: Comparing) -> Differences:
        """Compare in a child process if it is much, or if there is none on a thread. Raises BadUpdate."""
        if len(comparing.here) > LARGE_BYTES and (found := await self._compilers.do(comparing)) is not None:
            return found
        return await asyncio.to_thread(comparing.done)

    async def _compact(self) -> None:
        """Fold the rows if they are many; what people draw meanwhile is saved as ever."""
        if not self._is_long:
            return
        before, self._compacted = self._compacted, self._row
        loop = asyncio.get_running_loop()

        def fold(folding: Folding) -> Folded:
            folded = asyncio.run_coroutine_threadsafe(self._compilers.do(folding), loop).result()
            return folding.done() if folded is None else folded

        try:
            async with self._folding:
                await in_database(compact_document)(self.room.program, fold)
        except (DatabaseError, SnapshotDiffers, DocumentHole, BadUpdate, NoSuchProgram) as error:
            log.warning("Program %s was not compacted; it is tried again: %s", self.room.program, error)
            asyncio.get_running_loop().call_later(FOLD_AGAIN_AFTER_S, self._fold_again, before)

    def _fold_again(self, compacted: int) -> None:
        self._compacted = min(compacted, self._compacted)
        if not self._ended:
            self.wake()

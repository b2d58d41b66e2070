"""A room at work: its changes go to the database and to the other processes, and theirs come in."""

from __future__ import annotations

import asyncio
import logging
import math
import time
from collections.abc import Awaitable, Callable, Coroutine
from contextlib import suppress
from typing import Any, ParamSpec, TypeVar

from channels.db import database_sync_to_async
from django.db import DatabaseError
from django.utils import timezone

from editor.documents.shared_document import BadUpdate, SharedDocument
from editor.documents.store import (
    COMPACT_AFTER_ROWS,
    Change,
    SnapshotDiffers,
    append_changes,
    compact_document,
    load_document,
)
from editor.documents.yjs_encoding import BadFrame
from editor.errors import NoSuchProgram
from editor.language.compiler import EditedProgram
from editor.programs.checking import Around, Checked, check_document, read_around, store_check
from editor.rooms.compiled_form import encode_check
from editor.rooms.member import Close
from editor.rooms.room import INTERRUPTED, Room, encode_saved_note
from editor.rooms.stream import BEGINNING, Entry, RoomStream, StreamLost

log = logging.getLogger(__name__)
SAVE_EVERY_S = 0.25
PUBLISH_EVERY_S = 0.01
AWARENESS_EVERY_S = 0.033
STORE_EVERY_S = 0.1
AROUND_KEPT_S = 1.0
REST_OF_CHECKS = 4.0
"""So many times as long as a check took the next one waits."""
REST_S = 0.03
LEFT_TO_OTHERS_S = 2.0
"""What another process should have checked by then is checked here."""
COMPARE_EVERY_S = 30.0
BEAT_EVERY_S = 10.0
SILENT_AFTER_S = 75.0
RETRY_AFTER_S = 1.0
P = ParamSpec("P")
R = TypeVar("R")


def in_database(function: Callable[P, R]) -> Callable[P, Awaitable[R]]:
    """Run a function that uses the database on a thread, off the event loop."""
    awaitable: Callable[P, Awaitable[R]] = database_sync_to_async(function, thread_sensitive=False)
    return awaitable


class OpenRoom:
    """The tasks around one room. `on_end` is called once when it must be opened anew."""

    def __init__(self, room: Room, stream: RoomStream, after: str, on_end: Callable[[OpenRoom], None]) -> None:
        self.room = room
        self._stream = stream
        self._after = after
        self._on_end = on_end
        self._edited = EditedProgram()
        self._ended = False
        self._saving = asyncio.Lock()
        self._publishing = asyncio.Lock()
        self._heard_at: dict[str, float] = {}
        self._surroundings_at = math.inf
        self._checked: Checked | None = None
        self._around: Around | None = None
        self._around_at = -math.inf
        self._news = 0
        """How often it was heard that what is around the program has changed."""
        self._events = {name: asyncio.Event() for name in ("save", "publish", "awareness", "check", "store")}
        self._tasks: list[asyncio.Task[None]] = []
        room.wake = self.wake

    def wake(self) -> None:
        """Have the tasks look at the queues."""
        for event in self._events.values():
            event.set()

    def start(self) -> None:
        """Start the tasks."""
        loops: tuple[Coroutine[Any, Any, None], ...] = (
            self._when("publish", PUBLISH_EVERY_S, self._publish),
            self._when("save", SAVE_EVERY_S, self.save),
            self._when("awareness", AWARENESS_EVERY_S, self._spread_awareness),
            self._check_often(),
            self._when("store", STORE_EVERY_S, self._store),
            self._look_after_others(),
            self._every(COMPARE_EVERY_S, self.room.say_state),
            self._every(BEAT_EVERY_S, self._beat),
            self._read(),
        )
        self._tasks = [asyncio.create_task(loop) for loop in loops]
        self.room.say_state()

    async def stop(self) -> None:
        """Save and publish what is left, and end the tasks."""
        self._ended = True
        await self.save()
        await self._store()
        self.room.spread_awareness()
        with suppress(StreamLost):
            await self._publish()
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    async def _when(self, name: str, pause_s: float, act: Callable[[], Awaitable[None]]) -> None:
        """Act a little after each wake-up, so that what comes in a burst goes in one batch."""
        while True:
            await self._events[name].wait()
            await asyncio.sleep(pause_s)
            self._events[name].clear()
            try:
                await act()
            except StreamLost as error:
                self._end(error)

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
            queue = self.room.to_publish
            notes = [queue.popleft() for _ in range(len(queue))]
            if notes:
                await self._stream.append(self.room.program, self.room.origin, notes)

    async def _spread_awareness(self) -> None:
        self.room.spread_awareness()

    async def _read(self) -> None:
        while not self._ended:
            try:
                batch = await self._stream.read(self.room.program, self._after, 1.0)
                if batch.gap:
                    await self._reload()
                for entry in batch.entries:
                    self._after = entry.id
                    self._hear(entry)
            except (StreamLost, BadUpdate, BadFrame, DatabaseError, NoSuchProgram) as error:
                self._end(error)

    def _hear(self, entry: Entry) -> None:
        if entry.origin != self.room.origin:
            self._heard_at[entry.origin] = time.monotonic()
        self.room.hear(entry)

    def _beat(self) -> None:
        self.room.beat()
        for origin, heard_at in list(self._heard_at.items()):
            if time.monotonic() - heard_at > SILENT_AFTER_S:
                del self._heard_at[origin]
                self.room.board.forget_process(origin)
                self._events["awareness"].set()

    async def _reload(self) -> None:
        stored = await in_database(load_document)(self.room.program)
        self.room.take_over(list(stored.updates))

    async def save(self) -> None:
        """Write what waits into the database, then tell everybody that it is saved."""
        async with self._saving:
            queue = self.room.to_save
            changes = list(queue)
            if not changes:
                return
            state = self.room.document.state()
            try:
                seq, rows = await in_database(append_changes)(self.room.program, changes, timezone.now())
            except NoSuchProgram as error:
                queue.clear()
                self.room.close_all(Close(Close.NOT_FOUND, error.detail))
                return
            except DatabaseError as error:
                log.warning("Program %s could not be saved; it is tried again: %s", self.room.program, error)
                asyncio.get_running_loop().call_later(RETRY_AFTER_S, self._events["save"].set)
                return
            for _ in changes:
                queue.popleft()
            self.room.announce_saved(seq, state)
            self.room.to_publish.append(encode_saved_note(seq, state))
            self._events["publish"].set()
            if rows >= COMPACT_AFTER_ROWS:
                await self._compact()

    async def _compact(self) -> None:
        try:
            await in_database(compact_document)(self.room.program)
        except (DatabaseError, SnapshotDiffers) as error:
            log.warning("Program %s was not compacted: %s", self.room.program, error)

    async def _check_often(self) -> None:
        """Check at once after an edit; edits that follow each other are checked together, a while apart."""
        while True:
            await self._events["check"].wait()
            self._events["check"].clear()
            if self.room.touched:
                began = time.monotonic()
                await self.check()
                await asyncio.sleep(max(REST_S, REST_OF_CHECKS * (time.monotonic() - began)))

    async def check(self) -> None:
        """Check the document on a thread, and tell all processes what was found."""
        room = self.room
        try:
            around = await self._read_around()
            room.touched = False
            document, after = room.document.to_json(), self._after
            checked = await asyncio.to_thread(check_document, document, around, self._edited)
            said = await asyncio.to_thread(room.form.change_to, checked.form)
        except (DatabaseError, NoSuchProgram) as error:
            log.warning("Program %s was not checked: %s", room.program, error)
            room.touched = isinstance(error, DatabaseError)  # then it is tried again a little later
            return
        except Exception:  # the edge of the room: a fault in the checks must not end those of later edits
            log.exception("Program %s was not checked; the next edit is looked at from the beginning.", room.program)
            self._edited = EditedProgram()
            return
        room.to_publish.append(encode_check(said, after=after, more=room.touched, against=checked.against))
        try:
            await self._publish()
        except StreamLost as error:
            self._end(error)
        self._checked = checked
        self._events["store"].set()

    async def _read_around(self) -> Around:
        """Return what is around the program: as it was read last, for a second and while nothing is heard of it."""
        around, began, news = self._around, time.monotonic(), self._news
        if around is None or began - self._around_at > AROUND_KEPT_S:
            around = await in_database(read_around)(self.room.program)
            self._around, self._around_at = around if news == self._news else None, began
        return around

    async def _store(self) -> None:
        """Store what lists show, if this process made the last check; others may hold the program's row meanwhile."""
        (checked, self._checked), now = (self._checked, None), self.room.form.now
        if checked is not None and (now is None or now["revision"] <= checked.revision):
            try:
                await in_database(store_check)(self.room.program, checked)
            except DatabaseError as error:
                log.warning("What lists show of program %s was not stored: %s", self.room.program, error)
                self._checked = self._checked or checked
                asyncio.get_running_loop().call_later(RETRY_AFTER_S, self._events["store"].set)

    def take_in_surroundings(self) -> None:
        """Have the program checked against what is around it now: by one of the processes, the others look after it."""
        self._around, self._news = None, self._news + 1
        if self.room.origin == min([self.room.origin, *self._heard_at]):
            self.room.touched = True
            self.wake()
        else:
            self._surroundings_at = time.monotonic()

    async def _look_after_others(self) -> None:
        """Check what the process that should have done so has not: it may have ended before."""
        waited_since = math.inf
        while True:
            await asyncio.sleep(LEFT_TO_OTHERS_S / 4)
            now = time.monotonic()
            waited_since = min(now, waited_since) if self.room.form.not_shown() else math.inf
            if now - waited_since >= LEFT_TO_OTHERS_S:
                self.room.touched, waited_since = True, math.inf
            if now - self._surroundings_at >= LEFT_TO_OTHERS_S:
                self._surroundings_at = math.inf
                await self._compare_surroundings()
            if self.room.touched:
                self._events["check"].set()

    async def _compare_surroundings(self) -> None:
        try:
            around = await self._read_around()
        except (DatabaseError, NoSuchProgram) as error:
            log.warning("What is around program %s could not be read: %s", self.room.program, error)
            return
        if around.fingerprint != self.room.form.against:
            self.room.touched = True


async def open_room(program_id: str, origin: str, stream: RoomStream, on_end: Callable[[OpenRoom], None]) -> OpenRoom:
    """Load a program's document: the snapshot, the rows after it, what the stream has beyond them; in today's format.

    Raises NoSuchProgram, StreamLost, BadUpdate.
    """
    stored = await in_database(load_document)(program_id)
    tail, after = await _read_tail(stream, program_id)
    document = SharedDocument([*stored.updates, *tail])
    migrated = document.migrate()
    room = Room(program_id, stored.site, origin, document)
    room.saved_seq = stored.seq
    opened = OpenRoom(room, stream, after, on_end)
    if tail or migrated:
        _save_what_is_missing(room, stored.updates)
    opened.start()
    return opened


async def _read_tail(stream: RoomStream, program_id: str) -> tuple[list[bytes], str]:
    after, updates = BEGINNING, []
    while entries := (await stream.read(program_id, after, 0.001)).entries:
        updates += [entry.note.data for entry in entries if entry.note.kind in {"update", "full"}]
        after = entries[-1].id
    return updates, after


def _save_what_is_missing(room: Room, stored: tuple[bytes, ...]) -> None:
    """Save what is only in the stream, because its process died before it saved, and the migration of the format."""
    kept = SharedDocument(stored)
    if kept.state() != room.document.state() or kept.digest() != room.document.digest():
        room.to_save.append(Change(None, room.document.encode(kept.state())))

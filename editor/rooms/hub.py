"""The rooms of this process: who enters and what they may do there, which are open, and what concerns all of them."""

from __future__ import annotations

import asyncio
import logging
import math
import time
import uuid
import weakref
from collections.abc import Callable, Coroutine
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from asgiref.sync import async_to_sync
from django.conf import settings
from django.contrib.auth import get_user_model
from django.db import DatabaseError, Error

from editor.compiling.compilers import Compilers
from editor.documents.shared_document import BadUpdate
from editor.documents.store import flush_before_reading, last_rows
from editor.documents.work import DocumentTask, have_done_by
from editor.errors import DocumentHole, NoSuchProgram
from editor.models import Program
from editor.programs.checking import changes_programs
from editor.rooms.hold_off import HoldOffs, make_hold_offs
from editor.rooms.inbox import Inbox
from editor.rooms.member import Allowance, Close, Member, Person
from editor.rooms.refusals import INTERRUPTED
from editor.rooms.room import Room
from editor.rooms.room_loader import open_room
from editor.rooms.runner import OpenRoom, Shared
from editor.rooms.stream import Note, RoomStream, StreamLost, make_stream
from editor.rooms.threads import in_database
from registry import services as registry
from registry.services import Claim, Slots, Standing, find_access

log = logging.getLogger(__name__)
CLOSE_EMPTY_AFTER_S = 5.0
LOOK_FOR_ROWS_S = 3.0
FLUSH_LIMIT_S = 5.0
END_LIMIT_S = 5.0
TELL_LIMIT_S = 5.0
WORK_LIMIT_S = 30.0
FINISH_LIMIT_S = 30.0
MOST_CONNECTIONS, MOST_OF_PERSON = 5_000, 40
_HEARD = {"device", "device_removed", "map", "programs", "library", "hello"}


class Hub:
    """The rooms of one process, which all live in one event loop."""

    def __init__(self, stream: RoomStream, hold_offs: HoldOffs) -> None:
        self.loop = asyncio.get_running_loop()
        self.stream = stream
        self._shared = Shared(stream, Compilers())
        self._open: dict[str, OpenRoom] = {}
        self._ending: dict[str, asyncio.Task[None]] = {}
        self._locks: weakref.WeakValueDictionary[str, asyncio.Lock] = weakref.WeakValueDictionary()
        """One for each program whose room is being opened or closed, as long as anybody holds or awaits it."""
        self._background: set[asyncio.Task[None]] = set()
        self._looking: asyncio.Task[None] | None = None
        self._stop_listening: Callable[[], None] | None = None
        self._is_closed = False
        self._allowances: dict[int, Allowance] = {}
        registry.watch_amount(name="rooms", read=lambda: len(self._open))
        registry.watch_amount(name="program_sockets", read=lambda: self._slots.taken)
        self._turns = asyncio.Lock()
        self._hold_offs = hold_offs
        self._slots = Slots(in_all=MOST_CONNECTIONS, of_site=MOST_CONNECTIONS, of_person=MOST_OF_PERSON)

    async def enter(self, program_id: str, member: Member) -> Room:
        """Let a connection into a program's room, opening it if it is not open. Raises Close."""
        if self._is_closed:
            raise Close(Close.COME_AGAIN, INTERRUPTED)
        await self._hold_off(member)
        if not self._slots.take(Claim(member.person.id)):
            raise Close(Close.ABUSE, f"You have {MOST_OF_PERSON} programs open. Close other copies of the page.")
        member.allowance.connections += 1
        try:
            return await self._let_in(program_id, member)
        except BaseException:
            member.allowance.connections -= 1
            self._slots.give_back(Claim(member.person.id))
            raise

    async def _hold_off(self, member: Member) -> None:
        """Give a connection what its person has left; keep them out for a while after abuse. Raises Close."""
        now_s = time.monotonic()
        self._allowances = {person: each for person, each in self._allowances.items() if not each.is_like_new(now_s)}
        member.allowance = self._allowances.setdefault(member.person.id, member.allowance)
        elsewhere_s = await self._hold_offs.left_s(member.person.id)
        if wait_s := math.ceil(max(elsewhere_s, member.allowance.held_off_s(now_s))):
            raise Close(
                Close.ABUSE, f"A page of yours has sent too much. Close the others, and try again in {wait_s} s."
            )

    async def _let_in(self, program_id: str, member: Member) -> Room:
        async with self._lock_of(program_id):
            await self._listen()
            try:
                opened = self._open.get(program_id) or await self._open_room(program_id)
            except NoSuchProgram as error:
                raise Close(Close.NOT_FOUND, error.detail) from error
            except DocumentHole as error:
                log.exception("Program %s cannot be opened: %s", program_id, error.detail)
                raise Close(Close.COME_AGAIN, error.detail) from error
            except (StreamLost, DatabaseError, BadUpdate) as error:
                raise Close(Close.COME_AGAIN, INTERRUPTED) from error
            opened.room.join(member)
            return opened.room

    async def _open_room(self, program_id: str) -> OpenRoom:
        if program_id in self._ending:
            await asyncio.wait([self._ending[program_id]], timeout=END_LIMIT_S)  # its last rows are read by the next
        opened = await open_room(program_id, uuid.uuid4().hex, self._shared, self._drop)
        self._open[program_id] = opened
        self._looking = self._looking or self._start(self._look_for_rows)
        return opened

    async def _look_for_rows(self) -> None:
        """Now and then see whether there are rows of which nobody has told: one question for all rooms."""
        while not self._is_closed:
            await asyncio.sleep(LOOK_FOR_ROWS_S)
            try:
                rows = await in_database(last_rows)(list(self._open)) if self._open else {}
            except Error as error:
                log.warning("The rows of the open programs could not be looked for: %s", error)
            else:
                for program in rows.keys() & self._open.keys():
                    self._open[program].see_row(rows[program])

    def inbox(self, room: Room, member: Member) -> Inbox:
        """Return what a connection's messages are given to."""

        def note_close(close: Close) -> None:
            if points := member.allowance.note_close(close.code, time.monotonic()):
                self._start(self._hold_offs.note, member.person.id, points)

        return Inbox(room, member, self._shared.compilers.cut, self._turns, note_close)

    def leave_later(self, leave: Callable[[], None], inbox: Inbox) -> None:
        """Let a connection go that has been cut off, once what it sent before has been acted on."""

        async def finish() -> None:
            await inbox.finish(FINISH_LIMIT_S)
            leave()

        self._start(finish)

    def leave(self, room: Room, member: Member) -> None:
        """Let a connection go; a room that stays empty is closed."""
        room.leave(member)
        member.allowance.connections -= 1
        self._slots.give_back(Claim(member.person.id))
        if not room.members:
            self.loop.call_later(CLOSE_EMPTY_AFTER_S, self._start, self._close_if_empty, room)

    async def _close_if_empty(self, room: Room) -> None:
        async with self._lock_of(room.program):
            opened = self._open.get(room.program)
            if opened is not None and opened.room is room and not room.members:
                await opened.stop()
                self._open.pop(room.program, None)

    def _lock_of(self, program_id: str) -> asyncio.Lock:
        return self._locks.setdefault(program_id, asyncio.Lock())

    def _drop(self, opened: OpenRoom) -> None:
        """A room ended by itself: what it holds is saved, and the next connection opens it anew."""
        if self._open.get(opened.room.program) is opened:
            del self._open[opened.room.program]
        program = opened.room.program
        ending = self._ending[program] = self._start(opened.stop)
        ending.add_done_callback(lambda _: self._ending.pop(program, None))

    async def flush(self, program_id: str) -> None:
        """Write what waits of a program into the database, and ask the other processes to do so."""
        opened = self._open.get(program_id)
        if opened is not None:
            opened.room.to_publish.append(Note("keep", b""))
            opened.room.wake()
            await opened.save()

    async def do(self, task: DocumentTask[Any]) -> Any:
        """Have work on a document done in a child process; None where that fails."""
        return await self._shared.compilers.do(task)

    async def close(self) -> None:
        """Keep everything and end."""
        if self._stop_listening:
            self._stop_listening()
        self._is_closed = True
        if self._looking is not None:
            self._looking.cancel()
        opened, self._open = list(self._open.values()), {}
        for each in opened:
            each.room.close_all(Close(Close.COME_AGAIN, INTERRUPTED))
        await asyncio.gather(*(each.stop() for each in opened), *self._ending.values(), return_exceptions=True)
        await self._shared.compilers.close()
        await self.stream.close()
        await self._hold_offs.close()

    def _start(self, act: Callable[..., Coroutine[Any, Any, None]], *args: Any) -> asyncio.Task[None]:
        task: asyncio.Task[None] = self.loop.create_task(act(*args))
        self._background.add(task)
        task.add_done_callback(self._background.discard)
        return task

    async def _listen(self) -> None:
        if self._stop_listening is None:
            self._stop_listening = lambda: None
            self._stop_listening = await asyncio.to_thread(registry.listen, self._hear)

    def _hear(self, site: str, message: registry.Message) -> None:
        """Called on a foreign thread for every live message."""
        if message.get("type") in _HEARD and not self.loop.is_closed():
            self.loop.call_soon_threadsafe(self._on_live, site, message)

    def _on_live(self, site: str, message: registry.Message) -> None:
        rooms = [opened for opened in self._open.values() if site in (opened.room.site, registry.EVERY_SITE)]
        if message["type"] in {"programs", "hello"}:
            for opened in rooms:
                self._start(self._review, opened.room)
        if changes_programs(message):
            for opened in rooms:
                opened.checks.take_in_surroundings()

    async def _review(self, room: Room) -> None:
        """Close the room when its program has been deleted."""
        if not await in_database(Program.objects.filter(pk=room.program).exists)():
            room.close_all(GONE)


GONE = Close(Close.NOT_FOUND, "The program was deleted, or you are no longer one of its site.")


def review(room: Room, member: Member, standing: Standing | None) -> None:
    """Let a connection do what its session is good for now; it acts at once."""
    if standing is None:
        member.close(Close(Close.SIGNED_OUT, "You are signed out. Sign in again."))
    elif not standing.allows(room.site, "viewer"):
        member.close(GONE)
    else:
        could_write, member.can_write = member.can_write, standing.allows(room.site, "author")
        if member.can_write and not could_write:
            member.ask_for_state(room.document.state())


_hubs: weakref.WeakKeyDictionary[asyncio.AbstractEventLoop, Hub] = weakref.WeakKeyDictionary()


def hub_of_this_loop() -> Hub:
    """Return the hub of the running event loop, made at first use."""
    loop = asyncio.get_running_loop()
    if loop not in _hubs:
        flush_before_reading(flush_program)
        have_done_by(do_in_child_process)
        _hubs[loop] = Hub(make_stream(settings.VIPO_STREAM_URL), make_hold_offs(settings.VIPO_STREAM_URL))
    return _hubs[loop]


async def close_hub() -> None:
    """Keep everything of the running event loop's rooms, and end them; nobody is let in any more."""
    hub = _hubs.get(asyncio.get_running_loop())
    if hub is not None:
        await hub.close()


def flush_program(program_id: str) -> None:
    """Write into the database what this process's room of a program still holds; not to be called on an event loop."""
    for loop, hub in hubs_elsewhere():
        asyncio.run_coroutine_threadsafe(hub.flush(program_id), loop).result(FLUSH_LIMIT_S)


def do_in_child_process(task: DocumentTask[Any]) -> Any:
    """Have work on a document done in a child process; None where that fails. Not to be called on an event loop."""
    for loop, hub in hubs_elsewhere():
        with suppress(TimeoutError, RuntimeError):  # the loop may just end
            return asyncio.run_coroutine_threadsafe(hub.do(task), loop).result(WORK_LIMIT_S)
    return None


def tell_rooms(program_id: str, origin: str, note: Note) -> None:
    """Tell the rooms of a program in all processes; not to be called on an event loop. Raises StreamLost."""
    try:
        told = [
            asyncio.run_coroutine_threadsafe(hub.stream.append(program_id, origin, [note]), loop)
            for loop, hub in hubs_elsewhere()
        ]
        for each in told:
            each.result(TELL_LIMIT_S)
    except TimeoutError as error:
        raise StreamLost("The rooms of this process do not answer.") from error
    if not told and not settings.VIPO_STREAM_URL.startswith("memory:"):
        async_to_sync(_tell_alone)(program_id, origin, note)


async def _tell_alone(program_id: str, origin: str, note: Note) -> None:
    stream: RoomStream = make_stream(settings.VIPO_STREAM_URL)
    try:
        await stream.append(program_id, origin, [note])
    finally:
        await stream.close()


def hubs_elsewhere() -> list[tuple[asyncio.AbstractEventLoop, Hub]]:
    """Return the hubs of this process's other event loops, which are running."""
    return [(loop, hub) for loop, hub in list(_hubs.items()) if loop.is_running() and not _is_on(loop)]


def _is_on(loop: asyncio.AbstractEventLoop) -> bool:
    try:
        return asyncio.get_running_loop() is loop
    except RuntimeError:
        return False


@dataclass(frozen=True, slots=True)
class Permission:
    """What a person may do with a program: everybody of its site may look, authors may change."""

    site: str
    person: Person
    can_write: bool


def find_permission(user_id: int, program_id: str) -> Permission | None:
    """Return what a person may do; None when the program does not exist or is none of theirs: the two look the same."""
    program = Program.objects.select_related("site").filter(pk=program_id).first()
    user = get_user_model().objects.filter(pk=user_id, is_active=True).first()
    access = find_access(user, program.site) if program and user else None
    if program is None or user is None or access is None:
        return None
    return Permission(program.site.slug, Person(user.pk, user.display_name, user.initials), access.allows("author"))

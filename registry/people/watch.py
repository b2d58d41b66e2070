"""The watch over open sockets and streams: it learns within seconds when a session ends or a role changes.

Whatever process changed it: the database is asked, once a second for all that is open in this process, with two
statements. Live news of members only has it look at once. docs/adr/0015 says why.
"""

from __future__ import annotations

import asyncio
import logging
import time
import weakref
from collections.abc import AsyncIterator, Callable, Collection
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager, suppress

from django.db import Error, connection

from registry.live.fanout import Message, listen
from registry.people.seen import Seen, note_seen
from registry.people.sessions import Session, Standing, read_standings

log = logging.getLogger(__name__)
EVERY_S = 1.0
PAUSE_S = 0.05
"""Hints that come within such a while are one look."""
STALE_AFTER_S = 3.0
"""Nothing is taken from a session of which was heard longer ago: the database may have ended it since."""


class Seat:
    """A socket or a stream that is open; `standing` is what its session is good for, None once it has ended.

    `site` is the one that somebody looks at by it, empty for streams of programs.
    """

    def __init__(self, session: Session, on_change: Callable[[], None], site: str = "") -> None:
        self.session = session
        self.site = site
        self.standing: Standing | None = None
        self.on_change = on_change
        self._asked_at = float("-inf")

    @property
    def is_fresh(self) -> bool:
        """Whether `standing` is so young that something may be kept because of it."""
        return time.monotonic() - self._asked_at <= STALE_AFTER_S

    def take(self, standing: Standing | None, asked_at: float) -> None:
        """Take in what was found; tell whoever sits here if it differs."""
        first, self._asked_at = self._asked_at < 0, max(asked_at, self._asked_at)
        if standing != self.standing:
            self.standing = standing
            if not first:
                self.on_change()


class Watch:
    """The seats of one event loop, and the task that looks after them as long as there are any."""

    def __init__(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._seats: set[Seat] = set()
        self._rung = asyncio.Event()
        self._task: asyncio.Task[None] | None = None
        self._thread = ThreadPoolExecutor(1, "vipo-sessions")
        self._seen = Seen()
        self._is_away = False

    async def join(self, session: Session, on_change: Callable[[], None], site: str = "") -> Seat:
        """Watch a session: `on_change` is called on this loop whenever its standing has changed.

        That its person looks at `site` is noted. Raises django.db.Error while the database does not answer.
        """
        seat = Seat(session, on_change, site)
        self._seats.add(seat)
        try:
            await self._look([seat])
        except BaseException:
            self.leave(seat)
            raise
        if self._task is None or self._task.done():
            self._task = self._loop.create_task(self._watch())
        return seat

    def leave(self, seat: Seat) -> None:
        """Watch it no more."""
        self._seats.discard(seat)
        if not self._seats:
            self._rung.set()

    async def _watch(self) -> None:
        hearing = self._loop.create_task(asyncio.to_thread(listen, self._hear))
        try:
            while self._seats:
                with suppress(TimeoutError):
                    await asyncio.wait_for(self._rung.wait(), EVERY_S)
                await asyncio.sleep(PAUSE_S)
                self._rung.clear()
                await self._look_again()
        finally:
            stop = await hearing
            stop()
            await self._loop.run_in_executor(self._thread, _close_connection)

    def _hear(self, _site: str, message: Message) -> None:
        """Called on a foreign thread for every live message."""
        if message.get("type") in {"members", "hello"}:
            with suppress(RuntimeError):  # the loop has just ended: nobody sits there any more
                self._loop.call_soon_threadsafe(self._rung.set)

    async def _look_again(self) -> None:
        try:
            await self._look(list(self._seats))
            self._is_away = False
        except Error as error:
            if not self._is_away:
                log.warning("Sessions could not be looked after; it is tried again: %s", error)
            self._is_away = True
            await self._loop.run_in_executor(self._thread, _close_connection)
        except Exception:  # the edge of the task: the next look must come whatever befell this one
            log.exception("Sessions could not be looked after; it is tried again.")

    async def _look(self, seats: Collection[Seat]) -> None:
        asked_at = time.monotonic()
        sessions = {seat.session for seat in seats}
        if sessions:
            found = await self._loop.run_in_executor(self._thread, read_standings, sessions)
            for seat in seats:
                seat.take(found.get(seat.session), asked_at)
        seen = {(seat.session.person, seat.site) for seat in seats if seat.standing and seat.site}
        if due := self._seen.take_due(seen):
            await self._loop.run_in_executor(self._thread, note_seen, due)


def _close_connection() -> None:
    """Close the connection of the thread that calls this; `connection.close` would be looked up by another one."""
    with suppress(Error):
        connection.close()


_watches: weakref.WeakKeyDictionary[asyncio.AbstractEventLoop, Watch] = weakref.WeakKeyDictionary()


def watch_of_this_loop() -> Watch:
    """Return the watch of the running event loop, made at first use."""
    loop = asyncio.get_running_loop()
    if loop not in _watches:
        _watches[loop] = Watch()
    return _watches[loop]


@asynccontextmanager
async def seated(session: Session, on_change: Callable[[], None]) -> AsyncIterator[Seat]:
    """Watch a session within the block."""
    watch = watch_of_this_loop()
    seat = await watch.join(session, on_change)
    try:
        yield seat
    finally:
        watch.leave(seat)

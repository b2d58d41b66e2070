"""What a connection sends, acted on in its order and so that nobody else waits long.

A small message is acted on as it comes. What is more is done in short stretches, one person's at a time, with as long a
rest after each; large updates are checked and cut in a child process. Who has had much done for them waits, with all
their connections. What waits is bounded, and a message is counted before it waits.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections import deque
from collections.abc import Awaitable, Callable

from editor.compiling.compilers import CutFailed
from editor.documents.slices import Cutting, CutUpdate
from editor.documents.yjs_encoding import BadFrame
from editor.rooms.member import Close, Member
from editor.rooms.receiver import Acting
from editor.rooms.refusals import INTERRUPTED, TOO_COSTLY
from editor.rooms.room import Room

log = logging.getLogger(__name__)
STRETCH_S = 0.004
MOST_STEP_S = 0.2
"""A piece of an update that is applied for longer is no honest one's, also where processors are shared: usual ones take
about a hundredth of a second. The rest is not taken."""
Cut = Callable[[Cutting], Awaitable[CutUpdate]]


class Inbox:
    """The messages of one connection. `turns` is one lock for all of a process."""

    def __init__(
        self, room: Room, member: Member, cut: Cut, turns: asyncio.Lock, note_close: Callable[[Close], None]
    ) -> None:
        """`cut` cuts an update in another process; it raises BadFrame, CutFailed. `note_close` is told of each end."""
        self._room = room
        self._member = member
        self._cut = cut
        self._turns = turns
        self._note_close = note_close
        self._waiting: deque[bytes] = deque()
        self._working: asyncio.Task[None] | None = None

    def take(self, frame: bytes) -> None:
        """Count a message and act on it, now or in its turn."""
        now_s = time.monotonic()
        try:
            self._room.receiver.count(self._member, frame, now_s)
            self._member.not_acted_on += 1
            if self._working is not None or self._member.allowance.rest_s(now_s):
                self._member.allowance.let_wait(len(frame))
                self._waiting.append(frame)
                self._work(None, None)
                return
            acting = self._room.receiver.act(self._member, frame, now_s)
            wanted, is_done = self._step(acting, None)
            if is_done:
                self._member.not_acted_on -= 1
            else:
                self._work(acting, wanted)
        except Close as close:
            self._end(close)

    @property
    def is_busy(self) -> bool:
        """Whether something is not acted on yet."""
        return self._working is not None

    def _end(self, close: Close) -> None:
        self._note_close(close)
        self._member.close(close)

    def _step(self, acting: Acting, cut: CutUpdate | None) -> tuple[Cutting | None, bool]:
        """Go one step on; return what is to be cut, and whether that was the last step. Raises Close."""
        began_s = time.thread_time()
        try:
            return acting.send(cut), False
        except StopIteration:
            return None, True
        finally:
            self._member.allowance.spend_work(time.thread_time() - began_s, time.monotonic())

    def _work(self, acting: Acting | None, wanted: Cutting | None) -> None:
        if self._working is None:
            self._working = asyncio.create_task(self._work_off(acting, wanted))

    async def _work_off(self, acting: Acting | None, wanted: Cutting | None) -> None:
        try:
            if acting is not None:
                await self._go_on(acting, wanted)
                self._member.not_acted_on -= 1
            while self._waiting and self._member.closing is None:
                await asyncio.sleep(self._member.allowance.rest_s(time.monotonic()))
                frame = self._waiting.popleft()
                self._member.allowance.let_wait(-len(frame))
                await self._go_on(self._room.receiver.act(self._member, frame, time.monotonic()), None)
                self._member.not_acted_on -= 1
        except Close as close:
            self._end(close)
        except Exception:  # the edge of the task: nobody else would hear of it
            log.exception("A message to the room of program %s was not acted on.", self._room.program)
            self._end(Close(Close.COME_AGAIN, INTERRUPTED))
        finally:
            self._forget()
            self._working = None

    def _forget(self) -> None:
        while self._waiting:
            self._member.allowance.let_wait(-len(self._waiting.popleft()))

    async def _go_on(self, acting: Acting, wanted: Cutting | None) -> None:
        """Act on a message to the end, or until the connection is closed. Raises Close."""
        is_done = False
        while not is_done and self._member.closing is None:
            cut = None
            if wanted is not None:
                try:
                    async with self._member.allowance.cutting:
                        cut = await self._cut(wanted)
                except (BadFrame, CutFailed) as error:
                    acting.throw(error if isinstance(error, BadFrame) else Close(Close.TOO_LARGE, TOO_COSTLY))
            async with self._turns:
                began_s = time.thread_time()
                wanted, is_done = self._stretch(acting, cut)
                await asyncio.sleep(time.thread_time() - began_s)
            if not is_done:
                await asyncio.sleep(self._member.allowance.rest_s(time.monotonic()))

    def _stretch(self, acting: Acting, cut: CutUpdate | None) -> tuple[Cutting | None, bool]:
        began_s, at_s = time.thread_time(), 0.0
        while True:
            before_s = at_s
            wanted, is_done = self._step(acting, cut)
            cut, at_s = None, time.thread_time() - began_s
            if not is_done and at_s - before_s > MOST_STEP_S:
                raise Close(Close.ABUSE, TOO_COSTLY)
            if is_done or wanted is not None or at_s > STRETCH_S:
                return wanted, is_done

    async def finish(self, within_s: float) -> None:
        """Wait until all is acted on, so long at most."""
        if self._working is not None:
            await asyncio.wait([self._working], timeout=within_s)

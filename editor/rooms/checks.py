"""A room's checks: after an edit, and after what is around the program has changed, in a child process."""

from __future__ import annotations

import asyncio
import logging
import math
import time
from collections.abc import Awaitable, Callable, Coroutine, Mapping
from dataclasses import dataclass
from typing import Any

from django.db import DatabaseError

from editor.compiling.compilers import CheckFailed, Compilers
from editor.compiling.failures import failed_form
from editor.compiling.job_delta import Wanted
from editor.errors import NoSuchProgram
from editor.programs.checking import Around, new_revision, read_around, store_failure, store_summary
from editor.programs.programs import tell_checked
from editor.programs.summary import Summary
from editor.rooms.compiled_form import encode_check
from editor.rooms.room import Room
from editor.rooms.threads import in_database

log = logging.getLogger(__name__)
STORE_EVERY_S = 0.1
AROUND_KEPT_S = 1.0
REST_OF_CHECKS = 3.0
"""So many times as long as its process computed for a check the next one waits."""
REST_S = 0.03
FAILED_REST_S = 2.0
LEFT_TO_OTHERS_S = 2.0
"""What another process should have checked by then is checked here."""
RETRY_AFTER_S = 1.0


@dataclass(frozen=True, slots=True)
class _Checked:
    """A check of this process that is to be stored; nothing is `summary` of one that failed."""

    revision: int
    summary: Summary | None
    against: str


class Checks:
    """The checks of one room in this process."""

    def __init__(
        self,
        room: Room,
        compilers: Compilers,
        *,
        heard_to: Callable[[], str],
        others: Callable[[], Mapping[str, float]],
        publish: Callable[[], Awaitable[None]],
    ) -> None:
        """`heard_to` tells the last entry that was heard, `others` who else has the room open."""
        self.room = room
        self._heard_to = heard_to
        self._others = others
        self._publish = publish
        self._compilers = compilers
        self._surroundings_at = math.inf
        self._checked: _Checked | None = None
        self._around: Around | None = None
        self._last_around: Around | None = None
        self._around_at = -math.inf
        self._news = 0
        """How often it was heard that what is around the program has changed."""
        self._due, self._found = asyncio.Event(), asyncio.Event()

    def wake(self) -> None:
        """Look whether the document is to be checked."""
        self._due.set()

    def loops(self) -> tuple[Coroutine[Any, Any, None], ...]:
        """Return what is to run while the room is open."""
        return self._check_often(), self._store_often(), self._look_after_others()

    async def _store_often(self) -> None:
        while True:
            await self._found.wait()
            await asyncio.sleep(STORE_EVERY_S)
            self._found.clear()
            await self.store()

    async def _check_often(self) -> None:
        """Check at once after an edit; edits that follow each other are checked together, a while apart."""
        while True:
            await self._due.wait()
            self._due.clear()
            if self.room.touched:
                took_s = await self.check()
                await asyncio.sleep(max(REST_S, REST_OF_CHECKS * took_s))

    async def check(self) -> float:
        """Have the document checked, and tell all processes what was found; return for how long that was computed."""
        room, news = self.room, self._news
        try:
            around = await self._read_around()
            said, summary, after, took_s = await self._look(around)
        except (DatabaseError, NoSuchProgram) as error:
            log.warning("Program %s was not checked: %s", room.program, error)
            room.touched = isinstance(error, DatabaseError)  # then it is tried again a little later
            return 0.0
        if self._news != news:  # what was heard behind the look around is not in this check
            room.touched = True
            self.wake()
        room.to_publish.append(encode_check(said, after=after, more=room.touched, against=around.fingerprint))
        await self._publish()
        self._checked = _Checked(said["revision"], summary, around.fingerprint)
        self._found.set()
        return took_s

    async def _look(self, around: Around) -> tuple[Mapping[str, Any], Summary | None, str, float]:
        """Return what is to be said of the form, what lists show, up to which entry had been heard, and the time."""
        room, after = self.room, self._heard_to()

        def begin() -> None:
            nonlocal after
            room.touched, after = False, self._heard_to()

        wanted = Wanted(
            program=room.program,
            document=lambda: room.document,
            surroundings=around.surroundings,
            revision=lambda: room.form.revision,
            forms=room.form.way_from,
        )
        try:
            found = await self._compilers.check(wanted, begin)
        except CheckFailed as error:
            return failed_form(room.form.now, new_revision(), error.code), None, after, FAILED_REST_S
        return found.said, found.summary, after, found.took_s

    async def _read_around(self) -> Around:
        """Return what is around the program: as it was read last, for a second and while nothing is heard of it."""
        around, began, news = self._around, time.monotonic(), self._news
        if around is None or began - self._around_at > AROUND_KEPT_S:
            around = await in_database(_read_unless_same)(self.room.program, self._last_around)
            self._last_around = around
            self._around, self._around_at = around if news == self._news else None, began
        return around

    async def store(self) -> None:
        """Store what lists show, if this process made the last check; others may hold the program's row meanwhile."""
        (checked, self._checked), now = (self._checked, None), self.room.form.revision
        if checked is not None and (now is None or now <= checked.revision):
            try:
                await in_database(_store)(self.room.program, checked)
            except DatabaseError as error:
                log.warning("What lists show of program %s was not stored: %s", self.room.program, error)
                self._checked = self._checked or checked
                asyncio.get_running_loop().call_later(RETRY_AFTER_S, self._found.set)

    def take_in_surroundings(self) -> None:
        """Have the program checked against what is around it now: by one of the processes, the others look after it."""
        self._around, self._news = None, self._news + 1
        if self.room.origin == min([self.room.origin, *self._others()]):
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
                self._due.set()

    async def _compare_surroundings(self) -> None:
        try:
            around = await self._read_around()
        except (DatabaseError, NoSuchProgram) as error:
            log.warning("What is around program %s could not be read: %s", self.room.program, error)
            return
        if around.fingerprint != self.room.form.against:
            self.room.touched = True


def _read_unless_same(program_id: str, last: Around | None) -> Around:
    """Return what is around a program: the same object as the last one, if it is the same. Raises NoSuchProgram."""
    around = read_around(program_id)
    return last if last is not None and last == around else around


def _store(program_id: str, checked: _Checked) -> None:
    """Store what lists show, and tell the site if they show something else."""
    if checked.summary is None:
        is_news = store_failure(program_id, checked.against)
    else:
        is_news = store_summary(program_id, checked.summary, checked.against)
    if is_news:
        tell_checked(program_id=program_id, revision=checked.revision)

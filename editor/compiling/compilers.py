"""The child processes in which programs are checked: a few, each program always at the same one.

A check that goes on for too long is ended with its process, which costs nobody else anything: whoever waits behind it
goes to another process, and a program that was slow is checked in a process for slow ones until it is quick again.
"""

from __future__ import annotations

import asyncio
import logging
import os
from collections.abc import Callable
from dataclasses import dataclass

from editor.compiling.feeding import Wanted
from editor.compiling.lane import GaveWay, Lane, Lost, NotStarted, TookTooLong
from editor.compiling.workbench import Found, Opened, Opening

log = logging.getLogger(__name__)
MOST_LANES = 4
LIMIT_S = 20.0
"""So long a check may take; the first one of 5,000 steps takes about half a second."""
PATIENCE_S = 2.0
"""Who has waited so long for another program's check goes elsewhere, or has it moved to the slow ones."""
QUICK_S = 1.0
_TRIALS, _STARTS = 2, 4


class CheckFailed(Exception):
    """A program could not be checked: `code` is one of `failures.TEXTS`."""

    def __init__(self, code: str) -> None:
        super().__init__(code)
        self.code = code


@dataclass(frozen=True, slots=True)
class Limits:
    """How many processes there may be beside the one for slow programs, and how long a check may take in seconds."""

    lanes: int = max(2, min(MOST_LANES, os.cpu_count() or 1))
    check_s: float = LIMIT_S
    patience_s: float = PATIENCE_S


class Compilers:
    """The child processes of one event loop."""

    def __init__(self, limits: Limits | None = None) -> None:
        """Start nothing yet."""
        self._limits = limits or Limits()
        self._lanes = [Lane(f"{number}") for number in range(self._limits.lanes)]
        self._slow = Lane("slow")
        self._lane_of: dict[str, Lane] = {}

    def prepare(self, program: str) -> None:
        """Start the process of a program that will be checked soon."""
        self._lane(program).prepare()

    async def check(self, wanted: Wanted, begin: Callable[[], None]) -> Found:
        """Check a program; `begin` is called when its document is read, which may be twice. Raises CheckFailed.

        Who gives up does not end the check, and so the process that others use.
        """
        checking = asyncio.create_task(self._check(wanted, begin))
        checking.add_done_callback(lambda task: task.cancelled() or task.exception())
        return await asyncio.shield(checking)

    async def _check(self, wanted: Wanted, begin: Callable[[], None]) -> Found:
        starts = losses = 0
        while losses < _TRIALS and starts < _STARTS:
            try:
                return await self._check_once(wanted, begin)
            except TookTooLong as error:
                log.warning("The check of program %s was ended after %s s.", wanted.program, self._limits.check_s)
                self._lane_of[wanted.program] = self._slow
                raise CheckFailed("check_took_too_long") from error
            except NotStarted as error:
                starts += 1
                log.warning("The process that checks programs is started anew: %s", error)
            except Lost as error:
                losses += 1
                log.warning("The check of program %s broke off: %s", wanted.program, error)
        self._lane_of[wanted.program] = self._slow
        raise CheckFailed("check_broke_off")

    async def open(self, opening: Opening) -> Opened | None:
        """Put a document together in a process that has nothing else to do; None where there is none, or it fails."""
        lane = next((lane for lane in self._lanes if lane.pid is not None and not lane.is_busy), None)
        if lane is None or not await lane.enter(self._limits.patience_s):
            return None
        opened = asyncio.create_task(self._open(lane, opening))
        return await asyncio.shield(opened)

    async def _open(self, lane: Lane, opening: Opening) -> Opened | None:
        try:
            return await lane.open(opening, self._limits.check_s)
        except (NotStarted, Lost, TookTooLong, GaveWay) as error:
            log.warning("A document was not put together: %s", error)
            return None
        finally:
            lane.leave()

    async def _check_once(self, wanted: Wanted, begin: Callable[[], None]) -> Found:
        while True:
            lane = await self._enter(wanted.program)
            try:
                found = await lane.check(wanted, begin, self._limits.check_s)
            except GaveWay:
                self._lane_of[wanted.program] = self._slow
                continue
            finally:
                lane.leave()
            if lane is self._slow and found.took_s < QUICK_S:
                lane.forget(wanted.program)
                del self._lane_of[wanted.program]
            return found

    async def _enter(self, program: str) -> Lane:
        """Wait for a program's turn at its process, or at another one."""
        while True:
            lane = self._lane(program)
            if await lane.enter(None if lane is self._slow else self._limits.patience_s):
                return lane
            free = next((other for other in self._lanes if not other.is_busy), None)
            if free is None:
                lane.hurry(self._limits.patience_s)
            else:
                lane.forget(program)
                self._lane_of[program] = free

    def _lane(self, program: str) -> Lane:
        lane = self._lane_of.get(program)
        if lane is None:
            crowds = [sum(each is other for each in self._lane_of.values()) for other in self._lanes]
            lane = self._lane_of[program] = self._lanes[crowds.index(min(crowds))]
        return lane

    def forget(self, program: str) -> None:
        """Keep nothing of a program that nobody has open."""
        lane = self._lane_of.pop(program, None)
        if lane is not None:
            lane.forget(program)

    @property
    def pids(self) -> list[int]:
        """The processes that run now."""
        return [lane.pid for lane in (*self._lanes, self._slow) if lane.pid is not None]

    async def close(self) -> None:
        """End all processes."""
        await asyncio.gather(*(lane.close() for lane in (*self._lanes, self._slow)), return_exceptions=True)

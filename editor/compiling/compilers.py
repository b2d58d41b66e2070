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
from typing import Any, TypeVar

from editor.compiling.checker_process import CheckerProcess, GaveWay, Lost, NotStarted, TookTooLong
from editor.compiling.job_delta import Wanted
from editor.compiling.workbench import Found
from editor.documents.slices import Cutting, CutUpdate
from editor.documents.tasks import CuttingTask, Refusal
from editor.documents.work import DocumentTask
from editor.documents.yjs_encoding import BadFrame

log = logging.getLogger(__name__)
Said = TypeVar("Said")
MOST_PROCESSES = 4
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


class CutFailed(Exception):
    """An update could not be cut: the process ended over it, or it took too long."""


@dataclass(frozen=True, slots=True)
class Limits:
    """How many processes there may be beside the one for slow programs, and how long a check may take in seconds."""

    processes: int = max(2, min(MOST_PROCESSES, os.cpu_count() or 1))
    check_s: float = LIMIT_S
    patience_s: float = PATIENCE_S


class Compilers:
    """The child processes of one event loop."""

    def __init__(self, limits: Limits | None = None) -> None:
        """Start nothing yet."""
        self._limits = limits or Limits()
        self._processes = [CheckerProcess(f"{number}") for number in range(self._limits.processes)]
        self._slow = CheckerProcess("slow")
        self._cutting = CheckerProcess("cutting")
        self._process_of: dict[str, CheckerProcess] = {}

    @property
    def _all(self) -> tuple[CheckerProcess, ...]:
        return (*self._processes, self._slow, self._cutting)

    def prepare(self, program: str) -> None:
        """Start the process of a program that will be checked soon, and the one that reads what is sent to it."""
        self._usual_process(program).prepare()
        self._cutting.prepare()

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
                self._process_of[wanted.program] = self._slow
                raise CheckFailed("check_took_too_long") from error
            except NotStarted as error:
                starts += 1
                log.warning("The process that checks programs is started anew: %s", error)
            except Lost as error:
                losses += 1
                log.warning("The check of program %s broke off: %s", wanted.program, error)
        self._process_of[wanted.program] = self._slow
        raise CheckFailed("check_broke_off")

    async def do(self, task: DocumentTask[Said]) -> Said | None:
        """Have work on a document done in a process that has nothing else to do; None where that fails."""
        free = [process for process in self._processes if not process.is_busy]
        process = next((process for process in free if process.pid is not None), free[0] if free else self._slow)
        if not await process.enter(self._limits.patience_s):
            return None
        doing = asyncio.create_task(self._do(process, task))
        doing.add_done_callback(lambda task: task.cancelled() or task.exception())
        try:
            said: Said = await asyncio.shield(doing)
        except (NotStarted, Lost, TookTooLong, GaveWay) as error:
            log.warning("What is done with documents in a child process failed: %s", error)
            return None
        return said

    async def cut(self, cutting: Cutting) -> CutUpdate:
        """Check and cut an update that somebody sent, in a process for that alone. Raises BadFrame, CutFailed."""
        process = self._cutting
        for _ in range(_TRIALS):
            await process.enter(None)
            try:
                said = await asyncio.shield(asyncio.create_task(self._do(process, CuttingTask(cutting))))
            except NotStarted as error:
                log.warning("The process that reads what is sent is started anew: %s", error)
                continue
            except (Lost, TookTooLong) as error:
                log.warning("An update of %s bytes could not be cut: %s", len(cutting.update), error)
                raise CutFailed from error
            if isinstance(said, Refusal):
                raise BadFrame(said.reason)
            found: CutUpdate = said
            return found
        return await asyncio.to_thread(cutting.cut)

    async def _do(self, process: CheckerProcess, task: DocumentTask[Any]) -> Any:
        """Have a task done by a process whose turn it is, and give the turn back."""
        try:
            return await process.do(task, self._limits.check_s)
        finally:
            process.leave()

    async def _check_once(self, wanted: Wanted, begin: Callable[[], None]) -> Found:
        while True:
            process = await self._enter(wanted.program)
            try:
                found = await process.check(wanted, begin, self._limits.check_s)
            except GaveWay:
                self._process_of[wanted.program] = self._slow
                continue
            finally:
                process.leave()
            if process is self._slow and found.took_s < QUICK_S:
                process.forget(wanted.program)
                del self._process_of[wanted.program]
            return found

    async def _enter(self, program: str) -> CheckerProcess:
        """Wait for a program's turn at its process, or at another one."""
        while True:
            process = self._usual_process(program)
            if await process.enter(None if process is self._slow else self._limits.patience_s):
                return process
            free = next((other for other in self._processes if not other.is_busy), None)
            if free is None:
                process.hurry(self._limits.patience_s)
            else:
                process.forget(program)
                self._process_of[program] = free

    def _usual_process(self, program: str) -> CheckerProcess:
        process = self._process_of.get(program)
        if process is None:
            crowds = [sum(each is other for each in self._process_of.values()) for other in self._processes]
            process = self._process_of[program] = self._processes[crowds.index(min(crowds))]
        return process

    def forget(self, program: str) -> None:
        """Keep nothing of a program that nobody has open."""
        process = self._process_of.pop(program, None)
        if process is not None:
            process.forget(program)

    @property
    def pids(self) -> list[int]:
        """The processes that run now."""
        return [process.pid for process in self._all if process.pid is not None]

    async def close(self) -> None:
        """End all processes."""
        await asyncio.gather(*(process.close() for process in self._all), return_exceptions=True)

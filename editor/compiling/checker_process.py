"""One child process, started when it is needed and anew when it has died; one check after the other."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import sys
import time
from asyncio.subprocess import PIPE, Process
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from editor.compiling.frames import HEAD, decode_body, encode_frame
from editor.compiling.job_delta import ChildKnowledge, Wanted
from editor.compiling.workbench import Fault, Found
from editor.documents.work import DocumentTask
from registry.services import sigint_blocked

log = logging.getLogger(__name__)
ROOT = Path(__file__).resolve().parents[2]
SILENT_S = 5.0
"""A process that says nothing for so long while it checks is frozen."""
START_S = 30.0
MOST_RESIDENT_BYTES = 700 * 1024 * 1024
"""A process that holds more begins anew after its check."""


class Lost(Exception):
    """The process ended, froze or stumbled in a check; why."""


class NotStarted(Exception):
    """The process ended before it could check anything; why."""


class TookTooLong(Exception):
    """The check was ended by the clock."""


class GaveWay(Exception):
    """The check was ended since others wait."""


class CheckerProcess:
    """A child process and those who wait for it."""

    def __init__(self, name: str) -> None:
        """Start nothing yet."""
        self._name = name
        self._turn = asyncio.Lock()
        self._starting: asyncio.Task[Process] | None = None
        self._process: Process | None = None
        self._hurry = asyncio.Event()
        self._since: float | None = None
        self._known = ChildKnowledge()
        self._closed = False

    @property
    def pid(self) -> int | None:
        """The process that runs now."""
        return None if self._process is None or self._process.returncode is not None else self._process.pid

    @property
    def is_busy(self) -> bool:
        """Whether it checks."""
        return self._turn.locked()

    def prepare(self) -> None:
        """Start the process."""
        if self.pid is None and self._starting is None and not self._closed:
            self._starting = asyncio.create_task(self._start())
            self._starting.add_done_callback(self._note_started)

    def _note_started(self, task: asyncio.Task[Process]) -> None:
        self._starting = None
        if not task.cancelled() and task.exception() is not None:
            log.warning("The process that checks programs did not start: %s", task.exception())

    async def _start(self) -> Process:
        self._known = ChildKnowledge()
        with sigint_blocked():
            process = await asyncio.create_subprocess_exec(
                *(sys.executable, "-m", "editor.compiling.child_process"),
                stdin=PIPE, stdout=PIPE, cwd=ROOT, limit=2**20, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
            )  # fmt: skip
        self._process = process
        await _hear_ready(process)
        return process

    async def enter(self, patience_s: float | None) -> bool:
        """Wait for one's turn, so long at most; tell whether it is."""
        try:
            await asyncio.wait_for(self._turn.acquire(), patience_s)
        except TimeoutError:
            return False
        return True

    def leave(self) -> None:
        """Let the next one have their turn."""
        self._hurry.clear()
        self._turn.release()

    def hurry(self, after_s: float) -> None:
        """Have the check that goes on end if it has gone on for so long: others wait."""
        if self._since is not None and time.monotonic() - self._since >= after_s:
            self._hurry.set()

    def forget(self, program: str) -> None:
        """Have what is known of a program forgotten."""
        self._known.forget(program)

    async def check(self, wanted: Wanted, begin: Callable[[], None], limit_s: float) -> Found:
        """Have a program checked by who has the turn.

        Raises NotStarted, Lost, TookTooLong, GaveWay; the process is ended then, unless it said itself what went wrong.
        """
        process = await self._running()
        document = wanted.document()
        begin()
        job = self._known.job(wanted)
        found: Found = await self._have_done(process, encode_frame(job), limit_s)
        self._known.take(wanted, document, job, found)
        return found

    async def do(self, task: DocumentTask[Any], limit_s: float) -> Any:
        """Have a task done by who has the turn; raises as `check` does."""
        process = await self._running()
        return await self._have_done(process, await asyncio.to_thread(encode_frame, task), limit_s)

    async def _have_done(self, process: Process, frame: bytes, limit_s: float) -> Any:
        self._since, is_whole = time.monotonic(), False
        try:
            said = await self._ask(process, frame, limit_s)
            is_whole = _resident_bytes(process.pid) <= MOST_RESIDENT_BYTES
            if isinstance(said, Fault):
                raise Lost(said.story)
            return said
        finally:
            self._since = None
            if not is_whole:
                await self._end()

    async def _running(self) -> Process:
        if self._closed:
            raise NotStarted("This process ends.")
        self.prepare()
        if self._starting is not None:
            try:
                await asyncio.shield(self._starting)
            except OSError as error:
                raise NotStarted(f"It did not start: {error}") from error
        assert self._process is not None
        return self._process

    async def _ask(self, process: Process, frame: bytes, limit_s: float) -> Any:
        asking, hurrying = asyncio.create_task(_answer(process, frame)), asyncio.create_task(self._hurry.wait())
        try:
            await asyncio.wait({asking, hurrying}, timeout=limit_s, return_when=asyncio.FIRST_COMPLETED)
            if asking.done():
                return asking.result()
            raise GaveWay if hurrying.done() else TookTooLong
        finally:
            for task in (asking, hurrying):
                task.cancel()
            await asyncio.gather(asking, hurrying, return_exceptions=True)

    async def _end(self) -> None:
        process, self._process, self._known = self._process, None, ChildKnowledge()
        if process is not None:
            _kill(process)
            await process.wait()

    async def close(self) -> None:
        """End the process for good."""
        self._closed = True
        if self._starting is not None:
            await asyncio.wait([self._starting])
        await self._end()


def _kill(process: Process) -> None:
    """Kill a process, past `Process.kill`, which may take its end away from the event loop."""
    if process.returncode is None:
        with suppress(ProcessLookupError):
            os.kill(process.pid, signal.SIGKILL)


async def _hear_ready(process: Process) -> None:
    """Wait for the first beat. Raises NotStarted."""
    assert process.stdout is not None
    try:
        await asyncio.wait_for(process.stdout.readexactly(HEAD.size), START_S)
    except (OSError, TimeoutError, asyncio.IncompleteReadError) as error:
        _kill(process)
        raise NotStarted(f"It did not start: {error}") from error


async def _answer(process: Process, frame: bytes) -> Any:
    """Send a frame and return the answer. Raises Lost, and NotStarted if the process was dead before it began."""
    assert process.stdin is not None
    assert process.stdout is not None
    has_begun = False
    try:
        process.stdin.write(frame)
        await process.stdin.drain()
        while True:
            (size,) = HEAD.unpack(await asyncio.wait_for(process.stdout.readexactly(HEAD.size), SILENT_S))
            has_begun = True
            if size:
                return decode_body(await asyncio.wait_for(process.stdout.readexactly(size), SILENT_S))
    except TimeoutError as error:
        raise Lost("The process says nothing any more.") from error
    except (OSError, asyncio.IncompleteReadError) as error:
        raise (Lost if has_begun else NotStarted)("The process has ended.") from error


def _resident_bytes(pid: int) -> int:
    """Return what a process holds in memory; 0 where the kernel does not tell."""
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    except (OSError, IndexError, ValueError):
        return 0
    return pages * os.sysconf("SC_PAGE_SIZE")

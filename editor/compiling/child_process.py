"""`python -m editor.compiling.child_process`: checks what its parent asks for, until the parent ends. No Django.

Jobs come on standard input, what was found goes to standard output. A beat is sent when a check begins, which tells a
process that dies of it from one that was dead before; and now and then while it goes on, which tells a long check from
a frozen process.
"""

from __future__ import annotations

import os
import queue
import resource
import sys
import threading
import traceback
from typing import Any, BinaryIO

from editor.compiling.frames import BEAT, HEAD, decode_body, encode_frame
from editor.compiling.workbench import Fault, Job, Workbench
from editor.documents.work import DocumentTask
from registry.floorplan.plan import FloorPlan

__all__ = ["FloorPlan"]  # read here, and not with the first job that brings one: it takes half a second
BEAT_EVERY_S = 0.5
MOST_ADDRESS_BYTES = 4 * 1024**3
"""What of memory the kernel gives at most; a check that wants more raises MemoryError."""


class Child:
    """The child's end of the two pipes."""

    def __init__(self, reads: BinaryIO, writes: BinaryIO) -> None:
        """Begin to listen: who ends with the parent must hear of that while it checks."""
        self._reads, self._writes = reads, writes
        self._jobs: queue.SimpleQueue[Job | DocumentTask[Any]] = queue.SimpleQueue()
        self._writing = threading.Lock()
        self._busy = threading.Event()
        for act in (self._read, self._beat):
            threading.Thread(target=act, daemon=True).start()

    def work(self) -> None:
        """Tell that all is read, and check one job after the other."""
        bench = Workbench()
        self._write(BEAT)
        while True:
            job = self._jobs.get()
            self._busy.set()
            self._write(BEAT)
            said = _answer(bench, job)
            self._busy.clear()
            self._write(encode_frame(said))

    def _read(self) -> None:
        while len(head := self._reads.read(HEAD.size)) == HEAD.size:
            self._jobs.put(decode_body(self._reads.read(HEAD.unpack(head)[0])))
        os._exit(0)  # the parent has ended; a check that goes on is of no use to anybody

    def _beat(self) -> None:
        while True:
            threading.Event().wait(BEAT_EVERY_S)
            if self._busy.is_set():
                self._write(BEAT)

    def _write(self, frame: bytes) -> None:
        with self._writing:
            try:
                self._writes.write(frame)
                self._writes.flush()
            except OSError:
                os._exit(0)


def _answer(bench: Workbench, job: Job | DocumentTask[Any]) -> Any:
    try:
        return bench.check(job) if isinstance(job, Job) else job.done()
    except Exception:  # noqa: BLE001 - the edge of the process: one program's fault must not end the others' checks
        return Fault(traceback.format_exc(limit=20))


def main() -> None:
    """Work until the parent ends."""
    resource.setrlimit(resource.RLIMIT_AS, (MOST_ADDRESS_BYTES, resource.getrlimit(resource.RLIMIT_AS)[1]))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    writes = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # whatever prints does not write between the frames
    Child(sys.stdin.buffer, writes).work()


if __name__ == "__main__":
    main()

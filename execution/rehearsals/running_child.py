"""The worker's end of a child process that rehearses: what it says without waiting for it, and its end at any time."""

from __future__ import annotations

import json
import os
import selectors
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from registry.services import sigint_blocked

ROOT = Path(__file__).resolve().parents[2]
MOST_BYTES = 1024 * 1024


class RunningChild:
    """A child process with its job; as a context it is ended at the latest when the context is left."""

    def __init__(self, job: Mapping[str, Any], module: str = "execution.rehearsals.child_process") -> None:
        # A job in a file, not in a pipe: a child that is frozen before it has read it must not hold up the worker.
        with tempfile.TemporaryFile() as file:
            file.write(json.dumps(job).encode())
            file.seek(0)
            command = [sys.executable, "-m", module]
            with sigint_blocked():
                self._process = subprocess.Popen(  # noqa: S603 - our own module, with our own interpreter
                    command, stdin=file, stdout=subprocess.PIPE, cwd=ROOT, bufsize=0
                )
        assert self._process.stdout is not None
        self._pipe = self._process.stdout.fileno()
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._pipe, selectors.EVENT_READ)
        self._heard_at = time.monotonic()
        self._kept_waiting_s = self._kept_waiting()
        self._began: float | None = None
        self._rest = b""
        self.has_ended = False

    @property
    def pid(self) -> int:
        """The number of its process."""
        return self._process.pid

    @property
    def age_s(self) -> float:
        """How long ago it has begun to rehearse; 0 before that."""
        return 0.0 if self._began is None else time.monotonic() - self._began

    @property
    def silence_s(self) -> float:
        """How long it has said nothing, without the time in which everything else kept it from the processor.

        It gives way to everything else, so on a busy machine it may stand ready for minutes; one that is frozen, stuck
        or waits for something does not.
        """
        return time.monotonic() - self._heard_at - (self._kept_waiting() - self._kept_waiting_s)

    def _kept_waiting(self) -> float:
        """Return for how many seconds in all it stood ready and had no processor; 0 where the system does not say."""
        try:
            return int(Path(f"/proc/{self.pid}/schedstat").read_text().split()[1]) / 1e9
        except (OSError, IndexError, ValueError):
            return 0.0

    def read(self, limit_s: float) -> list[dict[str, Any]]:
        """Return the lines that have come, after waiting for `limit_s` at most; `has_ended` when no more will."""
        if not self._selector.select(limit_s):
            return []
        data = os.read(self._pipe, MOST_BYTES)
        self.has_ended = not data
        self._heard_at, self._kept_waiting_s = time.monotonic(), self._kept_waiting()
        if self._began is None:
            self._began = self._heard_at
        *lines, self._rest = (self._rest + data).split(b"\n")
        return [json.loads(line) for line in lines if line.startswith(b"{") and line.endswith(b"}")]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._process.kill()  # also one that is stopped or frozen
        self._process.wait()
        self._selector.close()
        assert self._process.stdout is not None
        self._process.stdout.close()

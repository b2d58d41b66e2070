"""Processes of Python that begin with the product's modules loaded.

`ForkedPython` and `run_forked` are called as `subprocess.Popen` and `subprocess.run` are, with a command of this
interpreter (`[sys.executable, "manage.py", "gateway"]`, or with `-m` or `-c`). Such a process has an id, an
environment, files and a folder of its own, reads its settings anew, and ends, freezes and is killed as any other.
Whoever tests how the product is started takes subprocess itself.
"""

from __future__ import annotations

import atexit
import functools
import json
import os
import select
import signal
import socket
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from threading import Lock
from typing import Any

from tests.kit.files import ROOT

ANSWER_BYTES = 64
_ASKING = Lock()


class ForkedPython(subprocess.Popen[Any]):
    """A process of Python, forked from the one that has loaded the product."""

    def _execute_child(self, args: Sequence[str], *options: Any) -> None:
        """Ask for the process where Popen forks and executes; `options` are Popen's own, in its order (Python 3.11)."""
        passed, cwd, env = options[3:6]
        pipes, session = options[9:15], options[20]
        read_by_child, _, _, written_by_child, _, errors = pipes
        interpreter, *arguments = args
        assert interpreter == sys.executable, "only what runs in this interpreter can be forked"
        assert not passed, "files besides the three usual ones do not come along"
        self._ended, ends = os.pipe()
        self._end = Lock()
        asked = {
            "arguments": [str(each) for each in arguments],
            "cwd": os.fspath(cwd or Path.cwd()),
            "environment": dict(os.environ if env is None else env),
            "new_session": session,
        }
        streams = [own if fd == -1 else fd for own, fd in enumerate((read_by_child, written_by_child, errors))]
        try:
            self.pid = _ask(asked, [*streams, ends])
        finally:
            os.close(ends)
            self._close_pipe_fds(*pipes)  # type: ignore[attr-defined]  # the stubs have only what is public
        self._child_created = True

    def _internal_poll(self, *_: Any, **__: Any) -> int | None:
        return self._look(0)

    def _wait(self, timeout: float | None) -> int:
        code = self._look(timeout)
        if code is None:
            raise subprocess.TimeoutExpired(self.args, timeout or 0)
        return code

    def _look(self, timeout_s: float | None) -> int | None:
        """Return the exit code if the process has ended or does so in time; negative for a signal, as Popen has it."""
        end = select.poll()  # not select(), which takes no file above 1,023
        end.register(self._ended, select.POLLIN)
        if self.returncode is None and end.poll(None if timeout_s is None else timeout_s * 1000):
            with self._end:
                if self.returncode is None:
                    self.returncode = int(os.read(self._ended, ANSWER_BYTES) or -signal.SIGKILL)
        return self.returncode

    def __del__(self, *_: Any) -> None:
        """Give the pipe back that told the end."""
        if hasattr(self, "_ended"):
            os.close(self._ended)


def run_forked(
    command: Sequence[str],
    *,
    input: str | bytes | None = None,
    capture_output: bool = False,
    check: bool = False,
    timeout: float | None = None,
    **options: Any,
) -> subprocess.CompletedProcess[Any]:
    """Run a command to its end; one that has not ended after `timeout` seconds is killed."""
    if input is not None:
        options["stdin"] = subprocess.PIPE
    if capture_output:
        options |= {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with ForkedPython(command, **options) as process:
        try:
            out, err = process.communicate(input, timeout)
        except BaseException:
            process.kill()
            raise
    if check and process.returncode:
        raise subprocess.CalledProcessError(process.returncode, command, out, err)
    return subprocess.CompletedProcess(command, process.returncode, out, err)


@functools.cache
def _server() -> socket.socket:
    """Start the process that forks, once for each process of tests; it ends when this one does."""
    ours, its = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with its:
        command = [sys.executable, "-m", "tests.kit.processes.fork_server", str(its.fileno())]
        process = subprocess.Popen(command, cwd=ROOT, pass_fds=[its.fileno()], start_new_session=True)

    def end() -> None:
        ours.close()
        process.wait()

    atexit.register(end)
    return ours


def _ask(asked: Mapping[str, Any], files: list[int]) -> int:
    """Return the id of the new process; several threads may ask."""
    with _ASKING:
        socket.send_fds(_server(), [json.dumps(asked).encode()], files)
        return int(_server().recv(ANSWER_BYTES))

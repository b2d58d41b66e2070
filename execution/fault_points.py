"""Named moments at which tests have a process die or freeze, as a power cut or the system does; free unless asked for.

`VIPO_FAULTS` names a folder. A file in it that is called like a point says what happens to the first process that
comes there: `kill`, or `freeze` until somebody sends SIGCONT; `kill 3` is for a process that comes there the third
time since it saw the file. The file is gone when it happens, so each file counts once, however many processes look.
"""

from __future__ import annotations

import os
import signal
import threading
from pathlib import Path

OWNER_POINTS = ("before_commit", "after_commit", "before_hand_over", "after_hand_over")
"""In a turn's commit, and in giving a site up."""
GATEWAY_POINTS = (
    "before_claim",
    "after_claim",
    "before_publish",
    "after_publish",
    "before_mark",
    "after_mark",
    "before_answer",
    "after_answer",
)
"""What goes out to devices, and what comes in from them."""
ARCHIVE_POINTS = ("archive_begun", "archive_file", "archive_whole", "archive_slice")
DIES_WITH = 137
"""The exit code of who is killed, as a shell gives it."""

_passed: dict[str, int] = {}


def fault_point(name: str) -> None:
    """Die or freeze here when `VIPO_FAULTS` asks for it."""
    folder = os.environ.get("VIPO_FAULTS")
    if folder:
        _look(Path(folder) / name, name)


def _look(file: Path, name: str) -> None:
    try:
        what, _, wanted = file.read_text().strip().partition(" ")
    except FileNotFoundError:
        _passed.pop(name, None)
        return
    _passed[name] = _passed.get(name, 0) + 1
    if _passed[name] < int(wanted or 1):
        return
    try:
        file.unlink()
    except FileNotFoundError:  # another process was first
        return
    if what == "kill":
        os._exit(DIES_WITH)
    signal.pthread_kill(threading.get_ident(), signal.SIGSTOP)  # to this thread, so that it goes no further

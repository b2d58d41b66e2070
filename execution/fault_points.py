"""Named moments at which tests have a process sleep, as one does that the system has frozen."""

from __future__ import annotations

import os
import signal
import threading
from pathlib import Path


def freeze_point(name: str, *, armed: bool = True) -> None:
    """Sleep here, until somebody sends SIGCONT, once for each file of this name in the folder `VIPO_FREEZE_IN`."""
    folder = os.environ.get("VIPO_FREEZE_IN")
    if not armed or not folder:
        return
    file = Path(folder) / name
    if file.exists():
        file.unlink()
        signal.pthread_kill(threading.get_ident(), signal.SIGSTOP)  # to this thread, so that it goes no further

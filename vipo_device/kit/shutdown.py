"""How a process that speaks for devices is asked to end: SIGTERM or Ctrl-C, and a limit for saying that it leaves."""

from __future__ import annotations

import signal
import threading
from types import FrameType


def stop_on_signals(limit_s: int) -> threading.Event:
    """Return an event that SIGTERM and Ctrl-C set; `limit_s` seconds later the kernel ends the process.

    A farewell that hangs is not worth waiting for: what counts was kept before it was said, and the last wills say the
    same. Call it on the main thread.
    """
    stopping = threading.Event()

    def stop(_signal: int, _frame: FrameType | None) -> None:
        stopping.set()
        signal.alarm(limit_s)

    signal.signal(signal.SIGTERM, stop)
    signal.signal(signal.SIGINT, stop)
    return stopping

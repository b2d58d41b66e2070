"""How a process starts another one."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager

SIGINT = {signal.SIGINT}


@contextmanager
def sigint_blocked() -> Iterator[None]:
    """Have a child that is started in here, on this thread, begin with SIGINT blocked.

    Ctrl-C reaches a whole process group, and parents end their children in order. A child that ignores it by itself
    does so too late: it may still be reading its modules. May be entered several times at once, by tasks of one loop.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, SIGINT)
    try:
        yield
    finally:
        if signal.SIGINT not in before:
            signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGINT)

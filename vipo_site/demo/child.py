"""Turns into another program that ends when its parent does, also when the parent is killed.

Used as `python -m vipo_site.demo.child PARENT COMMAND …`, where PARENT is the process id of whoever starts it.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys

PR_SET_PDEATHSIG = 1


def main() -> None:
    """Ask Linux for a signal at the parent's death, then become the command on the command line."""
    parent = int(sys.argv[1])
    # Whoever started us may have blocked or ignored SIGTERM, and a process hands that on to its children. Ctrl-C
    # reaches the whole process group, and the parent stops its children in order: it is blocked, not ignored, because
    # MicroPython puts a handler of its own in the place of an ignored signal.
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_SETMASK, {signal.SIGINT})
    if sys.platform == "linux":
        ctypes.CDLL(None, use_errno=True).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    if os.getppid() != parent:
        sys.exit(1)
    os.execvp(sys.argv[2], sys.argv[2:])  # noqa: S606 - the command comes from demo.py, never from outside


if __name__ == "__main__":
    main()

"""Turns into another program that ends when its parent does, also when the parent is killed."""

from __future__ import annotations

import ctypes
import os
import signal
import sys

PR_SET_PDEATHSIG = 1


def main() -> None:
    """Ask Linux for a signal at the parent's death, then become the command on the command line."""
    parent = os.getppid()
    if sys.platform == "linux":
        ctypes.CDLL(None, use_errno=True).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    # Ctrl-C reaches the whole process group; the parent stops its children in order. Blocked, not ignored, because
    # MicroPython puts a handler of its own in the place of an ignored signal.
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    if os.getppid() != parent:
        sys.exit(1)
    os.execvp(sys.argv[1], sys.argv[1:])  # noqa: S606 - the command comes from demo.py, never from outside


if __name__ == "__main__":
    main()

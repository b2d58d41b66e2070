"""A sign that a process's loop goes round: a file that it touches, and the look at it from outside.

python -m vipo_device.kit.pulse FILE     ends with 0 while the loop goes round, with 1 when it stands still
"""

from __future__ import annotations

import sys
import time
from contextlib import suppress
from pathlib import Path

EVERY_S = 2.0
STILL_AFTER_S = 45.0


class Pulse:
    """Touches a file, at most every EVERY_S; without a path it does nothing. A disk that is full stops nobody."""

    def __init__(self, path: str) -> None:
        self._path = Path(path) if path else None
        self._beaten_s = -EVERY_S

    def beat(self) -> None:
        """Say that the loop has come round once more."""
        now_s = time.monotonic()
        if self._path is not None and now_s - self._beaten_s >= EVERY_S:
            self._beaten_s = now_s
            with suppress(OSError):
                self._path.touch(mode=0o600)


def beats(path: Path) -> bool:
    """Tell whether a loop touched the file lately."""
    try:
        return time.time() - path.stat().st_mtime < STILL_AFTER_S
    except OSError:
        return False


if __name__ == "__main__":
    sys.exit(0 if beats(Path(sys.argv[1])) else 1)

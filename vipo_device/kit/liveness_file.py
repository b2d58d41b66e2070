"""A file that a process touches while its loop goes round, and the look at it from outside.

python -m vipo_device.kit.liveness_file FILE     ends with 0 while the loop goes round, with 1 when it stands still
"""

from __future__ import annotations

import sys
import time
from contextlib import suppress
from pathlib import Path

EVERY_S = 2.0
STILL_AFTER_S = 45.0


class LivenessFile:
    """Touches a file, at most every EVERY_S; without a path it does nothing. A disk that is full stops nobody."""

    def __init__(self, path: str) -> None:
        self._path = Path(path) if path else None
        self._touched_s = -EVERY_S

    def touch(self) -> None:
        """Say that the loop has come round once more."""
        now_s = time.monotonic()
        if self._path is not None and now_s - self._touched_s >= EVERY_S:
            self._touched_s = now_s
            with suppress(OSError):
                self._path.touch(mode=0o600)


def is_alive(path: Path) -> bool:
    """Tell whether a loop touched the file lately."""
    try:
        return time.time() - path.stat().st_mtime < STILL_AFTER_S
    except OSError:
        return False


if __name__ == "__main__":
    sys.exit(0 if is_alive(Path(sys.argv[1])) else 1)

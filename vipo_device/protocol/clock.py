"""A clock for how old something is that may have slept since."""

from __future__ import annotations

import time

_CLOCK = getattr(time, "CLOCK_BOOTTIME", time.CLOCK_MONOTONIC)


def steady_s() -> float:
    """Return seconds that nobody sets, and that go on while this process sleeps, or (on Linux) the machine."""
    return time.clock_gettime(_CLOCK)

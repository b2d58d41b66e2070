"""How a test waits for what comes from elsewhere: until it is there, with a limit that only a fault reaches."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")
PATIENCE_S = 120.0
SHARE, LONGEST_S = 0.05, 0.25
"""A question may be a request to a server, and asked all the time it takes the processor from what is waited for: the
pause between two grows with the time that was waited, by this share of it, up to this long."""


def wait_for(
    what: str,
    ready: Callable[[], T],
    timeout_s: float = PATIENCE_S,
    *,
    every_s: float = 0.02,
    story: Callable[[], str] = str,
    hopeless: Callable[[], str] = str,
) -> T:
    """Return the first true answer of `ready`.

    It is asked every `every_s` at first, then more seldom. Fails when `hopeless` says why it cannot come any more, or
    after the limit; with `story`, which tells what happened.
    """
    began = time.monotonic()
    while not (found := ready()):
        if why := hopeless():
            raise AssertionError(f"{what} cannot come: {why}\n{story()}")
        waited_s = time.monotonic() - began
        if waited_s > timeout_s:
            raise AssertionError(f"{what} did not come within {timeout_s:g} s\n{story()}")
        time.sleep(max(every_s, min(waited_s * SHARE, LONGEST_S)))
    return found

"""How a test waits for what comes from elsewhere: until it is there, with a limit that only a fault reaches."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")
PATIENCE_S = 60.0


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

    Fails when `hopeless` says why it cannot come any more, or after the limit; with `story`, which tells what happened.
    """
    deadline = time.monotonic() + timeout_s
    while not (found := ready()):
        if why := hopeless():
            raise AssertionError(f"{what} cannot come: {why}\n{story()}")
        if time.monotonic() > deadline:
            raise AssertionError(f"{what} did not come within {timeout_s:g} s\n{story()}")
        time.sleep(every_s)
    return found

"""How much work something takes, so that a busy machine does not change the answer: lines of Python, processor time."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType
from typing import Any


@dataclass
class Work:
    """The lines of Python that were run."""

    lines: int = 0


@contextmanager
def count_work() -> Iterator[Work]:
    """Count every line of Python that this thread runs in functions that are called within the block."""
    work = Work()

    def note(_frame: FrameType, event: str, _argument: Any) -> Any:
        work.lines += event == "line"
        return note

    before = sys.gettrace()
    sys.settrace(note)
    try:
        yield work
    finally:
        sys.settrace(before)


@contextmanager
def within_processor_time(limit_s: float) -> Iterator[None]:
    """Fail when this thread's own processor time in the block reaches the limit, where the work is done in C.

    What waits for its turn uses none; the limit lies far above what is usual, below what a wrong kind of growth takes.
    """
    began = time.thread_time()
    try:
        yield
    finally:
        took_s = time.thread_time() - began
        assert took_s < limit_s, f"{took_s:.2f} s of processor time"

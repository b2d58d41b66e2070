"""Waiting for sockets by poll(): select() takes no descriptor above 1,023, and a server of many browsers has such."""

from __future__ import annotations

import selectors
from collections.abc import Sequence
from typing import Any

Ready = tuple[list[Any], list[Any], list[Any]]


def wait_ready(readers: Sequence[Any], writers: Sequence[Any], _errors: Sequence[Any], timeout_s: float) -> Ready:
    """Do what `select.select` does, for descriptors of any number.

    Returns what can be read, what can be written, and an empty list. Raises ValueError for what is closed or no socket.
    """
    wanted: dict[Any, int] = dict.fromkeys(readers, selectors.EVENT_READ)
    for writer in writers:
        wanted[writer] = wanted.get(writer, 0) | selectors.EVENT_WRITE
    with getattr(selectors, "PollSelector", selectors.DefaultSelector)() as waiting:  # Windows has no poll()
        for each, events in wanted.items():
            waiting.register(each, events)
        found = [(key.fileobj, events) for key, events in waiting.select(timeout_s)]
    can_read = [each for each, events in found if events & selectors.EVENT_READ]
    return can_read, [each for each, events in found if events & selectors.EVENT_WRITE], []

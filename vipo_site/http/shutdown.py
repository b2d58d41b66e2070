"""What the web process does when it is told to end."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Coroutine
from typing import Any

LIMIT_S = 8.0
"""Containers are killed ten seconds after they were told to end."""


def keep_rooms_at_end(close_rooms: Callable[[], Coroutine[Any, Any, None]]) -> None:
    """Have Daphne wait, when it ends, until the rooms have kept everything and sent their people away to come again."""
    if "twisted.internet.reactor" in sys.modules:  # another server than Daphne has none
        from twisted.internet import reactor

        reactor.addSystemEventTrigger("before", "shutdown", _wait_for, close_rooms)


def _wait_for(close_rooms: Callable[[], Coroutine[Any, Any, None]]) -> Any:
    from twisted.internet.defer import Deferred

    return Deferred.fromFuture(asyncio.ensure_future(asyncio.wait_for(close_rooms(), LIMIT_S)))

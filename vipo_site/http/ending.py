"""What the web process does when it is told to end."""

from __future__ import annotations

import asyncio
import sys
from typing import Any

from editor.rooms.hub import close_hub

LIMIT_S = 8.0
"""Containers are killed ten seconds after they were told to end."""


def keep_rooms_at_end() -> None:
    """Have Daphne wait, when it ends, until the rooms have kept everything and sent their people away to come again."""
    if "twisted.internet.reactor" in sys.modules:  # another server than Daphne has none
        from twisted.internet import reactor

        reactor.addSystemEventTrigger("before", "shutdown", _close_rooms)


def _close_rooms() -> Any:
    from twisted.internet.defer import Deferred

    return Deferred.fromFuture(asyncio.ensure_future(asyncio.wait_for(close_hub(), LIMIT_S)))

"""What rooms do off the event loop."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import ParamSpec, TypeVar

from channels.db import database_sync_to_async

P = ParamSpec("P")
R = TypeVar("R")


def in_database(function: Callable[P, R]) -> Callable[P, Awaitable[R]]:
    """Run a function that uses the database on a thread, off the event loop."""
    awaitable: Callable[P, Awaitable[R]] = database_sync_to_async(function, thread_sensitive=False)
    return awaitable

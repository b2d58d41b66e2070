"""The database's clock, which is the same for every process, and a cursor for statements that are asked often."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from typing import Any

import psycopg
from django.db import DatabaseError, InterfaceError, connection

KEPT_S = 5.0
"""So long a process counts on from what the database's clock said, by a clock that nobody sets."""


class _Heard:
    """What the database's clock said last, and when that was by a clock that nobody sets."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._said: tuple[datetime, float] | None = None

    def note(self, said: datetime, asked_at: float) -> datetime:
        """Take in what the clock said; counted from the question, so that what others have just written is past."""
        with self._lock:
            self._said = (said, asked_at)
        return said

    def count_on(self, limit_s: float = float("inf")) -> datetime | None:
        with self._lock:
            said = self._said
        if said is None:
            return None
        since = time.monotonic() - said[1]
        return None if since >= limit_s else said[0] + timedelta(seconds=since)


_heard = _Heard()


def now() -> datetime:
    """Return the time by the database's clock; SQLite has that of its machine, which is this one.

    While the database is away it is counted on from what it said last.
    """
    if connection.vendor != "postgresql":
        return datetime.now(UTC)
    said = _heard.count_on(KEPT_S)
    if said is None:
        try:
            asked_at = time.monotonic()
            said = _heard.note(_ask(), asked_at)
        except (DatabaseError, InterfaceError):
            said = _heard.count_on() or datetime.now(UTC)
    return said


def _ask() -> datetime:
    with connection.cursor() as cursor:
        cursor.execute("SELECT clock_timestamp()")
        said: datetime = cursor.fetchone()[0]
    return said


@contextmanager
def preparing_cursor() -> Iterator[Any]:
    """Give a cursor for which PostgreSQL plans a statement once; planning often takes longer than what is planned."""
    if connection.vendor != "postgresql":
        with connection.cursor() as cursor:
            yield cursor
        return
    connection.ensure_connection()
    connection.connection.prepare_threshold = 0
    with connection.wrap_database_errors, psycopg.Cursor(connection.connection) as prepared:
        yield prepared

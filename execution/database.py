"""The database's clock, which is the same for every process, and a cursor for statements that are asked often."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from functools import cache
from typing import Any

import psycopg
from django.db import DatabaseError, InterfaceError, connection

log = logging.getLogger(__name__)
KEPT_S = 5.0
"""So long a process counts on from what the database's clock said, by a clock that nobody sets."""
AT_ONCE = (16, 4, 2, 1)
"""So many new rows go with one statement: each of these is planned once, and what a step writes is mostly one."""


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


@contextmanager
def kept_apart(what: str) -> Iterator[None]:
    """Write into the log what the block raises, so that what comes behind it has its turn; `what` is its name there.

    Raises what it does where the database is away: then nothing that comes behind can be done either.
    """
    try:
        yield
    except Exception as error:
        if isinstance(error, DatabaseError | InterfaceError) and not connection.is_usable():
            raise
        log.exception("%s failed; what comes after it goes on.", what)


def _ask() -> datetime:
    with connection.cursor() as cursor:
        cursor.execute("SELECT clock_timestamp()")
        said: datetime = cursor.fetchone()[0]
    return said


def open_cursor() -> Any:
    """Return a cursor for which PostgreSQL plans a statement once; planning often takes longer than what is planned."""
    if connection.vendor != "postgresql":
        return connection.cursor()
    connection.ensure_connection()
    connection.connection.prepare_threshold = 0
    return psycopg.Cursor(connection.connection)


@contextmanager
def preparing_cursor() -> Iterator[Any]:
    """Give a cursor as `open_cursor` returns it, for as long as the block takes."""
    with connection.wrap_database_errors, open_cursor() as prepared:
        yield prepared


@cache
def _insert(into: str, columns: int, rows: int, ending: str) -> str:
    row = f"({', '.join(['%s'] * columns)})"
    return f"{into} VALUES {', '.join([row] * rows)} {ending}"


class Batch:
    """Statements of which none waits for what the one before has come to; each returns its cursor.

    What a cursor says (`rowcount`, rows) may be asked behind the block of `sent_together`, when all have come back.
    """

    def ask(self, statement: str, told: Any) -> Any:
        """Send one statement."""
        cursor = open_cursor()
        cursor.execute(statement, told)
        return cursor

    def insert(self, into: str, rows: Sequence[Sequence[Any]], ending: str = "") -> None:
        """Insert rows in their order; `into` and `ending` are what stands before and behind their values."""
        begin = 0
        for count in AT_ONCE:
            while len(rows) - begin >= count:
                some = rows[begin : begin + count]
                self.ask(_insert(into, len(some[0]), count, ending), [value for row in some for value in row])
                begin += count

    def ask_many(self, statement: str, rows: Sequence[Any]) -> Any:
        """Send one statement for each of the rows; its `rowcount` is that of all of them."""
        cursor = open_cursor()
        cursor.executemany(statement, rows)
        return cursor


@contextmanager
def sent_together() -> Iterator[Batch]:
    """Give what statements are sent by in one exchange with PostgreSQL; SQLite is asked one after the other.

    Inside a transaction that may be its first exchange, too. What one of them raises is raised at the end of the block,
    and those behind it are not carried out.
    """
    if connection.vendor != "postgresql":
        yield Batch()
        return
    connection.ensure_connection()
    with connection.wrap_database_errors, connection.connection.pipeline():
        yield Batch()

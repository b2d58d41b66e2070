"""Whether this process can do its work."""

from __future__ import annotations

from typing import TypedDict

from django.db import DatabaseError, connection


class Health(TypedDict):
    """What the health page says."""

    ok: bool
    database: str


def check_health() -> Health:
    """Ask the database for an answer."""
    try:
        with connection.cursor() as cursor:
            cursor.execute("SELECT 1")
    except DatabaseError as error:
        return {"ok": False, "database": type(error).__name__}
    return {"ok": True, "database": "ok"}

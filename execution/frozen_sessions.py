"""Sessions of this product that have a transaction open and say nothing: PostgreSQL is told to end them.

PostgreSQL does that by itself (`idle_in_transaction_session_timeout`) behind a statement of its own, not within or
behind a pipeline: psycopg asks for what is left by a Flush, after which that clock stands still until the next
statement. A process that is frozen there would keep its rows for as long as its machine answers.
"""

from __future__ import annotations

import logging

from django.conf import settings
from django.db import connection

log = logging.getLogger(__name__)
OWNER_SILENT_S = 3.0
"""An owner of a site that has asked nothing for so long in its transaction does not hold up the next one."""
_SILENT = """
FROM pg_stat_activity AS session {joined}
WHERE session.datname = current_database() AND session.usename = current_user AND session.pid <> pg_backend_pid()
  AND session.application_name LIKE 'vipo%%' AND session.xact_start IS NOT NULL
  AND session.wait_event = 'ClientRead' AND session.state_change < clock_timestamp() - make_interval(secs => %s)
"""
_ENDED = "SELECT session.pid, session.application_name, pg_terminate_backend(session.pid)"
_END_ALL = _ENDED + _SILENT.format(joined="")
_END_HOLDER = (
    _ENDED
    + _SILENT.format(joined="JOIN execution_sitelease AS lease ON lease.xmax = session.backend_xid")
    + "AND lease.site_id = %s AND lease.expires_at < clock_timestamp()"
)


def end_frozen_sessions() -> int:
    """End all that were silent for VIPO_DATABASE_IDLE_S, as PostgreSQL would (0: none); returns how many."""
    return _end(_END_ALL, settings.FROZEN_AFTER_S)


def end_frozen_holder(site: int) -> int:
    """End the session that has a site's lease in its hand and let it run out; returns how many, which is 0 or 1."""
    return _end(_END_HOLDER, OWNER_SILENT_S, site)


def _end(statement: str, *told: float) -> int:
    if connection.vendor != "postgresql" or not told[0]:
        return 0
    with connection.cursor() as cursor:
        cursor.execute(statement, told)
        ended = cursor.fetchall()
    for number, name, _ in ended:
        log.warning("Session %s of %s was silent in its transaction and is ended.", number, name)
    return len(ended)

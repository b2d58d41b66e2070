"""What is new at a site, in one question: the database's time, runs that were started, and what waits for it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import reduce
from typing import Any
from uuid import UUID

from django.db import connection
from django.utils.dateparse import parse_datetime

from execution import database

MOST_AT_ONCE = 500
_READ = """
SELECT -1 AS id, (SELECT CAST(epoch AS text) FROM execution_floorstate WHERE site_id = %(site)s) AS target,
    CAST(NULL AS <json>) AS payload, <now> AS at
UNION ALL SELECT 0, CAST(number AS text) || ':' || CAST(id AS text), CAST(NULL AS <json>), created_at FROM execution_run
WHERE site_id = %(site)s AND number > %(number)s
UNION ALL SELECT * FROM (
    SELECT id, target, payload, created_at FROM execution_inboxevent WHERE site = %(slug)s AND taken_at IS NULL
    ORDER BY id LIMIT %(limit)s
) AS waiting
ORDER BY 1
"""
_DIALECTS = {
    "postgresql": {"<now>": "clock_timestamp()", "<json>": "jsonb"},
    "sqlite": {"<now>": "strftime('%%Y-%%m-%%d %%H:%%M:%%f', 'now')", "<json>": "text"},
}
_READS = {
    vendor: reduce(lambda text, part: text.replace(*part), parts.items(), _READ) for vendor, parts in _DIALECTS.items()
}
_TAKE = {
    "postgresql": "UPDATE execution_inboxevent SET taken_at = %(now)s WHERE id = ANY(%(ids)s)",
    "sqlite": "UPDATE execution_inboxevent SET taken_at = %(now)s WHERE id IN (SELECT value FROM json_each(%(ids)s))",
}


@dataclass(frozen=True, slots=True)
class Row:
    """Something that waits in an inbox, as it was kept."""

    id: int
    target: str
    payload: Any
    at: datetime


@dataclass(frozen=True, slots=True)
class News:
    """What is new at a site: runs by id with their numbers, and `rows` in the order in which they were posted.

    `floor_epoch` tells whether anybody else has changed the floor; None: there is none yet.
    """

    now: datetime
    floor_epoch: int | None = None
    runs: Mapping[UUID, int] = field(default_factory=dict)
    rows: Sequence[Row] = field(default=())


def read_news(site: int, slug: str, last_number: int, limit: int = MOST_AT_ONCE) -> News:
    """Return the runs behind a number and what waits for the site's floor and runs, at most `limit` of it."""
    told = {"site": site, "slug": slug, "number": last_number, "limit": limit}
    with database.preparing_cursor() as cursor:
        cursor.execute(_READS[connection.vendor], told)
        (_, epoch, _, now), *others = cursor.fetchall()
    started = [target.partition(":") for number, target, _, _ in others if number == 0]
    runs = {UUID(run): int(number) for number, _, run in started}
    rows = [Row(number, target, _value(said), _time(at)) for number, target, said, at in others if number > 0]
    return News(_time(now), None if epoch is None else int(epoch), runs, rows)


def mark_taken(batch: database.Batch, ids: Sequence[int], now: datetime) -> None:
    """Say that these messages are taken in; they are kept a while, so that a repetition is known as one."""
    if not ids:
        return
    given: Any = list(ids) if connection.vendor == "postgresql" else json.dumps(list(ids))
    batch.ask(_TAKE[connection.vendor], {"now": connection.ops.adapt_datetimefield_value(now), "ids": given})


def _value(said: Any) -> Any:
    """Return a message as JSON; what is no JSON is passed on as it is, and cannot be read by anybody."""
    try:
        return json.loads(said) if isinstance(said, str | bytes) else said
    except ValueError:
        return str(said)


def _time(said: Any) -> datetime:
    if isinstance(said, datetime):
        return said
    read = parse_datetime(str(said))
    assert read is not None
    return read if read.tzinfo else read.replace(tzinfo=UTC)

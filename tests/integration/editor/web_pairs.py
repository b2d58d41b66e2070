"""Two web processes over one PostgreSQL and one Redis."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.kit.served import served_without_broker
from tests.kit.servers import Redis
from tests.kit.web import Web, prepare


@dataclass(frozen=True)
class Pair:
    """Two web processes that share a database and a Redis."""

    one: Web
    two: Web
    redis: Redis
    database_url: str


@contextmanager
def running_pair(folder: Path, database_url: str, redis: Redis) -> Iterator[Pair]:
    """Prepare the database and start both."""
    extra = served_without_broker(folder, database_url, redis.url)
    extra = {name: value for name, value in extra.items() if name.startswith("VIPO_")}
    made = prepare(folder, extra)
    one, two = (Web(folder, **made, extra=extra) for _ in range(2))
    one.start()
    two.start()
    try:
        yield Pair(one, two, redis, database_url)
    finally:
        one.kill()
        two.kill()

"""A server that is killed (SIGKILL) in the middle of a request with an Idempotency-Key: nothing is done twice.

Where it stands still is chosen by locks that the test holds in PostgreSQL.
"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import psycopg
import pytest

from registry.people.keyed_requests import LONGEST
from tests.kit.served import served_without_broker
from tests.kit.servers import Redis
from tests.kit.waiting import wait_for
from tests.kit.web import Web, prepare

pytestmark = pytest.mark.servers
MAKING = "LOCK TABLE editor_program IN EXCLUSIVE MODE"
ANSWERING = "SELECT 1 FROM registry_keyedrequest FOR UPDATE"
WAITING = "FROM pg_stat_activity WHERE datname = current_database() AND wait_event_type = 'Lock'"
COUNT = "SELECT count(*) FROM editor_program WHERE name = 'Mix'"


@dataclass(frozen=True)
class Plant:
    """Two web processes on one PostgreSQL, of which the first is killed."""

    url: str
    first: Web
    second: Web

    def wait_until_one_waits(self) -> None:
        """Wait until a statement of a server waits for what the test holds."""
        with psycopg.connect(self.url, autocommit=True) as looking:
            wait_for("who waits", lambda: looking.execute(f"SELECT count(*) {WAITING}").fetchone() == (1,))

    def kill_first(self) -> None:
        """Kill the process, and let PostgreSQL learn of it at once instead of when it next speaks to it."""
        self.first.kill()
        with psycopg.connect(self.url, autocommit=True) as looking:
            assert looking.execute(f"SELECT pg_terminate_backend(pid) {WAITING}").fetchall() == [(True,)]

    def count(self) -> int:
        with psycopg.connect(self.url) as looking:
            row = looking.execute(COUNT).fetchone()
        return int(row[0]) if row else 0

    def grow_old(self) -> None:
        """Let the first request have begun so long ago that it must have been cut off."""
        with psycopg.connect(self.url) as changing:
            changing.execute("UPDATE registry_keyedrequest SET begun_at = begun_at - %s", [LONGEST])


@pytest.fixture
def plant(tmp_path: Path, database_url: str, shared_redis: Redis) -> Iterator[Plant]:
    told = served_without_broker(tmp_path, database_url, shared_redis.url)
    extra = {name: value for name, value in told.items() if name.startswith("VIPO_")}
    made = prepare(tmp_path, extra)
    webs = [Web(tmp_path, made["sessions"], made["program"], extra) for _ in range(2)]
    for web in webs:
        web.start()
    try:
        yield Plant(database_url, *webs)
    finally:
        for web in webs:
            web.kill()


def ask(web: Web, key: str = "k1") -> Any:
    """Ask for a program; return None where the line was cut."""
    with web.client("author") as client:
        try:
            return client.post("/sites/hall/programs", json={"name": "Mix"}, headers={"Idempotency-Key": key})
        except httpx.RemoteProtocolError:
            return None


def told(web: Web, key: str = "k1") -> tuple[int, str]:
    answer = ask(web, key)
    return answer.status_code, answer.json().get("code", "")


@pytest.mark.parametrize("done", [0, 1])
def test_what_a_killed_server_had_begun_is_not_done_again(plant: Plant, done: int) -> None:
    with ThreadPoolExecutor(1) as pool, psycopg.connect(plant.url) as maker, psycopg.connect(plant.url) as answerer:
        maker.execute(MAKING)
        asked = pool.submit(ask, plant.first)
        plant.wait_until_one_waits()
        if done:
            answerer.execute(ANSWERING)
            maker.commit()
            wait_for("the program", lambda: plant.count() == 1)
            plant.wait_until_one_waits()
        plant.kill_first()
        assert asked.result(60) is None
    assert plant.count() == done
    assert told(plant.second) == (409, "under_way")
    plant.grow_old()
    assert [told(plant.second) for _ in range(3)] == [(409, "outcome_unknown")] * 3
    assert plant.count() == done
    assert told(plant.second, "k2") == (201, "")
    assert plant.count() == done + 1

"""What the watch over open sockets costs: two statements a second in each process, for one session as for hundreds."""

from __future__ import annotations

import asyncio
import json
import re
import sys
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import AsyncExitStack
from dataclasses import dataclass
from pathlib import Path

import psycopg
import pytest
from websockets.asyncio.client import ClientConnection, connect

from registry.people.watch import EVERY_S
from tests.kit.databases import migrate
from tests.kit.files import ROOT
from tests.kit.processes.forked import run_forked
from tests.kit.served import served_without_broker
from tests.kit.servers import Postgres, Redis, run_postgres
from tests.kit.web import Web, environment, prepare

pytestmark = pytest.mark.servers
PEOPLE, EACH, WATCHED_S = 20, 20, 5.0
MAKE_SESSIONS = f"""
import json
import django
django.setup()
from registry.models import User
from tests.kit.web_process import make_person, make_session
sessions = []
for number in range({PEOPLE}):
    make_person(f"p{{number}}", "hall", "viewer")
    person = User.objects.get(email=f"p{{number}}@vipo.example")
    sessions += [make_session(person) for _ in range({EACH})]
print(json.dumps(sessions))
"""
STATEMENT = re.compile(r"\[(\d+)\] LOG: +(?:statement|execute [^:]*): (.*)")


@dataclass(frozen=True)
class Plant:
    """Two web processes on a PostgreSQL that writes down every statement, and 400 sessions of twenty people."""

    postgres: Postgres
    webs: list[Web]
    sessions: list[str]

    def count(self, since: int) -> Counter[str]:
        """Count the statements that came after this place of the log, by the process of PostgreSQL that ran them."""
        written = self.postgres.log.read_bytes()[since:].decode(errors="replace")
        return Counter(number for number, text in STATEMENT.findall(written) if text.startswith("SELECT"))


@pytest.fixture
def plant(tmp_path: Path, shared_redis: Redis) -> Iterator[Plant]:
    with run_postgres(tmp_path) as server:
        migrate(server.url, tmp_path)
        told = served_without_broker(tmp_path, server.url, shared_redis.url)
        extra = {name: value for name, value in told.items() if name.startswith("VIPO_")}
        made = prepare(tmp_path, extra)
        told_sessions = run_forked(
            [sys.executable, "-c", MAKE_SESSIONS],
            cwd=ROOT, env=environment(tmp_path, extra), capture_output=True, text=True, check=True,
        )  # fmt: skip
        with psycopg.connect(server.url, autocommit=True) as connection:
            connection.execute("ALTER DATABASE vipo SET log_statement = 'all'")
        webs = [Web(tmp_path, made["sessions"], made["program"], extra) for _ in range(2)]
        for web in webs:
            web.start()
        try:
            yield Plant(server, webs, json.loads(told_sessions.stdout))
        finally:
            for web in webs:
                web.kill()


async def open_socket(web: Web, session: str) -> ClientConnection:
    headers = {"Origin": f"http://127.0.0.1:{web.port}", "Cookie": f"sessionid={session}"}
    url = f"ws://127.0.0.1:{web.port}/ws/site/hall"
    socket = await connect(url, additional_headers=headers, ping_interval=None, open_timeout=60)
    assert json.loads(await asyncio.wait_for(socket.recv(), 60))["type"] == "hello"
    return socket


async def test_two_statements_a_second_in_each_process_whatever_is_open(plant: Plant) -> None:
    one, other = plant.webs
    async with AsyncExitStack() as stack:
        stack.push_async_callback((await open_socket(other, plant.sessions[0])).close)
        opened = 0
        for number in (1, 50, 400):
            for session in plant.sessions[opened:number]:
                stack.push_async_callback((await open_socket(one, session)).close)
            opened = number
            await asyncio.sleep(2 * EVERY_S)
            begun, since = time.monotonic(), plant.postgres.log.stat().st_size
            await asyncio.sleep(WATCHED_S)
            counted = plant.count(since)
            looks = (time.monotonic() - begun) / EVERY_S + 1
            by_process = sorted(asked for asked in counted.values() if asked > 1)  # heartbeats ask seldom
            assert len(by_process) == 2, f"{number} sessions: {counted}"
            assert all(2 <= statements <= 2 * looks for statements in by_process), f"{number} sessions: {counted}"

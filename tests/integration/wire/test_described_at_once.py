"""Two at once on one PostgreSQL: workers that take in the same devices' descriptions, admins who confirm one topic."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import psycopg
import pytest

from tests.kit.files import ROOT
from tests.kit.processes.forked import run_forked
from tests.kit.served import served_without_broker
from tests.kit.servers import Redis

NEWEST = """
    SELECT device.id, device.description->>'name', line.text FROM registry_device AS device, LATERAL (
        SELECT text FROM registry_deviceevent WHERE device_id = device.id AND kind = 'described'
        ORDER BY id DESC LIMIT 1
    ) AS line
"""
DEADLOCKS = "SELECT deadlocks FROM pg_stat_database WHERE datname = current_database()"
LINES = "SELECT count(*) FROM registry_deviceevent WHERE kind = 'described'"


def run_together(module: str, folder: Path, database_url: str, redis: Redis) -> Any:
    """Let a module's threads work at once on the database; return what it tells."""
    environment = served_without_broker(folder, database_url, redis.url)
    command = [sys.executable, "-m", f"tests.integration.wire.{module}"]
    done = run_forked(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300)
    assert (done.returncode, done.stderr) == (0, "")
    return json.loads(done.stdout)


@pytest.mark.servers
def test_two_workers_on_the_same_devices_keep_everything_and_never_lock_each_other_out(
    tmp_path: Path, database_url: str, shared_redis: Redis
) -> None:
    told = run_together("describers", tmp_path, database_url, shared_redis)
    assert told == {"faults": [], "acknowledged": {"first": 360, "one": 360, "two": 360}}
    with psycopg.connect(database_url) as connection:
        rows = connection.execute(NEWEST).fetchall()
        lines = connection.execute(LINES).fetchone()
        deadlocks = connection.execute(DEADLOCKS).fetchone()
    assert len(rows) == 30
    assert {name for _, name, _ in rows} <= {"one 11", "two 11"}
    assert {text for _, _, text in rows} == {"Describes itself anew all the time; not every time is written down"}
    assert (lines, deadlocks) == ((30 * 10,), (0,))


@pytest.mark.servers
def test_of_two_admins_who_confirm_a_topic_at_once_exactly_one_does_so(
    tmp_path: Path, database_url: str, shared_redis: Redis
) -> None:
    told = run_together("confirmers", tmp_path, database_url, shared_redis)
    assert told == {"came": {"confirmed": 20, "told": 20}, "owned_once": 20, "rows": 20}

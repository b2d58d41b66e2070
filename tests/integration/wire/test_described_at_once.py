"""Two at once on one PostgreSQL: workers that take in the same devices' descriptions, admins who confirm one topic."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import psycopg
import pytest

from tests.servers import ROOT, Postgres, Redis, run_postgres, run_redis

NEWEST = """
    SELECT device.id, device.description->>'name', line.text FROM registry_device AS device, LATERAL (
        SELECT text FROM registry_deviceevent WHERE device_id = device.id AND kind = 'described'
        ORDER BY id DESC LIMIT 1
    ) AS line
"""
DEADLOCKS = "SELECT deadlocks FROM pg_stat_database WHERE datname = current_database()"
LINES = "SELECT count(*) FROM registry_deviceevent WHERE kind = 'described'"


def served_environment(folder: Path, postgres: Postgres, redis: Redis) -> dict[str, str]:
    """What a process of the served product is told, without a broker."""
    return {
        **{name: value for name, value in os.environ.items() if not name.startswith(("VIPO_", "DJANGO_"))},
        "DJANGO_SETTINGS_MODULE": "vipo_site.settings",
        "VIPO_STATE_DIR": str(folder),
        "VIPO_MODE": "served",
        "VIPO_SECRET_KEY": "a key for this test alone, long enough to be taken",
        "VIPO_HOSTS": "127.0.0.1",
        "VIPO_DATABASE_URL": postgres.url,
        "VIPO_REDIS_URL": redis.url,
        "VIPO_MQTT_HOST": "127.0.0.1",
        "VIPO_MQTT_PASSWORD": "not used here",
    }


@pytest.mark.servers
def test_two_workers_on_the_same_devices_keep_everything_and_never_lock_each_other_out(tmp_path: Path) -> None:
    with run_postgres(tmp_path) as postgres, run_redis(tmp_path) as redis:
        environment = served_environment(tmp_path, postgres, redis)
        command = [sys.executable, "-m", "tests.integration.wire.describers"]
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=180)
        assert (done.returncode, done.stderr) == (0, "")
        assert json.loads(done.stdout) == {"faults": [], "acknowledged": {"first": 360, "one": 360, "two": 360}}
        with psycopg.connect(postgres.url) as connection:
            rows = connection.execute(NEWEST).fetchall()
            lines = connection.execute(LINES).fetchone()
            deadlocks = connection.execute(DEADLOCKS).fetchone()
    assert len(rows) == 30
    assert {name for _, name, _ in rows} <= {"one 11", "two 11"}
    assert [text for _, _, text in rows] == [f"Calls itself {name}" for _, name, _ in rows]
    assert (lines, deadlocks) == ((30 * 36,), (0,))


@pytest.mark.servers
def test_of_two_admins_who_confirm_a_topic_at_once_exactly_one_does_so(tmp_path: Path) -> None:
    with run_postgres(tmp_path) as postgres, run_redis(tmp_path) as redis:
        environment = served_environment(tmp_path, postgres, redis)
        command = [sys.executable, "-m", "tests.integration.wire.confirmers"]
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=180)
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout) == {"came": {"confirmed": 20, "told": 20}, "owned_once": 20, "rows": 20}

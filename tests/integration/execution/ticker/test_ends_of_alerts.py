"""That a command's alert has ended is found without reading what its device has done in years."""

from __future__ import annotations

import json
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from typing import Any
from uuid import uuid4

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext
from pytest_django import DjangoDbBlocker

from execution.models import Command
from execution.ticker.alerts import watch_alerts
from registry import services as registry
from registry.models import Device, Site
from tests.kit.databases import on_database
from vipo_site.settings import postgres

pytestmark = pytest.mark.servers
NOW = datetime(2026, 11, 21, 12, 0, tzinfo=UTC)
DONE = 5_000


@pytest.fixture
def hall(database_url: str, django_db_blocker: DjangoDbBlocker) -> Iterator[Site]:
    with django_db_blocker.unblock(), on_database(**postgres(database_url)):
        registry.create_site(name="Hall", slug="hall")
        site = Site.objects.get(slug="hall")
        Device.objects.create(pk="mixer", site=site, lifecycle="approved", last_seen_at=NOW)
        yield site


def command(site: Site, position: int, method: str, status: str, ended_s: float) -> Command:
    ended_at = NOW + timedelta(seconds=ended_s)
    return Command(
        id=uuid4(), site=site, position=position, device="mixer", method=method, status=status, send_after=ended_at,
        created_at=ended_at, ended_at=ended_at,
    )  # fmt: skip


def rows_read(plan: dict[str, Any]) -> int:
    """Return how many rows the parts of a plan took and left, as it was carried out."""
    own = plan["Actual Rows"] * plan["Actual Loops"] + plan.get("Rows Removed by Filter", 0)
    own += plan.get("Rows Removed by Index Recheck", 0)
    return int(own) + sum(rows_read(part) for part in plan.get("Plans", ()))


def read_at_a_look(now_s: float) -> list[int]:
    """Watch the alerts, and return how many rows each question after commands that are done reads."""
    now = NOW + timedelta(seconds=now_s)
    with CaptureQueriesContext(connection) as asked:
        watch_alerts(now=now, since=NOW)
    questions = [each["sql"] for each in asked if "'done'" in each["sql"] and "execution_command" in each["sql"]]
    with connection.cursor() as cursor:
        plans = [
            cursor.execute(f"EXPLAIN (ANALYZE, FORMAT JSON) {question}").fetchone()[0]  # type: ignore[union-attr]
            for question in questions
        ]
    return [rows_read((json.loads(plan) if isinstance(plan, str) else plan)[0]["Plan"]) for plan in plans]


def test_an_alert_that_stays_costs_a_few_rows_and_ends_once_its_method_was_done(hall: Site) -> None:
    before = [command(hall, n, "mix", "done", n - DONE) for n in range(DONE)]
    Command.objects.bulk_create([*before, command(hall, DONE, "mix", "failed", 1)])
    watch_alerts(now=NOW + timedelta(seconds=2), since=NOW)
    others = [command(hall, DONE + 1 + n, "heat", "done", 2 + n / DONE) for n in range(DONE)]
    Command.objects.bulk_create(others)
    with connection.cursor() as cursor:
        cursor.execute("ANALYZE execution_command")
    (read,) = read_at_a_look(3)
    assert read <= 5
    assert [alert.code for alert in registry.list_alerts(site="hall")] == ["command_failed"]
    # done while the ticker was away, and long behind what came after it
    Command.objects.bulk_create([command(hall, 3 * DONE, "mix", "done", 10)])
    Command.objects.bulk_create([command(hall, 3 * DONE + 1 + n, "heat", "done", 11 + n) for n in range(500)])
    (read,) = read_at_a_look(3600)
    assert read <= 5
    assert registry.list_alerts(site="hall") == ()

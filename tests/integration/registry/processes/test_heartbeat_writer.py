"""Real processes beside this one: what is seen of them when they work, freeze, die and end, on both databases."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from django.db import connection, transaction
from django.db.models import F
from django.test.utils import CaptureQueriesContext
from pytest_django import DjangoDbBlocker

from registry import services
from registry.models import Heartbeat
from registry.processes.heartbeat_writer import HeartbeatWriter
from registry.processes.heartbeats import FORGOTTEN_AFTER, SILENT_AFTER
from tests.kit.databases import on_database
from tests.kit.files import ROOT, copy_migrated
from tests.kit.processes.forked import ForkedPython
from tests.kit.served import served_without_broker
from tests.kit.waiting import PATIENCE_S, wait_for
from vipo_site.settings import postgres


@pytest.fixture(params=["sqlite", "postgres"])
def environment(
    request: pytest.FixtureRequest, tmp_path: Path, django_db_setup: None, django_db_blocker: DjangoDbBlocker
) -> Iterator[dict[str, str]]:
    """Share a database with processes that are started with what this returns."""
    if request.param == "postgres":
        url = request.getfixturevalue("database_url")
        own, database = served_without_broker(tmp_path, url, "redis://127.0.0.1:1/0"), postgres(url)
    else:
        copy_migrated(tmp_path / "vipo.sqlite3")
        own = {name: value for name, value in os.environ.items() if not name.startswith(("VIPO_", "DJANGO_"))}
        own |= {"VIPO_STATE_DIR": str(tmp_path)}
        database = {"NAME": str(tmp_path / "vipo.sqlite3")}
    with django_db_blocker.unblock(), on_database(**database):
        yield {**own, "VIPO_PULSE": str(tmp_path / "pulse"), "VIPO_LOG": "WARNING,json"}


@contextmanager
def running(environment: dict[str, str], *command: str) -> Iterator[subprocess.Popen[bytes]]:
    process = ForkedPython([sys.executable, *command], cwd=ROOT, env=environment)
    try:
        yield process
    finally:
        process.send_signal(signal.SIGCONT)
        process.kill()
        process.wait()


def states() -> list[tuple[str, str, str]]:
    return [(each.kind, each.state, each.activity) for each in services.list_processes()]


def codes() -> list[str]:
    return [finding.code for finding in services.find_trouble(processes=services.list_processes())]


def let_pass(age: timedelta) -> None:
    """Let the last beats be older by so much; a process that works writes a new one within two seconds."""
    Heartbeat.objects.update(at=F("at") - age)


def let_fall_silent() -> None:
    """Let the last beat of who works no more be so old that it is silent; PostgreSQL may have one that comes later."""

    def is_silent() -> bool:
        let_pass(SILENT_AFTER)
        return states()[0][1] == "silent"

    wait_for("its silence", is_silent)


def freeze(process: subprocess.Popen[bytes]) -> None:
    """Stop a process while this transaction alone writes: within a write it would keep SQLite's lock."""
    with transaction.atomic():
        let_pass(timedelta())
        process.send_signal(signal.SIGSTOP)
        state = Path(f"/proc/{process.pid}/stat")
        wait_for("the frozen process", lambda: state.read_text().rpartition(")")[2].split()[0] == "T")


def beats_anew(process: int) -> Callable[[], Any]:
    return lambda: [p for p in services.list_processes() if p.process == process and p.state == "beats"]


def test_a_ticker_that_freezes_dies_and_comes_back_is_seen_so(environment: dict[str, str]) -> None:
    with running(environment, "manage.py", "ticker") as ticker:
        wait_for("the ticker", lambda: [p.clock_apart_s for p in services.list_processes()] not in ([], [None]))
        wait_for("its lease", lambda: states() == [("ticker", "beats", "leads")])
        (told,) = services.list_processes(with_counters=True)
        assert told.clock_apart_s is not None
        assert (told.process, abs(told.clock_apart_s) < 2) == (ticker.pid, True)
        assert Path(environment["VIPO_PULSE"]).exists()
        freeze(ticker)
        let_fall_silent()
        assert states() == [("ticker", "silent", "leads")]
        assert codes() == ["no_ticker", "process_silent"]
        ticker.send_signal(signal.SIGCONT)
        wait_for("its next beat", beats_anew(ticker.pid))
        assert codes() == []
        ticker.kill()
        ticker.wait()
        let_fall_silent()
        assert codes() == ["no_ticker", "process_silent"]
    with running(environment, "manage.py", "ticker") as successor:
        wait_for("the one after it", beats_anew(successor.pid))
        assert [kind for kind, _, _ in states()] == ["ticker"]
        successor.terminate()
        assert successor.wait(PATIENCE_S) == 0
        assert states() == [("ticker", "ended", "leads")] or states() == [("ticker", "ended", "stands_by")]
        assert codes() == []


APART = """
import django, sys, time
from datetime import UTC, datetime, timedelta
django.setup()
from registry.services import HeartbeatWriter
heartbeat = HeartbeatWriter("worker", "late", clock=lambda: datetime.now(UTC) - timedelta(seconds=60)).start()
while True:
    heartbeat.beat("works")
    time.sleep(0.1)
"""


def test_a_clock_that_is_behind_is_told_and_no_beat_carries_it(environment: dict[str, str]) -> None:
    began = services.read_time()
    with running({"DJANGO_SETTINGS_MODULE": "vipo_site.settings", **environment}, "-c", APART):
        wait_for("its clock", lambda: any(p.clock_apart_s is not None for p in services.list_processes()))
        (late,) = services.list_processes()
        assert -60.5 < (late.clock_apart_s or 0) < -59.5
        assert began - timedelta(seconds=1) <= late.since <= late.at <= late.now
        wait_for("its finding, once a beat is young again", lambda: codes() == ["clock_apart"])


def test_a_loop_that_stands_still_falls_silent_though_its_thread_goes_on(
    environment: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("registry.processes.heartbeat_writer.BEAT_S", 0.02)
    monkeypatch.setattr("registry.processes.heartbeat_writer.LOOP_LIMIT_S", 0.3)
    heartbeat = HeartbeatWriter("gateway", "stuck").start()
    try:
        wait_for("its first beats", lambda: states() == [("gateway", "beats", "")])
        wait_for("its silence", lambda: services.list_processes()[0].age_s > 0.5)
        (silent,) = services.list_processes()

        def beats() -> bool:
            heartbeat.beat("works")
            return services.list_processes()[0].at > silent.at

        wait_for("its next beat", beats)
    finally:
        heartbeat.stop()
    assert [state for _, state, _ in states()] == ["ended"]


def test_who_was_forgotten_while_it_was_frozen_comes_back_by_itself(
    environment: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("registry.processes.heartbeat_writer.BEAT_S", 0.02)
    heartbeat = HeartbeatWriter("gateway", "thawed").start()
    try:
        wait_for("its first beat", states)
        Heartbeat.objects.all().delete()
        wait_for("its next beat", lambda: states() == [("gateway", "beats", "")])
    finally:
        heartbeat.stop()


def make_rows(count: int, age: timedelta = timedelta()) -> None:
    at = datetime.now(UTC) - age
    Heartbeat.objects.bulk_create(
        Heartbeat(kind="worker", name=f"w{n}", machine="m", process=n, version="1", since=at, at=at,
                  counters={"tasks": [[["t", "SUCCESS"], n]]})
        for n in range(count)
    )  # fmt: skip


def test_five_hundred_processes_are_read_by_one_question_and_the_old_ones_forgotten(
    environment: dict[str, str],
) -> None:
    make_rows(500)
    make_rows(20, FORGOTTEN_AFTER + timedelta(minutes=1))
    with CaptureQueriesContext(
        connection,
    ) as asked:
        found = services.list_processes()
    assert (len(found), len(asked)) == (500, 1)
    assert {process.state for process in found} == {"beats"}
    assert services.prune_processes() == 20
    assert Heartbeat.objects.count() == 500

"""What hangs in the database is ended by the database: statements, waits for locks, transactions of who is frozen."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import psycopg
import pytest
from pytest_django import DjangoDbBlocker

from execution.frozen_sessions import end_frozen_sessions
from tests.kit.databases import on_database
from tests.kit.files import ROOT
from tests.kit.processes.forked import ForkedPython
from tests.kit.served import served_without_broker
from tests.kit.waiting import wait_for
from vipo_site.settings import postgres

pytestmark = pytest.mark.servers
ASK = """
import sys
import django
django.setup()
from django.db import connection, transaction
with transaction.atomic(), connection.cursor() as cursor:
    for statement in sys.argv[1:]:
        cursor.execute(statement)
        print(*(cursor.fetchone() if cursor.description else ["done"]), flush=True)
    sys.stdin.read()
"""
TAKE = "UPDATE django_site_of_this_test SET number = 1"
PREPARE = "CREATE TABLE django_site_of_this_test (number int); INSERT INTO django_site_of_this_test VALUES (0)"


def ask(url: str, folder: Path, *statements: str, **limits: str) -> subprocess.Popen[str]:
    return ForkedPython(
        [sys.executable, "-c", ASK, *statements],
        cwd=ROOT,
        env=served_without_broker(folder, url, "redis://127.0.0.1:1/0") | {"VIPO_PROCESS": "worker"} | limits,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def limits_of(url: str, folder: Path, process: str, **limits: str) -> list[str]:
    shown = [f"SHOW {name}" for name in ("statement_timeout", "lock_timeout", "idle_in_transaction_session_timeout")]
    asking = ask(url, folder, *shown, "SHOW tcp_user_timeout", VIPO_PROCESS=process, **limits)
    out, errors = asking.communicate("")
    assert asking.returncode == 0, errors
    return out.split()


def test_each_process_has_limits_that_can_be_set(database_url: str, tmp_path: Path) -> None:
    assert limits_of(database_url, tmp_path, "gateway") == ["15s", "5s", "15s", "30000"]
    assert limits_of(database_url, tmp_path, "") == ["0", "1min", "15s", "30000"]
    chosen = {"VIPO_DATABASE_STATEMENT_S": "7", "VIPO_DATABASE_LOCK_S": "0.5", "VIPO_DATABASE_IDLE_S": "3"}
    assert limits_of(database_url, tmp_path, "web", **chosen) == ["7s", "500ms", "3s", "30000"]


def test_a_statement_that_hangs_and_a_lock_that_is_never_given_are_ended(database_url: str, tmp_path: Path) -> None:
    limits = {"VIPO_DATABASE_STATEMENT_S": "0.3", "VIPO_DATABASE_LOCK_S": "0.2"}
    _, errors = ask(database_url, tmp_path, "SELECT pg_sleep(60)", **limits).communicate("")
    assert "canceling statement due to statement timeout" in errors
    with psycopg.connect(database_url) as holder:
        holder.execute(PREPARE)
        holder.commit()
        holder.execute(TAKE)
        limits["VIPO_DATABASE_STATEMENT_S"] = "30"
        _, errors = ask(database_url, tmp_path, TAKE, **limits).communicate("")
        assert "canceling statement due to lock timeout" in errors


def test_the_row_of_a_frozen_process_is_free_again(database_url: str, tmp_path: Path) -> None:
    with psycopg.connect(database_url, autocommit=True) as other:
        other.execute(PREPARE)
        frozen = ask(database_url, tmp_path, TAKE, VIPO_DATABASE_IDLE_S="1")
        assert frozen.stdout is not None
        assert frozen.stdout.readline() == "done\n"
        frozen.send_signal(signal.SIGSTOP)
        state = Path(f"/proc/{frozen.pid}/stat")
        wait_for("the frozen process", lambda: state.read_text().rpartition(")")[2].split()[0] == "T")
        began = time.monotonic()
        other.execute("UPDATE django_site_of_this_test SET number = number + 5")
        assert time.monotonic() - began < 30
        os.kill(frozen.pid, signal.SIGCONT)
        _, errors = frozen.communicate("")
        assert "terminating connection due to idle-in-transaction timeout" in errors or "closed" in errors
        assert other.execute("SELECT number FROM django_site_of_this_test").fetchone() == (5,), "its change is undone"


def test_only_sessions_of_ours_that_are_silent_in_a_transaction_are_ended(
    database_url: str, settings: Any, django_db_blocker: DjangoDbBlocker
) -> None:
    settings.FROZEN_AFTER_S = 5
    silent, resting, somebody, at_work = (
        psycopg.connect(database_url, autocommit=True, application_name=name)
        for name in ("vipo worker", "vipo web", "psql", "vipo gateway")
    )
    for session in (silent, somebody, at_work):
        session.execute("BEGIN")
        with session.pipeline():
            session.execute("SELECT 1")
    time.sleep(5.2)
    at_work.execute("SELECT 2")
    with django_db_blocker.unblock(), on_database(**postgres(database_url)):
        assert end_frozen_sessions() == 1
        settings.FROZEN_AFTER_S = 0
        assert end_frozen_sessions() == 0, "0 says that nothing is ended"
    for session in (resting, somebody, at_work):
        session.execute("SELECT 3")
        session.close()
    with pytest.raises(psycopg.errors.AdminShutdown):
        silent.execute("COMMIT")

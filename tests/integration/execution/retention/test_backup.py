"""The backup of docs/operations.md, on a real PostgreSQL: a paused run is dumped, restored elsewhere, and goes on."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections import Counter
from datetime import timedelta
from pathlib import Path
from typing import Any

import psycopg
import pytest
from django.utils import timezone
from psycopg import sql

from execution import services
from execution.models import Command, Run
from execution.retention.upkeep import archive_old
from tests.kit.databases import on_database
from tests.kit.files import ROOT
from tests.kit.programs import CARRY, run_status
from tests.kit.servers import postgres_programs
from vipo_site.settings import postgres

pytestmark = [pytest.mark.django_db(transaction=True), pytest.mark.servers]


def documented(program: str) -> list[str]:
    """Return the options with which docs/operations.md calls a program, without those that name the database."""
    found = re.search(rf"`[^`]*\b{program} ([^`]*)`", (ROOT / "docs" / "operations.md").read_text())
    assert found is not None
    return [word for word in found[1].split() if word.startswith("--") or word == "-Fc"]


def call(program: str, *arguments: str) -> None:
    command = [str(postgres_programs() / program), *documented(program), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ)
    assert done.returncode == 0, done.stderr


def make_empty(url: str) -> str:
    """Make a database without any table beside another one; return its URL."""
    server, _, name = url.rpartition("/")
    with psycopg.connect(f"{server}/postgres", autocommit=True) as connection:
        connection.execute(sql.SQL("CREATE DATABASE {}").format(sql.Identifier(f"{name}_restored")))
    return f"{server}/{name}_restored"


class Log:
    """What devices were told, as they themselves write it down."""

    def __init__(self, world: Any) -> None:
        self.told: list[tuple[str, str, str]] = []
        self._command = world.command
        world.command = self.command

    def command(self, device: str, method: str, arguments: Any, key: str) -> None:
        self.told.append((device, method, str(key)))
        self._command(device, method, arguments, key)


def test_a_paused_run_goes_on_in_a_restored_database_and_no_device_is_told_anything_twice(
    database_url: str, tmp_path: Path, settings: Any, request: pytest.FixtureRequest
) -> None:
    settings.VIPO_ARCHIVE_DIR = tmp_path / "archive"
    with on_database(**postgres(database_url)):
        shop = request.getfixturevalue("factory")
        log = Log(shop.world)
        old = shop.start(CARRY)
        services.cancel_run(run_id=old, by="Ada")
        shop.go(lambda: run_status(old) == "cancelled")
        Run.objects.filter(id=old).update(ended_at=timezone.now() - timedelta(days=400))
        archive_old(pause=lambda _: None)
        journal = services.list_events(run_id=old)
        run = shop.start(CARRY)
        shop.go(lambda: Command.objects.filter(run=run, method="dispense").exists())
        services.pause_run(run_id=run, by="Ada")
        shop.go(lambda: run_status(run) == "paused")
        shop.go(lambda: not Command.objects.filter(status__in=Command.OPEN).exists())
        before = len(log.told)
        call("pg_dump", f"--dbname={database_url}", f"--file={tmp_path / 'vipo.dump'}")
    shutil.copytree(tmp_path / "archive", tmp_path / "restored")
    shutil.rmtree(tmp_path / "archive")
    restored = make_empty(database_url)
    call("pg_restore", "--exit-on-error", "--single-transaction", f"--dbname={restored}", str(tmp_path / "vipo.dump"))
    settings.VIPO_ARCHIVE_DIR = tmp_path / "restored"
    with on_database(**postgres(restored)):
        assert services.list_events(run_id=old) == journal
        assert run_status(run) == "paused"
        services.resume_run(run_id=run, by="Ada")
        shop.go(lambda: run_status(run) == "finished")
    assert before > 0
    assert len(log.told) > before
    assert set(Counter(log.told).values()) == {1}
    assert [method for _, method, _ in log.told if method in ("dispense", "pick", "drop")] == [
        "dispense",
        "pick",
        "drop",
    ]

"""Workers on one PostgreSQL: two at once, one that is killed, one that is frozen; people who ask at once."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from django.db import connection
from pytest_django import DjangoDbBlocker

from execution import services
from execution.errors import TooManyRehearsals
from execution.models import Rehearsal
from execution.rehearsals import worker
from registry import services as registry
from registry.demo.factory import make_grid, read_plan
from tests.integration.execution.rehearsals.conftest import ENDLESS, SHORT, queue, row, wait_until
from tests.kit.databases import on_database
from tests.kit.files import ROOT
from tests.kit.processes.forked import ForkedPython
from tests.kit.programs import SITE
from tests.kit.served import served_without_broker
from tests.kit.servers import Redis
from tests.kit.waiting import wait_for
from vipo_site.settings import postgres

pytestmark = pytest.mark.servers
Start = Callable[[str], subprocess.Popen[bytes]]
PATIENT_S = 300.0
"""So long a process may take that rehearses four programs: only one that does not end reaches it."""


@pytest.fixture
def url(database_url: str, django_db_blocker: DjangoDbBlocker) -> Iterator[str]:
    """A site with a map and nothing on it, on a PostgreSQL that other processes reach, too."""
    with django_db_blocker.unblock(), on_database(**postgres(database_url)):
        registry.create_site(name="Painting Factory", slug=SITE)
        registry.save_map(site=SITE, grid=make_grid(read_plan()), source="test")
        yield database_url


@pytest.fixture
def start(url: str, tmp_path: Path, shared_redis: Redis) -> Iterator[Start]:
    """Start a worker, which takes itself for this machine."""
    processes = []

    def start_one(machine: str) -> subprocess.Popen[bytes]:
        environment = {**served_without_broker(tmp_path, url, shared_redis.url), "VIPO_REHEARSALS_AT_ONCE": "1"}
        command = [sys.executable, "-m", "tests.integration.execution.rehearsals.rehearser", machine]
        processes.append(ForkedPython(command, cwd=ROOT, env=environment))
        return processes[-1]

    yield start_one
    for process in processes:
        process.kill()
        process.wait()


def children_of(process: subprocess.Popen[bytes]) -> list[int]:
    found = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text()
    return [int(pid) for pid in found.split()]


def test_two_workers_carry_each_rehearsal_out_once(url: str, start: Start) -> None:
    rehearsals = [queue(SHORT, person, driver="kinematic") for person in range(4)]
    for process in (start("one"), start("two")):
        assert process.wait(PATIENT_S) == 0
    rows = Rehearsal.objects.all()
    assert Counter((found.status, found.tries) for found in rows) == {("done", 1): len(rehearsals)}


def test_a_killed_worker_takes_its_child_along_and_another_one_begins_anew(url: str, start: Start) -> None:
    rehearsal = queue(ENDLESS)
    killed = start("one")
    wait_for("its child", lambda: row(rehearsal).course)
    [child] = children_of(killed)
    killed.kill()
    killed.wait()
    wait_for("the end of its child", lambda: not Path(f"/proc/{child}").exists(), 10)
    assert row(rehearsal).status == "running", "nobody has noticed yet"
    Rehearsal.objects.update(beat_at=Rehearsal.objects.get().began_at - worker.DEAD_AFTER)
    worker.sweep_rehearsals()
    second = start("two")
    wait_for("its second beginning", lambda: (found := row(rehearsal)).tries == 2 and found.course)
    services.cancel_rehearsal(rehearsal_id=rehearsal, by="Ada")
    assert second.wait(PATIENT_S) == 0, "the other process ends its child, and nothing else waits"
    assert (row(rehearsal).status, row(rehearsal).result) == ("cancelled", None)


def test_a_frozen_worker_that_thaws_ends_its_child_and_leaves_the_row_alone(url: str, start: Start) -> None:
    rehearsal = queue(ENDLESS)
    frozen = start("one")
    wait_for("its child", lambda: row(rehearsal).course)
    os.kill(frozen.pid, signal.SIGSTOP)
    Rehearsal.objects.update(beat_at=Rehearsal.objects.get().began_at - worker.DEAD_AFTER)
    worker.sweep_rehearsals()
    start("two")
    second = wait_until(rehearsal, "running")
    os.kill(frozen.pid, signal.SIGCONT)
    assert frozen.wait(20) == 0
    assert (row(rehearsal).status, row(rehearsal).claim) == ("running", second.claim)


def test_who_asks_for_many_at_the_same_moment_gets_as_many_as_may_be(url: str, settings) -> None:
    settings.VIPO_REHEARSALS_OF_PERSON = 3

    def ask(_: int) -> bool:
        try:
            queue(SHORT, 7)
        except TooManyRehearsals:
            return False
        finally:
            connection.close()
        return True

    with ThreadPoolExecutor(8) as pool:
        assert Counter(pool.map(ask, range(8))) == {True: 3, False: 5}
    assert Rehearsal.objects.count() == 3

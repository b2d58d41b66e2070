"""Owners in processes of their own on one PostgreSQL: frozen, killed at named points, asked to go."""

import os
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import pytest
from celery import Celery
from django.db import connection

from bench.hall import SITE, fill_hall
from execution.engine import drive
from execution.fault_points import DIES_WITH, OWNER_POINTS
from execution.frozen_sessions import OWNER_SILENT_S, end_frozen_sessions
from execution.job_lease import LEASE_S
from execution.mailbox import DRIVE_SITE
from execution.models import Command, DeadLetter, InboxEvent, SiteLease
from registry.maps.places import PlaceChange, add_place, change_place
from tests.integration.execution.engine.hall import answer_open, driving, heating, limited, row, start, told
from tests.kit.databases import on_database
from tests.kit.files import ROOT
from tests.kit.processes.forked import ForkedPython
from tests.kit.served import WORKER, served_without_broker
from tests.kit.waiting import PATIENCE_S, wait_for
from vipo_site.settings import postgres

pytestmark = [pytest.mark.servers, pytest.mark.django_db(transaction=True)]
OWNER = ("-m", "tests.integration.execution.engine.owner", SITE)


@pytest.fixture
def owners(tmp_path, database_url, shared_redis):
    """Start owners on a database that the test uses, too."""
    with on_database(**postgres(database_url)):
        fill_hall(4)
        begun = []

        def begin(*command, **more):
            environment = {**served_without_broker(tmp_path, database_url, shared_redis.url), **more}
            log = (tmp_path / f"owner{len(begun)}.log").open("wb")
            with log:
                process = ForkedPython(
                    [sys.executable, *command], cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=log
                )
            begun.append(process)
            return process

        yield begin
        for process in begun:
            process.kill()
            process.communicate()


def expire():
    SiteLease.objects.update(expires_at="2026-01-01T00:00Z")


def sessions():
    with connection.cursor() as cursor:
        cursor.execute("SELECT state FROM pg_stat_activity WHERE datname = current_database()")
        return {state for (state,) in cursor.fetchall()}


def is_frozen(process):
    return Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()[0] == "T"


def wait_told(run, count):
    wait_for(f"command {count}", lambda: len(told(run)) >= count)


def test_a_frozen_owner_is_replaced_and_what_it_decides_when_it_thaws_changes_nothing(owners):
    run = start(heating(3))
    frozen = owners(*OWNER, "60", "30")
    wait_told(run, 1)
    frozen.send_signal(signal.SIGSTOP)
    answer_open(run)
    began = time.monotonic()
    wait_for("another owner", lambda: drive.advance_site(SITE), every_s=0.1)
    assert LEASE_S + OWNER_SILENT_S <= 8
    assert time.monotonic() - began < 40, "a lease, a session's silence, and what a busy machine adds"
    wait_told(run, 2)
    fences = [command.fence for command in told(run)]
    assert fences == sorted(set(fences))
    frozen.send_signal(signal.SIGCONT)
    assert frozen.communicate(timeout=PATIENCE_S)[0] == b"False\n"
    for _ in range(2):
        answer_open(run)
        assert drive.advance_site(SITE)
    assert row(run).status == "finished"
    assert Counter(command.step for command in told(run)) == {"s0": 1, "s1": 1, "s2": 1}


@pytest.mark.parametrize(
    ("plan", "end"),
    [
        pytest.param(limited(), lambda: None, id="by PostgreSQL, behind a statement"),
        pytest.param(heating(2), end_frozen_sessions, id="by the ticker, behind a pipeline"),
        pytest.param(heating(2), lambda: drive.advance_site(SITE), id="by the next owner, behind a pipeline"),
    ],
)
def test_an_owner_that_was_frozen_until_its_session_was_ended_sets_nothing_aside(owners, tmp_path, settings, plan, end):
    settings.FROZEN_AFTER_S = 1
    run = start(plan)
    frozen = owners(*OWNER, "60", "30", VIPO_FAULTS=str(tmp_path))
    wait_told(run, 1)
    (tmp_path / "before_commit").write_text("freeze")
    answer_open(run)
    wait_for("the frozen transaction", lambda: is_frozen(frozen) and "idle in transaction" in sessions())
    wait_for("the end of its session", lambda: end() or "idle in transaction" not in sessions())
    frozen.send_signal(signal.SIGCONT)
    assert frozen.communicate(timeout=PATIENCE_S)[0] == b"False\n"
    expire()
    assert drive.advance_site(SITE)
    assert [command.step for command in told(run)] == ["s0", "s1"]
    assert DeadLetter.objects.count() == 0


@pytest.mark.parametrize("point", OWNER_POINTS)
def test_an_owner_that_is_killed_at_a_named_point_loses_and_repeats_nothing(owners, point, tmp_path):
    run = start(heating(2))
    (tmp_path / point).write_text("kill")
    dead = owners(*OWNER, "1", "0", VIPO_FAULTS=str(tmp_path))
    assert dead.wait(60) == DIES_WITH
    expire()
    for count in (1, 2):
        drive.forget_all()
        drive.advance_site(SITE)
        assert [command.step for command in told(run)] == ["s0", "s1"][:count]
        assert answer_open(run)
    drive.advance_site(SITE)
    assert (row(run).status, InboxEvent.objects.filter(taken_at=None).count()) == ("finished", 0)
    assert len({command.id for command in told(run)}) == 2


@pytest.mark.parametrize(("point", "goal"), [("before_commit", [4.5, 2.0]), ("after_commit", [4.0, 1.5])])
def test_an_owner_that_is_killed_has_kept_the_places_of_a_run_if_and_only_if_it_has_begun_it(
    owners, point, goal, tmp_path
):
    add_place(site=SITE, place_id="bay", place=PlaceChange(name="Bay 1", x=4.0, y=1.5))
    run = start(driving("bay"))
    (tmp_path / point).write_text("kill")
    assert owners(*OWNER, "1", "0", VIPO_FAULTS=str(tmp_path)).wait(60) == DIES_WITH
    change_place(site=SITE, place_id="bay", place=PlaceChange(x=4.5, y=2.0))
    expire()
    drive.forget_all()
    for _ in range(2):
        drive.advance_site(SITE)
        answer_open(run)
    assert [(command.step, command.arguments.get("path", [[]])[-1]) for command in told(run)] == [
        ("s0", []), ("way", goal),
    ]  # fmt: skip


def children_of(process):
    lists = Path(f"/proc/{process.pid}/task").glob("*/children")
    return [pid for each in lists for pid in each.read_text().split()]


def owner_pid():
    return SiteLease.objects.get().owner.split(":")[1]


@pytest.mark.parametrize("pool", ["threads", "processes"])
def test_a_worker_that_is_asked_to_end_hands_its_sites_over_at_once(owners, shared_redis, pool):
    run = start(heating(2))
    worker = owners(*WORKER, "--pool", pool)
    Celery(broker=shared_redis.url, set_as_current=False).send_task(DRIVE_SITE, [SITE], queue="runs")
    wait_told(run, 1)
    assert owner_pid() in ([str(worker.pid)] if pool == "threads" else children_of(worker))
    worker.send_signal(signal.SIGTERM)
    assert worker.wait(30) == 0
    assert drive.advance_site(SITE)
    assert owner_pid() == str(os.getpid())
    assert Command.objects.count() == 1


def test_the_children_of_a_killed_worker_hand_its_sites_over_as_well(owners, shared_redis):
    run = start(heating(2))
    worker = owners(*WORKER, "--pool", "processes")
    Celery(broker=shared_redis.url, set_as_current=False).send_task(DRIVE_SITE, [SITE], queue="runs")
    wait_told(run, 1)
    assert owner_pid() in children_of(worker)
    worker.kill()
    wait_for("the lease given up", lambda: drive.advance_site(SITE), every_s=0.1)
    assert owner_pid() == str(os.getpid())
    assert Command.objects.count() == 1

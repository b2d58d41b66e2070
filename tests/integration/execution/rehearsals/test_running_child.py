"""What counts as the time of a child process that rehearses, and what as its silence."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

import pytest

from execution.models import Rehearsal
from execution.rehearsals.running_child import RunningChild
from tests.integration.execution.rehearsals.conftest import ENDLESS, queue
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.django_db(transaction=True)
A_WHILE_S = 0.5


@pytest.fixture
def job(factory):
    """What a worker gives to a child that never ends."""
    queue(ENDLESS)
    return {**Rehearsal.objects.get().job, "limits": {"wall_s": 600, "parent": os.getpid()}}


def said(child: RunningChild) -> list[str]:
    """Return what kinds of lines a child has said."""
    return [name for line in child.read(0.1) for name in line]


def test_its_time_begins_when_it_begins_to_rehearse(job):
    with RunningChild(job) as child:
        os.kill(child.pid, signal.SIGSTOP)
        wait_for("a frozen child", lambda: is_stopped(child))
        time.sleep(A_WHILE_S)
        assert (said(child), child.age_s) == ([], 0.0)
        assert child.silence_s >= A_WHILE_S, "who is frozen is silent all the same"
        os.kill(child.pid, signal.SIGCONT)
        assert wait_for("its first words", lambda: said(child))[0] == "begun"
        wait_for("its time", lambda: child.age_s > 0)


def test_who_stands_ready_and_has_no_processor_is_not_silent(job):
    (core,) = sorted(os.sched_getaffinity(0))[:1]
    with RunningChild(job) as others, RunningChild(job) as child:
        began = time.monotonic()
        for each in (others, child):
            os.sched_setaffinity(each.pid, {core})
        wait_for("time that others took", lambda: time.monotonic() - began - child.silence_s >= A_WHILE_S)
        os.kill(child.pid, signal.SIGSTOP)
        before = wait_for("a frozen child", lambda: is_stopped(child) and child.silence_s)
        time.sleep(A_WHILE_S)
        assert child.silence_s >= before + A_WHILE_S, "who is frozen does not stand ready"


def is_stopped(child: RunningChild) -> bool:
    return Path(f"/proc/{child.pid}/stat").read_text().rsplit(")", 1)[1].split()[0] == "T"

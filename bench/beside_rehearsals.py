"""What a run feels of eight rehearsals that never end: its steps by the clock and at work, without and beside them.

A process of its own with an SQLite database, and the worker of rehearsals as another process beside it.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median

from bench.flow import ROOT, cpu_seconds

DEVICES, RUNS, REHEARSALS = 10, 30, 8
WORKER = """
import sys, threading, django
django.setup()
from execution.rehearsals import worker
for _ in range(int(sys.argv[1])):
    threading.Thread(target=worker.carry_out_waiting).start()
"""


def measure() -> Iterator[dict[str, object]]:
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "VIPO_STATE_DIR": folder, "VIPO_LOG": "ERROR", "VIPO_MODE": "embedded"}
        environment["DJANGO_SETTINGS_MODULE"] = "vipo_site.settings"
        command = [sys.executable, "-m", "bench.beside_rehearsals"]
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr)
    yield from map(json.loads, done.stdout.splitlines())


def _measure_here() -> Iterator[dict[str, object]]:
    import django

    django.setup()
    # Django has to be set up before models can be imported
    from django.core.management import call_command

    from bench.figures import figure
    from bench.hall import fill_hall
    from execution.models import Rehearsal

    call_command("migrate", verbosity=0, interactive=False)
    fill_hall(DEVICES)
    before_ms, before_cpu_ms = _time_runs()
    _queue_endless()
    worker = subprocess.Popen([sys.executable, "-c", WORKER, str(REHEARSALS)], cwd=ROOT)
    try:
        at_once = _wait_for_rehearsals()
        began, used_s = time.perf_counter(), _children_seconds(worker.pid)
        beside_ms, beside_cpu_ms = _time_runs()
        share = (_children_seconds(worker.pid) - used_s) / (time.perf_counter() - began)
        still_open = Rehearsal.objects.filter(status__in=Rehearsal.OPEN).count()
    finally:
        Rehearsal.objects.update(status="cancelled", claim=None)
        worker.wait(20)
    after_ms, after_cpu_ms = _time_runs()  # other work on the machine counts on both sides
    alone_ms, alone_cpu_ms = (before_ms + after_ms) / 2, round((before_cpu_ms + after_cpu_ms) / 2, 1)
    yield figure("a run's steps, nothing beside it", alone_ms, "ms by the clock", cpu_ms=alone_cpu_ms, runs=2 * RUNS)
    facts = {"cpu_ms": beside_cpu_ms, "under_way": at_once, "open_after": still_open, "their_cores": round(share, 2)}
    yield figure(f"a run's steps beside {REHEARSALS} endless rehearsals", beside_ms, "ms by the clock", **facts)
    yield figure("beside them", beside_ms / alone_ms, "times as long")


def _time_runs() -> tuple[float, float]:
    """Return the median of a run's steps in ms, by the clock and at work."""
    from bench.hall import carry_out_run

    clocks, works = [], []
    for _ in range(RUNS):
        began = time.perf_counter()
        counts = carry_out_run(counting=False)
        clocks.append((time.perf_counter() - began) * 1000)
        works.append(sum(count.cpu_ms for count in counts.values()))
    return median(clocks), round(median(works), 1)


def _queue_endless() -> None:
    from uuid import uuid4

    from bench.hall import SITE
    from editor.language import plan_to_json
    from editor.language.expressions.nodes import Constant
    from editor.language.plan.instructions import Instruction, Jump, Plan, Wait
    from execution import services

    plan = plan_to_json(Plan((Instruction(Wait(Constant(0.02)), "w"), Instruction(Jump(0)))))
    for person in range(REHEARSALS):
        prepared = services.Prepared(uuid4(), SITE, "Endless", 1, {}, {}, plan, {})
        services.start_rehearsal(prepared=prepared, by="Ada", person=person)


def _wait_for_rehearsals() -> int:
    """Return how many are under way, once as many as may be are in the middle of it."""
    from django.conf import settings

    from execution.models import Rehearsal

    limit = time.monotonic() + 60
    wanted = min(REHEARSALS, settings.VIPO_REHEARSALS_AT_ONCE)
    while (found := Rehearsal.objects.exclude(course={}).count()) < wanted:
        if time.monotonic() > limit:
            raise RuntimeError("The rehearsals have not begun.")
        time.sleep(0.1)
    return found


def _children_seconds(worker: int) -> float:
    """Return the processor time of the processes that rehearse."""
    tasks = Path(f"/proc/{worker}/task").glob("*/children")
    return sum(cpu_seconds(int(pid)) for file in tasks for pid in file.read_text().split())


if __name__ == "__main__":
    for found in _measure_here():
        print(json.dumps(found), flush=True)

"""Celery tasks: harmless when they run twice, never waiting for a robot, and short, save rehearsals and archiving."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from celery import current_task, shared_task
from celery.signals import worker_shutting_down

from execution.errors import StepConflict
from execution.floor.advance import advance_site as step_site
from execution.mailbox import REQUEST_HEADER
from execution.rehearsals import worker
from execution.retention import upkeep
from execution.runs.advance import advance_run as step_run
from vipo_device.kit.log_ids import LogId, bind_ids


@contextmanager
def _at(name: LogId, value: str) -> Iterator[None]:
    """Let what is logged meanwhile say what it belongs to."""
    request = (current_task.request.get("headers") or {}).get(REQUEST_HEADER, "") if current_task else ""
    with bind_ids({name: value, "request": request}):
        yield


@shared_task(name="execution.tasks.advance_run", ignore_result=True)  # type: ignore[untyped-decorator]
def advance_run(run_id: str) -> bool:
    """Bring a run up to date."""
    with _at("run", run_id):
        try:
            return step_run(run_id)
        except StepConflict:
            return False


@shared_task(name="execution.tasks.advance_site", ignore_result=True)  # type: ignore[untyped-decorator]
def advance_site(slug: str) -> bool:
    """Bring a site's floor up to date."""
    with _at("site", slug):
        try:
            return step_site(slug)
        except StepConflict:
            return False


@shared_task(name="execution.tasks.rehearse", ignore_result=True)  # type: ignore[untyped-decorator]
def rehearse(_hint: str) -> int:
    """Carry out the rehearsals that wait, each in a process of its own; which one is next the database knows."""
    return worker.carry_out_waiting()


@shared_task(name=upkeep.ARCHIVE_OLD, ignore_result=True)  # type: ignore[untyped-decorator]
def archive_old(_hint: str) -> None:
    """Put into the archive what is older than its site keeps it; what is left when time runs out is for the next."""
    if upkeep.archive_old():
        upkeep.ask_for_archiving()


@worker_shutting_down.connect  # type: ignore[untyped-decorator]
def give_rehearsals_back(**_told: Any) -> None:
    """Let what is rehearsed here go back into the queue: nobody waits ten minutes for a process to end."""
    worker.stopping.set()

"""Celery tasks: harmless when they run twice, and lost without harm."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from typing import Any

from celery import current_task, shared_task
from celery.signals import worker_init, worker_process_init, worker_shutting_down

from execution import mailbox
from execution.engine.drive import drive_site as drive
from execution.engine.drive import leave
from execution.errors import NotFound
from execution.pool_children import end_of_worker
from execution.program_tests.test_runs import queue_named_versions
from execution.rehearsals import worker
from execution.retention import upkeep
from execution.runs.runs import site_of_run
from execution.ticker.mail import send_due_mail
from vipo_device.kit.log_ids import LogId, bind_ids


@contextmanager
def _at(name: LogId, value: str) -> Iterator[None]:
    """Let what is logged meanwhile say what it belongs to."""
    request = (current_task.request.get("headers") or {}).get(mailbox.REQUEST_HEADER, "") if current_task else ""
    with bind_ids({name: value, "request": request}):
        yield


@shared_task(name=mailbox.DRIVE_SITE, ignore_result=True)  # type: ignore[untyped-decorator]
def drive_site(slug: str) -> bool:
    """Carry out a site's runs while there is work; done by one process at a time."""
    with _at("site", slug):
        return drive(slug)


@shared_task(name="execution.tasks.advance_site", ignore_result=True)  # type: ignore[untyped-decorator]
def advance_site(slug: str) -> None:
    """Wake a site's owner: the version before sent this, and it may still stand in the queue."""
    mailbox.hint_now(slug)


@shared_task(name="execution.tasks.advance_run", ignore_result=True)  # type: ignore[untyped-decorator]
def advance_run(run_id: str) -> None:
    """Wake the owner of a run's site, as `advance_site` does."""
    with suppress(NotFound):
        mailbox.hint_now(site_of_run(run_id=run_id))


@worker_init.connect  # type: ignore[untyped-decorator]
def prepare_pool(**_more: Any) -> None:
    """See to it that child processes, where the worker has a pool of them, will hear of its end."""
    end_of_worker.prepare()


@worker_process_init.connect  # type: ignore[untyped-decorator]
def follow_worker(**_more: Any) -> None:
    """Hand over, in a child process, when its worker is to end."""
    end_of_worker.listen(_leave_all)


@worker_shutting_down.connect  # type: ignore[untyped-decorator]
def hand_over(**_more: Any) -> None:
    """Hand every site over, and let what is rehearsed go back into the queue, before the worker waits for its tasks."""
    end_of_worker.say()
    _leave_all()


def _leave_all() -> None:
    worker.stopping.set()
    leave()


@shared_task(name="execution.tasks.rehearse", ignore_result=True)  # type: ignore[untyped-decorator]
def rehearse(_hint: str) -> int:
    """Carry out the rehearsals that wait, each in a process of its own; which one is next the database knows.

    The tests of versions that were named come into the queue here.
    """
    queue_named_versions()
    return worker.carry_out_waiting()


@shared_task(name=upkeep.ARCHIVE_OLD, ignore_result=True)  # type: ignore[untyped-decorator]
def archive_old(_hint: str) -> None:
    """Put into the archive what is older than its site keeps it; what is left when time runs out is for the next."""
    if upkeep.archive_old():
        upkeep.ask_for_archiving()


@shared_task(name=mailbox.SEND_MAIL, ignore_result=True)  # type: ignore[untyped-decorator]
def send_mail(_hint: str) -> int:
    """Send what waits to be told by e-mail; the database knows what, and to whom."""
    return send_due_mail(datetime.now(UTC))

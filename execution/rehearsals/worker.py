"""What a worker of the queue `rehearsals` does: takes what waits in its turn, and looks after the child that rehearses.

A rehearsal belongs to whoever's `claim` its row has. Each half second the worker writes how far it is, if the row is
still its own: so a cancellation, made by any process, ends the child within a second; and a worker that was frozen,
whose rehearsal another one has taken meanwhile, changes nothing.
"""

from __future__ import annotations

import logging
import os
import socket
import threading
import time
from collections.abc import Callable, Mapping
from datetime import timedelta
from typing import Any, TypeVar
from uuid import UUID, uuid4

from django.conf import settings
from django.db import InterfaceError, OperationalError, connection, transaction
from django.db.models import F
from django.db.models.functions import Now

from execution import mailbox
from execution.models import Rehearsal
from execution.rehearsals.rehearsals import lock_queue, order_of_queue, publish_rehearsal
from execution.rehearsals.running_child import RunningChild
from execution.rehearsals.test_results import keep_results

log = logging.getLogger(__name__)
LOOK_S = 0.1
BEAT_S = 0.5
SILENT_S = 60.0
"""A child that has said nothing for so long, though it had a processor, is frozen; a large site takes a few seconds."""
GRACE_S = 15.0
"""A child ends itself when its time is over, with what it has found; one that says nothing for so long then is ended.

Whoever says how far it is looks at its time, too; so only silence is a sign that a child will not end itself.
"""
DEAD_AFTER = timedelta(seconds=15)
LOST_AFTER = timedelta(seconds=5)
MOST_TRIES = 2
"""A rehearsal whose worker has died is begun anew once: it may be what the worker has died of."""
DIED = "The process that rehearsed it has died. Start it again."
MACHINE = socket.gethostname()
MIB = 1024 * 1024
CHILDREN: Mapping[str, str] = {
    Rehearsal.Kind.REHEARSAL: "execution.rehearsals.child_process",
    Rehearsal.Kind.TESTS: "execution.trials.child_process",
}
"""The module that carries out each kind of what is in the queue."""
ProgressJson = Mapping[str, Any]
Answer = TypeVar("Answer")
stopping = threading.Event()
"""Set when this process is to end: what it rehearses goes back to where it stood in the queue."""


def carry_out_waiting() -> int:
    """Carry out what waits, in fair order, while this machine has a place free; returns how many were begun."""
    count = 0
    while not stopping.is_set() and (row := claim_next()) is not None:
        count += 1
        carry_out(row)
    return count


def claim_next() -> Rehearsal | None:
    """Take the rehearsal whose turn it is; None when none waits or as many as may are under way on this machine."""
    with transaction.atomic():
        lock_queue()
        here = Rehearsal.objects.filter(status=Rehearsal.Status.RUNNING, machine=MACHINE).count()
        if here >= settings.VIPO_REHEARSALS_AT_ONCE:
            return None
        claimed = next(filter(_claim, order_of_queue()), None)
        if claimed is None:
            return None
        row = Rehearsal.objects.select_related("site").get(id=claimed)
    publish_rehearsal(row)
    return row


def _claim(rehearsal_id: UUID) -> bool:
    """Take a rehearsal that still waits: somebody may have cancelled it since the queue was read."""
    return bool(
        Rehearsal.objects.filter(id=rehearsal_id, status=Rehearsal.Status.QUEUED).update(
            status=Rehearsal.Status.RUNNING, claim=uuid4(), machine=MACHINE, tries=F("tries") + 1,
            began_at=Now(), beat_at=Now(), progress=0.0, course={},
        )
    )  # fmt: skip


def carry_out(row: Rehearsal) -> None:
    """Rehearse what was claimed to its end, or until it is cancelled or this process is to end."""
    limits = {
        "wall_s": settings.VIPO_REHEARSAL_LIMIT_S,
        "memory_bytes": settings.VIPO_REHEARSAL_MEMORY_MB * MIB,
        "parent": os.getpid(),
    }
    with RunningChild({**row.job, "limits": limits}, CHILDREN[row.kind]) as child:
        ending = _follow(row, child)
    if ending is not None:
        _end(row, **ending)


def _follow(row: Rehearsal, child: RunningChild) -> dict[str, Any] | None:
    """Return how it ended, as columns of its row; None when the row is not this worker's any more."""
    course: ProgressJson = row.course
    beat_at = time.monotonic()
    while True:
        for line in child.read(LOOK_S):
            if "course" in line:
                course = line["course"]
            elif "begun" not in line:
                return _ending(line)
        if child.has_ended:
            return {"status": Rehearsal.Status.FAILED, "reason": DIED}
        if stopping.is_set():
            return {"status": Rehearsal.Status.QUEUED, "tries": row.tries - 1, "claim": None, "progress": 0.0}
        if reason := _overdue(child, course):
            return {"status": Rehearsal.Status.FAILED, "reason": reason}
        if time.monotonic() - beat_at >= BEAT_S:
            beat_at = time.monotonic()
            if not _beat(row, course):
                return None


def _ending(line: Mapping[str, Any]) -> dict[str, Any]:
    """Return the columns for the last line of a child."""
    if "result" in line:
        result = line["result"]
        waits = result.get("zone_waits", {}) if isinstance(result, dict) else {}
        return {"status": Rehearsal.Status.DONE, "progress": 1.0, "result": result, "zone_waits": waits}
    if "memory" in line:
        megabytes = settings.VIPO_REHEARSAL_MEMORY_MB
        reason = f"It needs more than {megabytes} MB of memory. Rehearse a smaller part of the program."
    else:
        reason = str(line.get("error", ""))[:500]
    return {"status": Rehearsal.Status.FAILED, "reason": reason}


def _overdue(child: RunningChild, course: ProgressJson) -> str:
    """Return why a child is to be ended that does not do so itself; empty when it is not."""
    if child.silence_s > SILENT_S:
        return f"The process that rehearsed it gave no sign for {SILENT_S:g} s and was ended. Start it again."
    if child.age_s > settings.VIPO_REHEARSAL_LIMIT_S + GRACE_S and child.silence_s > GRACE_S:
        minutes, reached = settings.VIPO_REHEARSAL_LIMIT_S / 60, course.get("virtual_s", 0.0)
        return f"It was ended after {minutes:.3g} min, at {reached:.0f} s of simulated time; it may never end."
    return ""


def _beat(row: Rehearsal, course: ProgressJson) -> bool:
    """Say that it goes on and how far it is; False when the row is not this worker's any more."""
    mine = _owned(row)
    progress = float(course.get("share", 0.0))
    is_news = course != row.course
    row.course, row.progress = dict(course), progress
    kept = _through(lambda: mine.update(beat_at=Now(), progress=progress, course=row.course))
    if kept and is_news:
        publish_rehearsal(row)
    return kept != 0


def _end(row: Rehearsal, **columns: Any) -> None:
    """Write how it ended, if the row is still this worker's; a database that is away is waited for."""
    if columns["status"] != Rehearsal.Status.QUEUED:
        columns["ended_at"] = Now()
    while (kept := _through(lambda: _keep(row, columns))) is None and not stopping.wait(1.0):
        pass
    if kept:
        publish_rehearsal(Rehearsal.objects.select_related("site").defer("job").get(id=row.id))


def _keep(row: Rehearsal, columns: Mapping[str, Any]) -> int:
    """Write how it ended; what tests found goes to the tests."""
    found = columns.get("result") if row.kind == Rehearsal.Kind.TESTS else None
    with transaction.atomic():
        kept: int = _owned(row).update(**(columns if found is None else {**columns, "result": None}))
        if kept and found is not None:
            keep_results(rehearsal=row.id, found=found)
    return kept


def _owned(row: Rehearsal) -> Any:
    return Rehearsal.objects.filter(id=row.id, claim=row.claim, status=Rehearsal.Status.RUNNING)


def _through(write: Callable[[], Answer]) -> Answer | None:
    """Return what a statement returns; None when the database is away, for which no rehearsal is given up."""
    try:
        return write()
    except (OperationalError, InterfaceError) as error:
        log.warning("The database does not take how far a rehearsal is: %s", error)
        connection.close()
        return None


def sweep_rehearsals() -> None:
    """Find rehearsals whose worker has died or is frozen, by the database's clock, and those whose hint was lost."""
    dead = Rehearsal.objects.filter(status=Rehearsal.Status.RUNNING, beat_at__lt=Now() - DEAD_AFTER)
    for row in dead.select_related("site").defer("job", "document", "compiled"):
        _take_back(row)
    lost = Rehearsal.objects.filter(status=Rehearsal.Status.QUEUED, created_at__lt=Now() - LOST_AFTER)
    if lost.exists():
        mailbox.send_hint(mailbox.REHEARSE, "")


def _take_back(row: Rehearsal) -> None:
    """Let another worker begin it anew, or end it when that was done before."""
    if row.tries < MOST_TRIES:
        columns: dict[str, Any] = {"status": Rehearsal.Status.QUEUED}
    else:
        columns = {"status": Rehearsal.Status.FAILED, "reason": DIED, "ended_at": Now()}
    if _owned(row).update(**columns, claim=None):
        publish_rehearsal(Rehearsal.objects.select_related("site").defer("job").get(id=row.id))

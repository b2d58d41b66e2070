"""One pass over all sites by one process at a time: finish what was begun, archive what is old, delete its rows.

The lease keeps two processes from doing the same work. That they cannot spoil it is held by the rows of the archives:
who was frozen finds its archive discarded and says nothing of it.
"""

from __future__ import annotations

import logging
import os
import socket
import time
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from uuid import uuid4

from execution import mailbox
from execution.archive.history_file import UnreadableHistory
from execution.job_lease import JobLease
from execution.models import Archive, Lease
from execution.retention.archiver import Overtaken, Turn, archive_next, check_whole, discard
from execution.retention.periods import KINDS, get_keeping, note_trouble
from execution.retention.pruner import prune
from registry import services as registry

log = logging.getLogger(__name__)
ARCHIVE_OLD = "execution.tasks.archive_old"
JOB = "archive"
PASS_S = 240.0
"""After so long a pass ends and asks for another one, so that a worker that is told to end need not wait for days."""
PAUSE_S = 0.02


def ask_for_archiving() -> None:
    """Wake a worker, which looks whether anything is old enough."""
    mailbox.send_hint(ARCHIVE_OLD, "")


class _Hold:
    """This pass's hold on the work: `go_on` raises Overtaken once another process has it, or the time is over."""

    def __init__(self, clock: Callable[[], datetime], until: datetime) -> None:
        self._holder = f"{socket.gethostname()}:{os.getpid()}:{uuid4().hex[:8]}"
        self._lease = JobLease(JOB, self._holder)
        self.clock, self._until = clock, until

    def take(self) -> bool:
        return self._lease.hold(self.clock())

    def go_on(self) -> None:
        if not self._lease.hold(self.clock()):
            raise Overtaken

    @property
    def is_late(self) -> bool:
        return self.clock() >= self._until

    def give_back(self) -> None:
        Lease.objects.filter(name=JOB, holder=self._holder).update(until=self.clock() - timedelta(seconds=1))


def archive_old(*, now: datetime | None = None, pause: Callable[[float], None] = time.sleep) -> bool:
    """Archive what is older than its site keeps it; True when time ran out and there may be more.

    `now` is a moment to look back from, for tests; the database's clock otherwise.
    """
    ahead = registry.read_time() - datetime.now(UTC)

    def clock() -> datetime:
        return datetime.now(UTC) + ahead

    begun = clock()
    hold = _Hold(clock, begun + timedelta(seconds=PASS_S))
    if not hold.take():
        return False
    try:
        left = [_archive_site(slug, hold, now or begun, pause) for slug in registry.list_slugs()]
        return any(left)
    except Overtaken:
        return False
    finally:
        hold.give_back()


def _archive_site(slug: str, hold: _Hold, now: datetime, pause: Callable[[float], None]) -> bool:
    """Archive one site's histories; what keeps it from that is written down, and no row is deleted."""
    turn = Turn(registry.get_site_id(site=slug), slug, now, hold.go_on)

    def breathe() -> None:
        pause(PAUSE_S)
        hold.go_on()

    try:
        _finish(turn, breathe)
        more = _archive_kinds(turn, hold, breathe)
    except (OSError, UnreadableHistory) as error:
        why = (error.strerror or str(error)) if isinstance(error, OSError) else str(error)
        log.warning("The histories of %s cannot be archived: %s", slug, why)
        note_trouble(site=slug, text=why, at=hold.clock())
        return False
    note_trouble(site=slug, text="", at=hold.clock())
    return more


def _finish(turn: Turn, breathe: Callable[[], None]) -> None:
    """Do what a pass before this one has left: files that nobody spoke for go, whole ones are read again and pruned."""
    for archive in Archive.objects.filter(site_id=turn.site).exclude(state=Archive.State.PRUNED).order_by("made_at"):
        if archive.state == Archive.State.WHOLE:
            prune(archive, check_whole(archive, turn.go_on), breathe, turn.now)
        else:
            discard(archive)


def _archive_kinds(turn: Turn, hold: _Hold, breathe: Callable[[], None]) -> bool:
    keeping = get_keeping(site=turn.slug)
    for kind in KINDS:
        before = keeping.limit(kind, turn.now)
        while before is not None:
            turn.go_on()
            if hold.is_late:
                return True
            archive = archive_next(turn, kind, before)
            if archive is None:
                break
            prune(archive, check_whole(archive, turn.go_on), breathe, turn.now)
    return False

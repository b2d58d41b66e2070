"""What happens because time passes: due timers, floors with something under way, hints that were lost, old rows."""

from __future__ import annotations

import logging
import os
import socket
import threading
from collections import defaultdict
from datetime import datetime, timedelta

from django.db import DatabaseError, connection, transaction
from django.db.models import Q

from editor import services as editor
from execution import database, mailbox
from execution.commands.manual_calls import expire_calls
from execution.commands.outbox import drop_stale_controls, end_commands_of_those_out
from execution.floor.stops import follow_stops
from execution.floor_protocol import ToFloor, ToRun
from execution.frozen_sessions import end_frozen_sessions
from execution.job_lease import JobLease
from execution.machine.messages import TimerFired
from execution.models import Run, Timer
from execution.rehearsals.worker import sweep_rehearsals
from execution.retention.upkeep import ask_for_archiving
from execution.runs.terms import call_late
from execution.runs.triggers import start_armed
from execution.ticker.alerts import watch_alerts
from execution.ticker.mail import is_mail_due
from registry import services as registry

TICK_SITES_S = 0.5
SWEEP_S = 1.0
MAIL_S = 60.0
PRUNE_S = 600.0
KEPT_FOR = timedelta(days=2)
LOST_AFTER = timedelta(seconds=1)
HOLDER = f"{socket.gethostname()}:{os.getpid()}"


class Ticker:
    """Called every 0.1 to 0.25 s; does each thing as often as it needs, while it holds the lease."""

    def __init__(self, holder: str = HOLDER) -> None:
        self._lease = JobLease("ticker", holder)
        self._done_at: dict[str, datetime] = {}
        self._leads_since: datetime | None = None

    def tick(self, now: datetime) -> bool:
        """Do what is due; False when another process has the lease."""
        if not self._lease.hold(now):
            self._leads_since = None
            return False
        self._leads_since = self._leads_since or now
        if self._is_due("frozen", SWEEP_S, now):
            end_frozen_sessions()
        fire_timers(now)
        if self._is_due("sites", TICK_SITES_S, now):
            mailbox.hint_watching()
            start_armed(now=now)
        if self._is_due("sweep", SWEEP_S, now):
            sweep(now)
            for view in registry.mark_stale(now=now):
                registry.note_samples(view=view, at=now)
                mailbox.hint_now(view.site)
            registry.flush_samples()
            watch_alerts(now=now, since=self._leads_since)
        if self._is_due("mail", MAIL_S, now) and is_mail_due(now):
            mailbox.send_hint(mailbox.SEND_MAIL, "")
        if self._is_due("prune", PRUNE_S, now):
            mailbox.forget_taken(now - KEPT_FOR)
            ask_for_archiving()
            registry.prune_samples(now=now)
            registry.prune_alerts(now=now)
            registry.prune_tokens(now=now)
            registry.prune_invitations(now=now)
            registry.prune_wall_screens(now=now)
            registry.prune_audit(now=now)
            registry.prune_keyed_requests(now=now)
            registry.drop_expired(now=now)
            registry.forget_attempts(now=now)
            registry.forget_sign_ons(now=now)
            registry.prune_processes()
        return True

    def _is_due(self, what: str, every_s: float, now: datetime) -> bool:
        last = self._done_at.get(what)
        if last is not None and (now - last).total_seconds() < every_s:
            return False
        self._done_at[what] = now
        return True


def fire_timers(now: datetime) -> int:
    """Turn due timers into events, the earliest first; returns how many."""
    if not _is_timer_due(now):  # ten times a second, so it costs no transaction
        return 0
    with transaction.atomic():
        rows = Timer.objects.select_for_update(skip_locked=True, of=("self",)).filter(due_at__lte=now)
        rows = rows.select_related("run__site").only("timer", "due_at", "run__site__slug")
        due = list(rows.order_by("due_at", "timer")[:500])
        fired: defaultdict[str, list[tuple[str, str, ToFloor | ToRun]]] = defaultdict(list)
        for row in due:
            message = (mailbox.run_target(row.run_id), f"timer:{row.run_id}:{row.timer}", TimerFired(row.timer))
            fired[row.run.site.slug].append(message)
        for site, messages in fired.items():
            mailbox.post(site, messages)
        Timer.objects.filter(id__in=[row.id for row in due]).delete()
    return len(due)


def _is_timer_due(now: datetime) -> bool:
    with database.preparing_cursor() as cursor:
        when = connection.ops.adapt_datetimefield_value(now)
        cursor.execute("SELECT 1 FROM execution_timer WHERE due_at <= %s LIMIT 1", [when])
        return cursor.fetchone() is not None


def sweep(now: datetime) -> None:
    """Find what was left lying because a message was lost or a worker died."""
    mailbox.hint_left(now - LOST_AFTER)
    pending = Run.objects.filter(status=Run.Status.PENDING, created_at__lt=now - LOST_AFTER)
    pending = pending.filter(Q(not_before=None) | Q(not_before__lte=now))
    for site in pending.values_list("site__slug", flat=True).distinct():
        mailbox.hint_now(site)
    call_late(now)
    follow_stops()
    drop_stale_controls(now)
    end_commands_of_those_out(now)
    expire_calls(now=now)
    sweep_rehearsals()
    if editor.has_versions_to_test():
        mailbox.send_hint(mailbox.REHEARSE, "")


_ticker = Ticker()


def tick(now: datetime) -> bool:
    """Do what is due by the clock in this process; False when another process does it."""
    return _ticker.tick(now)


log = logging.getLogger(__name__)
TICK_S = 0.1
IDLE_S = 1.0


def run_ticker(*, stopping: threading.Event, heartbeat: registry.HeartbeatWriter | None = None) -> None:
    """Tick until `stopping` is set; a database that is away is waited for. Each tick is told to the `heartbeat`."""
    leads = False
    while not stopping.is_set():
        if heartbeat is not None:
            heartbeat.beat("leads" if leads else "stands_by")
        try:
            leads = tick(database.now())
        except DatabaseError as error:
            log.warning("The ticker's database does not answer: %s", error)
            connection.close()
            leads = False
        except Exception:  # the edge of the process: without the ticker no timer would ever fire
            log.exception("The ticker failed; it goes on.")
            leads = False
        stopping.wait(TICK_S if leads else IDLE_S)
    connection.close()

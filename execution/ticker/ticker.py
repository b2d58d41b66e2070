"""What happens because time passes: due timers, floors with something under way, hints that were lost, old rows."""

from __future__ import annotations

import logging
import os
import socket
import threading
from collections import defaultdict
from collections.abc import Callable
from datetime import datetime, timedelta
from functools import partial

from django.db import DatabaseError, InterfaceError, connection, transaction

from editor import services as editor
from execution import database, mailbox
from execution.commands.manual_calls import expire_calls
from execution.commands.outbox import drop_stale_controls, end_commands_of_runs_over, end_commands_of_those_out
from execution.floor.stops import follow_stops
from execution.floor_protocol import ToFloor, ToRun
from execution.frozen_sessions import end_frozen_sessions
from execution.job_lease import JobLease
from execution.machine.messages import TimerFired
from execution.models import Timer
from execution.rehearsals.worker import sweep_rehearsals
from execution.retention.upkeep import ask_for_archiving
from execution.runs.before_start import due_runs
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
PRUNES = (
    registry.prune_alerts,
    registry.prune_tokens,
    registry.prune_invitations,
    registry.prune_wall_screens,
    registry.prune_audit,
    registry.prune_keyed_requests,
    registry.drop_expired,
    registry.forget_attempts,
    registry.forget_sign_ons,
)
HOLDER = f"{socket.gethostname()}:{os.getpid()}"


class Ticker:
    """Called every 0.1 to 0.25 s; does each thing as often as it needs, while it holds the lease."""

    def __init__(self, holder: str = HOLDER) -> None:
        self._lease = JobLease("ticker", holder)
        self._done_at: dict[str, datetime] = {}
        self._leads_since: datetime | None = None
        self._has_old_samples = False

    def tick(self, now: datetime) -> bool:
        """Do what is due; False when another process has the lease."""
        if not self._lease.hold(now):
            self._leads_since = None
            return False
        self._leads_since = min(self._leads_since or now, now)
        if self._is_due("frozen", SWEEP_S, now):
            _do_each(end_frozen_sessions)
        _do_each(partial(fire_timers, now))
        if self._is_due("sites", TICK_SITES_S, now):
            _do_each(mailbox.hint_watching, partial(start_armed, now=now))
        if self._is_due("sweep", SWEEP_S, now):
            sweep(now)
            alerts = partial(watch_alerts, now=now, since=self._leads_since)
            _do_each(partial(_mark_stale, now), registry.flush_samples, alerts)
        if self._is_due("mail", MAIL_S, now):
            _do_each(partial(_ask_for_mail, now))
        if self._is_due("samples", SWEEP_S if self._has_old_samples else PRUNE_S, now):
            _do_each(partial(self._prune_samples, now))
        if self._is_due("prune", PRUNE_S, now):
            _prune(now)
        return True

    def _prune_samples(self, now: datetime) -> None:
        self._has_old_samples = not registry.prune_samples(now=now)

    def _is_due(self, what: str, every_s: float, now: datetime) -> bool:
        last = self._done_at.get(what)
        if last is not None and 0 <= (now - last).total_seconds() < every_s:  # less than 0: the clock was put back
            return False
        self._done_at[what] = now
        return True


def _do_each(*steps: Callable[[], object]) -> None:
    """Do one thing after the other; one that fails is written into the log and keeps no other from its turn.

    A step is a function, or a `partial` of one. Raises what it does where the database is away.
    """
    for step in steps:
        function = step.func if isinstance(step, partial) else step
        with database.kept_apart(f"A step of the ticker ({function.__qualname__})"):
            step()


def _mark_stale(now: datetime) -> None:
    for view in registry.mark_stale(now=now):
        mailbox.hint_now(view.site)


def _ask_for_mail(now: datetime) -> None:
    if is_mail_due(now):
        mailbox.send_hint(mailbox.SEND_MAIL, "")


def _prune(now: datetime) -> None:
    _do_each(partial(mailbox.forget_taken, now - KEPT_FOR), ask_for_archiving, registry.prune_processes)
    _do_each(*(partial(prune, now=now) for prune in PRUNES))


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
    _do_each(
        partial(mailbox.hint_left, now - LOST_AFTER),
        partial(_hint_pending, now),
        partial(call_late, now),
        follow_stops,
        partial(drop_stale_controls, now),
        partial(end_commands_of_those_out, now),
        partial(end_commands_of_runs_over, now),
        partial(expire_calls, now=now),
        sweep_rehearsals,
        _ask_for_tests,
    )


def _ask_for_tests() -> None:
    if editor.has_versions_to_test():
        mailbox.send_hint(mailbox.REHEARSE, "")


def _hint_pending(now: datetime) -> None:
    """Call the owners of sites for runs whose call was lost, and for those whose time has come."""
    pending = due_runs(created_before=now - LOST_AFTER, due_by=now)
    for site in pending.values_list("site__slug", flat=True).distinct():
        mailbox.hint_now(site)


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
        except (DatabaseError, InterfaceError) as error:
            log.warning("The ticker's database does not answer: %s", error)
            connection.close()
            leads = False
        except Exception:  # the edge of the process: without the ticker no timer would ever fire
            log.exception("The ticker failed; it goes on.")
            leads = False
        stopping.wait(TICK_S if leads else IDLE_S)
    connection.close()

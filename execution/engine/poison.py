"""What the database does not take what comes of, a message or a run's own going on: set aside past runs and floor."""

from __future__ import annotations

from datetime import datetime

from django.db import transaction

from execution import database, mailbox
from execution.engine import lease as leases
from execution.engine.commit import dead_notice, refused_runs
from execution.engine.dead_letter_capture import pause_by_hand, pause_for, words_of
from execution.engine.inbox import Row, mark_taken
from execution.engine.lease import Lease
from execution.engine.turn import Turn
from execution.models import DeadLetter, Run, RunEvent
from execution.runs.fold import RunWork
from execution.runs.journal import Journal, shown
from registry import services as registry


def set_row_aside(row: Row, lease: Lease, now: datetime, error: Exception) -> None:
    """Set one message aside and pause its run, in a transaction of its own; raises LeaseLost.

    The run's row alone keeps it paused whatever it is told next: its machine follows the row before it hears anything.
    Where nobody tells it anything its robots would drive on, so a pause is posted for its machine and the floor to
    take in at once. None follows a pause that was set aside, since it might be set aside like that, and so for ever.
    """
    kind, _, name = row.target.partition(":")
    words = words_of(error).replace("\x00", "")
    event = row.payload if isinstance(row.payload, dict) else {"type": "unreadable"}
    with transaction.atomic():
        leases.hold(lease)
        run = Run.objects.select_related("site").filter(id=name).first() if kind == "run" else None
        DeadLetter.objects.create(site_id=lease.site, run=run, target=row.target, event=event, error=words, at=now)
        journal = pause_by_hand(run, words, now) if run is not None and run.status in Run.OPEN else None
        if run is not None and journal is not None:
            _keep(run, journal)
            if event.get("type") != "pause":
                mailbox.post_to_run(run.site.slug, run.id, [(f"aside:{row.id}", pause_for(words))])
        with database.sent_together() as batch:
            mark_taken(batch, [row.id], now)


def set_run_aside(turn: Turn, lease: Lease) -> bool:
    """Set aside that a run begins or goes on where the database does not take what it has come to by itself.

    False where there is no such run, or it may be due to a message to it. A run that could not begin is as one that was
    paused before its start; who resumed it is told so by its reason, and that order is taken in. Raises LeaseLost.
    """
    for work, error in refused_runs(turn):
        own = [row for row in turn.rows if row.target == mailbox.run_target(work.id)]
        begins = work.row.started_at == turn.now
        if (begins or not own) and _set_aside(work, own if begins else [], turn, lease, error):
            return True
    return False


def _set_aside(work: RunWork, told: list[Row], turn: Turn, lease: Lease, error: Exception) -> bool:
    """Pause a run in a transaction of its own; False if it is paused for this already and nobody has resumed it."""
    words = words_of(error).replace("\x00", "")
    begins = work.row.started_at == turn.now
    resumes = [row.id for row in told if isinstance(row.payload, dict) and row.payload.get("type") == "resume"]
    with transaction.atomic():
        leases.hold(lease)
        run = Run.objects.select_related("site").get(id=work.row.pk)
        journal = pause_by_hand(run, words, turn.now) if run.status in Run.OPEN else None
        if journal is None and not resumes:
            return False
        event = {"type": "start" if begins else "step"}
        target = mailbox.run_target(run.id)
        letter = DeadLetter.objects.create(
            site_id=lease.site, run=run, target=target, event=event, error=words, at=turn.now
        )
        lines = _keep(run, journal) if journal is not None else []
        if not begins:
            mailbox.post_to_run(run.site.slug, run.id, [(f"letter:{letter.id}", pause_for(words))])
        with database.sent_together() as batch:
            mark_taken(batch, resumes, turn.now)
    said = [*shown(run, lines), dead_notice(str(run.id), words)]
    registry.publish_all([(run.site.slug, message) for message in said])
    return True


def _keep(run: Run, journal: Journal) -> list[RunEvent]:
    """Write a run that was paused by hand, and its lines."""
    lines = journal.close()
    RunEvent.objects.bulk_create(lines)
    run.save(update_fields=["status", "reason", "next_seq", "steps", "roles"])
    return lines

"""A run of which nothing has begun, since it waits for its time or was set aside: it is paused, resumed, cancelled."""

from __future__ import annotations

from datetime import datetime

from django.db.models import Q, QuerySet

from editor import services as editor
from execution.floor_protocol import DeadlinePassed, ResumeAsked, ToRun
from execution.machine.messages import CancelAsked, PauseAsked
from execution.models import Run
from execution.runs import notices
from execution.runs.journal import Journal, describe


def is_before_start(run: Run) -> bool:
    """Tell whether a run was planned for later and has not begun, or could not begin when it should."""
    return run.started_at is None and (run.not_before is not None or run.status == Run.Status.PAUSED)


def may_begin(run: Run, now: datetime) -> bool:
    """Tell whether a run goes on, or begins, now; one that is over or paused before its start does not."""
    if run.status not in Run.OPEN:
        return False
    if not is_before_start(run):
        return True
    return run.status == Run.Status.PENDING and (run.not_before is None or run.not_before <= now)


def due_runs(*, created_before: datetime, due_by: datetime) -> QuerySet[Run]:
    """Return the runs of all sites that have not begun though they might.

    They were created before the one time, and what was planned for later was to begin at the other at the latest.
    """
    waiting = Run.objects.filter(status=Run.Status.PENDING, created_at__lt=created_before)
    return waiting.filter(Q(not_before=None) | Q(not_before__lte=due_by))


def is_admitted(run: Run) -> bool:
    """Tell whether a planned run may begin by the approvals that its site demands now."""
    if run.permit.get("emergency"):
        return True
    document = Run.objects.values_list("document", flat=True).get(pk=run.pk)
    return editor.is_admitted(site=run.site.slug, program_id=run.program, document=document)


def ingest(run: Run, journal: Journal, messages: list[ToRun]) -> None:
    """Do what people want of a run before its start; a Cancel that arrives together with the start comes before it."""
    for message in messages:
        match message:
            case CancelAsked(reason=why) if run.status in Run.OPEN:
                run.status, run.reason, run.ended_at = Run.Status.CANCELLED, why, journal.now
                journal.say("run", describe("cancelled", why), code="cancelled")
            case PauseAsked(reason=why) if run.status == Run.Status.PENDING:
                run.status, run.reason = Run.Status.PAUSED, why
                journal.say("run", describe("paused", why), code="paused")
            case ResumeAsked() if run.status == Run.Status.PAUSED:
                run.status, run.reason = Run.Status.PENDING, ""
                journal.say("run", "The run waits for its time again.", code="waits_again")
            case DeadlinePassed() if run.status in Run.OPEN:
                notices.tell_late(run, journal)
            case _:
                journal.note(message)

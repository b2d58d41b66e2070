"""Celery tasks: short, harmless when they run twice, and never waiting for a robot."""

from __future__ import annotations

from celery import shared_task

from execution.errors import StepConflict
from execution.floor.advance import advance_site as step_site
from execution.rehearsals.rehearsals import carry_out
from execution.runs.advance import advance_run as step_run


@shared_task(name="execution.tasks.advance_run", ignore_result=True)  # type: ignore[untyped-decorator]
def advance_run(run_id: str) -> bool:
    """Bring a run up to date."""
    try:
        return step_run(run_id)
    except StepConflict:
        return False


@shared_task(name="execution.tasks.advance_site", ignore_result=True)  # type: ignore[untyped-decorator]
def advance_site(slug: str) -> bool:
    """Bring a site's floor up to date."""
    try:
        return step_site(slug)
    except StepConflict:
        return False


@shared_task(name="execution.tasks.rehearse", ignore_result=True)  # type: ignore[untyped-decorator]
def rehearse(rehearsal_id: str) -> bool:
    """Carry out a rehearsal in a process of its own."""
    return carry_out(rehearsal_id)

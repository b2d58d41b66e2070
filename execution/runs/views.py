"""Runs, events and rehearsals as JSON, in the shapes of docs/architecture.md."""

from __future__ import annotations

from typing import Any

from execution.models import ArmedProgram, Question, Rehearsal, Run, RunEvent
from execution.reasons import cause_of

WITH_CAUSE = frozenset({"failed", "cancelled", "paused"})
WELL = frozenset({"step_entered", "step_done"})


def run_to_json(run: Run) -> dict[str, Any]:
    """Return a run without its document."""
    return {
        "id": str(run.id),
        "number": run.number,
        "program": {"id": str(run.program), "name": run.program_name},
        "site": run.site.slug,
        "version": run.version,
        "status": run.status,
        "reason": run.reason,
        "cause": cause_of(run.reason),
        "created_at": run.created_at.isoformat(),
        "started_at": run.started_at.isoformat() if run.started_at else None,
        "ended_at": run.ended_at.isoformat() if run.ended_at else None,
        "started_by": run.started_by,
        "steps": run.steps,
        "roles": run.roles,
    }


def event_to_json(event: RunEvent) -> dict[str, Any]:
    """Return a line of the journal."""
    return {
        "seq": event.seq,
        "at": event.at.isoformat(),
        "t_s": event.t_s,
        "kind": event.kind,
        "step": event.step,
        "device": event.device,
        "robot": event.robot,
        "text": event.text,
        "cause": _cause_of_event(event),
        "code": event.code,
        "args": event.args,
    }


def _cause_of_event(event: RunEvent) -> dict[str, Any] | None:
    """Return why a step was not done, or a run ended or paused, as an event tells it."""
    if event.kind == "run":
        return cause_of(event.text.partition(": ")[2]) if event.code in WITH_CAUSE else None
    return cause_of(event.text) if event.kind == "step" and event.code not in WELL else None


def question_to_json(question: Question) -> dict[str, Any]:
    """Return a question with its answer, if there is one."""
    run = question.run
    return {
        "id": str(question.id),
        "run": str(run.id),
        "run_number": run.number,
        "program": {"id": str(run.program), "name": run.program_name},
        "site": run.site.slug,
        "step": question.step,
        "text": question.text,
        "answer": question.answer,
        "state": question.state,
        "value": question.value,
        "asked_at": question.asked_at.isoformat(),
        "answered_by": question.answered_by,
        "answered_at": question.answered_at.isoformat() if question.answered_at else None,
    }


def armed_to_json(armed: ArmedProgram) -> dict[str, Any]:
    """Return which version of a program starts by itself, and who wanted that."""
    version = armed.prepared["version"]
    return {"program": str(armed.program), "version": version, "by": armed.by, "at": armed.at.isoformat()}


def rehearsal_to_json(rehearsal: Rehearsal) -> dict[str, Any]:
    """Return a rehearsal with its result, if there is one."""
    return {
        "id": str(rehearsal.id),
        "program": str(rehearsal.program),
        "status": rehearsal.status,
        "progress": rehearsal.progress,
        "reason": rehearsal.reason,
        "result": rehearsal.result,
        "document": rehearsal.document,
        "compiled": rehearsal.compiled,
        "created_at": rehearsal.created_at.isoformat(),
    }

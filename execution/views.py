"""What execution's services hand out: frozen, free of the database; and how the API and the sockets say it as JSON."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Any
from uuid import UUID

from execution.models import ArmedProgram, Command, Question, Run, RunEvent
from execution.reasons import cause_of
from vipo_device.protocol.description import Scalar

WITH_CAUSE = frozenset({"failed", "cancelled", "paused"})
WELL = frozenset({"step_entered", "step_done"})
PRIORITIES: Mapping[str, int] = {"low": -1, "normal": 0, "high": 1}
PRIORITY_NAMES: Mapping[int, str] = {number: name for name, number in PRIORITIES.items()}
LATE = "The device took longer than it may. Look what it is doing."


@dataclass(frozen=True, slots=True)
class RunView:
    """A run without its document; `steps` says how far each step is, `roles` which robot has which role.

    Of one that `is_archived` lists have no steps; by itself it has them, from the archive.
    """

    id: UUID
    number: int
    program: UUID
    program_name: str
    site: str
    version: int
    status: str
    reason: str
    created_at: datetime
    started_at: datetime | None
    ended_at: datetime | None
    started_by: str
    steps: Mapping[str, Mapping[str, Any]]
    roles: Mapping[str, str]
    priority: str = "normal"
    not_before: datetime | None = None
    deadline: datetime | None = None
    is_archived: bool = False
    permit: Mapping[str, Any] = field(default_factory=dict)

    @property
    def cause(self) -> dict[str, Any] | None:
        """Why it ended or waits, for screens to say."""
        return cause_of(self.reason)


@dataclass(frozen=True, slots=True)
class WholeRunView:
    """A run with the program as it was when it was started, both as JSON."""

    run: RunView
    document: Mapping[str, Any]
    compiled: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class RunEventView:
    """One line of a run's journal; `t_s` counts from the run's start."""

    seq: int
    at: datetime
    t_s: float
    kind: str
    step: str
    device: str
    robot: str
    text: str
    code: str
    args: Mapping[str, Any]

    @property
    def cause(self) -> dict[str, Any] | None:
        """Why a step was not done, or a run ended or paused."""
        if self.kind == "run":
            return cause_of(self.text.partition(": ")[2]) if self.code in WITH_CAUSE else None
        return cause_of(self.text) if self.kind == "step" and self.code not in WELL else None


@dataclass(frozen=True, slots=True)
class QuestionView:
    """Something that a run asks people; `answer` says what fits, `value` is the answer once there is one."""

    id: UUID
    run: UUID
    run_number: int
    program: UUID
    program_name: str
    site: str
    step: str
    text: str
    answer: Mapping[str, Any]
    state: str
    value: Scalar
    asked_at: datetime
    answered_by: str
    answered_at: datetime | None


@dataclass(frozen=True, slots=True)
class ArmedView:
    """Which version of a program starts by itself, and who wanted that."""

    program: UUID
    version: int
    by: str
    at: datetime


@dataclass(frozen=True, slots=True)
class CallView:
    """Something that a person told a device to do; `is_over` once nothing more will come of it."""

    id: UUID
    device: str
    method: str
    arguments: Mapping[str, Any]
    by: str
    status: str
    is_over: bool
    why: str
    result: Mapping[str, Scalar]
    created_at: datetime
    expires_at: datetime
    sent_at: datetime | None
    ended_at: datetime | None

    @property
    def cause(self) -> dict[str, Any] | None:
        """Why it ended or waits, for screens to say."""
        return cause_of(self.why)


@dataclass(frozen=True, slots=True)
class RouteView:
    """The way that a robot would drive, as a drawn line in metres."""

    path: tuple[tuple[float, float], ...]
    length_m: float
    seconds: int


def view_run(row: Run) -> RunView:
    """Return the view of a run's row, whose document may be left out."""
    return RunView(
        id=row.id,
        number=row.number,
        program=row.program,
        program_name=row.program_name,
        site=row.site.slug,
        version=row.version,
        status=row.status,
        reason=row.reason,
        created_at=row.created_at,
        started_at=row.started_at,
        ended_at=row.ended_at,
        started_by=row.started_by,
        steps=row.steps,
        roles=row.roles,
        priority=PRIORITY_NAMES[row.priority],
        not_before=row.not_before,
        deadline=row.deadline,
        is_archived=row.archive_id is not None,
        permit=row.permit,
    )


def view_event(row: RunEvent) -> RunEventView:
    """Return the view of a line of the journal."""
    return RunEventView(
        row.seq, row.at, row.t_s, row.kind, row.step, row.device, row.robot, row.text, row.code, row.args
    )


def view_question(row: Question) -> QuestionView:
    """Return the view of a question's row."""
    return QuestionView(
        id=row.id,
        run=row.run.id,
        run_number=row.run.number,
        program=row.run.program,
        program_name=row.run.program_name,
        site=row.run.site.slug,
        step=row.step,
        text=row.text,
        answer=row.answer,
        state=row.state,
        value=row.value,
        asked_at=row.asked_at,
        answered_by=row.answered_by,
        answered_at=row.answered_at,
    )


def view_armed(row: ArmedProgram) -> ArmedView:
    """Return the view of an armed program's row."""
    return ArmedView(row.program, row.prepared["version"], row.by, row.at)


def view_call(row: Command) -> CallView:
    """Return the view of a command that a person gave."""
    return CallView(
        id=row.id,
        device=row.device,
        method=row.method,
        arguments=row.arguments,
        by=row.by,
        status=row.status,
        is_over=row.status not in Command.OPEN,
        why=row.why or (LATE if row.status == Command.Status.TIMED_OUT else ""),
        result=row.result,
        created_at=row.created_at,
        expires_at=row.created_at + timedelta(seconds=row.ttl_s),
        sent_at=row.sent_at,
        ended_at=row.ended_at,
    )


def run_to_json(run: RunView) -> dict[str, Any]:
    """Return a run as lists and live messages have it."""
    return {
        "id": str(run.id),
        "number": run.number,
        "program": {"id": str(run.program), "name": run.program_name},
        "site": run.site,
        "version": run.version,
        "status": run.status,
        "reason": run.reason,
        "cause": run.cause,
        "created_at": run.created_at.isoformat(),
        "started_at": iso(run.started_at),
        "ended_at": iso(run.ended_at),
        "started_by": run.started_by,
        "steps": run.steps,
        "roles": run.roles,
        "priority": run.priority,
        "not_before": iso(run.not_before),
        "deadline": iso(run.deadline),
        "archived": run.is_archived,
        "permit": run.permit or None,
    }


def whole_run_to_json(whole: WholeRunView) -> dict[str, Any]:
    """Return a run with its document and compiled form."""
    return {**run_to_json(whole.run), "document": whole.document, "compiled": whole.compiled}


def event_to_json(event: RunEventView) -> dict[str, Any]:
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
        "cause": event.cause,
        "code": event.code,
        "args": event.args,
    }


def question_to_json(question: QuestionView) -> dict[str, Any]:
    """Return a question with its answer, if there is one."""
    return {
        "id": str(question.id),
        "run": str(question.run),
        "run_number": question.run_number,
        "program": {"id": str(question.program), "name": question.program_name},
        "site": question.site,
        "step": question.step,
        "text": question.text,
        "answer": question.answer,
        "state": question.state,
        "value": question.value,
        "asked_at": question.asked_at.isoformat(),
        "answered_by": question.answered_by,
        "answered_at": iso(question.answered_at),
    }


def armed_to_json(armed: ArmedView) -> dict[str, Any]:
    """Return an armed program."""
    return {"program": str(armed.program), "version": armed.version, "by": armed.by, "at": armed.at.isoformat()}


def call_to_json(call: CallView) -> dict[str, Any]:
    """Return a call and what has come of it."""
    return {
        "id": str(call.id),
        "device": call.device,
        "method": call.method,
        "args": call.arguments,
        "by": call.by,
        "status": call.status,
        "over": call.is_over,
        "why": call.why,
        "cause": call.cause,
        "result": call.result,
        "created_at": call.created_at.isoformat(),
        "expires_at": call.expires_at.isoformat(),
        "sent_at": iso(call.sent_at),
        "ended_at": iso(call.ended_at),
    }


def route_to_json(route: RouteView) -> dict[str, Any]:
    """Return a way for drawing."""
    return {"path": [list(point) for point in route.path], "length_m": route.length_m, "seconds": route.seconds}


def iso(at: datetime | None) -> str | None:
    """Return a moment as JSON says it."""
    return at.isoformat() if at else None

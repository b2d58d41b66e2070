"""What cannot be taken in becomes a dead letter with its error, and its run is paused with the reason."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from typing import Any

from execution.floor.fold import FloorWork
from execution.floor_protocol import ToFloor, to_json
from execution.machine.messages import PauseAsked
from execution.models import Run, RunEvent
from execution.reasons import SENTENCES
from execution.runs.journal import Journal, describe
from execution.traffic import messages as m
from execution.traffic.floor_state import FloorState, FloorTask
from vipo_device.kit.log_ids import LogId

MOST_CHARACTERS = 300
LONGEST_ID = 80


@dataclass(frozen=True, slots=True)
class SetAside:
    """Something that raised: whose inbox it was for, what it says as JSON, and how it failed; `run` may be empty."""

    target: str
    event: Mapping[str, Any]
    error: str
    run: str = ""


@dataclass
class ByHand:
    """A run whose machine cannot be asked, and what was written into its row past it."""

    row: Run
    lines: list[RunEvent] = field(default_factory=list)


def words_of(error: BaseException) -> str:
    """Return an error as people read it."""
    cause = error.__cause__ or error
    return f"{type(cause).__name__}: {cause}"[:MOST_CHARACTERS]


def log_ids_of(event: Mapping[str, Any], run: str) -> dict[LogId, object]:
    """Return what a line about something that was set aside belongs to, as far as the message says it."""
    order = event.get("order")
    said = {"step": order.get("step") if isinstance(order, Mapping) else None, **event}
    names: tuple[LogId, ...] = ("step", "command", "device")
    told = {name: said.get(name) for name in names}
    return {"run": run, **{name: value[:LONGEST_ID] for name, value in told.items() if isinstance(value, str)}}


def pause_for(error: str) -> PauseAsked:
    """Return the order that pauses a run of which something was set aside."""
    return PauseAsked(SENTENCES["set_aside"].format(error=error))


def pause_by_hand(row: Run, error: str, now: datetime) -> Journal | None:
    """Pause a run's row past its machine, which cannot be asked; None if it is paused for this already."""
    reason = pause_for(error).reason[:500]
    if (row.status, row.reason) == (Run.Status.PAUSED, reason):
        return None
    row.status, row.reason = Run.Status.PAUSED, reason
    journal = Journal(row, now, {})
    journal.say("run", describe("paused", reason), code="paused")
    return journal


def cancel_by_hand(row: Run, why: str, now: datetime) -> Journal:
    """End a run past its machine, which cannot be asked."""
    row.status, row.reason, row.ended_at, row.watches = Run.Status.CANCELLED, why[:500], now, False
    journal = Journal(row, now, {})
    journal.say("run", describe("cancelled", why), code="cancelled")
    return journal


def without_tasks_of_one(work: FloorWork) -> Iterator[tuple[str, FloorWork, list[ToFloor]]]:
    """Yield the floor without the tasks of one run, for each run that has some, with what asks for them again."""
    for run in sorted({task.run for task in work.state.tasks}):
        others = tuple(task for task in work.state.tasks if task.run != run)
        asked: list[ToFloor] = [_asking(task, work.state) for task in work.state.tasks if task.run == run]
        yield run, replace(work.fork(), state=replace(work.state, tasks=others)), asked


def _asking(task: FloorTask, state: FloorState) -> m.TaskAsked:
    return m.TaskAsked(
        task.run, task.number, task.order, task.wants, task.can, task.run_name, tuple(state.zones.get(task.run, ())),
        task.where, task.said, task.priority, task.due, task.holds,
    )  # fmt: skip


def several(messages: Sequence[ToFloor]) -> dict[str, Any]:
    """Return several messages to a floor as one event, which is taken apart again when it is retried."""
    return {"type": "several", "messages": [to_json(message) for message in messages]}


def run_of(message: ToFloor, state: FloorState | None) -> str:
    """Return the id of the run that a message to the floor concerns; empty if none is."""
    if isinstance(message, m.CommandAnswered):
        sent = state.sent.get(message.command) if state else None
        return sent.run if sent else ""
    run: str = getattr(message, "run", "")
    return run

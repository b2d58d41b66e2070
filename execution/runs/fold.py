"""What a run makes of what it is told, in memory: nothing here is written, and what raises has changed nothing."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from typing import Any, Literal, assert_never

from editor.language.plan.instructions import Plan
from execution.floor_protocol import AskingRun, DeadlinePassed, ToFloor, ToRun, to_floor, to_json, to_machine
from execution.machine import machine
from execution.machine import messages as r
from execution.machine.floor_task import TaskOrder
from execution.machine.needs import Needs
from execution.machine.state import RunState
from execution.models import Run, RunEvent
from execution.runs import notices
from execution.runs.before_start import ingest, is_before_start, may_begin
from execution.runs.journal import Journal, describe
from execution.traffic.messages import RunPaused, RunResumed, floor_zones
from vipo_device.protocol.description import Scalar

Facts = Mapping[tuple[str, str], Scalar]
REASON_CHARACTERS = 500
GOING_ON = frozenset({"running", "paused"})


class CannotTakeIn(Exception):
    """A run cannot take something in; `what` is the index of a message, or says that it is none of them.

    `pause` is that of its machine, which is to follow the row.
    """

    def __init__(self, what: int | Literal["start", "facts", "pause"]) -> None:
        super().__init__(what)
        self.what = what


@dataclass
class RunWork:
    """An open run in memory with what a turn has made of it so far: lines, orders to the floor, timers, questions.

    `row` has neither document nor plan. `orders` are the tasks of the floor that are under way, kept only where the
    plan reads properties.
    """

    row: Run
    plan: Plan
    needs: Needs
    state: RunState | None
    orders: dict[int, TaskOrder] = field(default_factory=dict)
    is_changed: bool = False
    lines: list[RunEvent] = field(default_factory=list)
    live: list[Mapping[str, Any]] = field(default_factory=list)
    timers: dict[int, float] = field(default_factory=dict)
    dropped_timers: set[int] = field(default_factory=set)
    asked: list[r.AskPeople | r.CancelQuestion] = field(default_factory=list)
    inputs: list[dict[str, Any]] = field(default_factory=list)

    @property
    def id(self) -> str:
        """The run's id."""
        return str(self.row.id)

    @property
    def is_open(self) -> bool:
        """Tell whether the run is not over."""
        return self.row.status in Run.OPEN

    def fork(self) -> RunWork:
        """Return the same to work on; this one stays as it is."""
        row = copy.copy(self.row)
        row.notices = dict(row.notices)
        return replace(
            self,
            row=row,
            orders=dict(self.orders),
            lines=list(self.lines),
            live=list(self.live),
            timers=dict(self.timers),
            dropped_timers=set(self.dropped_timers),
            asked=list(self.asked),
            inputs=list(self.inputs),
        )

    def settled(self) -> RunWork:
        """Return the run after all this was written down."""
        return RunWork(self.row, self.plan, self.needs, self.state, self.orders)


@dataclass
class _Fold:
    """One run taking several messages in."""

    work: RunWork
    journal: Journal
    told: list[ToFloor]
    asking: AskingRun


def fold(
    work: RunWork, facts: Callable[[], Facts], messages: Sequence[ToRun], now: datetime, names: Mapping[str, str]
) -> tuple[RunWork, list[ToFloor]]:
    """Take in all messages, oldest first; return the run after them and what the floor is told.

    Readings come before messages, since a device speaks before it answers. They are asked for if the run has begun, or
    begins now. A run that has not begun takes in what people want and begins, if it may, in a step of its own: before
    that whoever calls looks anew whether it may. Raises CannotTakeIn; the work that was given is as it was.
    """
    new = work.fork()
    fold = _Fold(new, Journal(new.row, now, names), [], _asking(new))
    if is_before_start(new.row) and messages:
        _before_start(fold, messages)
    elif may_begin(new.row, now):
        _take_pause(fold)
        _take_facts(fold, facts)
        for index, message in enumerate(messages):
            _take_message(fold, index, message)
        _close(fold)
    if fold.journal.live or fold.journal.seq != new.row.next_seq:
        new.is_changed = True
    new.lines += fold.journal.close()
    new.live += fold.journal.live
    return new, fold.told


def _asking(work: RunWork) -> AskingRun:
    run, plan = work.row, work.plan
    due = run.deadline.timestamp() if run.deadline else 0.0
    zones = floor_zones(str(run.program), plan.zones)
    return AskingRun(str(run.id), f"run {run.number}", plan.roles, zones, run.priority, due)


def _before_start(fold: _Fold, messages: Sequence[ToRun]) -> None:
    before = (fold.work.row.status, fold.work.row.reason, fold.work.row.late)
    ingest(fold.work.row, fold.journal, list(messages))
    run = fold.work.row
    fold.work.is_changed |= before != (run.status, run.reason, run.late)


def _take_pause(fold: _Fold) -> None:
    """Pause the machine of a run whose row was paused past it; else it would go on without what was set aside."""
    work = fold.work
    if work.state is None or work.row.status != Run.Status.PAUSED or work.state.status != "running":
        return
    try:
        asked = r.PauseAsked(work.row.reason)
        work.inputs.append({"told": to_json(asked)})
        work.state, actions = machine.step(work.plan, work.state, asked)
        work.is_changed = True
        _do(fold, actions)
        fold.told.append(RunPaused(work.id))
    except Exception as error:
        raise CannotTakeIn("pause") from error


def _take_facts(fold: _Fold, facts: Callable[[], Facts]) -> None:
    """Begin the run, or take in what readings are news."""
    work = fold.work
    begins = work.state is None
    try:
        known = facts()
        if work.state is None:
            work.row.started_at = fold.journal.now
            _say_started(fold)
            work.is_changed = True
            work.inputs.append({"start": _listed(known)})
            work.state, actions = machine.start(work.plan, work.row.parameters, known, work.row.entry)
            _do(fold, actions)
            return
        news = {key: value for key, value in known.items() if work.state.facts.get(key) != value}
        if news:
            work.inputs.append({"facts": _listed(news)})
            _tell(fold, r.Facts(news))
    except Exception as error:
        raise CannotTakeIn("start" if begins else "facts") from error


def _listed(facts: Facts) -> list[list[Scalar]]:
    return [[thing, name, value] for (thing, name), value in facts.items()]


def _take_message(fold: _Fold, index: int, message: ToRun) -> None:
    try:
        fold.journal.note(message)
        if isinstance(message, DeadlinePassed):
            notices.tell_late(fold.work.row, fold.journal)
        event = to_machine(message)
        if event is not None:
            if isinstance(event, r.TaskDone | r.TaskFailed):
                fold.work.orders.pop(event.task, None)
            fold.work.inputs.append({"told": to_json(message)})
            _tell(fold, event)
    except Exception as error:
        raise CannotTakeIn(index) from error


def _close(fold: _Fold) -> None:
    """Say in the run's row what its machine has come to."""
    run, state = fold.work.row, fold.work.state
    assert state is not None
    watches = state.status in GOING_ON and _watches(fold.work.plan, state)
    said = (state.status, state.reason[:REASON_CHARACTERS], watches)
    if said != (run.status, run.reason, run.watches):
        run.status, run.reason, run.watches = said
        fold.work.is_changed = True


def _say_started(fold: _Fold) -> None:
    run, by = fold.work.row, fold.work.row.started_by or "Somebody"
    if run.entry:
        text = f"Run {run.number} started by itself; {by} has armed the program."
        fold.journal.say("run", text, code="started_itself", by=by, number=run.number)
    elif run.not_before:
        text = f"Run {run.number} began at its time; {by} has planned it."
        fold.journal.say("run", text, code="started_planned", by=by, number=run.number)
    else:
        fold.journal.say("run", f"{by} started run {run.number}.", code="started", by=by, number=run.number)


def _tell(fold: _Fold, event: r.Event) -> None:
    work = fold.work
    assert work.state is not None
    before = work.state
    work.state, actions = machine.step(work.plan, before, event)
    work.is_changed |= work.state is not before and work.state != before
    _do(fold, actions)
    if before.status != work.state.status and {before.status, work.state.status} == {"running", "paused"}:
        fold.journal.say("run", describe(work.state.status, work.state.reason), code=work.state.status)
        fold.told.append(RunPaused(work.id) if work.state.status == "paused" else RunResumed(work.id))


def _do(fold: _Fold, actions: tuple[r.Action, ...]) -> None:
    """Note what the machine wants done."""
    work, journal = fold.work, fold.journal
    is_last = work.state is not None and (work.state.ending is not None or work.state.status not in GOING_ON)
    for action in actions:
        match action:
            case r.Ask(task=task, order=order):
                if work.needs.properties:
                    work.orders[task] = order
                fold.told.append(to_floor(fold.asking, action))
            case r.Cancel(task=task):
                work.orders.pop(task, None)
                fold.told.append(to_floor(fold.asking, action))
            case r.SetTimer() | r.CancelTimer():
                _time(work, action)
            case r.AskPeople() | r.CancelQuestion() | r.Tell():
                _speak(fold, action)
            case r.Finished(status=status, reason=reason):
                work.row.ended_at = journal.now
                notices.say_held(work.row, journal)
                journal.say("run", describe(status, reason), code=status)
                fold.told.append(to_floor(fold.asking, action))
            case r.StepEntered() | r.StepLeft() | r.StepFailed():
                journal.mark(action, is_last=is_last)
            case _:
                assert_never(action)


def _time(work: RunWork, action: r.SetTimer | r.CancelTimer) -> None:
    """Note a timer that is to be set, or is not needed any more."""
    if isinstance(action, r.SetTimer):
        work.timers[action.timer] = action.seconds
        work.dropped_timers.discard(action.timer)
    elif work.timers.pop(action.timer, None) is None:
        work.dropped_timers.add(action.timer)


def _speak(fold: _Fold, action: r.AskPeople | r.CancelQuestion | r.Tell) -> None:
    """Note what people are asked or told."""
    match action:
        case r.AskPeople(step=name, text=text):
            fold.journal.ask(name, text)
            fold.work.asked.append(action)
        case r.CancelQuestion():
            fold.work.asked.append(action)
        case r.Tell():
            notices.tell(fold.work.row, fold.journal, action)


def _watches(plan: Plan, state: RunState) -> bool:
    """Tell whether news of devices may let the run go on."""
    waits = any(thread.waits_for == "until" for thread in state.threads.values())
    return waits or any(event.starts == "branch" for event in plan.events)

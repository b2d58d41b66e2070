"""One step of a run: take in what came, let the machine decide, write everything in one transaction."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from datetime import UTC, datetime, timedelta
from typing import assert_never
from uuid import UUID

from django.conf import settings
from django.db import transaction

from editor.language import plan_from_json
from editor.language.plan.instructions import Plan
from execution import mailbox
from execution.errors import StepConflict
from execution.floor_protocol import AskingRun, DeadlinePassed, ToFloor, ToRun, to_floor, to_machine
from execution.machine import machine
from execution.machine import messages as r
from execution.machine.needs import Needs, needs_of
from execution.machine.state import RunState
from execution.models import Run, Timer
from execution.runs import notices, questions
from execution.runs.before_start import is_before_start, may_begin, take_in
from execution.runs.facts import facts_of, names_of
from execution.runs.journal import Journal, describe
from execution.runs.reading_grace import asking_key, split_early, wake_later
from execution.traffic.messages import RunPaused, RunResumed, floor_zones
from vipo_device.protocol.description import Scalar

PLANS_KEPT = 64
_plans: OrderedDict[UUID, tuple[Plan, Needs]] = OrderedDict()


def advance_run(run_id: UUID | str) -> bool:
    """Bring a run up to date; False when it is over, unknown, or another process is at it already."""
    with transaction.atomic():
        rows = Run.objects.select_for_update(skip_locked=True, of=("self",)).defer("document", "compiled", "plan")
        run = rows.select_related("site").filter(id=run_id, status__in=Run.OPEN).first()
        if run is None:
            return False
        plan, needs = _plan(run.id)
        now = datetime.now(UTC)
        deliveries, early = split_early(run, needs, mailbox.waiting_for_run(run.id), now)
        messages = [delivery.message for delivery in deliveries]
        journal = Journal(run, now, names_of(run, messages))
        if is_before_start(run):
            take_in(run, journal, messages)
            messages = []
        if may_begin(run, now):
            facts = facts_of(needs, run, messages, now)
            if early:
                wake_later(run, now)
            state = _fold(_Step(run, plan, journal), facts, messages)
            run.state, run.status, run.reason = machine.to_json(state), state.status, state.reason
            run.watches = bool(early) or _watches(plan, state)
        if deliveries or run.state is not None:
            _write(run, journal)
        mailbox.mark_taken(deliveries)
        mailbox.crash_point("run_before_commit")
    mailbox.crash_point("run_after_commit")
    return True


class _Step:
    """What one step works on."""

    def __init__(self, run: Run, plan: Plan, journal: Journal) -> None:
        self.run, self.plan, self.journal = run, plan, journal
        zones = floor_zones(str(run.program), plan.zones)
        due = run.deadline.timestamp() if run.deadline else 0.0
        self.asking = AskingRun(str(run.id), f"run {run.number}", plan.roles, zones, run.priority, due)

    def tell_floor(self, key: str, message: ToFloor) -> None:
        """Put a message of the run into its floor's inbox; the key is the run's own."""
        mailbox.post_to_floor(self.run.site.slug, [(f"{self.run.id}:{key}", message)])


def _plan(run_id: UUID) -> tuple[Plan, Needs]:
    """Return a run's plan, which never changes, with what it needs to know."""
    if run_id not in _plans:
        plan = plan_from_json(Run.objects.values_list("plan", flat=True).get(id=run_id))
        _plans[run_id] = (plan, needs_of(plan))
        while len(_plans) > PLANS_KEPT:
            _plans.popitem(last=False)
    return _plans[run_id]


def _fold(step: _Step, facts: Mapping[tuple[str, str], Scalar], messages: list[ToRun]) -> RunState:
    """Take in all messages, oldest first; readings come before them, since a device speaks before it answers."""
    run = step.run
    if run.state is None:
        run.started_at = step.journal.now
        _say_started(step)
        state, actions = machine.start(step.plan, run.parameters, facts, run.entry)
        _do(step, actions)
    else:
        state = machine.from_json(run.state)
        news = {key: value for key, value in facts.items() if state.facts.get(key) != value}
        if news:
            state = _tell(step, state, r.Facts(news))
    for message in messages:
        step.journal.note(message)
        if isinstance(message, DeadlinePassed):
            notices.tell_late(run, step.journal)
        event = to_machine(message)
        if event is not None:
            state = _tell(step, state, event)
    return state


def _say_started(step: _Step) -> None:
    run, by = step.run, step.run.started_by or "Somebody"
    if run.entry:
        text = f"Run {run.number} started by itself; {by} has armed the program."
        step.journal.say("run", text, code="started_itself", by=by, number=run.number)
    elif run.not_before:
        text = f"Run {run.number} began at its time; {by} has planned it."
        step.journal.say("run", text, code="started_planned", by=by, number=run.number)
    else:
        step.journal.say("run", f"{by} started run {run.number}.", code="started", by=by, number=run.number)


def _tell(step: _Step, state: RunState, event: r.Event) -> RunState:
    before = state.status
    state, actions = machine.step(step.plan, state, event)
    _do(step, actions)
    if before != state.status and {before, state.status} == {"running", "paused"}:
        step.journal.say("run", describe(state.status, state.reason), code=state.status)
        order = RunPaused(step.asking.id) if state.status == "paused" else RunResumed(step.asking.id)
        step.tell_floor(f"{state.status}:{step.run.epoch}:{step.journal.seq}", order)
    return state


def _do(step: _Step, actions: tuple[r.Action, ...]) -> None:
    """Write down what the machine wants done."""
    run, journal = step.run, step.journal
    for action in actions:
        match action:
            case r.Ask(task=task):
                step.tell_floor(asking_key(task), to_floor(step.asking, action))
            case r.Cancel(task=task):
                step.tell_floor(f"drop:{task}", to_floor(step.asking, action))
            case r.SetTimer(timer=timer, seconds=seconds):
                due_at = journal.now + timedelta(seconds=seconds / settings.VIPO_SPEED)
                Timer.objects.create(run=run, timer=timer, due_at=due_at)
            case r.CancelTimer(timer=timer):
                Timer.objects.filter(run=run, timer=timer).delete()
            case r.AskPeople() | r.CancelQuestion() | r.Tell():
                _speak(step, action)
            case r.Finished(status=status, reason=reason):
                run.ended_at = journal.now
                notices.say_held(run, journal)
                journal.say("run", describe(status, reason), code=status)
                step.tell_floor("over", to_floor(step.asking, action))
            case r.StepEntered() | r.StepLeft() | r.StepFailed():
                journal.mark(action)
            case _:
                assert_never(action)


def _speak(step: _Step, action: r.AskPeople | r.CancelQuestion | r.Tell) -> None:
    """Write down what people are asked or told."""
    match action:
        case r.AskPeople(step=name, text=text):
            step.journal.ask(name, text)
            questions.ask(step.run, action, step.journal.now)
        case r.CancelQuestion(question=number):
            questions.withdraw(step.run, number)
        case r.Tell():
            notices.tell(step.run, step.journal, action)


def _watches(plan: Plan, state: RunState) -> bool:
    """Tell whether news of devices may let the run go on."""
    waits = any(thread.waits_for == "until" for thread in state.threads.values())
    return waits or any(event.starts == "branch" for event in plan.events)


def _write(run: Run, journal: Journal) -> None:
    """Write the new state, if nobody else has advanced the run meanwhile."""
    written = Run.objects.filter(id=run.id, epoch=run.epoch).update(
        state=run.state,
        status=run.status,
        reason=run.reason[:500],
        epoch=run.epoch + 1,
        watches=run.watches,
        late=run.late,
        notices=run.notices,
        steps=journal.steps,
        roles=journal.roles,
        next_seq=journal.seq,
        started_at=run.started_at,
        ended_at=run.ended_at,
    )
    if not written:
        raise StepConflict(f"Run {run.number} was advanced by another process.")
    journal.write()

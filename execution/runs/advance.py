"""One step of a run: take in what came, let the machine decide, write everything in one transaction."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import asdict
from datetime import UTC, datetime, timedelta
from typing import Any
from uuid import UUID

from django.conf import settings
from django.db import transaction

from editor.language import plan_from_json
from editor.language.plan.instructions import Plan, RoleBinding
from execution import mailbox
from execution.errors import StepConflict
from execution.machine import machine
from execution.machine import messages as r
from execution.machine.floor_task import mission_to_json
from execution.machine.needs import Needs, needs_of
from execution.machine.places import ROLE
from execution.machine.state import RunState
from execution.models import InboxEvent, Run, Timer
from execution.runs import notices, questions
from execution.runs.facts import facts_of, names_of
from execution.runs.journal import Journal, describe
from execution.runs.settle import split_early, wake_later
from execution.traffic.messages import floor_zones
from vipo_device.protocol.description import Scalar

PLANS_KEPT = 64
_plans: OrderedDict[UUID, tuple[Plan, Needs]] = OrderedDict()
OPEN = (Run.Status.PENDING, Run.Status.RUNNING, Run.Status.PAUSED)


def advance_run(run_id: UUID | str) -> bool:
    """Bring a run up to date; False when it is over, unknown, or another process is at it already."""
    with transaction.atomic():
        rows = Run.objects.select_for_update(skip_locked=True, of=("self",)).defer("document", "compiled", "plan")
        run = rows.select_related("site").filter(id=run_id, status__in=OPEN).first()
        if run is None:
            return False
        events = mailbox.waiting(mailbox.run_target(run.id))
        plan, needs = _plan(run.id)
        now = datetime.now(UTC)
        events, early = split_early(run, needs, events, now)
        facts = facts_of(needs, run, events, now)
        journal = Journal(run, now, names_of(run, events))
        if early:
            wake_later(run, now)
        state = _fold(_Step(run, plan, journal), facts, events)
        _write(run, state, journal, watches=bool(early) or _watches(plan, state))
        mailbox.mark_taken(events)
        mailbox.crash_point("run_before_commit")
    mailbox.crash_point("run_after_commit")
    return True


class _Step:
    """What one step works on."""

    def __init__(self, run: Run, plan: Plan, journal: Journal) -> None:
        self.run, self.plan, self.journal = run, plan, journal


def _plan(run_id: UUID) -> tuple[Plan, Needs]:
    """Return a run's plan, which never changes, with what it needs to know."""
    if run_id not in _plans:
        plan = plan_from_json(Run.objects.values_list("plan", flat=True).get(id=run_id))
        _plans[run_id] = (plan, needs_of(plan))
        while len(_plans) > PLANS_KEPT:
            _plans.popitem(last=False)
    return _plans[run_id]


def _fold(step: _Step, facts: Mapping[tuple[str, str], Scalar], events: list[InboxEvent]) -> RunState:
    """Take in all events, oldest first; readings come before them, since a device speaks before it answers."""
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
    for row in events:
        event = _event(step, row.payload)
        if event is not None:
            state = _tell(step, state, event)
    return state


def _say_started(step: _Step) -> None:
    run, by = step.run, step.run.started_by or "Somebody"
    if run.entry:
        text = f"Run {run.number} started by itself; {by} has armed the program."
        step.journal.say("run", text, code="started_itself", by=by, number=run.number)
    else:
        step.journal.say("run", f"{by} started run {run.number}.", code="started", by=by, number=run.number)


def _tell(step: _Step, state: RunState, event: r.Event) -> RunState:
    before = state.status
    state, actions = machine.step(step.plan, state, event)
    _do(step, actions)
    if before != state.status and {before, state.status} == {"running", "paused"}:
        paused = state.status == "paused"
        step.journal.say("run", describe(state.status, state.reason), code=state.status)
        _post_site(step.run, f"{state.status}:{step.run.epoch}:{step.journal.seq}",
                   {"type": "run_paused" if paused else "run_resumed", "run": str(step.run.id)})  # fmt: skip
    return state


def _event(step: _Step, data: Mapping[str, Any]) -> r.Event | None:
    """Read an event from the inbox; what is only to be noted is noted here."""
    match data["type"]:
        case "mission_over" if data["kind"]:
            return r.MissionFailed(data["mission"], data["kind"], data["why"])
        case "mission_over":
            return r.MissionDone(data["mission"], data["result"])
        case "timer":
            return r.TimerFired(data["timer"])
        case "pause":
            return r.PauseAsked(data["reason"])
        case "resume":
            return r.Resumed()
        case "cancel":
            return r.CancelAsked(data["reason"])
        case "role_bound":
            step.journal.note(data)
            return r.Facts({(ROLE, data["role"]): data["robot"]})
        case "answered":
            text = f"{data['by']} answered: {questions.in_short(data['value'])}."
            step.journal.say("question", text, step=data["step"], code="answered", by=data["by"], value=data["value"])
            return r.Answered(data["question"], data["value"])
    step.journal.note(data)
    return None


def _do(step: _Step, actions: tuple[r.Action, ...]) -> None:
    """Write down what the machine wants done."""
    run, journal = step.run, step.journal
    for action in actions:
        match action:
            case r.Ask(mission=mission, order=order):
                role = step.plan.roles.get(order.role, RoleBinding(order.role))
                payload: dict[str, Any] = {"type": "mission_asked", "run": str(run.id), "run_name": f"run {run.number}"}
                asked = {"mission": mission, "order": mission_to_json(order)}
                _post_site(
                    run,
                    f"ask:{mission}",
                    {**payload, **asked, "wants": role.device or "", "can": role.can, "zones": _zones(step)},
                )
            case r.Cancel(mission=mission):
                payload = {"type": "mission_cancelled", "run": str(run.id), "mission": mission}
                _post_site(run, f"drop:{mission}", payload)
            case r.SetTimer(timer=timer, seconds=seconds):
                due_at = journal.now + timedelta(seconds=seconds / settings.VIPO_SPEED)
                Timer.objects.create(run=run, timer=timer, due_at=due_at)
            case r.CancelTimer(timer=timer):
                Timer.objects.filter(run=run, timer=timer).delete()
            case r.AskPeople(step=name, text=text):
                journal.ask(name, text)
                questions.ask(run, action, journal.now)
            case r.CancelQuestion(question=number):
                questions.withdraw(run, number)
            case r.Tell():
                notices.tell(run, journal, action)
            case r.Finished(status=status, reason=reason):
                run.ended_at = journal.now
                notices.say_held(run, journal)
                journal.say("run", describe(status, reason), code=status)
                _post_site(run, "over", {"type": "run_over", "run": str(run.id)})
            case _:
                journal.mark(action)


def _zones(step: _Step) -> list[dict[str, Any]]:
    return [asdict(zone) for zone in floor_zones(str(step.run.program), step.plan.zones)]


def _post_site(run: Run, key: str, payload: Mapping[str, Any]) -> None:
    mailbox.post(mailbox.site_target(run.site.slug), [(f"{run.id}:{key}", payload)])


def _watches(plan: Plan, state: RunState) -> bool:
    """Tell whether news of devices may let the run go on."""
    waits = any(thread.waits_for == "until" for thread in state.threads.values())
    return waits or any(event.starts == "branch" for event in plan.events)


def _write(run: Run, state: RunState, journal: Journal, *, watches: bool) -> None:
    """Write the new state, if nobody else has advanced the run meanwhile."""
    written = Run.objects.filter(id=run.id, epoch=run.epoch).update(
        state=machine.to_json(state),
        status=state.status,
        reason=state.reason[:500],
        epoch=run.epoch + 1,
        watches=watches,
        notices=run.notices,
        steps=journal.steps,
        roles=journal.roles,
        next_seq=journal.seq,
        started_at=run.started_at,
        ended_at=run.ended_at,
    )
    if not written:
        raise StepConflict(f"Run {run.number} was advanced by another process.")
    run.status, run.reason = state.status, state.reason
    journal.write()

"""The run machine: a run's state and one event in, the new state and what is to be done out; pure.

It knows no time, no network and no robots: time is a timer that fires, the floor is tasks that end.
The same plan, state and event always give the same answer, so that a recorded history can be replayed.
Its parts: `turn` (what changes), `flow` (threads, functions, events), `outcomes` (failures).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import assert_never

from editor.language.expressions.nodes import Expression, PlaceRef
from editor.language.plan import instructions as p
from execution.machine.evaluation import EvaluationError, NoReading, bound_roles, in_words
from execution.machine.floor_task import Target, TaskKind, TaskOrder
from execution.machine.flow import end, end_thread, fork, invoke, leave_function, remember_truths, start_events
from execution.machine.limits import begin_limit, strike
from execution.machine.messages import (
    Action,
    Answered,
    Ask,
    AskPeople,
    CancelAsked,
    CancelQuestion,
    Event,
    Facts,
    PauseAsked,
    Resumed,
    TaskDone,
    TaskFailed,
    Tell,
    TimerFired,
)
from execution.machine.outcomes import begin_guard, end_guard, end_run, finish, rethrow, unwind
from execution.machine.state import FLOOR_TASK, MAIN, Activation, Guard, RunState, Thread, Wake, from_json, to_json
from execution.machine.turn import YIELD_S, Failure, Turn, Watch
from vipo_device.protocol.description import Scalar

__all__ = ["YIELD_S", "from_json", "start", "step", "to_json"]

TIMED_OUT = Wake("timed_out", "The condition did not come true in time.")
UNANSWERED = Wake("timed_out", "Nobody answered in time.")
NO_REASON = "The program failed here and does not say why."
FloorAction = p.Move | p.Pick | p.Drop | p.Cover | p.Call | p.Perform | p.Release


def start(
    plan: p.Plan,
    parameters: Mapping[str, Scalar],
    facts: Mapping[tuple[str, str], Scalar] | None = None,
    entry: int = 0,
    watch: Watch | None = None,
) -> tuple[RunState, tuple[Action, ...]]:
    """Begin a run: parameters override the plan's defaults; `facts` are the readings known so far.

    `entry` is where it begins: the body of an event that starts runs, or the program's at 0. `watch` is told of each
    instruction that is carried out; it changes nothing.
    """
    opened = next((e.step for e in plan.events if entry and e.entry == entry and e.step), "")
    first = Thread(id=MAIN, at=entry, calls=(Activation(frame=MAIN, back_to=-1),))
    frames = {MAIN: {**plan.parameters, **parameters}}
    state = RunState(threads={MAIN: first}, frames=frames, facts={**bound_roles(plan), **(facts or {})})
    turn = Turn(plan, state, watch)
    turn.keep(turn.enter(first, (opened,) if opened else ()))
    remember_truths(turn)
    _run_ready(turn)
    return turn.close()


def step(
    plan: p.Plan, state: RunState, event: Event, watch: Watch | None = None
) -> tuple[RunState, tuple[Action, ...]]:
    """Take in one event; a run that is over, or an answer nobody waits for, changes nothing."""
    if state.status not in {"running", "paused"}:
        return state, ()
    turn = Turn(plan, state, watch)
    _take(turn, event)
    _run_ready(turn)
    return turn.close()


def _take(turn: Turn, event: Event) -> None:
    match event:
        case Facts(values=values):
            turn.facts.update(values)
        case TaskDone(task=task):
            _wake(turn, FLOOR_TASK, task, Wake())
        case TaskFailed(task=task, kind=kind, why=why):
            _wake(turn, FLOOR_TASK, task, Wake(kind, why))
        case TimerFired(timer=timer):
            strike(turn, timer)
            for waits_for, wake in (("timer", Wake()), ("yield", Wake()), ("until", TIMED_OUT), ("ask", UNANSWERED)):
                _wake(turn, waits_for, timer, wake)
        case Answered(question=question, value=value):
            _wake(turn, "ask", question, Wake(value=value))
        case PauseAsked(reason=reason):
            turn.status, turn.reason = "paused", reason
        case Resumed():
            turn.status, turn.reason = "running", ""
        case CancelAsked(reason=reason):
            finish(turn, "cancelled", reason)
        case _:
            assert_never(event)


def _wake(turn: Turn, waits_for: str, waits_id: int, wake: Wake) -> None:
    for thread in turn.threads.values():
        if waits_id and (thread.waits_for, thread.waits_id, thread.wake) == (waits_for, waits_id, None):
            turn.threads[thread.id] = replace(thread, wake=wake)
            return


def _run_ready(turn: Turn) -> None:
    """Let every thread that can go on do so, the oldest first, until all wait; then look at the events."""
    start_events_if_running(turn)
    while turn.status == "running":
        ready = next((t for t in sorted(turn.threads.values(), key=lambda t: t.id) if _can_go_on(turn, t)), None)
        if ready is not None:
            _run(turn, ready)
        elif turn.ending is not None and not turn.threads:
            finish(turn, turn.ending.status, turn.ending.reason)
        elif MAIN not in turn.threads and turn.ending is None:
            end_run(turn, "finished", "")
        elif not start_events_if_running(turn):
            return


def start_events_if_running(turn: Turn) -> bool:
    """Look at the events; True when something has begun or come to an end by it."""
    if turn.status != "running" or turn.ending is not None:
        return False
    threads = len(turn.threads)
    start_events(turn)
    return len(turn.threads) > threads or turn.ending is not None


def _can_go_on(turn: Turn, thread: Thread) -> bool:
    if thread.waits_for == "join":
        return not turn.children(thread)
    if thread.wake is not None or not thread.waits_for:
        return True
    return thread.waits_for == "until" and _has_come_true(turn, thread)


def _has_come_true(turn: Turn, thread: Thread) -> bool:
    action = turn.plan.instructions[thread.at].do
    assert isinstance(action, p.WaitUntil)
    try:
        return turn.holds(thread, action.condition)
    except NoReading:
        return False
    except EvaluationError:
        return True


def _run(turn: Turn, thread: Thread) -> None:
    """Carry a thread on until it waits, ends or has done its share."""
    try:
        thread = _resume(turn, thread)
        while thread.id in turn.threads and not thread.waits_for and turn.status == "running":
            carried = _carry_out(turn, thread) if turn.spend(thread) else turn.wait(thread, "yield", YIELD_S)
            turn.tell(thread, carried)
            thread = turn.keep(carried)
    except Failure as failure:
        turn.tell(thread, thread)
        unwind(turn, turn.threads[thread.id], failure.wake)
    except EvaluationError as error:
        turn.tell(thread, thread)
        unwind(turn, turn.threads[thread.id], Wake("failed", str(error)))


def _resume(turn: Turn, thread: Thread) -> Thread:
    """Go on after a wait, or fail as it failed."""
    wake, waited_for = thread.wake or Wake(), thread.waits_for
    awake = turn.keep(replace(thread, waits_for="", waits_id=0, wake=None))
    if wake.ends:
        if waited_for == "ask":
            turn.actions.append(CancelQuestion(thread.waits_id))
        raise Failure.of(wake)
    if waited_for in {"", "yield"}:
        return awake
    action = turn.plan.instructions[thread.at].do
    match action:
        case p.WaitUntil(condition=condition):
            turn.drop_timer(thread.waits_id)
            turn.holds(awake, condition)
        case p.AskPerson(result=result, shared=shared, timeout_s=timeout):
            turn.drop_timer(thread.waits_id if timeout is not None else 0)
            turn.assign(awake, result, wake.value, shared=shared)
        case p.Fork(join=join):
            return turn.keep(turn.go(awake, join))
    return turn.keep(turn.go(awake))


def _carry_out(turn: Turn, thread: Thread) -> Thread:
    """Carry out one instruction."""
    if not 0 <= thread.at < len(turn.plan.instructions):
        return end(turn, thread)
    thread = turn.keep(turn.begin(thread))
    action = turn.plan.instructions[thread.at].do
    match action:
        case p.Move() | p.Pick() | p.Drop() | p.Cover() | p.Call() | p.Perform() | p.Release():
            return _ask_floor(turn, thread, action)
        case p.Wait(seconds=seconds):
            return turn.wait(thread, "timer", turn.seconds(thread, seconds))
        case p.WaitUntil(timeout_s=timeout):
            return turn.wait(thread, "until", None if timeout is None else turn.seconds(thread, timeout))
        case p.Branch(condition=condition, otherwise=otherwise):
            return turn.go(thread, None if turn.holds(thread, condition) else otherwise)
        case p.Jump(to=to):
            return turn.go(thread, to)
        case p.Assign(name=name, value=value, shared=shared):
            turn.assign(thread, name, turn.value(thread, value), shared=shared)
            return turn.go(thread)
        case p.AskPerson() | p.Notify() | p.Fail():
            return _speak(turn, thread, action)
    return _change_flow(turn, thread, action)


def _change_flow(turn: Turn, thread: Thread, action: p.Action) -> Thread:
    """Carry out what changes the shape of the execution: threads, guards, calls."""
    match action:
        case p.Fork(branches=branches):
            return fork(turn, thread, branches)
        case p.Join() | p.EventEnd():
            return end_thread(turn, thread)
        case p.TryBegin() | p.LimitBegin():
            return _begin_stretch(turn, thread, action)
        case p.Caught():
            return turn.go(thread)
        case p.TryEnd():
            return end_guard(turn, thread)
        case p.Rethrow():
            return rethrow(turn, thread)
        case p.Invoke():
            return invoke(turn, thread, action)
        case p.Return(value=value):
            return leave_function(turn, thread, value)
        case p.End():
            return end(turn, thread)
    raise AssertionError(f"no such instruction: {action!r}")


def _begin_stretch(turn: Turn, thread: Thread, action: p.TryBegin | p.LimitBegin) -> Thread:
    """Enter what a Try or a time limit stands around."""
    if isinstance(action, p.LimitBegin):
        return begin_limit(turn, thread, action.seconds)
    guard = Guard(action.handler, action.kinds, len(thread.calls), len(thread.open), action.final)
    return begin_guard(turn, thread, guard)


def _ask_floor(turn: Turn, thread: Thread, action: FloorAction) -> Thread:
    instruction = turn.plan.instructions[thread.at]
    order = replace(_order(turn, thread, action), step=instruction.step, line=instruction.line)
    task = turn.new_id()
    turn.actions.append(Ask(task, order))
    return replace(thread, waits_for=FLOOR_TASK, waits_id=task)


def _order(turn: Turn, thread: Thread, action: FloorAction) -> TaskOrder:
    match action:
        case p.Move(role=role, to=to, route=route):
            return TaskOrder("move", _target(turn, thread, to), role, route=route)
        case p.Call(device=device, method=method, arguments=arguments, serves=serves):
            values = _worked_out(turn, thread, arguments)
            return TaskOrder("call", _target(turn, thread, device), serves or "", method=method, arguments=values)
        case p.Perform(role=role, method=method, arguments=arguments):
            return TaskOrder("perform", Target(), role, method=method, arguments=_worked_out(turn, thread, arguments))
        case p.Release(role=role):
            return TaskOrder("release", Target(), role)
        case p.Cover(role=role, zone=zone, lane_m=lane):
            lane_m = 0.0 if lane is None else turn.number(thread, lane)
            if lane is not None and lane_m <= 0:
                raise Failure("refused", f"The lanes are {lane_m:g} m wide; they must be wider than nothing.")
            return TaskOrder("cover", Target(), role, arguments={"zone": zone, "lane": lane_m})
        case p.Pick() | p.Drop():
            quantity = turn.number(thread, action.quantity)
            if quantity <= 0:
                raise Failure("refused", f"The quantity is {quantity:g}; it must be more than nothing.")
            thing = str(turn.scalar(thread, action.object))
            kind: TaskKind = "pick" if isinstance(action, p.Pick) else "drop"
            return TaskOrder(kind, _target(turn, thread, action.at), action.role, thing, quantity)


def _worked_out(turn: Turn, thread: Thread, arguments: Mapping[str, Expression]) -> dict[str, Scalar]:
    return {name: turn.scalar(thread, value) for name, value in arguments.items()}


def _target(turn: Turn, thread: Thread, place: PlaceRef) -> Target:
    if place.point is not None:
        return Target(point=place.point)
    if place.value is not None:
        return Target(str(turn.scalar(thread, place.value)))
    return Target(place.device or place.place or "")


def _speak(turn: Turn, thread: Thread, action: p.AskPerson | p.Notify | p.Fail) -> Thread:
    """Carry out what people are told or asked, or the failure that they read of."""
    match action:
        case p.AskPerson():
            return _ask_people(turn, thread, action)
        case p.Notify(message=message, level=level):
            turn.actions.append(Tell(_text(turn, thread, message), level, turn.plan.instructions[thread.at].step))
            return turn.go(thread)
        case p.Fail(message=message):
            raise Failure("failed", _text(turn, thread, message) or NO_REASON)


def _ask_people(turn: Turn, thread: Thread, action: p.AskPerson) -> Thread:
    text = _text(turn, thread, action.question)
    limit_s = None if action.timeout_s is None else turn.seconds(thread, action.timeout_s)
    thread = turn.wait(thread, "ask", limit_s)
    step = turn.plan.instructions[thread.at].step
    turn.actions.append(AskPeople(thread.waits_id, text, action.answer, step))
    return thread


def _text(turn: Turn, thread: Thread, message: Expression) -> str:
    """Return what people are told, in a reasonable length."""
    return in_words(turn.value(thread, message)).strip()[:500]

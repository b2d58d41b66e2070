"""The run machine: a run's state and one event in, the new state and what is to be done out; pure.

It knows no time, no network and no robots: time is a timer that fires, the floor is missions that end.
The same plan, state and event always give the same answer, so that a recorded history can be replayed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from editor.language import plan as p
from execution.expressions import EvaluationError, NoReading, evaluate_number, evaluate_scalar, is_true
from execution.mission import Mission, MissionKind, Target
from execution.run_messages import (
    Action,
    Ask,
    Cancel,
    CancelAsked,
    CancelTimer,
    Event,
    Facts,
    Finished,
    MissionDone,
    MissionFailed,
    PauseAsked,
    Resumed,
    SetTimer,
    StepEntered,
    StepFailed,
    StepLeft,
    TimerFired,
)
from execution.run_state import Activation, Guard, RunState, RunStatus, Thread, Wake, from_json, to_json
from registry.capability import Scalar

__all__ = ["from_json", "start", "step", "to_json"]

GLUE_LIMIT = 200
"""Instructions that a thread may carry out in one go without waiting for anything."""
YIELD_S = 1.0
"""How long a thread rests that has used up its share; a loop without a wait cannot stop the others."""
DEEPEST_CALL = 100
_LEAVES = (p.Move, p.Pick, p.Drop, p.Call, p.Wait, p.WaitUntil)


def start(
    plan: p.Plan, parameters: Mapping[str, Scalar], facts: Mapping[tuple[str, str], Scalar] | None = None
) -> tuple[RunState, tuple[Action, ...]]:
    """Begin a run: parameters override the plan's defaults; `facts` are the readings known so far."""
    first = Thread(id=0, at=0, calls=(Activation(frame=0, back_to=-1),))
    frames = {0: {**plan.parameters, **parameters}}
    turn = _Turn(plan, RunState(threads={0: first}, frames=frames, facts=dict(facts or {})))
    turn.run_ready()
    return turn.close()


def step(plan: p.Plan, state: RunState, event: Event) -> tuple[RunState, tuple[Action, ...]]:
    """Take in one event; a run that is over, or an answer nobody waits for, changes nothing."""
    if state.status not in {"running", "paused"}:
        return state, ()
    turn = _Turn(plan, state)
    turn.take(event)
    turn.run_ready()
    return turn.close()


class _Failure(Exception):
    """An instruction cannot be carried out."""

    def __init__(self, kind: str, why: str) -> None:
        super().__init__(why)
        self.kind, self.why = kind, why


class _Turn:
    """One step being worked out: a copy of the state that changes, and the actions so far."""

    def __init__(self, plan: p.Plan, state: RunState) -> None:
        self.plan = plan
        self.status = state.status
        self.reason = state.reason
        self.threads = dict(state.threads)
        self.frames = {number: dict(frame) for number, frame in state.frames.items()}
        self.facts = dict(state.facts)
        self.next_id = state.next_id
        self.actions: list[Action] = []

    def close(self) -> tuple[RunState, tuple[Action, ...]]:
        state = RunState(self.status, self.reason, self.threads, self.frames, self.facts, self.next_id)
        return state, tuple(self.actions)

    def take(self, event: Event) -> None:
        match event:
            case Facts(values=values):
                self.facts.update(values)
            case MissionDone(mission=mission):
                self._wake("mission", mission, Wake())
            case MissionFailed(mission=mission, kind=kind, why=why):
                self._wake("mission", mission, Wake(kind, why))
            case TimerFired(timer=timer):
                self._wake("timer", timer, Wake())
                self._wake("yield", timer, Wake())
                self._wake("until", timer, Wake("timed_out", "The condition did not come true in time."))
            case PauseAsked(reason=reason):
                self.status, self.reason = "paused", reason
            case Resumed():
                self.status, self.reason = "running", ""
            case CancelAsked(reason=reason):
                self._finish("cancelled", reason)

    def _wake(self, waits_for: str, waits_id: int, wake: Wake) -> None:
        for thread in self.threads.values():
            if (thread.waits_for, thread.waits_id) == (waits_for, waits_id) and thread.wake is None:
                self.threads[thread.id] = replace(thread, wake=wake)
                return

    def run_ready(self) -> None:
        """Let every thread that can go on do so, the oldest first, until all wait."""
        while self.status == "running":
            ready = next((t for t in sorted(self.threads.values(), key=lambda t: t.id) if self._can_go_on(t)), None)
            if ready is None:
                return
            self._run(ready)

    def _can_go_on(self, thread: Thread) -> bool:
        if thread.wake is not None or not thread.waits_for:
            return True
        if thread.waits_for == "until":
            return self._holds(thread)
        children = [t for t in self.threads.values() if t.parent == thread.id]
        return thread.waits_for == "join" and not children

    def _holds(self, thread: Thread) -> bool:
        action = self.plan.instructions[thread.at].do
        assert isinstance(action, p.WaitUntil)
        try:
            return is_true(action.condition, self._variables(thread), self.facts)
        except NoReading:
            return False
        except EvaluationError:
            return True

    def _run(self, thread: Thread) -> None:
        """Carry a thread on until it waits, ends or has done its share."""
        try:
            thread = self._resume(thread)
            for _ in range(GLUE_LIMIT):
                if thread.waits_for or thread.id not in self.threads or self.status != "running":
                    return
                thread = self._keep(self._carry_out(thread))
            if not thread.waits_for and thread.id in self.threads:
                self._keep(self._wait(thread, "yield", YIELD_S))
        except _Failure as failure:
            self._fail(self.threads[thread.id], failure.kind, failure.why)
        except EvaluationError as error:
            self._fail(self.threads[thread.id], "failed", str(error))

    def _keep(self, thread: Thread) -> Thread:
        if thread.id in self.threads:
            self.threads[thread.id] = thread
        return thread

    def _resume(self, thread: Thread) -> Thread:
        """Go on after a wait, or fail as it failed."""
        wake, waited_for = thread.wake, thread.waits_for
        awake = self._keep(replace(thread, waits_for="", waits_id=0, wake=None))
        if wake is not None and wake.kind:
            raise _Failure(wake.kind, wake.why)
        action = self.plan.instructions[thread.at].do if waited_for else None
        if waited_for == "until" and isinstance(action, p.WaitUntil):
            if thread.waits_id:
                self.actions.append(CancelTimer(thread.waits_id))
            is_true(action.condition, self._variables(thread), self.facts)
        if isinstance(action, p.Fork) and waited_for == "join":
            return self._keep(self._go(awake, action.join))
        return self._keep(self._go(awake)) if waited_for not in {"", "yield"} else awake

    def _carry_out(self, thread: Thread) -> Thread:
        """Carry out one instruction."""
        if thread.at >= len(self.plan.instructions):
            self._finish("finished", "")
            return thread
        thread = self._keep(self._begin(thread))
        action = self.plan.instructions[thread.at].do
        variables = self._variables(thread)
        match action:
            case p.Move() | p.Pick() | p.Drop() | p.Call():
                return self._ask(thread, action)
            case p.Wait(seconds=seconds):
                return self._wait(thread, "timer", self._seconds(seconds, variables))
            case p.WaitUntil(timeout_s=timeout):
                return self._wait(thread, "until", None if timeout is None else self._seconds(timeout, variables))
            case p.Branch(condition=condition, otherwise=otherwise):
                return self._go(thread, thread.at + 1 if is_true(condition, variables, self.facts) else otherwise)
            case p.Jump(to=to):
                return self._go(thread, to)
            case p.Assign(name=name, value=value):
                self.frames[thread.calls[-1].frame][name] = evaluate_scalar(value, variables, self.facts)
                return self._go(thread)
            case p.End():
                self._finish("finished", "")
                return thread
            case _:
                return self._change_flow(thread, action)

    def _change_flow(self, thread: Thread, action: p.Action) -> Thread:
        """Carry out what changes the shape of the execution: threads, guards, calls."""
        match action:
            case p.Fork(branches=branches):
                for branch in branches:
                    child = Thread(self._new_id(), branch, (replace(thread.calls[-1], back_to=-1, open=0),))
                    self.threads[child.id] = replace(child, parent=thread.id)
                return replace(thread, waits_for="join")
            case p.Join():
                self._go(thread)
                del self.threads[thread.id]
                return thread
            case p.TryBegin(handler=handler, kinds=kinds):
                guard = Guard(handler, kinds, len(thread.calls), len(thread.open))
                return self._go(replace(thread, guards=(*thread.guards, guard)))
            case p.TryEnd():
                return self._go(replace(thread, guards=thread.guards[:-1]))
            case p.Invoke():
                return self._invoke(thread, action)
            case p.Return(value=value):
                return self._return(thread, value)
        raise AssertionError(f"no such instruction: {action!r}")

    def _begin(self, thread: Thread) -> Thread:
        """Mark the steps that begin with this instruction, and the plain step before it as done."""
        instruction = self.plan.instructions[thread.at]
        if thread.leaf and thread.leaf != instruction.step:
            self.actions.append(StepLeft(thread.leaf))
            thread = replace(thread, leaf="")
        for name in instruction.enters:
            if name not in thread.open:
                self.actions.append(StepEntered(name))
                thread = replace(thread, open=(*thread.open, name))
        name = instruction.step
        if name and isinstance(instruction.do, _LEAVES) and name not in thread.open and name != thread.leaf:
            self.actions.append(StepEntered(name))
            thread = replace(thread, leaf=name)
        return thread

    def _go(self, thread: Thread, to: int | None = None) -> Thread:
        """Leave the instruction, marking the steps that end with it."""
        thread = self._leave(thread, self.plan.instructions[thread.at].leaves)
        return replace(thread, at=thread.at + 1 if to is None else to)

    def _leave(self, thread: Thread, names: tuple[str, ...]) -> Thread:
        for name in names:
            if name == thread.leaf:
                self.actions.append(StepLeft(name))
                thread = replace(thread, leaf="")
            elif name in thread.open:
                self.actions.append(StepLeft(name))
                thread = replace(thread, open=tuple(o for o in thread.open if o != name))
        return thread

    def _ask(self, thread: Thread, action: p.Move | p.Pick | p.Drop | p.Call) -> Thread:
        instruction = self.plan.instructions[thread.at]
        order = replace(self._order(action, self._variables(thread)), step=instruction.step, line=instruction.line)
        mission = self._new_id()
        self.actions.append(Ask(mission, order))
        return replace(thread, waits_for="mission", waits_id=mission)

    def _order(self, action: p.Move | p.Pick | p.Drop | p.Call, variables: Mapping[str, Scalar]) -> Mission:
        match action:
            case p.Move(role=role, to=to, route=route):
                return Mission("move", self._target(to, variables), role, route=route)
            case p.Call(device=device, method=method, arguments=arguments, serves=serves):
                values = {name: evaluate_scalar(value, variables, self.facts) for name, value in arguments.items()}
                return Mission("call", self._target(device, variables), serves or "", method=method, arguments=values)
            case p.Pick() | p.Drop():
                quantity = evaluate_number(action.quantity, variables, self.facts)
                if quantity <= 0:
                    raise _Failure("refused", f"The quantity is {quantity:g}; it must be more than nothing.")
                thing = str(evaluate_scalar(action.object, variables, self.facts))
                kind: MissionKind = "pick" if isinstance(action, p.Pick) else "drop"
                return Mission(kind, self._target(action.at, variables), action.role, thing, quantity)

    def _target(self, place: p.PlaceRef, variables: Mapping[str, Scalar]) -> Target:
        if place.point is not None:
            return Target(point=place.point)
        if place.value is not None:
            return Target(str(evaluate_scalar(place.value, variables, self.facts)))
        return Target(place.device or place.place or "")

    def _seconds(self, expression: p.Expression, variables: Mapping[str, Scalar]) -> float:
        seconds = evaluate_number(expression, variables, self.facts)
        if seconds < 0:
            raise _Failure("refused", f"It is told to wait {seconds:g} s; a wait cannot be less than nothing.")
        return seconds

    def _wait(self, thread: Thread, waits_for: str, seconds: float | None) -> Thread:
        if seconds is None:
            return replace(thread, waits_for=waits_for, waits_id=0)
        timer = self._new_id()
        self.actions.append(SetTimer(timer, seconds))
        return replace(thread, waits_for=waits_for, waits_id=timer)

    def _invoke(self, thread: Thread, action: p.Invoke) -> Thread:
        if len(thread.calls) >= DEEPEST_CALL:
            raise _Failure("failed", f"“{action.function}” calls itself more than {DEEPEST_CALL} times deep.")
        variables = self._variables(thread)
        frame = self._new_id()
        arguments = action.arguments.items()
        self.frames[frame] = {name: evaluate_scalar(value, variables, self.facts) for name, value in arguments}
        call = Activation(frame, thread.at + 1, action.result, len(thread.open))
        return replace(thread, calls=(*thread.calls, call), at=action.entry)

    def _return(self, thread: Thread, value: p.Expression | None) -> Thread:
        result = None if value is None else evaluate_scalar(value, self._variables(thread), self.facts)
        call = thread.calls[-1]
        if call.back_to < 0:
            self._finish("finished", "")
            return thread
        del self.frames[call.frame]
        calls = thread.calls[:-1]
        if call.result is not None:
            self.frames[calls[-1].frame][call.result] = result
        guards = tuple(guard for guard in thread.guards if guard.calls <= len(calls))
        thread = self._leave(thread, tuple(reversed(thread.open[call.open :])))
        return self._go(replace(thread, calls=calls, guards=guards, at=call.back_to - 1))

    def _variables(self, thread: Thread) -> dict[str, Scalar]:
        return {**self.frames[0], **self.frames[thread.calls[-1].frame]}

    def _new_id(self) -> int:
        self.next_id += 1
        return self.next_id - 1

    def _fail(self, thread: Thread, kind: str, why: str) -> None:
        """Go on at the innermost handler for this kind; without one the thread's parent fails, or the run."""
        if thread.leaf:
            self.actions.append(StepFailed(thread.leaf, kind, why))
            thread = self._keep(replace(thread, leaf=""))
        fitting = [i for i, guard in enumerate(thread.guards) if not guard.kinds or kind in guard.kinds]
        if fitting:
            guard = thread.guards[fitting[-1]]
            thread = self._fail_open(thread, guard.open, kind, why)
            for call in thread.calls[guard.calls :]:
                del self.frames[call.frame]
            calls, guards = thread.calls[: guard.calls], thread.guards[: fitting[-1]]
            self._keep(replace(thread, at=guard.handler, calls=calls, guards=guards))
        elif thread.parent is None:
            self._fail_open(thread, 0, kind, why)
            self._finish("failed", why)
        else:
            self._fail_open(thread, 0, kind, why)
            parent = self.threads[thread.parent]
            self._end_children(parent.id, "Another branch failed.")
            parent = self._keep(replace(parent, waits_for="", wake=None))
            self._fail(parent, kind, why)

    def _fail_open(self, thread: Thread, depth: int, kind: str, why: str) -> Thread:
        self.actions.extend(StepFailed(name, kind, why) for name in reversed(thread.open[depth:]))
        return self._keep(replace(thread, open=thread.open[:depth]))

    def _end_children(self, parent: int, why: str) -> None:
        for child in [t for t in self.threads.values() if t.parent == parent]:
            self._end_children(child.id, why)
            self._end_thread(child, why)

    def _end_thread(self, thread: Thread, why: str) -> None:
        """Take a thread away with all that it waits for."""
        if thread.waits_for == "mission" and thread.wake is None:
            self.actions.append(Cancel(thread.waits_id))
        elif thread.waits_id and thread.wake is None:
            self.actions.append(CancelTimer(thread.waits_id))
        unfinished = (thread.leaf, *reversed(thread.open)) if thread.leaf else tuple(reversed(thread.open))
        self.actions.extend(StepFailed(name, "cancelled", why) for name in unfinished)
        del self.threads[thread.id]

    def _finish(self, status: RunStatus, reason: str) -> None:
        """End the run in good order: whatever is still under way is called off."""
        for thread in list(self.threads.values()):
            if status == "finished" and not thread.waits_for:
                left = (thread.leaf, *reversed(thread.open)) if thread.leaf else tuple(reversed(thread.open))
                self.actions.extend(StepLeft(name) for name in left)
                thread = replace(thread, leaf="", open=())
            self._end_thread(thread, reason or "The program was over.")
        self.status, self.reason = status, reason
        self.actions.append(Finished(status, reason))

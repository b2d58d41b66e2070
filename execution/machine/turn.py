"""One step of a run being worked out: a copy of the state that changes, and the actions so far; pure."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

from editor.language.expressions import nodes as e
from editor.language.plan import instructions as p
from execution.machine.evaluation import Value, evaluate, evaluate_number, evaluate_scalar, is_true
from execution.machine.messages import Action, CancelTimer, SetTimer, StepEntered, StepLeft
from execution.machine.state import MAIN, RunState, RunStatus, Thread, Wake
from vipo_device.protocol.description import Scalar

GLUE_LIMIT = 200
"""Instructions that a thread and its branches may carry out in one go without waiting for anything."""
LONGEST_WAIT_S = 1e9
"""About thirty years; calendars end soon after."""
YIELD_S = 1.0
"""How long a thread rests that has used up its share; a loop without a wait cannot stop the others."""


Watch = Callable[[int, int, int], None]
"""Told of an instruction that was carried out: the thread's id, its address, and where the thread goes on.

Where it waits or fails, that is the same address."""


class Failure(Exception):
    """An instruction cannot be carried out, or its thread is to end."""

    def __init__(self, kind: str, why: str) -> None:
        super().__init__(why)
        self.wake = Wake(kind, why)

    @classmethod
    def of(cls, wake: Wake) -> Failure:
        """Return the failure that a thread was told."""
        failure = cls(wake.kind, wake.why)
        failure.wake = wake
        return failure


class Turn:
    """A run while one event is taken in; `close` gives the new state and what is to be done."""

    def __init__(self, plan: p.Plan, state: RunState, watch: Watch | None = None) -> None:
        self.plan = plan
        self._watch = watch
        self.status: RunStatus = state.status
        self.reason = state.reason
        self.threads = dict(state.threads)
        self.frames = {number: dict(frame) for number, frame in state.frames.items()}
        self.facts = dict(state.facts)
        self.next_id = state.next_id
        self.truths = dict(state.truths)
        self.ending = state.ending
        self.zones = {zone.id: zone.points for zone in plan.zones}
        self.actions: list[Action] = []
        self.started: set[int] = set()
        """Events that have begun in this turn."""
        self._spent: dict[int, int] = {}

    def close(self) -> tuple[RunState, tuple[Action, ...]]:
        """Return the new state and the actions."""
        state = RunState(self.status, self.reason, self.threads, self.frames, self.facts, self.next_id, self.truths,
                         self.ending)  # fmt: skip
        return state, tuple(self.actions)

    def tell(self, thread: Thread, carried: Thread) -> None:
        """Tell who watches what a thread has carried out."""
        if self._watch is not None and carried.waits_for != "yield":
            self._watch(thread.id, thread.at, carried.at)

    def new_id(self) -> int:
        """Return the next number: threads, frames, tasks, timers and questions share one sequence."""
        self.next_id += 1
        return self.next_id - 1

    def keep(self, thread: Thread) -> Thread:
        """Store a thread, unless it has ended meanwhile."""
        if thread.id in self.threads:
            self.threads[thread.id] = thread
        return thread

    def ancestors(self, thread: Thread) -> Iterator[Thread]:
        """Go through the threads that wait for this one, the nearest first."""
        while thread.parent is not None and thread.parent in self.threads:
            thread = self.threads[thread.parent]
            yield thread

    def children(self, thread: Thread) -> list[Thread]:
        """Return the threads that this one has forked."""
        return [other for other in self.threads.values() if other.parent == thread.id]

    def spend(self, thread: Thread) -> bool:
        """Take one instruction from the share of a thread and its branches; False when it is used up."""
        root = thread.id
        for ancestor in self.ancestors(thread):
            root = ancestor.id
        self._spent[root] = self._spent.get(root, 0) + 1
        return self._spent[root] <= GLUE_LIMIT

    def variables(self, thread: Thread) -> Mapping[str, Value]:
        """Return what the names mean where the thread is, the function's own before the program's."""
        frame = thread.calls[-1].frame
        return self.frames[MAIN] if frame == MAIN else {**self.frames[MAIN], **self.frames[frame]}

    def assign(self, thread: Thread, name: str | None, value: Value, *, shared: bool) -> None:
        """Give a variable of the program or of the thread's frame a value; no name, no variable."""
        if name is not None:
            self.frames[MAIN if shared else thread.calls[-1].frame][name] = value

    def value(self, thread: Thread, expression: e.Expression) -> Value:
        """Return what an expression is worth in a thread; it may be a list."""
        return evaluate(expression, self.variables(thread), self.facts, self.zones)

    def scalar(self, thread: Thread, expression: e.Expression) -> Scalar:
        """Return what an expression that gives a single value is worth in a thread."""
        return evaluate_scalar(expression, self.variables(thread), self.facts, self.zones)

    def number(self, thread: Thread, expression: e.Expression) -> float:
        """Return what an expression that gives a number is worth in a thread."""
        return evaluate_number(expression, self.variables(thread), self.facts, self.zones)

    def holds(self, thread: Thread | None, condition: e.Expression) -> bool:
        """Tell whether a condition holds in a thread, or with the program's variables."""
        return is_true(condition, self.variables(thread) if thread else self.frames[MAIN], self.facts, self.zones)

    def seconds(self, thread: Thread, expression: e.Expression) -> float:
        """Return a time to wait in seconds."""
        seconds = self.number(thread, expression)
        if seconds < 0:
            raise Failure("refused", f"It is told to wait {seconds:g} s; a wait cannot be less than nothing.")
        return min(seconds, LONGEST_WAIT_S)

    def wait(self, thread: Thread, waits_for: str, seconds: float | None) -> Thread:
        """Let a thread wait, for so many seconds when they are given."""
        number = self.new_id() if seconds is not None or waits_for == "ask" else 0
        if seconds is not None:
            self.actions.append(SetTimer(number, seconds))
        return replace(thread, waits_for=waits_for, waits_id=number)

    def drop_timer(self, timer: int) -> None:
        """Say that a timer is not needed any more."""
        if timer:
            self.actions.append(CancelTimer(timer))

    def begin(self, thread: Thread) -> Thread:
        """Mark the steps that begin with this instruction, and the plain step before it as done."""
        instruction = self.plan.instructions[thread.at]
        if thread.leaf and thread.leaf != instruction.step:
            self.actions.append(StepLeft(thread.leaf))
            thread = replace(thread, leaf="")
        thread = self.enter(thread, instruction.enters)
        name = instruction.step
        if name and isinstance(instruction.do, p.LEAVES) and name not in thread.open and name != thread.leaf:
            self.actions.append(StepEntered(name))
            thread = replace(thread, leaf=name)
        return thread

    def enter(self, thread: Thread, names: tuple[str, ...]) -> Thread:
        """Mark steps that begin and hold others."""
        for name in names:
            if name not in thread.open:
                self.actions.append(StepEntered(name))
                thread = replace(thread, open=(*thread.open, name))
        return thread

    def go(self, thread: Thread, to: int | None = None) -> Thread:
        """Leave the instruction, marking the steps that end with it."""
        thread = self.leave(thread, self.plan.instructions[thread.at].leaves)
        return replace(thread, at=thread.at + 1 if to is None else to)

    def leave(self, thread: Thread, names: tuple[str, ...]) -> Thread:
        """Mark steps as done."""
        for name in names:
            if name == thread.leaf:
                self.actions.append(StepLeft(name))
                thread = replace(thread, leaf="")
            elif name in thread.open:
                self.actions.append(StepLeft(name))
                thread = replace(thread, open=tuple(o for o in thread.open if o != name))
        return thread

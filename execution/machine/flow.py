"""What changes the shape of the execution: threads, functions, and events that run beside the program; pure."""

from __future__ import annotations

from dataclasses import replace

from editor.language.expressions import nodes as e
from editor.language.plan import instructions as p
from execution.machine.evaluation import EvaluationError, NoReading, NoValue
from execution.machine.messages import StepEntered, StepFailed
from execution.machine.outcomes import ENOUGH_ENDED, OVER, call_off_branches, end_run, leave_call, remove, unwind
from execution.machine.state import MAIN, Activation, Thread
from execution.machine.turn import YIELD_S, Failure, Turn

DEEPEST_CALL = 100
MOST_THREADS = 500


def fork(turn: Turn, thread: Thread, branches: tuple[int, ...]) -> Thread:
    """Start a thread for each branch and wait for them."""
    if len(turn.threads) + len(branches) > MOST_THREADS:
        raise Failure("failed", f"More than {MOST_THREADS} branches would run at once.")
    for branch in branches:
        child = Thread(turn.new_id(), branch, (replace(thread.calls[-1], back_to=-1, open=0),), parent=thread.id)
        turn.threads[child.id] = child
    return replace(thread, waits_for="join")


def end_thread(turn: Turn, thread: Thread) -> Thread:
    """A branch, an event's body or the program's is over; with the program's the run is."""
    thread = turn.go(thread)
    if thread.id == MAIN:
        return end(turn, thread)
    thread = turn.leave(thread, (*filter(None, [thread.leaf]), *reversed(thread.open)))
    remove(turn, thread)
    _end_race(turn, thread)
    return thread


def _end_race(turn: Turn, thread: Thread) -> None:
    """Call the other branches off when as many have ended as are needed."""
    parent = turn.threads.get(thread.parent) if thread.parent is not None else None
    fork_ = turn.plan.instructions[parent.at].do if parent is not None else None
    if parent is None or parent.wake is not None or not isinstance(fork_, p.Fork) or not fork_.needed:
        return
    left = turn.children(parent)
    if left and len(fork_.branches) - len(left) >= fork_.needed:
        call_off_branches(turn, parent, ENOUGH_ENDED)


def end(turn: Turn, thread: Thread) -> Thread:
    """The program is over; the `final` handlers around are carried out first."""
    end_run(turn, "finished", "", by=thread)
    unwind(turn, turn.keep(thread), OVER)
    return turn.threads.get(thread.id, thread)


def invoke(turn: Turn, thread: Thread, action: p.Invoke) -> Thread:
    """Begin a function in a frame of its own."""
    depth = len(thread.calls) + sum(len(ancestor.calls) for ancestor in turn.ancestors(thread))
    if depth >= DEEPEST_CALL:
        raise Failure("failed", f"“{action.function}” calls itself more than {DEEPEST_CALL} times deep.")
    values = {name: turn.value(thread, value) for name, value in action.arguments.items()}
    frame = turn.new_id()
    turn.frames[frame] = values
    call = Activation(frame, thread.at + 1, action.result, len(thread.open), action.shared)
    return replace(thread, calls=(*thread.calls, call), at=action.entry)


def leave_function(turn: Turn, thread: Thread, value: e.Expression | None) -> Thread:
    """Leave the function's frame, with its value."""
    result = None if value is None else turn.value(thread, value)
    call = thread.calls[-1]
    if call.back_to < 0:
        return end_thread(turn, thread)
    del turn.frames[call.frame]
    thread = leave_call(turn, replace(thread, calls=thread.calls[:-1]), len(thread.calls) - 1)
    turn.assign(thread, call.result, result, shared=call.shared)
    thread = turn.leave(thread, tuple(reversed(thread.open[call.open :])))
    return turn.go(replace(thread, at=call.back_to - 1))


def remember_truths(turn: Turn) -> None:
    """Take in what holds at the beginning, which is no becoming true."""
    for number, event in _watched(turn):
        turn.truths[number] = _holds(turn, event)


def start_events(turn: Turn) -> None:
    """Start the body of each event whose condition has become true, unless it is still being carried out."""
    for number, event in _watched(turn):
        before = turn.truths.get(number, False)
        turn.truths[number] = now = _holds(turn, event)
        running = any(thread.event == number for thread in turn.threads.values())
        if now and not before and not running and turn.ending is None:
            _start_event(turn, number, event)


def _watched(turn: Turn) -> list[tuple[int, p.EventEntry]]:
    if turn.ending is not None:
        return []
    return [(number, event) for number, event in enumerate(turn.plan.events) if event.starts == "branch"]


def _holds(turn: Turn, event: p.EventEntry) -> bool:
    """Tell whether the condition holds: not before what it looks at has a value; one that is wrong fails the run."""
    try:
        return turn.holds(None, event.condition)
    except (NoReading, NoValue):
        return False
    except EvaluationError as error:
        turn.actions.append(StepFailed(event.step, "failed", str(error)))
        end_run(turn, "failed", str(error))
        return False


def _start_event(turn: Turn, number: int, event: p.EventEntry) -> None:
    """Begin the body; a second time in one turn it rests first, so that events cannot chase each other for ever."""
    frame = turn.new_id()
    turn.frames[frame] = {}
    thread = Thread(turn.new_id(), event.entry, (Activation(frame, back_to=-1),), event=number)
    turn.threads[thread.id] = thread
    if event.step:
        turn.actions.append(StepEntered(event.step))
        thread = turn.keep(replace(thread, open=(event.step,)))
    if number in turn.started:
        turn.keep(turn.wait(thread, "yield", YIELD_S))
    turn.started.add(number)

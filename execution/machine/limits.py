"""Time limits: when one begins, and what its timer ends; pure."""

from __future__ import annotations

from dataclasses import replace

from editor.language.expressions.nodes import Expression
from execution.machine.messages import SetTimer
from execution.machine.outcomes import begin_guard, call_off_branches, tell_at_once
from execution.machine.state import Guard, Thread, Wake
from execution.machine.turn import LONGEST_WAIT_S, Failure, Turn

NO_HANDLER = -1


def begin_limit(turn: Turn, thread: Thread, seconds: Expression) -> Thread:
    """Enter a stretch that may take so many seconds."""
    time_s = min(turn.number(thread, seconds), LONGEST_WAIT_S)
    if time_s < 0:
        raise Failure("refused", f"The time limit is {time_s:g} s; it cannot be less than nothing.")
    timer = turn.new_id()
    turn.actions.append(SetTimer(timer, time_s))
    guard = Guard(NO_HANDLER, (), len(thread.calls), len(thread.open), limit=timer, seconds=time_s)
    return begin_guard(turn, thread, guard)


def strike(turn: Turn, timer: int) -> None:
    """End what stands in the time limit with this timer, unless it is being left already; other timers mean nothing."""
    for thread in turn.threads.values():
        for index, guard in enumerate(thread.guards):
            if guard.limit == timer:
                _strike(turn, thread, index)
                return


def _strike(turn: Turn, thread: Thread, index: int) -> None:
    """A thread that is in a `final` handler within the limit carries that out first, with all that it has begun."""
    guard = thread.guards[index]
    why = f"The time limit of {guard.seconds:g} s was over."
    wake = Wake("timed_out", why, final=True, limit=guard.limit)
    first = next((place for place, item in enumerate(thread.pending) if item.guards > index), None)
    if _goes_further(thread, thread.wake if first is None else thread.pending[first].wake, index):
        return
    if first is not None:
        pending = (*thread.pending[:first], replace(thread.pending[first], wake=wake), *thread.pending[first + 1 :])
        turn.keep(replace(thread, pending=pending))
        return
    call_off_branches(turn, thread, Wake("cancelled", why, final=True, limit=guard.limit))
    tell_at_once(turn, turn.threads[thread.id], wake)


def _goes_further(thread: Thread, wake: Wake | None, index: int) -> bool:
    """Tell whether a thread was told to end more than the limit with this index among its guards."""
    if wake is None or not wake.final:
        return False
    return all(guard.limit != wake.limit for guard in thread.guards[index:]) if wake.limit else True

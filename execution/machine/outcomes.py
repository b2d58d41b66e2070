"""How threads end: failures go outwards to a handler, an End past all but the `final` ones; pure."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from editor.language.plan import instructions as p
from execution.machine.messages import Action, Cancel, CancelQuestion, Finished, StepFailed, StepLeft
from execution.machine.state import FLOOR_TASK, MAIN, Ending, Guard, Pending, RunStatus, Thread, Wake
from execution.machine.turn import Failure, Turn

OVER = Wake(final=True)
CALLED_OFF = Wake("cancelled", "Another branch failed.", final=True)
ENOUGH_ENDED = Wake("cancelled", "Enough other branches have ended.", final=True)
PROGRAM_OVER = "The program was over."
_IN_GOOD_ORDER = frozenset({OVER, CALLED_OFF, ENOUGH_ENDED})
"""What threads are told that are called off; anything else that is final is a failure in a `final` handler."""


def unwind(turn: Turn, thread: Thread, wake: Wake) -> None:
    """Go on at the innermost guard that takes this; without one the thread ends, and its parent or the run fails."""
    thread = _mark(turn, replace(thread, wake=None), len(thread.open), wake)
    while True:
        index, leaving = _guard_for(thread, wake), _leaving(thread)
        if not wake.final and leaving is not None and index < leaving.guards:
            wake = replace(wake, final=True, limit=leaving.wake.limit)
            _note_failure(turn, wake)
        elif index >= 0 and thread.guards[index].limit:
            thread = _leave_guards(turn, thread, index, wake)
            wake = Wake(wake.kind, wake.why)
        else:
            break
    if index < 0:
        _end(turn, thread, wake)
    else:
        _handle(turn, thread, index, wake)


def _leaving(thread: Thread) -> Pending | None:
    """Return the innermost `final` handler by which the thread leaves for good, or what a time limit is around."""
    return next((item for item in reversed(thread.pending) if item.wake.final), None)


def _guard_for(thread: Thread, wake: Wake) -> int:
    """Return the index of the innermost guard that takes this, or -1.

    A `final` handler by which a thread leaves keeps what fails in it: no guard outside of that may catch it.
    """
    leaving = _leaving(thread)
    inside = leaving.guards if leaving is not None else 0
    for index in range(len(thread.guards) - 1, -1, -1):
        guard = thread.guards[index]
        if guard.limit:
            fits = guard.limit == wake.limit
        else:
            fits = not wake.final and index >= inside and (not guard.kinds or wake.kind in guard.kinds)
        if guard.final or fits:
            return index
    return -1


def _note_failure(turn: Turn, wake: Wake) -> None:
    """A failure in a `final` handler on the way out makes a run fail that would have ended well."""
    if not wake.limit and turn.ending is not None and turn.ending.status == "finished":
        turn.ending = Ending("failed", wake.why)


def _leave_guards(turn: Turn, thread: Thread, index: int, wake: Wake) -> Thread:
    """Return a thread that stands where it began this guard, with the steps in it marked, and keep it."""
    guard = thread.guards[index]
    thread = _mark(turn, thread, guard.open, wake)
    _drop_frames(turn, thread, guard.calls)
    drop_limits(turn, thread.guards[index + 1 :])
    pending = tuple(item for item in thread.pending if item.guards <= index)
    calls, guards = thread.calls[: guard.calls], thread.guards[:index]
    return turn.keep(replace(thread, calls=calls, guards=guards, pending=pending))


def drop_limits(turn: Turn, guards: Iterable[Guard]) -> None:
    """Say that the timers of time limits that are left are not needed any more."""
    for guard in guards:
        turn.drop_timer(guard.limit)


def _handle(turn: Turn, thread: Thread, index: int, wake: Wake) -> None:
    guard = thread.guards[index]
    thread = _leave_guards(turn, thread, index, wake)
    pending = thread.pending
    if guard.final:
        pending = (*pending, Pending(guard.handler, guard.calls, index, wake))
    thread = turn.keep(replace(thread, at=guard.handler, pending=pending))
    instructions = turn.plan.instructions
    begins = instructions[guard.handler].do if 0 <= guard.handler < len(instructions) else None
    if isinstance(begins, p.Caught):
        turn.assign(thread, begins.text, wake.why, shared=False)
        turn.assign(thread, begins.kind, wake.kind, shared=False)


def _end(turn: Turn, thread: Thread, wake: Wake) -> None:
    """Take a thread away that nothing holds any more; what failed goes on in its parent."""
    _mark(turn, thread, 0, wake)
    remove(turn, thread)
    parent = turn.threads.get(thread.parent) if thread.parent is not None else None
    if wake.final:
        if parent is not None and turn.ending is None and not _is_called_off(wake):
            _spoil(turn, parent, wake)
        return
    if parent is None:
        end_run(turn, "failed", wake.why)
        return
    call_off_branches(turn, parent, CALLED_OFF)
    if parent.wake is None:
        turn.keep(replace(parent, wake=Wake(wake.kind, wake.why)))


def _is_called_off(wake: Wake) -> bool:
    """Tell whether a thread ends because it was told to, not because something failed on its way out."""
    return wake in _IN_GOOD_ORDER or (wake.limit != 0 and wake.kind == "cancelled")


def _spoil(turn: Turn, parent: Thread, wake: Wake) -> None:
    """A branch that was called off failed in a `final` handler on its way out: so does what goes on without it."""
    if parent.wake is None:
        call_off_branches(turn, parent, CALLED_OFF)
        turn.keep(replace(parent, wake=Wake(wake.kind, wake.why)))
    elif parent.wake == ENOUGH_ENDED:
        turn.keep(replace(parent, wake=wake))


def call_off_branches(turn: Turn, thread: Thread, wake: Wake) -> None:
    """Tell the branches that a thread has forked to end, with theirs."""
    above = {thread.id, *(other.id for other in turn.ancestors(thread))}
    for other in list(_descendants(turn, thread)):
        if not _is_spared(turn, other, above):
            _tell(turn, other, wake)


def remove(turn: Turn, thread: Thread) -> None:
    """Take a thread away with the frames of its functions and its time limits."""
    drop_limits(turn, thread.guards)
    _drop_frames(turn, thread, 0 if thread.event >= 0 else 1)
    turn.threads.pop(thread.id, None)


def _drop_frames(turn: Turn, thread: Thread, depth: int) -> None:
    for call in thread.calls[depth:]:
        if call.frame != MAIN:
            turn.frames.pop(call.frame, None)


def _descendants(turn: Turn, thread: Thread) -> Iterator[Thread]:
    for child in turn.children(thread):
        yield child
        yield from _descendants(turn, child)


def end_run(turn: Turn, status: RunStatus, reason: str, by: Thread | None = None) -> None:
    """Let every thread but the one that ends the run unwind; the first ending counts."""
    if turn.ending is not None:
        return
    turn.ending = Ending("failed" if status == "failed" else "finished", reason)
    over = Wake("cancelled", reason or PROGRAM_OVER, final=True)
    above = {thread.id for thread in turn.ancestors(by)} if by else set()
    for thread in list(turn.threads.values()):
        if thread.id in above:
            turn.keep(replace(thread, wake=OVER))
        elif (by is None or thread.id != by.id) and not _is_spared(turn, thread, above):
            _tell(turn, thread, over)


def _is_spared(turn: Turn, thread: Thread, above: set[int]) -> bool:
    """Tell whether a thread is a branch within a `final` handler, which is carried out to its end."""
    return any(ancestor.pending and ancestor.id not in above for ancestor in turn.ancestors(thread))


def _tell(turn: Turn, thread: Thread, wake: Wake) -> None:
    """Tell a thread to end; one that is in a `final` handler carries it out first, with what has failed in that."""
    if thread.pending:
        first, *inner = thread.pending
        turn.keep(replace(thread, pending=(replace(first, wake=wake), *inner)))
        return
    tell_at_once(turn, thread, wake)


def tell_at_once(turn: Turn, thread: Thread, wake: Wake) -> None:
    """Tell a thread to end, whatever it waits for; for the branches that it has forked it still waits."""
    call_off(turn, thread)
    waits = thread.waits_for if thread.waits_for == "join" else ""
    turn.keep(replace(thread, waits_for=waits, waits_id=0, wake=wake))


def call_off(turn: Turn, thread: Thread) -> None:
    """Say that nothing of what a thread waits for is wanted any more."""
    if thread.wake is not None or thread.waits_for in {"", "join"}:
        return
    if thread.waits_for == FLOOR_TASK:
        turn.actions.append(Cancel(thread.waits_id))
    elif thread.waits_for == "ask":
        turn.actions.append(CancelQuestion(thread.waits_id))
        turn.drop_timer(thread.waits_id)
    else:
        turn.drop_timer(thread.waits_id)


def rethrow(turn: Turn, thread: Thread) -> Thread:
    """Behind a `final` handler: go on failing or ending as before it, or simply on if nothing was on its way."""
    handler = _handler_of(turn, thread.at)
    top = thread.pending[-1] if thread.pending else None
    if top is None or (top.handler, top.calls) != (handler, len(thread.calls)):
        return turn.go(thread)
    turn.keep(replace(thread, pending=thread.pending[:-1]))
    raise Failure.of(top.wake)


def _handler_of(turn: Turn, address: int) -> int:
    """Return where the handler begins that this Rethrow ends; handlers lie within each other like brackets."""
    instructions = turn.plan.instructions
    handlers = {i.do.handler for i in instructions if isinstance(i.do, p.TryBegin) and i.do.final}
    depth = 0
    for at in range(address, -1, -1):
        if at != address and isinstance(instructions[at].do, p.Rethrow):
            depth += 1
        if at in handlers:
            if depth == 0:
                return at
            depth -= 1
    return -1


def begin_guard(turn: Turn, thread: Thread, guard: Guard) -> Thread:
    """Enter a guarded stretch; what an earlier time round left pending there is forgotten."""
    stale = (guard.handler, guard.calls)
    pending = tuple(item for item in thread.pending if (item.handler, item.calls) != stale)
    return turn.go(replace(thread, guards=(*thread.guards, guard), pending=pending))


def end_guard(turn: Turn, thread: Thread) -> Thread:
    """Leave the innermost guarded stretch."""
    drop_limits(turn, thread.guards[-1:])
    guards = thread.guards[:-1]
    return turn.go(replace(thread, guards=guards, pending=_still_pending(thread, len(guards), len(thread.calls))))


def _still_pending(thread: Thread, guards: int, calls: int) -> tuple[Pending, ...]:
    return tuple(item for item in thread.pending if item.guards <= guards and item.calls <= calls)


def leave_call(turn: Turn, thread: Thread, calls: int) -> Thread:
    """Drop the guards and handlers of a function that is over."""
    drop_limits(turn, (guard for guard in thread.guards if guard.calls > calls))
    guards = tuple(guard for guard in thread.guards if guard.calls <= calls)
    return replace(thread, guards=guards, pending=_still_pending(thread, len(guards), calls))


def _mark(turn: Turn, thread: Thread, depth: int, wake: Wake) -> Thread:
    """Mark the plain step, and the holding ones down to a depth, as done or failed."""
    names = [thread.leaf] if thread.leaf else []
    names += reversed(thread.open[depth:])
    turn.actions.extend(_marked(name, wake) for name in names)
    return turn.keep(replace(thread, leaf="", open=thread.open[:depth]))


def _marked(name: str, wake: Wake) -> Action:
    return StepFailed(name, wake.kind, wake.why) if wake.kind else StepLeft(name)


def finish(turn: Turn, status: RunStatus, reason: str) -> None:
    """End the run now: whatever is still under way is called off, no handler is carried out."""
    wake = Wake("cancelled", reason or PROGRAM_OVER, final=True)
    for thread in list(turn.threads.values()):
        call_off(turn, thread)
        _mark(turn, thread, 0, wake)
        remove(turn, thread)
    turn.status, turn.reason = status, reason
    turn.actions.append(Finished(status, reason))

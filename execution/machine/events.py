"""Events: bodies that run beside the program each time a condition becomes true; pure."""

from __future__ import annotations

from dataclasses import replace

from editor.language.plan import instructions as p
from execution.machine.ending import end_run
from execution.machine.evaluation import EvaluationError, NoReading
from execution.machine.messages import StepEntered, StepFailed
from execution.machine.state import Activation, Thread
from execution.machine.turn import YIELD_S, Turn


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
            _start(turn, number, event)


def _watched(turn: Turn) -> list[tuple[int, p.EventEntry]]:
    if turn.ending is not None:
        return []
    return [(number, event) for number, event in enumerate(turn.plan.events) if event.starts == "branch"]


def _holds(turn: Turn, event: p.EventEntry) -> bool:
    """Tell whether the condition holds; one that cannot be worked out at all fails the run."""
    try:
        return turn.holds(None, event.condition)
    except NoReading:
        return False
    except EvaluationError as error:
        turn.actions.append(StepFailed(event.step, "failed", str(error)))
        end_run(turn, "failed", str(error))
        return False


def _start(turn: Turn, number: int, event: p.EventEntry) -> None:
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

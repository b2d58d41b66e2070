"""What a run is told a little later than it came: an end whose device is about to speak, or one too many at once."""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from execution.engine.memory import SiteMemory
from execution.floor_protocol import TaskEnded
from execution.machine.turn import YIELD_S
from execution.runs.fold import RunWork
from execution.runs.reading_grace import AT_MOST, is_early

REST = timedelta(seconds=YIELD_S)
NOT_HELD = timedelta(0)


@dataclass(frozen=True, slots=True)
class Mail:
    """A message that is on its way within a turn; `row` is where it was kept, 0 where it never was."""

    message: Any
    since: Any
    row: int = 0


def held_for(site: SiteMemory, work: RunWork, mail: Mail, asked: Set[tuple[str, int]], now: datetime) -> timedelta:
    """Return how long a run is not told something yet; nothing where it is told now.

    `asked` are the tasks, by run and number, that were asked for in this turn.
    """
    message = mail.message
    if not isinstance(message, TaskEnded):
        return NOT_HELD
    rest = _rest(site, work.id, message.task, now, is_at_once=not mail.row and (work.id, message.task) in asked)
    if rest > NOT_HELD:
        return rest
    is_end = not message.kind and bool(work.needs.properties)
    order = site.order_of(work, message.task) if is_end else None
    return AT_MOST if is_end and is_early(work.row, work.needs, message, order, mail.since, now) else NOT_HELD


def _rest(site: SiteMemory, run: str, task: int, now: datetime, *, is_at_once: bool) -> timedelta:
    """Return how long a task that has ended at once, once too often, still rests; any other does not."""
    resting = site.resting.setdefault(run, {})
    if is_at_once and site.at_once.is_too_often(run, now.timestamp()):
        resting[task] = now + REST
    rest = resting.get(task, now) - now
    if not NOT_HELD < rest <= REST:  # a clock that was put back keeps nobody waiting
        resting.pop(task, None)
        return NOT_HELD
    return rest

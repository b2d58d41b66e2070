"""Who goes first where several tasks wait for robots: higher priority, then earlier deadline; nobody waits for ever."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from math import inf

from execution.traffic.floor_state import FloorTask
from execution.traffic.turn import Turn

AGE_S = 300.0
"""For each such time that a task has stood behind others it counts as one priority higher, without end."""

Waiting = tuple[str, FloorTask]
"""A task with the key of its role, `run/role`."""


def in_groups(turn: Turn, waiting: Sequence[Waiting]) -> Iterator[list[Waiting]]:
    """Go through waiting tasks by precedence, the first to choose first; those of a group are equal."""
    ordered = sorted(waiting, key=lambda each: _rank(turn, each[1]))
    for _, group in groupby(ordered, key=lambda each: _rank(turn, each[1])):
        yield list(group)


def note_behind(turn: Turn, waiting: Sequence[Waiting]) -> None:
    """Keep since when those have stood behind others that have found no robot."""
    best = min((_rank(turn, task) for _, task in waiting), default=None)
    for key, task in waiting:
        now = turn.tasks.get((task.run, task.number))
        if now is not None and key not in turn.roles and now.behind_since is None and _rank(turn, task) != best:
            turn.put_task(now, behind_since=turn.now)


def _rank(turn: Turn, task: FloorTask) -> tuple[float, float]:
    aged = 0 if task.behind_since is None else int(max(0.0, turn.now - task.behind_since) // AGE_S)
    return -(task.priority + aged), task.due or inf

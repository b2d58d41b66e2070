"""How often what a run asks the floor for may end in the moment in which it is asked; pure.

A loop that tries again what fails at once never waits, and each time round is a step of the machine with a share of
its own (`turn.GLUE_LIMIT`): by this it rests all the same.
"""

from __future__ import annotations

from execution.machine.turn import YIELD_S

MOST_AT_ONCE = 15
"""So many tasks of a run may end at once within YIELD_S; what ends so beyond that is told to it YIELD_S later.

Fewer than the rounds of a turn, so that such a loop leaves nothing for the next one."""


class EndsAtOnce:
    """Counts by run what has ended in the moment in which it was asked for."""

    def __init__(self) -> None:
        self._counted: dict[str, tuple[float, int]] = {}

    def is_too_often(self, run: str, now: float) -> bool:
        """Count one that has ended so (`now` in seconds); tell whether that is more than a run may have."""
        since, count = self._counted.get(run, (now, 0))
        if not 0 <= now - since < YIELD_S:
            since, count = now, 0
        self._counted[run] = (since, count + 1)
        return count >= MOST_AT_ONCE

    def forget(self, run: str) -> None:
        """Forget a run that is over."""
        self._counted.pop(run, None)

"""Whether the mirror hears things when they happen: what it has not, or hears late, is not to be measured. Pure."""

from __future__ import annotations

FROZEN_S = 3.0
"""Who comes round so late was frozen, or had no turn: what was heard meanwhile has the wrong time."""
SETTLING_S = 3.0
"""After that, and after each new connection, what was kept for the mirror comes at once."""


class Attention:
    """Tells from when the mirror comes round, and when its line was new. Times are of a clock that only rises."""

    def __init__(self) -> None:
        self._turned_at: float | None = None
        self._settled_at = 0.0

    def turn(self, now: float, *, is_new_line: bool) -> bool:
        """Take in that the mirror comes round; False where something was missed, and what is under way is worthless."""
        last, self._turned_at = self._turned_at, now
        is_whole = not is_new_line and (last is None or now - last < FROZEN_S)
        if not is_whole:
            self._settled_at = now + SETTLING_S
        return is_whole

    def hears(self, at: float) -> bool:
        """Tell whether what has come at this time has happened then."""
        return at >= self._settled_at

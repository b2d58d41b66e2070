"""Whether a vehicle is there, by what it says of its connection, by its last will and its states."""

from __future__ import annotations

from collections.abc import Mapping

SILENT_LIMIT_S = 75.0
"""A vehicle says its state at least every 30 s; one that misses two counts as gone, whatever its connection says."""
ASK_S = 1.0
ASK_AGAIN_S = 30.0
PATIENCE_S = 10.0
"""So long a vehicle may take to become a device before the log says what is missing."""
STATES_OF_LIFE = 2
"""So many states after its last will show that a vehicle is there: the will was that of an earlier connection."""


class ConnectionState:
    """Times are seconds of one clock. What the vehicle tells by itself is waited for a moment before it is asked."""

    def __init__(self) -> None:
        self.is_connected = False
        self._heard_s = 0.0
        self._states_since_will: int | None = 0
        self._ask_at_s: dict[str, float] = {}
        self._missing_at_s = 0.0

    def hear_connection(self, said: str, now_s: float) -> None:
        """Take in ONLINE, OFFLINE or CONNECTIONBROKEN; some say every few seconds ONLINE, which changes nothing."""
        was_connected, self.is_connected = self.is_connected, said == "ONLINE"
        self._states_since_will = 0 if said == "CONNECTIONBROKEN" else None
        if not (was_connected and self.is_connected):
            self._heard_s = 0.0
            self._expect(now_s)

    def hear_state(self, now_s: float) -> None:
        """Take in a state: who goes on telling it after its last will, or without any word, is connected."""
        self._heard_s = now_s
        if self._states_since_will is not None:
            self._states_since_will += 1
            if self._states_since_will >= STATES_OF_LIFE:
                self.is_connected, self._states_since_will = True, None
                self._expect(now_s)

    def lose_sight(self, now_s: float) -> None:
        """Take in that the vehicles' broker is not reached: the next state is waited for."""
        if self._heard_s:
            self._heard_s, self._ask_at_s["stateRequest"] = 0.0, now_s + ASK_S

    def is_online(self, now_s: float) -> bool:
        """Tell whether the vehicle is connected, and was heard of lately."""
        return self.is_connected and self._heard_s > 0 and now_s - self._heard_s < SILENT_LIMIT_S

    def take_questions(self, now_s: float, *, has_sheet: bool) -> list[str]:
        """Return the instant actions that ask for what does not come by itself, if it is time; then not for a while."""
        is_missing: Mapping[str, bool] = {"stateRequest": self._heard_s == 0, "factsheetRequest": not has_sheet}
        due = [w for w, at_s in self._ask_at_s.items() if self.is_connected and is_missing[w] and now_s >= at_s]
        self._ask_at_s.update(dict.fromkeys(due, now_s + ASK_AGAIN_S))
        return due

    def is_long_here(self, now_s: float) -> bool:
        """Tell whether the vehicle has been connected long enough to have told everything."""
        return self.is_connected and now_s >= self._missing_at_s

    def _expect(self, now_s: float) -> None:
        self._ask_at_s = {"stateRequest": now_s + ASK_S, "factsheetRequest": now_s + ASK_S}
        self._missing_at_s = now_s + PATIENCE_S

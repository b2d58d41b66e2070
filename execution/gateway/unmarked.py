"""Commands that have gone out and of which the database is still to be told."""

from __future__ import annotations

import threading
from collections.abc import Iterable
from datetime import datetime

from vipo_device.protocol.clock import steady_s

MARK_AFTER_S = 0.1


class Unmarked:
    """What one thread sends and another hears answers to: an answer says that a command has gone out, too."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._sent: dict[str, datetime] = {}
        self._since_s = 0.0

    def add(self, commands: Iterable[str], at: datetime) -> None:
        """Take in that these have gone out."""
        with self._lock:
            self._since_s = self._since_s if self._sent else steady_s()
            self._sent |= dict.fromkeys(commands, at)

    def forget(self, commands: Iterable[str]) -> None:
        """Take in that the database knows of these."""
        with self._lock:
            for command in commands:
                self._sent.pop(command, None)

    def list_due(self, *, all_of_it: bool = False) -> dict[str, datetime]:
        """Return when which have gone out, once the first of them waits for a moment; before that nothing."""
        with self._lock:
            is_due = all_of_it or steady_s() - self._since_s >= MARK_AFTER_S
            return dict(self._sent) if is_due else {}

"""A server that is away for a while: said once when it begins and once when it is over."""

from __future__ import annotations

import logging
import threading
import time

log = logging.getLogger(__name__)


class Outage:
    """Knows whether a server answers; may be told by several threads. `count` is how often it was away so far."""

    def __init__(self, server: str, meanwhile: str) -> None:
        self._server, self._meanwhile = server, meanwhile
        self._lock = threading.Lock()
        self._since: float | None = None
        self.count = 0

    def begin(self, error: BaseException) -> None:
        """Take in that the server did not answer."""
        with self._lock:
            if self._since is not None:
                return
            self._since, self.count = time.monotonic(), self.count + 1
        why = str(error).strip().partition("\n")[0].rstrip(".")
        log.warning("%s does not answer: %s. %s", self._server, why, self._meanwhile)

    def end(self) -> None:
        """Take in that the server answers."""
        if self._since is None:
            return
        with self._lock:
            since, self._since = self._since, None
        if since is not None:
            log.warning("%s answers again after %.1f s.", self._server, time.monotonic() - since)

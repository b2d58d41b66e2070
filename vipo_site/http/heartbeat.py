"""The heartbeat of a web process: it beats while Daphne's loop goes round, and measures how long calls wait for it."""

from __future__ import annotations

import sys
import time
from typing import Any

from registry.services import HeartbeatWriter, time_spent

TURN_S = 1.0


def beat_while_serving() -> None:
    """Begin to beat when Daphne serves, and say goodbye when it ends; another server than Daphne has no reactor."""
    if "twisted.internet.reactor" in sys.modules:
        from twisted.internet import reactor

        reactor.callWhenRunning(_begin, reactor)


def _begin(reactor: Any) -> None:
    from twisted.internet.threads import deferToThread

    heartbeat = HeartbeatWriter("web").start()
    reactor.addSystemEventTrigger("before", "shutdown", deferToThread, heartbeat.stop)
    _turn(reactor, heartbeat, time.monotonic())


def _turn(reactor: Any, heartbeat: HeartbeatWriter, due_s: float) -> None:
    """Note that the loop has come round, and how late."""
    now_s = time.monotonic()
    time_spent(name="loop_lag_seconds", seconds=max(0.0, now_s - due_s))
    heartbeat.beat("works")
    reactor.callLater(TURN_S, _turn, reactor, heartbeat, now_s + TURN_S)

"""`manage.py ticker`: timers, lost hints, stale devices. Any number may run; one works."""

from __future__ import annotations

import signal
import threading
from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand

from execution.ticker.ticker import run_ticker
from registry.services import HeartbeatWriter


class Command(BaseCommand):
    """Runs the ticker until it is told to stop."""

    help = "Run the ticker: due timers, lost hints, stale devices."
    requires_system_checks = ()  # it serves no pages, and starts a second sooner

    def handle(self, *args: Any, **options: Any) -> None:
        """Run until SIGTERM or SIGINT."""
        stopping = threading.Event()
        for number in (signal.SIGTERM, signal.SIGINT):
            signal.signal(number, lambda *_: stopping.set())
        heartbeat = HeartbeatWriter("ticker", liveness_file=settings.VIPO_PULSE).start()
        try:
            run_ticker(stopping=stopping, heartbeat=heartbeat)
        finally:
            heartbeat.stop()

"""Run one gateway between MQTT and the database until SIGTERM or Ctrl-C."""

from __future__ import annotations

import signal
import threading
from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand

from execution.gateway.gateway import Gateway
from registry.services import HeartbeatWriter


class Command(BaseCommand):
    """`manage.py gateway`; start as many as the load needs."""

    help = __doc__ or ""
    requires_system_checks = ()  # it serves no pages, and starts a second sooner

    def handle(self, *_args: Any, **_options: Any) -> None:
        """Serve."""
        stopping = threading.Event()
        for number in (signal.SIGTERM, signal.SIGINT):
            signal.signal(number, lambda *_: stopping.set())
        heartbeat = HeartbeatWriter("gateway", settings.VIPO_GATEWAY, liveness_file=settings.VIPO_PULSE).start()
        try:
            Gateway(settings, heartbeat).run_forever(stopping)
        finally:
            heartbeat.stop()

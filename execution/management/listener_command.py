"""The command of a process that is a `Listener`: its speed, its heartbeat, its end."""

from __future__ import annotations

from argparse import ArgumentParser
from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand, CommandError

from execution.listener import Listener
from registry.services import HeartbeatWriter, ProcessKind
from vipo_device.kit.shutdown import stop_on_signals

STOP_LIMIT_S = 10


class ListenerCommand(BaseCommand):
    """Serves until SIGTERM or Ctrl-C."""

    requires_system_checks = ()  # it serves no pages, and starts a second sooner
    kind: ProcessKind
    listener: type[Listener]

    def add_arguments(self, parser: ArgumentParser) -> None:
        """Say what can be chosen."""
        parser.add_argument("--speed", type=float, default=1.0, help="of all devices, times real time (1)")

    def handle(self, *_args: Any, **options: Any) -> None:
        """Serve."""
        if not 0.1 <= options["speed"] <= 100:
            raise CommandError(f"--speed {options['speed']:g} is outside 0.1 to 100; 1 is real time.")
        stopping = stop_on_signals(STOP_LIMIT_S)
        heartbeat = HeartbeatWriter(self.kind, liveness_file=settings.VIPO_PULSE).start()
        try:
            self.listener(settings, heartbeat, speed=options["speed"]).run_forever(stopping)
        finally:
            heartbeat.stop()

"""Play the devices that are simulated in place of real ones, of all sites, until SIGTERM or Ctrl-C."""

from __future__ import annotations

from argparse import ArgumentParser
from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand, CommandError

from execution.stand_ins.stand_ins import StandIns
from registry.services import Heart
from vipo_device.kit.shutdown import stop_on_signals

STOP_LIMIT_S = 10


class Command(BaseCommand):
    """`manage.py stand_ins`; one is enough, of several one plays."""

    help = __doc__ or ""

    def add_arguments(self, parser: ArgumentParser) -> None:
        """Say what can be chosen."""
        parser.add_argument("--speed", type=float, default=1.0, help="of all devices, times real time (1)")

    def handle(self, *_args: Any, **options: Any) -> None:
        """Serve."""
        if not 0.1 <= options["speed"] <= 100:
            raise CommandError(f"--speed {options['speed']:g} is outside 0.1 to 100; 1 is real time.")
        stopping = stop_on_signals(STOP_LIMIT_S)
        heart = Heart("stand-ins", pulse=settings.VIPO_PULSE).start()
        try:
            StandIns(settings, heart, speed=options["speed"]).run_forever(stopping)
        finally:
            heart.stop()

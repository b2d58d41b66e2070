"""`manage.py seed_demo`: fill in the painting factory."""

from __future__ import annotations

from argparse import ArgumentParser
from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand

from registry.demo.seed import seed_demo
from registry.demo.workshop import seed_workshop


class Command(BaseCommand):
    """Make what is missing of the demo's site; harmless when done again."""

    help = "Fill in the painting factory: site, map, places, two accounts and the devices' keys."

    def add_arguments(self, parser: ArgumentParser) -> None:
        """Say what can be chosen."""
        parser.add_argument("--empty-floor", action="store_true", help="make a second site, which nobody has mapped")

    def handle(self, *args: Any, **options: Any) -> None:
        """Run, and say who can sign in."""
        accounts = seed_demo(state=settings.VIPO_STATE_DIR)
        if options["empty_floor"]:
            seed_workshop(people={account["email"]: account["role"] for account in accounts})
        if options["verbosity"]:
            for account in accounts:
                self.stdout.write(f"{account['role']:<7} {account['email']:<22} {account['password']}")

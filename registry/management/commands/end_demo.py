"""`manage.py end_demo`: end the accounts of the demo, whose passwords are known."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand

from registry.demo.accounts import end_accounts


class Command(BaseCommand):
    """Take the demo's known passwords away; its site stays. Harmless where there was no demo."""

    help = __doc__ or ""

    def handle(self, *_args: Any, **_options: Any) -> None:
        """Say who cannot sign in any more."""
        for email in end_accounts(state=Path(settings.VIPO_STATE_DIR)):
            self.stdout.write(f"{email} was an account of the demo and cannot sign in any more.")

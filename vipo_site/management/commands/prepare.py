"""Bring the database up to date; fill in the painting factory when VIPO_DEMO=1, else end its accounts."""

from __future__ import annotations

from typing import Any

from django.conf import settings
from django.core.management import call_command
from django.core.management.base import BaseCommand


class Command(BaseCommand):
    """`manage.py prepare`: run once before the other processes of a new version start."""

    help = __doc__ or ""

    def handle(self, *_args: Any, **_options: Any) -> None:
        """Migrate, then seed or end the demo; all may be repeated."""
        call_command("migrate", verbosity=0, interactive=False)
        if not settings.VIPO_DEMO:
            call_command("end_demo")
            return
        from editor.services import seed_library, seed_programs

        call_command("seed_demo", verbosity=0)
        seed_programs(site=settings.VIPO_DEFAULT_SITE)
        seed_library(site=settings.VIPO_DEFAULT_SITE)

"""Write the API's OpenAPI file, docs/openapi.json."""

from __future__ import annotations

from argparse import ArgumentParser
from pathlib import Path
from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand

from vipo_site.http.api import api
from vipo_site.http.openapi import describe


class Command(BaseCommand):
    """`manage.py openapi`; `make openapi` also makes the frontend's types from it."""

    help = __doc__ or ""

    def add_arguments(self, parser: ArgumentParser) -> None:
        """Take the file's path."""
        parser.add_argument("file", nargs="?", default=str(settings.BASE_DIR / "docs" / "openapi.json"))

    def handle(self, *_args: Any, file: str, **_options: Any) -> None:
        """Write the file."""
        Path(file).write_text(describe(api), encoding="utf-8")

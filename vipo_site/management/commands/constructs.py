"""Write what follows from the records of constructs: the editor's file of them, and the table of the document."""

from __future__ import annotations

from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand

from editor.language.constructs.json_form import write_constructs, write_table

FILE = settings.BASE_DIR / "frontend" / "src" / "program" / "constructs.json"
PAGE = settings.BASE_DIR / "docs" / "shapes" / "document.md"
_HEADING = "| kind | params |"


def with_table(page: str) -> str:
    """Return the page of the document's shape with the table of kinds as the records have it."""
    before, _, rest = page.partition(_HEADING)
    return f"{before}{write_table()}\n{rest.partition(chr(10) * 2)[2]}"


class Command(BaseCommand):
    """`manage.py constructs`; `make constructs` also renews what the API says of steps."""

    help = __doc__ or ""

    def handle(self, *_args: Any, **_options: Any) -> None:
        """Write both."""
        FILE.write_text(write_constructs(), encoding="utf-8")
        PAGE.write_text(with_table(PAGE.read_text(encoding="utf-8")), encoding="utf-8")

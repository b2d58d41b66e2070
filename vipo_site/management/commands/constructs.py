"""Write what follows from the records of constructs and units: what the pages read, the document's table, words."""

from __future__ import annotations

import json
from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand

from editor.language.constructs.json_form import write_constructs, write_table
from vipo_device.protocol.units import UNITS

FILE = settings.BASE_DIR / "frontend" / "src" / "program" / "constructs.json"
PAGE = settings.BASE_DIR / "docs" / "shapes" / "document.md"
WORDS = settings.BASE_DIR / "editor" / "library" / "step_words.json"
CATALOGUES = settings.BASE_DIR / "frontend" / "src" / "i18n"
UNIT_SIGNS = CATALOGUES / "units.json"
_HEADING = "| kind | params |"


def with_table(page: str) -> str:
    """Return the page of the document's shape with the table of kinds as the records have it."""
    before, _, rest = page.partition(_HEADING)
    return f"{before}{write_table()}\n{rest.partition(chr(10) * 2)[2]}"


def write_words() -> str:
    """Return what the editor's catalogues call each kind of step in either language: the library is searched by it."""
    words: dict[str, dict[str, str]] = {}
    for language in ("en", "de"):
        texts = json.loads((CATALOGUES / language / "editor.json").read_text(encoding="utf-8"))
        for kind, also in texts["also"].items():
            words.setdefault(kind, {})[language] = f"{texts['kind'][kind]}, {also}"
    return json.dumps(words, indent=1, ensure_ascii=False) + "\n"


def write_units() -> str:
    """Return the codes of all units with their symbols, as the pages show them."""
    return json.dumps({unit.code: unit.symbol for unit in UNITS.values()}, indent=2, ensure_ascii=False) + "\n"


class Command(BaseCommand):
    """`manage.py constructs`; `make constructs` also renews what the API says of steps."""

    help = __doc__ or ""

    def handle(self, *_args: Any, **_options: Any) -> None:
        """Write all four."""
        WORDS.write_text(write_words(), encoding="utf-8")
        UNIT_SIGNS.write_text(write_units(), encoding="utf-8")
        FILE.write_text(write_constructs(), encoding="utf-8")
        PAGE.write_text(with_table(PAGE.read_text(encoding="utf-8")), encoding="utf-8")

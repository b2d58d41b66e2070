"""The programs that the demo begins with."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from django.conf import settings

from editor.models import Program
from editor.programs.programs import create_program
from editor.rooms.document import empty_document

_SEEDS = (("Paint order", "paint-order.json"), ("First errand", None))


def seed_programs(*, site: str) -> None:
    """Give a site the example programs that it does not have yet; harmless when done again."""
    have = set(Program.objects.filter(site__slug=site).values_list("name", flat=True))
    for name, file in reversed(_SEEDS):
        if name in have:
            continue
        document = empty_document() if file is None else _read_example(Path(settings.BASE_DIR) / "examples" / file)
        if document is not None:
            create_program(site=site, name=name, document=document)


def _read_example(path: Path) -> dict[str, Any] | None:
    """Return the document of an example file: bare, or under `document`; None while there is no such file."""
    if not path.exists():
        return None
    body: dict[str, Any] = json.loads(path.read_text())
    document: dict[str, Any] = body.get("document", body)
    return document

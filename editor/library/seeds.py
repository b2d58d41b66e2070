"""The functions of the demo: what the library of the painting factory begins with."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from django.conf import settings

from editor.library.functions import Said, add_version
from editor.models import LibraryFunction
from registry import services as registry

_FILE = Path("examples") / "library" / "painting-factory.json"


def seed_library(*, site: str) -> None:
    """Give a site the example functions that it does not have yet; harmless when done again."""
    have = set(LibraryFunction.objects.filter(site__slug=site).values_list("name", flat=True))
    site_id = registry.get_site_id(site=site)
    for function in _read_examples():
        if function["name"] in have:
            continue
        said = Said(function["name"], function["description"], function["visibility"])
        for definition in function["versions"]:
            add_version(site_id, site, said, definition, None, None)


def _read_examples() -> list[dict[str, Any]]:
    path = Path(settings.BASE_DIR) / _FILE
    found: list[dict[str, Any]] = json.loads(path.read_text())["functions"] if path.exists() else []
    return found

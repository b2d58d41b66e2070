"""The W3C's own JSON Schema for Thing Descriptions 1.1, and whether a Thing keeps to it."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

from jsonschema import Draft7Validator
from jsonschema.exceptions import best_match

from registry.rdf_text import BadDescription, Fault

SCHEMA = Path(__file__).parent / "schemas" / "thing-description-1.1.json"


@cache
def _validator() -> Draft7Validator:
    return Draft7Validator(json.loads(SCHEMA.read_text(encoding="utf-8")))


def check_thing(body: Any) -> None:
    """Refuse a Thing that the schema does not allow, with its worst fault. Raises BadDescription."""
    error = best_match(_validator().iter_errors(body))
    if error is None:
        return
    path = "".join(f"/{str(part).replace('~', '~0').replace('/', '~1')}" for part in error.absolute_path)
    text = f"The description is no Thing Description 1.1: {error.message[:200].rstrip('.')}."
    raise BadDescription(Fault(text, path=path))

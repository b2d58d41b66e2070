"""The W3C's own JSON Schema for Thing Descriptions 1.1, and whether a Thing keeps to it.

Two libraries: one in Rust tells in microseconds that a Thing keeps to it; the other says what is wrong.
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

from jsonschema import Draft7Validator
from jsonschema.exceptions import best_match
from jsonschema_rs import Draft7Validator as QuickValidator

from registry.rdf_text import BadDescription, Fault

SCHEMA = Path(__file__).parent / "schemas" / "thing-description-1.1.json"
MOST_FAULTS = 5
REMEDIES = {
    "security": ' Such as "security": ["device_key"].',
    "securityDefinitions": ' Such as "securityDefinitions": {"device_key": {"scheme": "basic"}}.',
    "forms": ' Such as "forms": [{"href": "vipo/v1/dev/<id>/down/<action>"}].',
    "title": ' Such as "title": "Lamp".',
}
"""What people leave out, and how it is said."""


@cache
def _schema() -> Any:
    return json.loads(SCHEMA.read_text(encoding="utf-8"))


@cache
def _quick() -> QuickValidator:
    return QuickValidator(_schema(), validate_formats=False)


@cache
def _thorough() -> Draft7Validator:
    return Draft7Validator(_schema())


def check_thing(body: Any) -> None:
    """Refuse a Thing that the schema does not allow, with its first faults. Raises BadDescription."""
    if _quick().is_valid(body):
        return
    errors = sorted(_thorough().iter_errors(body), key=lambda error: error.json_path)
    faults = [_fault(best_match([error])) for error in errors[:MOST_FAULTS]]
    raise BadDescription(*faults, heading="The description is no Thing Description 1.1.")


def _fault(error: Any) -> Fault:
    path = "".join(f"/{str(part).replace('~', '~0').replace('/', '~1')}" for part in error.absolute_path)
    message = error.message if len(error.message) <= 200 else f"{error.message[:60]}…{error.message[-100:]}"
    remedy = next((text for name, text in REMEDIES.items() if message == f"{name!r} is a required property"), "")
    return Fault(f"The TD schema says: {message.rstrip('.')}.{remedy}", path=path)

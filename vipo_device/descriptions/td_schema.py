"""The W3C's own JSON Schema for Thing Descriptions 1.1, and whether a Thing keeps to it.

Two libraries: one in Rust tells in microseconds that a Thing keeps to it; the other says what is wrong.
"""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path
from typing import Any

from jsonschema import Draft7Validator
from jsonschema.exceptions import best_match
from jsonschema_rs import Draft7Validator as QuickValidator

from vipo_device.descriptions.forms import BadDescription
from vipo_device.protocol.faults import Fault, fault

SCHEMA = Path(__file__).parent / "schemas" / "thing-description-1.1.json"
MOST_FAULTS = 5
MOST_CHARACTERS = 160
EXAMPLES = {
    "security": '"security": ["device_key"]',
    "securityDefinitions": '"securityDefinitions": {"device_key": {"scheme": "basic"}}',
    "forms": '"forms": [{"href": "vipo/v1/dev/<id>/down/<action>"}]',
    "title": '"title": "Lamp"',
}
"""What people leave out, and how it is said."""
_MISSING = re.compile(r"'([^']+)' is a required property")


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
    if (missing := _MISSING.fullmatch(error.message)) and missing[1] in EXAMPLES:
        return fault("td_missing_such", 0, 0, path, name=missing[1], example=EXAMPLES[missing[1]])
    if missing:
        return fault("td_missing", 0, 0, path, name=missing[1])
    value = _shortened(repr(error.instance))
    match error.validator:
        case "type" if isinstance(error.validator_value, str):
            return fault("td_type", 0, 0, path, value=value, type=error.validator_value)
        case "enum":
            return fault("td_choice", 0, 0, path, value=value, choices=", ".join(map(str, error.validator_value)))
        case "minItems" | "minLength" | "minProperties":
            return fault("td_empty", 0, 0, path, value=value)
    return fault("td_unclear", 0, 0, path, reason=_shortened(error.message))


def _shortened(text: str) -> str:
    text = text.rstrip(".")
    return text if len(text) <= MOST_CHARACTERS else f"{text[:60]}…{text[-100:]}"

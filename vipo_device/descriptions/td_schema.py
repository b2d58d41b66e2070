"""The W3C's own JSON Schema for Thing Descriptions 1.1: whether a Thing keeps to it, and if not, what is wrong."""

from __future__ import annotations

import heapq
import json
from functools import cache
from pathlib import Path
from typing import Any

from jsonschema_rs import Draft7, Draft7Validator, ValidationError, is_valid
from jsonschema_rs import ValidationErrorKind as Kind

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


@cache
def _schema() -> Any:
    return json.loads(SCHEMA.read_text(encoding="utf-8"))


@cache
def _validator() -> Draft7Validator:
    return Draft7Validator(_schema(), validate_formats=False)


def check_thing(body: Any) -> None:
    """Refuse a Thing that the schema does not allow, with its first faults. Raises BadDescription."""
    if _validator().is_valid(body):
        return
    errors = sorted(_validator().iter_errors(body), key=_order)
    faults = [_fault(_most_telling(error, body), body) for error in errors[:MOST_FAULTS]]
    raise BadDescription(*faults, heading="The description is no Thing Description 1.1.")


def _order(error: ValidationError) -> list[tuple[bool, str]]:
    """Sort by place, with plain names before what has `@` or a colon in it."""
    return [(not str(part).isidentifier(), str(part)) for part in error.instance_path]


def _most_telling(error: ValidationError, body: Any) -> ValidationError:
    """Go down from "none of these schemas" to the fault that was probably meant; stay where two are as likely.

    The deepest fault is: whoever wrote it came nearest to that schema. It is the rule of the package `jsonschema`.
    """

    def unlikeliness(inner: ValidationError) -> tuple[Any, ...]:
        path = inner.instance_path
        is_choice = inner.kind.name in ("oneOf", "anyOf")
        return -len(path), path, not is_choice, not _is_of_right_type(inner, body)

    while inner := [each for branch in getattr(error.kind, "context", ()) for each in branch]:
        first = heapq.nsmallest(2, inner, key=unlikeliness)
        if len(first) == 2 and unlikeliness(first[0]) == unlikeliness(first[1]):
            return error
        error = first[0]
    return error


def _is_of_right_type(error: ValidationError, body: Any) -> bool:
    """Tell whether the schema that was broken names a type, and the value is of it."""
    schema = _at(_schema(), error.schema_path[:-1])
    named = isinstance(schema, dict) and "type" in schema
    return named and is_valid({"type": schema["type"]}, _at(body, error.instance_path), draft=Draft7)


def _fault(error: ValidationError, body: Any) -> Fault:
    path = _pointer(error.instance_path)
    said = repr(_at(body, error.instance_path))
    value = _shortened(said)
    match error.kind:
        case Kind.Required(name) if name in EXAMPLES:
            return fault("td_missing_such", 0, 0, path, name=name, example=EXAMPLES[name])
        case Kind.Required(name):
            return fault("td_missing", 0, 0, path, name=name)
        case Kind.Type([kind]):
            return fault("td_type", 0, 0, path, value=value, type=kind)
        case Kind.Enum(options):
            return fault("td_choice", 0, 0, path, value=value, choices=", ".join(map(str, options)))
        case Kind.MinItems() | Kind.MinLength() | Kind.MinProperties():
            return fault("td_empty", 0, 0, path, value=value)
        case Kind.OneOfNotValid() | Kind.AnyOf():
            reason = f"{said} is not valid under any of the given schemas"
        case Kind.Type(kinds):
            reason = f"{said} is not of type {', '.join(map(repr, kinds))}"
        case _:
            reason = error.message
    return fault("td_unclear", 0, 0, path, reason=_shortened(reason))


def _at(value: Any, path: list[str | int]) -> Any:
    for part in path:
        value = value[part]
    return value


def _pointer(path: list[str | int]) -> str:
    return "".join(f"/{str(part).replace('~', '~0').replace('/', '~1')}" for part in path)


def _shortened(text: str) -> str:
    text = text.rstrip(".")
    return text if len(text) <= MOST_CHARACTERS else f"{text[:60]}…{text[-100:]}"

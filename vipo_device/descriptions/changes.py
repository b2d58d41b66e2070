"""What changed between two canonical descriptions, field by field; never graph by graph."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from typing import Any

MOST_CHANGES = 40
MOST_CHARACTERS = 200
STATE_FIELDS = frozenset({"done"})
"""What a description says of now, not of what the device is; its change is no news."""


@dataclass(frozen=True, slots=True)
class Change:
    """One field that differs: its path, and its JSON before and after, empty where it was or is not there."""

    path: str
    before: str
    after: str


def list_changes(before: Mapping[str, Any], after: Mapping[str, Any]) -> tuple[Change, ...]:
    """Return how two descriptions' JSON differ, at most 40 fields; lists of named things are compared by name."""
    kept = [{key: value for key, value in body.items() if key not in STATE_FIELDS} for body in (before, after)]
    return tuple(islice(_changes("", kept[0], kept[1]), MOST_CHANGES))


def _changes(path: str, before: Any, after: Any) -> Iterator[Change]:
    if before == after:
        return
    old, new = _by_name(before), _by_name(after)
    if old is None or new is None:
        yield Change(path, _written(before), _written(after))
        return
    for name in (*old, *(name for name in new if name not in old)):
        yield from _changes(f"{path}/{name}" if path else name, old.get(name), new.get(name))
    if list(old) != list(new) and sorted(old) == sorted(new):
        yield Change(f"{path} (order)", ", ".join(old)[:MOST_CHARACTERS], ", ".join(new)[:MOST_CHARACTERS])


def _by_name(value: Any) -> dict[str, Any] | None:
    """Return an object, or a list of named objects, as a dictionary; None for a plain value."""
    if isinstance(value, dict):
        return value
    if isinstance(value, list) and value and all(isinstance(item, dict) and "name" in item for item in value):
        return {str(item["name"]): item for item in value}
    return {} if value == [] else None


def _written(value: Any) -> str:
    if value is None:
        return ""
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= MOST_CHARACTERS else f"{text[: MOST_CHARACTERS - 1]}…"

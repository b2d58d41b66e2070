"""Documents of former formats, brought to the format of today one format at a time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

FORMAT: Final = 2
FIRST_FORMAT: Final = 1
_RENAMED_IN_WAITS: Final = {"seconds": "duration", "timeout_s": "timeout"}

Document = Mapping[str, object]


def format_of(document: object) -> int:
    """Return a document's format; one that does not say it is of the first."""
    said = document.get("format") if isinstance(document, Mapping) else FORMAT
    return said if isinstance(said, int) and not isinstance(said, bool) and said > 0 else FIRST_FORMAT


def migrate(document: object) -> object:
    """Return the document in today's format; one that is there already, or of a later format, as it is."""
    if not isinstance(document, Mapping):
        return document
    migrated: Document = document
    for number in range(format_of(document), FORMAT):
        migrated = {**_MIGRATIONS[number](migrated), "format": number + 1}
    return migrated


def _waits_without_units(document: Document) -> Document:
    """Format 2: a value may bring its unit, so the names of what a Wait waits for no longer do."""
    steps = document.get("steps")
    if not isinstance(steps, Mapping):
        return document
    return {**document, "steps": {name: _renamed(step) for name, step in steps.items()}}


def _renamed(step: object) -> object:
    params = step.get("params") if isinstance(step, Mapping) and step.get("kind") == "wait" else None
    if not isinstance(step, Mapping) or not isinstance(params, Mapping) or not params.keys() & _RENAMED_IN_WAITS.keys():
        return step
    kept = {name: value for name, value in params.items() if name not in _RENAMED_IN_WAITS}
    renamed = {new: params[old] for old, new in _RENAMED_IN_WAITS.items() if old in params}
    return {**step, "params": {**renamed, **kept}}


_MIGRATIONS: Final[Mapping[int, Callable[[Document], Document]]] = {1: _waits_without_units}

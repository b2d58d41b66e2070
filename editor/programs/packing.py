"""The document and script of a version as few bytes: whole, or as the difference to a version that is whole. Pure.

A version of a program that people go on drawing differs in a few steps from the one before, and names its steps by what
looks like chance: as a difference it takes a fiftieth of what it takes by itself. Differences are to whole versions
only, so any version is opened from two rows.
"""

from __future__ import annotations

import bz2
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from editor.language.comparison.changes import (
    apply_changes,
    change_to_json,
    find_changes,
    is_same,
    read_change,
)

PACKED: Final = 1
"""The form of what is packed, for those who come later."""
MOST_OF_WHOLE = 0.5
"""A difference that takes more than this of what its base takes is not worth a second row."""


class UnknownPacking(ValueError):
    """It was packed by a later VIPO, or is damaged."""


@dataclass(frozen=True, slots=True)
class Content:
    """What a version holds."""

    document: Mapping[str, Any]
    script: str


def pack(content: Content) -> bytes:
    """Return a content by itself."""
    return _packed({"document": content.document}, content.script)


def pack_difference(content: Content, base: Content, base_size: int) -> bytes | None:
    """Return a content as the difference to another, of so many bytes; None where that saves too little."""
    changes = find_changes(base.document, content.document)
    if not is_same(apply_changes(base.document, changes), dict(content.document)):
        return None
    packed = _packed({"changes": [change_to_json(change) for change in changes]}, content.script)
    return packed if len(packed) <= MOST_OF_WHOLE * base_size else None


def unpack(packed: bytes, base: Content | None = None) -> Content:
    """Return what was packed; a difference needs its base. Raises UnknownPacking."""
    try:
        form = json.loads(bz2.decompress(packed))
        if form["packed"] != PACKED:
            raise UnknownPacking(f"It is packed in form {form['packed']}; this VIPO knows {PACKED}.")
        if "document" in form:
            return Content(form["document"], form["script"])
        changes = [read_change(change) for change in form["changes"]]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise UnknownPacking(str(error)) from error
    if base is None:
        raise UnknownPacking("The version that it differs from is missing.")
    return Content(apply_changes(base.document, changes), form["script"])


def _packed(body: Mapping[str, Any], script: str) -> bytes:
    form = {"packed": PACKED, **body, "script": script}
    return bz2.compress(json.dumps(form, separators=(",", ":")).encode())

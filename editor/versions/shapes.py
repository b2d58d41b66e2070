"""The shapes of what is asked and answered about versions."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated, Any, Literal
from uuid import UUID

from ninja import Field, Schema

from editor.language.comparison.changes import ABSENT, ValueChange, change_to_json
from editor.language.comparison.difference import ConstructChange, Difference
from editor.shapes import Author, Compiled, Document
from editor.versions.restore import Changed
from editor.versions.sides import Comparison, Side
from registry.requests import Asked, Flag, Line, Repaired, Unchecked

MOST_CONSTRUCTS = 6_000
Root = Literal["steps", "functions", "roles", "parameters", "zones", "program"]


class VersionShape(Schema):
    """A version without what is in it; `cause` says before what it was made by itself."""

    id: UUID
    number: int
    author: Author | None
    authors: list[Author] = Field(description="Who had drawn since the version before.")
    name: str
    message: str
    cause: Literal["", "run", "rehearsal", "import", "restore"]
    created_at: datetime


class PinnedVersionShape(VersionShape):
    """A version with its script."""

    script: str


class WholeVersionShape(PinnedVersionShape):
    """A version with its script and its document."""

    document: Document


class VersionToPin(Asked):
    """What a version is about, and before what it is made."""

    name: Line = Field("", max_length=80)
    message: str = Field("", max_length=300)
    cause: Literal["", "import", "restore"] = ""


class VersionWords(Asked):
    """Another name and message of a version."""

    name: Line = Field("", max_length=80)
    message: str = Field("", max_length=300)


class ValueChangeShape(Schema):
    """At the path stands `new` instead of `old`; what is left out is absent there."""

    path: list[str]
    old: Any = None
    new: Any = None


class ConstructChangeShape(Schema):
    """What happened to a construct, with its fields, old and new."""

    root: Root
    id: str
    kind: Literal["added", "removed", "changed", "moved"]
    moved: bool
    changes: Annotated[list[dict[str, Any]], Unchecked(list[ValueChangeShape])]


class DifferenceShape(Schema):
    """What differs, in reading order; apart from it what was only tidied, and how many steps do the same."""

    constructs: list[ConstructChangeShape]
    tidied: list[ConstructChangeShape]
    same: int


class SideShape(Schema):
    """A side: a version, or what is drawn now. With a problem it has neither a document nor its compiled form.

    The compiled form is without diagnostics; `errors` is how many of them are errors.
    """

    version: VersionShape | None
    document: Document | None
    compiled: Compiled | None
    problem: Literal["", "missing", "unreadable"]
    errors: int


class ComparisonShape(Schema):
    """Two sides and how they differ, where both can be read."""

    old: SideShape
    new: SideShape
    difference: DifferenceShape | None


Names = Annotated[list[tuple[Line, Line]], Field(max_length=MOST_CONSTRUCTS)]


class RestoreAsked(Asked):
    """What shall be restored: all, or constructs as [root, id], or single fields as paths."""

    everything: Flag = False
    constructs: Names = []
    fields: Annotated[list[list[Line]], Field(max_length=MOST_CONSTRUCTS)] = []


class ChangedShape(Schema):
    """What was changed, what stays as somebody has changed it since, and what was needed, as [root, id]."""

    changes: Annotated[list[dict[str, Any]], Unchecked(list[ValueChangeShape])]
    skipped: Annotated[list[dict[str, Any]], Unchecked(list[ValueChangeShape])]
    needs: list[tuple[str, str]]


class ChangesToMake(Asked):
    """Changes that are made where their old values still stand: {path, old, new}; what is left out is absent."""

    changes: Annotated[list[dict[str, Any]], Repaired(), Field(max_length=20 * MOST_CONSTRUCTS)]


def changed_to_json(changed: Changed) -> dict[str, Any]:
    """Return what was changed in its shape."""
    return {
        "changes": [change_to_json(change) for change in changed.changes],
        "skipped": [change_to_json(change) for change in changed.skipped],
        "needs": changed.needs,
    }


def comparison_to_json(comparison: Comparison) -> dict[str, Any]:
    """Return a comparison in its shape."""
    found = comparison.difference
    return {
        "old": _side(comparison.old),
        "new": _side(comparison.new),
        "difference": None if found is None else _difference(found),
    }


def _side(side: Side) -> dict[str, Any]:
    return {name: getattr(side, name) for name in ("version", "document", "compiled", "problem", "errors")}


def _difference(found: Difference) -> dict[str, Any]:
    return {
        "constructs": [_construct(each) for each in found.constructs],
        "tidied": [_construct(each) for each in found.tidied],
        "same": found.same,
    }


def _construct(each: ConstructChange) -> dict[str, Any]:
    changes = [change_to_json(change) for change in each.changes]
    return {"root": each.root, "id": each.id, "kind": each.kind, "moved": each.is_moved, "changes": changes}


def read_sent(form: dict[str, Any]) -> ValueChange:
    """Return a change as it was sent; whether it is a sound one is looked at where it is made."""
    path = form.get("path")
    names = path if isinstance(path, list) else []
    return ValueChange(tuple(names), form.get("old", ABSENT), form.get("new", ABSENT))

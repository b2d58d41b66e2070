"""What a version held, drawn again: an ordinary edit of a person, while others go on, which that person can take back.

The server computes it from the program as it is at that moment and writes only what becomes another, so what others
change at the same time stays. What was changed is told value by value: reversed, it is what takes it back, and where
somebody has changed a value since, that value stays theirs.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from editor import services
from editor.errors import BadRequest
from editor.language.comparison.changes import (
    BadChange,
    Path,
    ValueChange,
    apply_changes,
    apply_where_same,
    check_change,
)
from editor.language.comparison.difference import Name
from editor.language.comparison.needs import Restoring, restore_all, restore_some
from editor.programs.views import WholeVersionView
from editor.rooms.content_update import change_content


@dataclass(frozen=True, slots=True)
class Wanted:
    """What shall be restored: these constructs, and single fields of others; all of a version if `everything`."""

    constructs: frozenset[Name]
    fields: frozenset[Path]
    everything: bool

    def restoring(self, now: Mapping[str, Any], version: WholeVersionView) -> Restoring:
        """Return what restores it in a document of now."""
        if self.everything:
            return restore_all(now, version.document)
        return restore_some(now, version.document, self.constructs, self.fields)


@dataclass(frozen=True, slots=True)
class Changed:
    """What was changed, what was left as somebody had changed it since, and the constructs that were needed."""

    changes: tuple[ValueChange, ...]
    skipped: tuple[ValueChange, ...] = ()
    needs: tuple[Name, ...] = ()


def look_at_restore(*, version: WholeVersionView, wanted: Wanted) -> Changed:
    """Return what restoring would change now, and what it needs. Raises NoSuchProgram, DocumentHole."""
    restoring = wanted.restoring(services.get_document(program_id=version.program), version)
    return Changed(restoring.changes, needs=restoring.needs)


def restore(*, version: WholeVersionView, wanted: Wanted, user: Any) -> Changed:
    """Make what is wanted of a version the program's, after a version of what was there before.

    Raises RoomsAway, BadRequest, NoSuchProgram, DocumentHole.
    """
    services.pin_version(program_id=version.program, user=user, cause="restore")
    found: list[Restoring] = []

    def change(document: Mapping[str, Any]) -> Mapping[str, Any]:
        restoring = wanted.restoring(document, version)
        found.append(restoring)
        return apply_changes(document, restoring.changes)

    change_content(program_id=version.program, change=change, author=user.pk)
    return Changed(found[-1].changes, needs=found[-1].needs)


def apply_sent(*, program_id: UUID, changes: Sequence[ValueChange], user: Any) -> Changed:
    """Make these changes where their old values still stand; where somebody was there before, theirs stays.

    Raises RoomsAway, BadRequest, NoSuchProgram, DocumentHole.
    """
    try:
        checked = [check_change(change) for change in changes]
    except BadChange as error:
        raise BadRequest(str(error)) from error
    told: list[Changed] = []

    def change(document: Mapping[str, Any]) -> Mapping[str, Any]:
        applied = apply_where_same(document, checked)
        told.append(Changed(applied.applied, applied.skipped))
        return applied.document

    change_content(program_id=program_id, change=change, author=user.pk)
    return told[-1]


def names_of(constructs: Collection[Sequence[str]]) -> frozenset[Name]:
    """Return constructs as they were sent: each the root that it stands in, and its id."""
    return frozenset((each[0], each[1]) for each in constructs)

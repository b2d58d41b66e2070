"""What is handed out of rehearsals: frozen, free of the database; and how the API says it as JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any
from uuid import UUID

from execution.models import Rehearsal
from execution.reasons import cause_of
from execution.views import iso


@dataclass(frozen=True, slots=True)
class RehearsalView:
    """A rehearsal with its result, once there is one, or tests in the same queue (`kind`); `progress` goes from 0 to 1.

    `place` counts from 1 in the queue of all sites, while it waits; `tries` is how often it was begun. How it was
    `asked` for is not known of the oldest.
    """

    id: UUID
    kind: str
    program: UUID
    program_name: str
    site: str
    status: str
    progress: float
    course: Mapping[str, Any] | None
    asked: Mapping[str, Any] | None
    place: int | None
    tries: int
    reason: str
    started_by: str
    person: int | None
    created_at: datetime
    began_at: datetime | None
    ended_at: datetime | None
    result: Mapping[str, Any] | None
    document: Mapping[str, Any]
    compiled: Mapping[str, Any]

    @property
    def cause(self) -> dict[str, Any] | None:
        """Why it has not come to a result, for screens to say."""
        return cause_of(self.reason)


def view_rehearsal(row: Rehearsal, order: Sequence[UUID] = (), *, whole: bool = True) -> RehearsalView:
    """Return the view of a rehearsal's row; `order` is the queue, and not `whole` leaves out what lists do not show."""
    return RehearsalView(
        id=row.id,
        kind=row.kind,
        program=row.program,
        program_name=row.program_name,
        site=row.site.slug,
        status=row.status,
        progress=row.progress,
        course=row.course or None,
        asked=row.asked or None,
        place=order.index(row.id) + 1 if row.id in order else None,
        tries=row.tries,
        reason=row.reason,
        started_by=row.started_by,
        person=row.person,
        created_at=row.created_at,
        began_at=row.began_at,
        ended_at=row.ended_at,
        result=_whole(row.result) if whole else None,
        document=row.document if whole else {},
        compiled=row.compiled if whole else {},
    )


def _whole(result: Mapping[str, Any] | None) -> Mapping[str, Any] | None:
    """Add to a result what those of earlier versions did not hold."""
    return None if result is None else {"obstacles": [], "zone_waits": {}, **result}


def rehearsal_to_json(rehearsal: RehearsalView, asker: int | None) -> dict[str, Any]:
    """Return a rehearsal as lists have it, for the person who asks."""
    return {
        "id": str(rehearsal.id),
        "kind": rehearsal.kind,
        "program": str(rehearsal.program),
        "program_name": rehearsal.program_name,
        "status": rehearsal.status,
        "progress": rehearsal.progress,
        "course": rehearsal.course,
        "place": rehearsal.place,
        "tries": rehearsal.tries,
        "reason": rehearsal.reason,
        "cause": rehearsal.cause,
        "started_by": rehearsal.started_by,
        "mine": rehearsal.person is not None and rehearsal.person == asker,
        "created_at": rehearsal.created_at.isoformat(),
        "began_at": iso(rehearsal.began_at),
        "ended_at": iso(rehearsal.ended_at),
    }


def whole_rehearsal_to_json(rehearsal: RehearsalView, asker: int | None) -> dict[str, Any]:
    """Return a rehearsal with its program as it was then, and its result, if there is one."""
    return {
        **rehearsal_to_json(rehearsal, asker),
        "asked": rehearsal.asked,
        "result": rehearsal.result,
        "document": rehearsal.document,
        "compiled": rehearsal.compiled,
    }

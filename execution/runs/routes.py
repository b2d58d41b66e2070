"""What became of runs over HTTP: their journals and timelines."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any
from uuid import UUID

from django.http import HttpRequest, HttpResponse
from ninja import Query, Router

from execution.errors import NotFound
from execution.runs import history
from execution.runs.runs import NO_SUCH_RUN, site_of_run
from execution.runs.shapes import EventsAsked, TimelineShape
from execution.shapes import RunEventShape
from execution.views import event_to_json
from registry.requests import link_to_next
from registry.services import NotAMember, require

router = Router(tags=["execution"])


def _require_run(request: HttpRequest, run: UUID) -> None:
    """Let members through; to strangers a run does not exist."""
    try:
        require(request.user, site_of_run(run_id=run), "viewer", "read")
    except NotAMember as error:
        raise NotFound(NO_SUCH_RUN) from error


@router.get("/runs/{uuid:run}/events", response=list[RunEventShape])
def list_events(
    request: HttpRequest, response: HttpResponse, run: UUID, asked: Query[EventsAsked]
) -> list[dict[str, Any]]:
    """Return the run's journal after a line's number, or its newest lines; oldest first."""
    _require_run(request, run)
    after, before, limit = asked.after, asked.before, asked.limit
    if not asked.newest:
        found = history.list_events(run_id=run, after=after, before=before, limit=limit)
        return [event_to_json(event) for event in found]
    events, has_older = history.list_newest_events(run_id=run, after=after, before=before, limit=limit)
    if has_older:
        response["Link"] = link_to_next(request, before=events[0].seq)
    return [event_to_json(event) for event in events]


@router.get("/runs/{uuid:run}/timeline", response=TimelineShape)
def show_timeline(request: HttpRequest, run: UUID) -> dict[str, Any]:
    """Return who worked when on which step of a run; where it took too long for that, short bars as one."""
    _require_run(request, run)
    found = history.show_timeline(run_id=run)
    bars, steps, drives = found.timeline.bars, found.timeline.steps, found.timeline.drives
    shown = {"bars": [asdict(bar) for bar in bars], "steps": steps, "drives": drives}
    return {"seq": found.seq, "simulated": found.simulated, **shown}

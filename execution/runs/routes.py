"""What became of runs over HTTP: their journals and timelines, and which versions of a program they used."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any
from uuid import UUID

from django.http import HttpRequest, HttpResponse
from ninja import Query, Router

from editor.services import NoSuchProgram
from execution.errors import ExecutionError, NotFound
from execution.runs import history
from execution.runs.programs import site_of_program
from execution.runs.runs import NO_SUCH_RUN, site_of_run
from execution.runs.shapes import MOST_VERSIONS, EventsAsked, TimelineShape, VersionRunsShape, VersionsAsked
from execution.shapes import RunEventShape
from execution.views import event_to_json
from registry import services as registry
from registry.requests import link_to_next, signed_in
from registry.services import NotAMember, require

router = Router(tags=["execution"])
PATIENCE_S = 5.0
timeline_slots = registry.Slots(in_all=4, of_site=4, of_person=2, most_waiting=4)
"""Journals that are gone through at once; one of a run that goes on for months has millions of lines."""


class TooManyTimelines(ExecutionError):
    """This process goes through as many journals as it may, in all or for this person."""

    code = "too_many_timelines"
    status = 429


def _require_run(request: HttpRequest, run: UUID) -> str:
    """Let members through, and return the run's site; to strangers a run does not exist."""
    site = site_of_run(run_id=run)
    try:
        require(request.user, site, "viewer", "read")
    except NotAMember as error:
        raise NotFound(NO_SUCH_RUN) from error
    return site


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
    site = _require_run(request, run)
    refusal = TooManyTimelines("Other runs' timelines are being read, by you or others. Try again in a moment.")
    claim = registry.Claim(signed_in(request).pk, site)
    with timeline_slots.held(claim, refusal, patience_s=PATIENCE_S):
        found = history.show_timeline(run_id=run)
    bars, steps, drives = found.timeline.bars, found.timeline.steps, found.timeline.drives
    shown = {"bars": [asdict(bar) for bar in bars], "steps": steps, "drives": drives}
    return {"seq": found.seq, "simulated": found.simulated, **shown}


@router.get("/programs/{uuid:program}/version-runs", response=list[VersionRunsShape])
def list_version_runs(request: HttpRequest, program: UUID, asked: Query[VersionsAsked]) -> list[dict[str, Any]]:
    """Return which runs used the versions of a program, the newest version first; those that none used are left out."""
    try:
        require(request.user, site_of_program(program_id=program), "viewer", "read")
    except NotAMember as error:
        raise NoSuchProgram("There is no such program. It may have been deleted.") from error
    oldest = max(asked.oldest, asked.newest - MOST_VERSIONS + 1)
    found = history.list_version_runs(program_id=program, oldest=oldest, newest=asked.newest)
    return [_runs_to_json(used) for used in found]


def _runs_to_json(used: history.VersionRuns) -> dict[str, Any]:
    newest = [{"id": str(run.id), "number": run.number, "status": run.status} for run in used.newest]
    return {"version": used.version, "count": used.count, "newest": newest}

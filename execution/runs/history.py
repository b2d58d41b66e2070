"""What became of runs: journals and timelines, from the archive if they are there, and which versions they used."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from django.db.models import Count, F, QuerySet, Window
from django.db.models.fields.json import KT
from django.db.models.functions import RowNumber

from execution.archive.rows import each_event, read_events, read_newest_events, read_run
from execution.errors import NotFound
from execution.models import Run, RunEvent
from execution.runs.runs import NO_SUCH_RUN
from execution.runs.timeline import TOLD, Timeline, TimelineLine, read_timeline, robots_of
from execution.views import RunEventView, view_event

EVENTS_AT_ONCE = 1000
MOST_NAMED = 3
"""So many of the runs that used a version are named."""
AT_ONCE = 2000


def list_events(
    *, run_id: UUID | str, after: int = 0, before: int | None = None, limit: int = EVENTS_AT_ONCE
) -> tuple[RunEventView, ...]:
    """Return the lines of a run's journal after a number, and before another, oldest first; at most a thousand at once.

    Raises:
        HistoryUnreadable: it is in the archive, which cannot be read.
    """
    found = list(_between(run_id, after, before).order_by("seq")[:limit])
    archived = _archived(run_id)
    if archived is not None:
        found = read_events(archived, after, before, limit)
    return tuple(view_event(row) for row in found)


def list_newest_events(
    *, run_id: UUID | str, after: int = 0, before: int | None = None, limit: int = EVENTS_AT_ONCE
) -> tuple[tuple[RunEventView, ...], bool]:
    """Return the newest lines of a run's journal, oldest first, and whether there are older ones.

    They are the newest before a number, if one is given, and those after another.

    Raises:
        HistoryUnreadable: it is in the archive, which cannot be read.
    """
    found = list(_between(run_id, after, before).order_by("-seq")[: limit + 1])[::-1]
    archived = _archived(run_id)
    if archived is not None:
        found = read_newest_events(archived, after, before, limit + 1)
    return tuple(view_event(row) for row in found[-limit:]), len(found) > limit


def _between(run_id: UUID | str, after: int, before: int | None) -> QuerySet[RunEvent]:
    lines = RunEvent.objects.filter(run_id=run_id, seq__gt=after)
    return lines if before is None else lines.filter(seq__lt=before)


def _archived(run_id: UUID | str) -> Run | None:
    """Return a run that is in the archive.

    Asked after rows were read: a run is named as archived before any row of it goes, so what was read just before is
    all there is.
    """
    runs = Run.objects.select_related("site", "archive").filter(id=run_id).exclude(archive=None)
    return runs.only("site", "archive", "archive_offset", "archive_bytes").first()


@dataclass(frozen=True, slots=True)
class RunTimeline:
    """A run's timeline up to a line of its journal, its number, and the devices that were simulated at some time."""

    seq: int
    timeline: Timeline
    simulated: tuple[str, ...]


def show_timeline(*, run_id: UUID | str) -> RunTimeline:
    """Return the timeline of a run up to the last line of its journal.

    Raises:
        NotFound: there is no such run.
        HistoryUnreadable: it is in the archive, which cannot be read.
    """
    row = Run.objects.only("document", "roles").filter(id=run_id).first()
    if row is None:
        raise NotFound(NO_SUCH_RUN)
    told = _Told()
    timeline = read_timeline(told.rows_of(run_id), robots_of(row.document, row.roles))
    archived = _archived(run_id)
    if archived is not None:
        told = _Told()
        robots = robots_of(read_run(archived).document, row.roles)
        timeline = read_timeline(told.lines_of(each_event(archived)), robots)
    return RunTimeline(told.seq, timeline, tuple(sorted(told.simulated)))


class _Told:
    """What a journal tells of a timeline; once it was gone through, its last number and who was simulated, too."""

    def __init__(self) -> None:
        self.seq = 0
        self.simulated: set[str] = set()

    def rows_of(self, run_id: UUID | str) -> Iterator[TimelineLine]:
        """Yield what the rows of a journal tell, a few of their columns at a time."""
        names = ("seq", "t_s", "kind", "code", "step", "device", "robot")
        lines = RunEvent.objects.filter(run_id=run_id, kind__in=TOLD).order_by("seq")
        marked = lines.annotate(status=KT("args__status"), simulated=KT("args__simulated"))
        for row in marked.values_list(*names, "status", "simulated").iterator(chunk_size=AT_ONCE):
            yield self._line(*row)

    def lines_of(self, events: Iterable[RunEvent]) -> Iterator[TimelineLine]:
        """Yield what the lines of an archived journal tell."""
        for row in events:
            if row.kind in TOLD:
                args = row.args
                yield self._line(row.seq, row.t_s, row.kind, row.code, row.step, row.device, row.robot,
                                 args.get("status"), args.get("simulated"))  # fmt: skip

    def _line(self, seq: int, t_s: float, *told: Any) -> TimelineLine:
        kind, code, step, device, robot, status, simulated = told
        self.seq = seq
        # as JSON has it in PostgreSQL, as SQLite has it, and as it is
        if simulated in ("true", 1, True):
            self.simulated.add(device)
        return TimelineLine(t_s, kind, code, step, device, robot, str(status or ""))


@dataclass(frozen=True, slots=True)
class RunOfVersion:
    """A run that used a version of its program."""

    id: UUID
    number: int
    status: str


@dataclass(frozen=True, slots=True)
class VersionRuns:
    """How many runs used a version of a program, and the newest of them, the newest first."""

    version: int
    count: int
    newest: tuple[RunOfVersion, ...]


def list_version_runs(*, program_id: UUID, oldest: int, newest: int) -> tuple[VersionRuns, ...]:
    """Return which runs used the versions of a program between two numbers; those that none used are left out."""
    place = Window(RowNumber(), partition_by=F("version"), order_by=F("number").desc())
    count = Window(Count("*"), partition_by=F("version"))
    used = Run.objects.filter(program=program_id, version__range=(oldest, newest)).annotate(place=place, count=count)
    named = used.filter(place__lte=MOST_NAMED).order_by("-version", "place")
    found: dict[int, VersionRuns] = {}
    for row in named.values_list("version", "count", "id", "number", "status", named=True):
        before = found.get(row.version)
        run = RunOfVersion(row.id, row.number, row.status)
        found[row.version] = VersionRuns(row.version, row.count, (*(before.newest if before else ()), run))
    return tuple(found.values())

"""Runs as people see them: start, pause, resume, cancel, look."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from datetime import datetime
from typing import Any
from uuid import UUID, uuid4

from django.db import IntegrityError, transaction
from django.db.models import Max

from editor import services as editor
from execution import database, mailbox
from execution.archive.rows import read_run
from execution.errors import NotFound, NotPossibleNow
from execution.floor.stops import get_stop, hold_if_stopped
from execution.floor_protocol import ResumeAsked, ToRun
from execution.machine.messages import CancelAsked, PauseAsked
from execution.models import Command, FloorState, Run
from execution.runs.programs import Prepared
from execution.runs.terms import USUAL, Terms, fit_terms
from execution.views import PRIORITIES, RunView, WholeRunView, run_to_json, view_run
from registry import services as registry
from vipo_device.protocol.messages import EXPLORE

OPEN = "open"
NO_SUCH_RUN = "There is no such run. It may have been deleted with its site."
STOPPED = "The site is stopped. Reset the stop, then resume the run."


def start_run(
    *, prepared: Prepared, by: str, entry: int = 0, terms: Terms = USUAL, fence: int | None = None, emergency: str = ""
) -> RunView:
    """Start a run of a program that was checked; a worker takes it from here. `entry` is where it begins.

    `fence` is the site's when it was decided that the run shall begin, if that was earlier: a stop that was pressed
    since then pauses it, also one that was reset again. `emergency` is an admin's reason to start it without the
    approvals that the site demands.

    Raises:
        editor.NotApproved: approvals that the site demands are missing.
        BadTerms: it may begin or should be over at a time that makes no sense.
        NotPossibleNow: the site is stopped, or a robot explores its floor.
    """
    stop = get_stop(site=prepared.site)
    if stop.active:
        raise NotPossibleNow("The site is stopped. Reset the stop before you start a run.", {"why": "stopped"})
    begin = _Beginning(by, entry, fit_terms(terms, database.now()), stop.fence if fence is None else fence, emergency)
    row = _create_numbered(prepared, begin)
    transaction.on_commit(lambda: hold_if_stopped(row))
    return _announce(prepared, row)


def _require_nobody_explores(site: str) -> None:
    """Refuse while a robot drives where it likes. Raises NotPossibleNow."""
    calls = Command.objects.filter(site__slug=site, run=None, method=EXPLORE, status__in=Command.OPEN)
    for name in calls.values_list("device", flat=True):
        device = registry.get_device(site=site, device_id=name)
        if device.kind == "robot":
            raise NotPossibleNow(
                f"{device.name} explores the floor. Wait until it is done, or cancel that on its page."
            )


@dataclass(frozen=True, slots=True)
class _Beginning:
    """By whom, where, on which terms, for which emergency a run begins, and the site's fence when it was asked for."""

    by: str
    entry: int
    terms: Terms
    fence: int
    emergency: str


def _announce(prepared: Prepared, row: Run) -> RunView:
    view = view_run(row)
    mailbox.hint(prepared.site)
    transaction.on_commit(lambda: registry.publish(prepared.site, {"type": "run", "run": run_to_json(view)}))
    return view


def _create_numbered(prepared: Prepared, begin: _Beginning) -> Run:
    """Write the row; when another run took the number at the same time, try the next."""
    for _ in range(5):
        try:
            with transaction.atomic():
                return _create(prepared, begin)
        except IntegrityError:
            continue
    raise NotPossibleNow("Many runs are being started at once. Try again in a moment.")


def _create(prepared: Prepared, begin: _Beginning) -> Run:
    site = registry.get_site_id(site=prepared.site)
    # Calls by hand hold this row, too: until the run stands here, no robot begins to explore.
    FloorState.objects.get_or_create(site_id=site)
    FloorState.objects.select_for_update(of=("self",)).get(site_id=site)
    _require_nobody_explores(prepared.site)
    permit = editor.admit_start(
        site=prepared.site, program_id=prepared.program, document=prepared.document, emergency=begin.emergency
    )
    last = Run.objects.filter(site_id=site).aggregate(last=Max("number"))["last"] or 0
    facts = {"number": last + 1, "program": prepared.name, "armed": begin.entry > 0}
    registry.note_act(site_id=site, code="run_started", by=begin.by, facts=facts)
    if permit.emergency:
        facts = {"number": last + 1, "program": prepared.name, "reason": permit.emergency}
        registry.note_act(site_id=site, code="run_started_in_emergency", by=begin.by, facts=facts)
    return Run.objects.create(
        site_id=site,
        number=last + 1,
        program=prepared.program,
        program_name=prepared.name,
        version=prepared.version,
        parameters=dict(prepared.parameters),
        document=prepared.document,
        compiled=prepared.compiled,
        plan=prepared.plan,
        entry=begin.entry,
        started_by=begin.by,
        priority=PRIORITIES[begin.terms.priority],
        not_before=begin.terms.not_before,
        deadline=begin.terms.deadline,
        fence=begin.fence,
        permit=asdict(permit) if permit.needed else {},
        created_at=database.now(),
    )


def pause_run(*, run_id: UUID | str, by: str) -> RunView:
    """Ask a run to pause: nothing new is begun, what is under way settles."""
    row = _find_open(run_id)
    return _order(row, PauseAsked(f"{by} paused it"))


def resume_run(*, run_id: UUID | str, by: str) -> RunView:
    """Let a paused run go on where it is.

    Raises:
        NotPossibleNow: the run is over, or its site is stopped, also if that happens at this moment.
    """
    row = _find_open(run_id)
    stop = get_stop(site=row.site.slug)
    if stop.active:
        raise NotPossibleNow(STOPPED)
    with transaction.atomic():
        Run.objects.filter(id=row.id, fence__lt=stop.fence).update(fence=stop.fence)
        view = _order(row, ResumeAsked(by))
    if hold_if_stopped(row):
        raise NotPossibleNow(STOPPED)
    return view


def cancel_run(*, run_id: UUID | str, by: str) -> RunView:
    """Ask a run to end: what machines do for it is called off, its robots stop at the next safe point."""
    row = _find_open(run_id)
    with transaction.atomic():
        facts = {"number": row.number, "program": row.program_name}
        registry.note_act(site_id=row.site_id, code="run_cancelled", by=by, facts=facts)
        return _order(row, CancelAsked(f"{by} cancelled it"))


def _order(row: Run, order: ToRun) -> RunView:
    with transaction.atomic():
        mailbox.post_to_run(row.site.slug, row.id, [(f"order:{row.id}:{uuid4()}", order)])
    return view_run(row)


def _find(run_id: UUID | str) -> Run:
    row = Run.objects.select_related("site", "archive").defer("plan", "state", "places").filter(id=run_id).first()
    if row is None:
        raise NotFound(NO_SUCH_RUN)
    return row


def _find_open(run_id: UUID | str) -> Run:
    row = _find(run_id)
    if row.status not in Run.OPEN:
        raise NotPossibleNow(f"Run {row.number} is over ({row.status}). Start the program again for a new run.")
    return row


def site_of_run(*, run_id: UUID | str) -> str:
    """Return the site of a run; raises NotFound."""
    site = Run.objects.filter(id=run_id).values_list("site__slug", flat=True).first()
    if site is None:
        raise NotFound(NO_SUCH_RUN)
    return str(site)


@dataclass(frozen=True, slots=True)
class RunSpan:
    """Which run of which program this is, and for how many seconds it has gone on."""

    program: UUID
    number: int
    seconds: float


def find_span(*, run_id: UUID | str, now: datetime) -> RunSpan:
    """Return how long a run has gone on until it was over, or until `now`.

    Raises:
        NotFound: there is no such run.
        NotPossibleNow: it has not begun.
    """
    row = _find(run_id)
    if row.started_at is None:
        raise NotPossibleNow(f"Run {row.number} has not begun, so it has no moments yet. Comment on the program.")
    return RunSpan(row.program, row.number, max(0.0, ((row.ended_at or now) - row.started_at).total_seconds()))


def get_run(*, run_id: UUID | str) -> WholeRunView:
    """Return a run with its document and compiled form, from the archive if it is there.

    Raises:
        NotFound: there is none.
        HistoryUnreadable: it is in the archive, which cannot be read.
    """
    row = _find(run_id)
    row = read_run(row) if row.archive_id else row
    return WholeRunView(view_run(row), row.document, row.compiled)


@dataclass(frozen=True, slots=True)
class RunFilter:
    """Which runs are looked for: with a status, of a program, and made from one moment until another.

    `state` is a status, or `open` for all that are not over.
    """

    state: str | None = None
    program: UUID | None = None
    since: datetime | None = None
    until: datetime | None = None

    def conditions(self) -> dict[str, Any]:
        """Return what the rows of such runs fulfil."""
        named = {
            "status__in": None if self.state is None else Run.OPEN if self.state == OPEN else (self.state,),
            "program": self.program,
            "created_at__gte": self.since,
            "created_at__lt": self.until,
        }
        return {name: value for name, value in named.items() if value is not None}


ANY_RUN = RunFilter()


def list_runs(
    *, site: str, limit: int = 50, before: int | None = None, which: RunFilter = ANY_RUN
) -> tuple[tuple[RunView, ...], bool]:
    """Return a site's runs, the newest first or the newest before a number, and whether there are older ones."""
    rows = Run.objects.select_related("site").filter(site__slug=site, **which.conditions())
    if before is not None:
        rows = rows.filter(number__lt=before)
    found = list(rows.defer("document", "compiled", "plan", "state", "places").order_by("-number")[: limit + 1])
    return tuple(view_run(row) for row in found[:limit]), len(found) > limit

"""Armed programs: they start by themselves when a condition becomes true and no run of theirs is under way."""

from __future__ import annotations

import logging
from collections import OrderedDict
from dataclasses import asdict
from datetime import UTC, datetime
from uuid import UUID

from django.db import transaction

from editor import services as editor
from editor.language import plan_from_json
from editor.language.plan.instructions import EventEntry, Plan
from execution import database
from execution.errors import NotPossibleNow, NotReady
from execution.floor.stops import get_stop
from execution.machine.evaluation import EvaluationError, bound_roles, is_true
from execution.machine.needs import needs_of
from execution.models import ArmedProgram, Run
from execution.runs.facts import site_facts
from execution.runs.programs import Prepared
from execution.runs.runs import start_run
from execution.views import ArmedView, armed_to_json, view_armed
from registry import services as registry

log = logging.getLogger(__name__)
PLANS_KEPT = 64
_watched: OrderedDict[tuple[UUID, datetime], _Watched] = OrderedDict()


class _Watched:
    """A plan with all that its conditions ask of the site, as far as the plan alone tells it. Raises what it may."""

    def __init__(self, plan: Plan) -> None:
        self.starters = [(number, event) for number, event in enumerate(plan.events) if event.starts == "run"]
        self._parameters, self._needs, self._bound = plan.parameters, needs_of(plan), bound_roles(plan)
        self._zones = {zone.id: zone.points for zone in plan.zones}

    def look(self, site: str, now: datetime) -> dict[str, bool]:
        """Return which of the conditions that start the program hold; one that cannot be worked out does not."""
        facts, truths = site_facts(self._needs, site, now) | self._bound, {}
        for number, event in self.starters:
            try:
                truths[str(number)] = is_true(event.condition, self._parameters, facts, self._zones)
            except EvaluationError:
                truths[str(number)] = False
        return truths


def list_armed(*, site: str) -> tuple[ArmedView, ...]:
    """Return the armed programs of a site."""
    rows = ArmedProgram.objects.filter(site__slug=site).order_by("at")
    return tuple(view_armed(row) for row in rows)


def arm_program(*, prepared: Prepared, by: str, fence: int | None = None) -> ArmedView:
    """Let a program start by itself from now on, in the version that was prepared; what holds already does not count.

    `fence` is the site's when that was asked for, if earlier: a stop since then disarms it, as `start_run` has it.

    Raises:
        NotReady: the program has no step that starts it.
        editor.NotApproved: approvals that the site demands are missing.
        NotPossibleNow: the site is stopped.
    """
    watched = _Watched(plan_from_json(prepared.plan))
    if not watched.starters:
        detail = "Nothing starts this program by itself. Add a step “When …” that starts a run."
        raise NotReady(detail, {"why": "never_starts"})
    stop = get_stop(site=prepared.site)
    if stop.active:
        raise NotPossibleNow("The site is stopped. Reset the stop before you arm a program.", {"why": "stopped"})
    now = datetime.now(UTC)
    whole = {**asdict(prepared), "program": str(prepared.program)}
    truths = watched.look(prepared.site, now)
    values = {
        "site_id": registry.get_site_id(site=prepared.site),
        "prepared": whole,
        "truths": truths,
        "fence": stop.fence if fence is None else fence,
        "by": by,
        "at": now,
    }
    with transaction.atomic():
        row, _ = ArmedProgram.objects.update_or_create(program=prepared.program, defaults=values)
        # After the row of what is armed, as a firing has it: two that wait for each other would both fail.
        editor.admit_start(site=prepared.site, program_id=prepared.program, document=prepared.document)
        _announce(prepared.site)
    return view_armed(row)


def site_of_armed(*, program_id: UUID) -> str | None:
    """Return the site where a program is armed, also one that was deleted since; None where it is not."""
    return ArmedProgram.objects.filter(program=program_id).values_list("site__slug", flat=True).first()


def disarm_program(*, program_id: UUID, site: str) -> None:
    """Let a program start only by hand again."""
    with transaction.atomic():
        ArmedProgram.objects.filter(program=program_id).delete()
        _announce(site)


def _announce(site: str) -> None:
    def publish() -> None:
        programs = [armed_to_json(armed) for armed in list_armed(site=site)]
        registry.publish(site, {"type": "armed", "programs": programs})

    transaction.on_commit(publish)


def start_armed(*, now: datetime) -> int:
    """Look at the conditions of all armed programs and start what has become due; returns how many runs.

    One that was deleted is disarmed.
    """
    rows = list(ArmedProgram.objects.select_related("site"))
    there = editor.keep_existing(program_ids=[row.program for row in rows]) if rows else frozenset()
    return sum(_look_apart(row, now, is_there=row.program in there) for row in rows)


def _look_apart(row: ArmedProgram, now: datetime, *, is_there: bool) -> bool:
    """Look at one armed program, or disarm it; what that raises keeps no other from its turn."""
    with database.kept_apart(f"The armed program {row.program}"):
        if is_there:
            return _look_at(row, now)
        _disarm(row)
    return False


def _look_at(row: ArmedProgram, now: datetime) -> bool:
    """Start a run if a condition has become true; of several processes that see it one does.

    One that cannot be read is disarmed; what looking at the site raises may pass, so it stays armed.
    """
    try:
        watched, prepared = _watch(row), Prepared(**{**row.prepared, "program": row.program})
    except Exception:  # it was armed by another version of VIPO, say: it would never start, and nobody would know
        log.exception("The armed program %s cannot be read and is disarmed.", row.program)
        _disarm(row, "armed_run_unreadable")
        return False
    truths = watched.look(row.site.slug, now)
    if truths == row.truths:
        return False
    due = next((e for number, e in watched.starters if truths[str(number)] and not row.truths.get(str(number))), None)
    try:
        with transaction.atomic():
            mine = ArmedProgram.objects.filter(program=row.program, epoch=row.epoch, at=row.at)
            if not mine.update(truths=truths, epoch=row.epoch + 1) or due is None:
                return False
            return _start(row, prepared, due, now)
    except NotPossibleNow:  # a robot explores, say: what held stays as it was, so the next look tries it again
        return False


def _start(row: ArmedProgram, prepared: Prepared, due: EventEntry, now: datetime) -> bool:
    """Start a run at an entry; one that was armed while the stop was pressed is disarmed instead."""
    stop = get_stop(site=row.site.slug)
    if row.fence < stop.pressed:
        _disarm(row)
        return False
    if stop.active or _is_under_way(row.program, now):
        return False
    try:
        editor.lock_program(program_id=row.program)
        start_run(prepared=prepared, by=row.by, entry=due.entry, fence=row.fence)
    except editor.NotApproved:
        _disarm(row, "armed_run_not_approved")
        return False
    except editor.NoSuchProgram:
        _disarm(row)
        return False
    return True


def _disarm(row: ArmedProgram, why: str = "") -> None:
    """Disarm a program as it was armed; where nobody has done anything that shows why, the record says it by a code."""
    with transaction.atomic():
        ArmedProgram.objects.filter(program=row.program, at=row.at).delete()
        if why:
            facts = {"program": row.prepared.get("name", ""), "by": row.by}
            registry.note_act(site_id=row.site_id, code=why, facts=facts)
        _announce(row.site.slug)


def _is_under_way(program: UUID, now: datetime) -> bool:
    """Tell whether a run of the program has begun, or is about to; one that waits for its time has not."""
    runs = Run.objects.filter(program=program, status__in=Run.OPEN)
    return runs.exclude(state=None, not_before__gt=now).exists()


def _watch(row: ArmedProgram) -> _Watched:
    key = (row.program, row.at)
    if key not in _watched:
        _watched[key] = _Watched(plan_from_json(row.prepared["plan"]))
        while len(_watched) > PLANS_KEPT:
            _watched.popitem(last=False)
    return _watched[key]

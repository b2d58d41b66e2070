"""How the floor of a site was used in its runs of the last days, over HTTP: where robots drove, where they waited."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime, timedelta
from time import monotonic
from typing import Any
from uuid import UUID

from django.db.models import Q
from django.http import HttpRequest
from ninja import Query, Router, Schema
from pydantic import Field

from execution import database
from execution.errors import ExecutionError
from execution.floor.floor_use import (
    Drive,
    JournalLine,
    ZoneUse,
    ZoneWait,
    heat_of,
    read_back,
    square_for,
    zones_of,
)
from execution.models import Run, RunEvent
from registry import services as registry
from registry.requests import signed_in

router = Router(tags=["execution"])
MOST_RUNS = 500
MOST_LINES = 20_000
PATIENCE_S = 5.0
KEPT_S = 60.0
"""So long what was counted is told again."""
KEPT = 16
"""So many answers are kept, of all sites."""
OF_SITE = "site/"
_TOLD = Q(kind__in=("way", "wait")) | Q(kind="step", code__startswith="step_") & ~Q(
    code__in=("step_entered", "step_done")
)
"""The lines of a journal that tell of drives and of waits, and of steps that ended while they waited."""
count_slots = registry.Slots(in_all=2, of_site=2, of_person=1, most_waiting=1)
"""Floors whose use is counted at once."""


@dataclass(frozen=True, slots=True)
class _Counted:
    """How a floor was used in so many runs; `is_cut`: there were more. `heat` has column, row and drives."""

    runs: int
    is_cut: bool
    square_m: float
    heat: tuple[tuple[int, int, int], ...]
    waits: tuple[ZoneWait, ...]


_kept: dict[tuple[int, int], tuple[float, _Counted]] = {}
"""What was counted, by site and days, with until when it is told again; hours of the day are worked out each time."""


class TooManyCounts(ExecutionError):
    """This process counts the use of as many floors as it may, in all or for this person."""

    code = "too_many_floor_counts"
    status = 429


class ZoneUseShape(Schema):
    """How often anybody waited before a zone for so many robots at once, and for how many seconds in all.

    `busiest_min` is where the half hour of the day begins in which the most waiting was, all days together: minutes
    since midnight at `utc_offset_min`, in steps of ten; null where nobody waited.
    """

    zone: str
    waits: int
    waited_s: float
    busiest_min: int | None


class FloorUseShape(Schema):
    """How a floor was used in the runs of the last `days`; `runs` is how many were counted.

    `is_cut` says that there were more: the newest 500 are counted, and of their journals the newest 20,000 lines.
    `heat` is how often robots drove through a square of `square_m` metres: (column, row, drives), the square (0, 0)
    with its lower left corner in the origin of the map's frame, for those where any did. Runs in an archive do not
    count, nor does what was before the map lay otherwise.
    """

    days: int
    utc_offset_min: int
    runs: int
    is_cut: bool
    square_m: float
    heat: list[tuple[int, int, int]]
    zones: list[ZoneUseShape]


class AskFloorUse(Schema):
    """Over how many days until now, and where they begin: so many minutes before those of UTC."""

    days: int = Field(7, ge=1, le=30)
    utc_offset_min: int = Field(0, ge=-720, le=840)


@router.get("/sites/{slug:site}/floor-use", response=FloorUseShape)
def get_floor_use(request: HttpRequest, site: str, asked: Query[AskFloorUse]) -> dict[str, Any]:
    """Tell where robots drove in the site's runs of the last days, and what waiting before its zones cost.

    It may be a minute old.
    """
    user = signed_in(request)
    registry.require(user, site, "viewer")
    counted = _known(site, asked.days)
    if counted is None:
        refusal = TooManyCounts("How floors were used is being counted, for you or others. Try again in a moment.")
        with count_slots.held(registry.Claim(user.pk), refusal, patience_s=PATIENCE_S):
            counted = _known(site, asked.days) or _keep(site, asked.days)
    return {"days": asked.days, "utc_offset_min": asked.utc_offset_min, **_to_json(site, counted, asked.utc_offset_min)}


def _known(site: str, days: int) -> _Counted | None:
    """Return what was counted a moment ago."""
    kept_until, counted = _kept.get((registry.get_site_id(site=site), days), (0.0, None))
    return counted if monotonic() < kept_until else None


def _keep(site: str, days: int) -> _Counted:
    now = monotonic()
    for key in [key for key, (until, _) in list(_kept.items()) if until <= now]:
        _kept.pop(key, None)
    if len(_kept) >= KEPT:
        _kept.clear()
    counted = _count(site, days)
    _kept[registry.get_site_id(site=site), days] = (monotonic() + KEPT_S, counted)
    return counted


def _count(site: str, days: int) -> _Counted:
    now, (frame_since, width_m, height_m) = database.now(), registry.get_map_frame(site=site)
    since = max(now - timedelta(days=days), frame_since)
    of_time = Q(ended_at=None) | Q(ended_at__gte=since)
    begun = Run.objects.filter(of_time, site__slug=site, archive=None, started_at__isnull=False).order_by("-number")
    found = list(begun.values_list("id", "number", "ended_at")[: MOST_RUNS + 1])
    runs = found[:MOST_RUNS]
    lines = _Lines([run for run, *_ in runs], since)
    ends = {str(run): ended_at or now for run, _, ended_at in runs}
    used = list(read_back(lines, ends))
    square_m = square_for(width_m, height_m)
    heat = heat_of((each for each in used if isinstance(each, Drive)), square_m)
    reached = sum(number >= lines.oldest_run for _, number, _ in runs) if lines.is_cut else len(runs)
    return _Counted(
        reached,
        lines.is_cut or len(found) > MOST_RUNS,
        square_m,
        tuple(sorted((column, row, count) for (column, row), count in heat.items())),
        tuple(each for each in used if isinstance(each, ZoneWait)),
    )


class _Lines:
    """What journals tell of drives and waits since a time: the newest run first, the last line of each first.

    Once it was gone through it knows whether it was cut short, and which is the oldest run of which it had a line.
    """

    def __init__(self, runs: list[UUID], since: datetime) -> None:
        self.is_cut, self.oldest_run = False, 0
        lines = RunEvent.objects.filter(_TOLD, run__in=runs, at__gte=since).order_by("-run__number", "-seq")
        told = lines.values_list("run", "run__number", "at", "kind", "code", "step", "robot", "args")
        self._rows = told[: MOST_LINES + 1]

    def __iter__(self) -> Iterator[JournalLine]:
        for count, (run, number, *told) in enumerate(self._rows.iterator()):
            if count == MOST_LINES:
                self.is_cut = True
                return
            self.oldest_run = number
            yield _line_of(str(run), tuple(told))


def _line_of(run: str, told: tuple[datetime, str, str, str, str, Any]) -> JournalLine:
    at, kind, code, step, robot, args = told
    if kind == "way":
        return JournalLine(run, at, robot=robot, path=[(x, y) for x, y in args["path"]])
    # former versions did not write which zone it was
    return JournalLine(run, at, step, robot, args.get("zone_key", "") if code == "zone_taken" else "")


def _to_json(site: str, counted: _Counted, utc_offset_min: int) -> dict[str, Any]:
    limited = [zone.id for zone in registry.list_zones(site=site) if zone.rule == "one_at_a_time"]
    used = zones_of(counted.waits, utc_offset_min)
    waited = [(zone, used.get(OF_SITE + zone, ZoneUse())) for zone in limited]
    return {
        "runs": counted.runs,
        "is_cut": counted.is_cut,
        "square_m": counted.square_m,
        "heat": counted.heat,
        "zones": [
            {"zone": zone, "waits": use.waits, "waited_s": use.waited_s, "busiest_min": use.busiest_min}
            for zone, use in waited
        ],
    }

"""Measured paces that people take over, so that rehearsals and tests take as long as the real devices do."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any, NamedTuple

from django.db import transaction

from execution import database
from execution.errors import NotFound, NotPossibleNow
from execution.mirror.paces import KEPT, USUAL_OF, Pace, pace_of
from execution.models import Calibration, Measurement
from registry import services as registry

LEAST_MEASURED = 5
"""Of fewer measurements a pace says little; nobody can take it over."""
LONGEST_PACE = 20.0
"""What takes a device longer than this many times its model's time is no pace but a model that is wrong."""

WORTH = 0.02
"""A pace that differs less than this part from the one in use is not offered."""


class _Row(NamedTuple):
    """One measurement, as far as it counts here."""

    predicted_s: float
    real_s: float
    apart_m: float | None
    at: datetime


@dataclass(frozen=True, slots=True)
class Calibrated:
    """A pace that was taken over: by whom, when, and of how many measurements it was the median."""

    pace: float
    count: int
    at: datetime
    by: str


@dataclass(frozen=True, slots=True)
class MethodPace:
    """What was measured of a device's method; `newest` are (predicted, real) seconds, the newest last."""

    method: str
    pace: Pace | None
    newest: tuple[tuple[float, float], ...]
    apart_m: float | None
    last_at: datetime | None
    calibrated: Calibrated | None

    @property
    def can_be_taken(self) -> bool:
        """Tell whether the pace may be taken over, and says something that is not in use yet."""
        if (
            self.pace is None
            or self.pace.count < LEAST_MEASURED
            or not 1 / LONGEST_PACE <= self.pace.usual <= LONGEST_PACE
        ):
            return False
        in_use = 1.0 if self.calibrated is None else self.calibrated.pace
        return abs(self.pace.usual / in_use - 1) >= WORTH


def find_paces(*, site: str) -> dict[str, dict[str, float]]:
    """Return the paces that hold at a site, by device and method."""
    found: defaultdict[str, dict[str, float]] = defaultdict(dict)
    rows = Calibration.objects.filter(site__slug=site).order_by("device", "method")
    for device, method, pace in rows.values_list("device", "method", "pace"):
        found[device][method] = pace
    return dict(found)


def list_paces(*, site: str, device_id: str) -> tuple[MethodPace, ...]:
    """Return what was measured of each method of a device, by name. Raises NoSuchDevice."""
    registry.get_device(site=site, device_id=device_id)
    measured: defaultdict[str, list[_Row]] = defaultdict(list)
    rows = Measurement.objects.filter(site__slug=site, device=device_id).order_by("at", "id")
    for row in rows.only("method", *_Row._fields):
        measured[row.method].append(_Row(row.predicted_s, row.real_s, row.apart_m, row.at))
    taken = {row.method: row for row in _calibrations(site, device_id).select_related("by")}
    return tuple(
        _view(method, measured[method][-KEPT:], taken.get(method)) for method in sorted(measured.keys() | taken.keys())
    )


def take_pace(*, site: str, device_id: str, method: str, by: Any) -> MethodPace:
    """Let rehearsals and tests take as long for this method as was measured.

    Raises:
        NoSuchDevice: the site has no such device.
        NotFound: nothing was measured of this method.
        NotPossibleNow: it was measured too few times, or the pace is no use.
    """
    with transaction.atomic():
        found = _find(site, device_id, method)
        pace = found.pace
        if pace is None:
            raise NotFound(f"Nothing was measured of {method} yet. Let a program run that uses it.")
        if pace.count < LEAST_MEASURED:
            raise NotPossibleNow(
                f"{method} was measured {pace.count} times; {LEAST_MEASURED} are needed. Let it run some more times.",
                {"why": "few_measured", "count": pace.count, "least": LEAST_MEASURED},
            )
        if not 1 / LONGEST_PACE <= pace.usual <= LONGEST_PACE:
            raise NotPossibleNow(
                f"{method} takes {pace.usual:.1f} times what its description says: correct the description instead.",
                {"why": "far_from_model", "pace": round(pace.usual, 2)},
            )
        values = {"pace": round(pace.usual, 4), "count": min(pace.count, USUAL_OF), "at": database.now(), "by": by}
        site_id = registry.get_site_id(site=site)
        Calibration.objects.update_or_create(site_id=site_id, device=device_id, method=method, defaults=values)
        facts = {"device": device_id, "method": method, "percent": round(100 * (pace.usual - 1))}
        registry.note_act(site_id=site_id, code="calibration_taken", facts=facts)
    return _find(site, device_id, method)


def drop_pace(*, site: str, device_id: str, method: str) -> MethodPace:
    """Let rehearsals and tests take the model's time again. Raises NoSuchDevice, NotFound."""
    with transaction.atomic():
        registry.get_device(site=site, device_id=device_id)
        dropped, _ = _calibrations(site, device_id).filter(method=method).delete()
        if not dropped:
            raise NotFound(f"No measured pace of {method} is in use.")
        facts = {"device": device_id, "method": method}
        registry.note_act(site_id=registry.get_site_id(site=site), code="calibration_dropped", facts=facts)
    return _find(site, device_id, method)


def method_pace_to_json(found: MethodPace) -> dict[str, Any]:
    """Return what was measured of a method, as the API says it."""
    pace, taken = found.pace, found.calibrated
    return {
        "method": found.method,
        "count": 0 if pace is None else pace.count,
        "usual": None if pace is None else round(pace.usual, 3),
        "band": None if pace is None else [round(pace.low, 3), round(pace.high, 3)],
        "change": None
        if pace is None or pace.change is None
        else {"percent": pace.change.percent, "before": round(pace.change.before, 3), "now": round(pace.change.now, 3)},
        "newest": [{"predicted_s": round(predicted, 2), "real_s": round(real, 2)} for predicted, real in found.newest],
        "apart_m": None if found.apart_m is None else round(found.apart_m, 2),
        "last_at": found.last_at,
        "can_be_taken": found.can_be_taken,
        "calibrated": None
        if taken is None
        else {"pace": round(taken.pace, 3), "count": taken.count, "at": taken.at, "by": taken.by},
    }


def _calibrations(site: str, device_id: str) -> Any:
    return Calibration.objects.filter(site__slug=site, device=device_id)


def _find(site: str, device_id: str, method: str) -> MethodPace:
    found: Mapping[str, MethodPace] = {each.method: each for each in list_paces(site=site, device_id=device_id)}
    return found.get(method) or MethodPace(method, None, (), None, None, None)


def _view(method: str, rows: list[_Row], taken: Calibration | None) -> MethodPace:
    apart = [row.apart_m for row in rows[-USUAL_OF:] if row.apart_m is not None]
    calibrated = None
    if taken is not None:
        by = "" if taken.by is None else taken.by.display_name
        calibrated = Calibrated(taken.pace, taken.count, taken.at, by)
    return MethodPace(
        method=method,
        pace=pace_of([row.real_s / row.predicted_s for row in rows]) if rows else None,
        newest=tuple((row.predicted_s, row.real_s) for row in rows[-USUAL_OF:]),
        apart_m=max(apart, default=None),
        last_at=rows[-1].at if rows else None,
        calibrated=calibrated,
    )

"""How long robots waited before the site's zones that take only so many at once: in a rehearsal, and in many; pure."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

LIMITED = "one_at_a_time"
"""The rule of the zones that take only so many robots."""


@dataclass(frozen=True, slots=True)
class ZoneCost:
    """What a zone cost: in how many rehearsals, seconds a rehearsal and at most, and in how many anybody waited."""

    zone: str
    rehearsals: int
    waited_s: float
    most_s: float
    waited_in: int


def mark_of(points: Sequence[Sequence[float]], robots: int) -> str:
    """Return what tells a zone as it is now from one that is drawn otherwise, or takes another number of robots."""
    said = json.dumps([[list(point) for point in points], robots])
    return hashlib.sha256(said.encode()).hexdigest()[:12]


def costs_of(marks: Mapping[str, str], rehearsed: Iterable[Mapping[str, Any]]) -> list[ZoneCost]:
    """Return what each zone cost in the rehearsals that knew it as it is; zones of which none did cost nothing yet.

    `marks` are those of the zones by their ids, `rehearsed` the `zone_waits` of each rehearsal.
    """
    waited: dict[str, list[float]] = {zone: [] for zone in marks}
    for waits in rehearsed:
        for zone, mark in marks.items():
            if (found := waits.get(zone)) and found["mark"] == mark:
                waited[zone].append(float(found["waited_s"]))
    return [
        ZoneCost(zone, len(each), round(sum(each) / len(each), 1), round(max(each), 1), sum(s > 0 for s in each))
        if each
        else ZoneCost(zone, 0, 0.0, 0.0, 0)
        for zone, each in waited.items()
    ]

"""What the zones of a site cost in its newest rehearsals, over HTTP: how long robots waited before them."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from django.http import HttpRequest
from ninja import Router, Schema

from execution.models import Rehearsal
from execution.rehearsals.zone_waits import LIMITED, ZoneCost, costs_of, mark_of
from registry import services as registry
from registry.requests import signed_in

router = Router(tags=["execution"])
MOST_REHEARSALS = 100


class ZoneCostShape(Schema):
    """What a zone for so many robots at once cost in the newest rehearsals that knew it as it is now (100 at most).

    `waited_s` is how long robots waited before it in a rehearsal, on average; `most_s` in the worst of them;
    `waited_in` is in how many of them anybody waited.
    """

    zone: str
    rehearsals: int
    waited_s: float
    most_s: float
    waited_in: int


@router.get("/sites/{slug:site}/zone-costs", response=list[ZoneCostShape])
def list_zone_costs(request: HttpRequest, site: str) -> list[dict[str, Any]]:
    """Return how long robots waited in rehearsals before each zone that takes only so many at once."""
    registry.require(signed_in(request), site, "viewer")
    return [asdict(cost) for cost in _costs(site)]


def _costs(site: str) -> list[ZoneCost]:
    zones = registry.list_zones(site=site)
    marks = {zone.id: mark_of(zone.points, zone.robots or 1) for zone in zones if zone.rule == LIMITED}
    if not marks:
        return []
    done = Rehearsal.objects.filter(site__slug=site, status=Rehearsal.Status.DONE, kind=Rehearsal.Kind.REHEARSAL)
    newest = done.order_by("-ended_at").values_list("zone_waits", flat=True)[:MOST_REHEARSALS]
    return costs_of(marks, newest)

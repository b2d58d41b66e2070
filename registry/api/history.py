"""What properties were, over HTTP."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from django.http import HttpRequest
from django.utils import timezone
from ninja import Router, Schema

from registry import services
from registry.devices.property_history import MOST_POINTS
from registry.people.access import require
from registry.shapes import Reading, signed_in

router = Router(tags=["registry"])


class PointShape(Schema):
    """A property over the seconds from `at` on in which it last changed: its least, greatest and last value."""

    at: str
    minimum: float | None
    maximum: float | None
    value: Reading


class SeriesShape(Schema):
    """What a property was, oldest first; the first point may lie before `since`: what held until the next."""

    property: str
    unit: str
    since: str
    bucket_s: int
    points: list[PointShape]


@router.get("/sites/{slug}/devices/{device_id}/history", response=SeriesShape)
def show_property_history(
    request: HttpRequest,
    slug: str,
    device_id: str,
    property: str,
    since: datetime | None = None,
    points: int = MOST_POINTS,
) -> dict[str, Any]:
    """Show what a property was since a time, at most seven days back, in so many points at most (1 to 500)."""
    require(signed_in(request), slug, "viewer")
    begin = timezone.make_aware(since) if since and timezone.is_naive(since) else since
    found = services.read_history(
        site=slug, device_id=device_id, name=property, since=begin, now=timezone.now(), most=points
    )
    told = [
        {"at": p.at.isoformat(), "minimum": p.minimum, "maximum": p.maximum, "value": p.value} for p in found.points
    ]
    return {
        "property": found.property,
        "unit": found.unit,
        "since": found.since.isoformat(),
        "bucket_s": found.bucket_s,
        "points": told,
    }

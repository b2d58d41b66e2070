"""The zones of a site over HTTP: where its robots keep out, drive slowly, one way, rather, or one at a time."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any

from django.http import HttpRequest
from ninja import Router
from pydantic import Field, Strict

from registry import services
from registry.people.access import require
from registry.requests import Asked, Line, Number, refuses, signed_in
from registry.shapes import SiteZoneShape, ZoneRule

router = Router(tags=["registry"])
Coordinate = Annotated[Number, Field(ge=-1e6, le=1e6)]
Corners = Annotated[list[tuple[Coordinate, Coordinate]], Field(max_length=1000)]
Speed = Annotated[Number, Field(gt=0, le=1000)]
Robots = Annotated[int, Strict(), Field(ge=1, le=1000)]
Heading = Annotated[Number, Field(ge=-360, le=360)]


class NewZone(Asked):
    """A zone that is to be: corners in metres in the map frame; `speed_m_s` for `slow` alone, `robots` for
    `one_at_a_time` (1 unless it says so), `heading_deg` for `one_way`: where robots drive, in degrees from the x axis,
    counter-clockwise; `id` made of its name.
    """

    name: Line = Field(max_length=200)
    rule: ZoneRule
    points: Corners
    speed_m_s: Speed | None = None
    robots: Robots | None = None
    heading_deg: Heading | None = None
    id: Line = Field("", max_length=60)


class ZoneEdit(Asked):
    """What is to be another about a zone; what is left out stays."""

    name: Line | None = Field(None, max_length=200)
    rule: ZoneRule | None = None
    points: Corners | None = None
    speed_m_s: Speed | None = None
    robots: Robots | None = None
    heading_deg: Heading | None = None


class ZoneOpening(Asked):
    """For how long all robots are let into a zone."""

    minutes: Annotated[int, Strict(), Field(ge=1, le=1_000_000)]


@router.post("/sites/{slug}/zones", response={201: SiteZoneShape})
def add_zone(request: HttpRequest, slug: str, body: NewZone) -> dict[str, Any]:
    """Make a zone on a site's map. Robots heed it from then on, those under way, too."""
    require(signed_in(request), slug, "admin")
    values = body.dict()
    zone_id = values.pop("id")
    return asdict(services.add_zone(site=slug, zone_id=zone_id, zone=services.ZoneChange(**values)))


@router.get("/sites/{slug}/zones/{zone_id}", response=SiteZoneShape)
def show_zone(request: HttpRequest, slug: str, zone_id: str) -> dict[str, Any]:
    """Show a zone of a site's map."""
    require(signed_in(request), slug, "viewer")
    return asdict(services.find_zone(site=slug, zone_id=zone_id))


@router.patch("/sites/{slug}/zones/{zone_id}", response=SiteZoneShape)
def edit_zone(request: HttpRequest, slug: str, zone_id: str, body: ZoneEdit) -> dict[str, Any]:
    """Change a zone: robots heed it as it is from then on, those under way, too."""
    require(signed_in(request), slug, "admin")
    change = services.ZoneChange(**body.dict())
    return asdict(services.change_zone(site=slug, zone_id=zone_id, zone=change))


@router.put("/sites/{slug}/zones/{zone_id}/opening", response=SiteZoneShape, openapi_extra=refuses(409))
def open_zone(request: HttpRequest, slug: str, zone_id: str, body: ZoneOpening) -> dict[str, Any]:
    """Let all robots into a zone for a time from now that are let in one by one else."""
    require(signed_in(request), slug, "operator", "run")
    return asdict(services.open_zone(site=slug, zone_id=zone_id, minutes=body.minutes))


@router.delete("/sites/{slug}/zones/{zone_id}/opening", response={204: None}, openapi_extra=refuses(409))
def close_zone(request: HttpRequest, slug: str, zone_id: str) -> None:
    """Let robots into a zone one by one again; those under way stop before it, those in it leave it."""
    require(signed_in(request), slug, "operator", "run")
    services.close_zone(site=slug, zone_id=zone_id)


@router.delete("/sites/{slug}/zones/{zone_id}", response={204: None})
def remove_zone(request: HttpRequest, slug: str, zone_id: str) -> None:
    """Take a zone away: robots drive there as anywhere else."""
    require(signed_in(request), slug, "admin")
    services.remove_zone(site=slug, zone_id=zone_id)

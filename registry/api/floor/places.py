"""The named places of a site over HTTP: where robots may be sent, wait and are parked, and what rooms are called."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any, Literal

from django.http import HttpRequest
from ninja import Router
from pydantic import Field

from registry import services
from registry.people.access import require
from registry.requests import Asked, Line, Number, signed_in
from registry.shapes import PlaceShape

router = Router(tags=["registry"])
Kind = Literal["dock", "room", "point"]
Coordinate = Annotated[Number, Field(ge=-1e6, le=1e6)]


class NewPlace(Asked):
    """A place that is to be: metres and radians in the map frame; `id` is what scripts call it, made of its name."""

    name: Line = Field(max_length=200)
    kind: Kind
    x: Coordinate
    y: Coordinate
    theta: Coordinate = 0.0
    id: Line = Field("", max_length=60)


class PlaceEdit(Asked):
    """What is to be another about a place; what is left out stays."""

    name: Line | None = Field(None, max_length=200)
    kind: Kind | None = None
    x: Coordinate | None = None
    y: Coordinate | None = None
    theta: Coordinate | None = None


@router.post("/sites/{slug}/places", response={201: PlaceShape})
def add_place(request: HttpRequest, slug: str, body: NewPlace) -> dict[str, Any]:
    """Make a place on a site's map. The site needs a map; a place where robots stand may not be in a wall."""
    require(signed_in(request), slug, "admin")
    values = body.dict()
    place_id = values.pop("id")
    return asdict(services.add_place(site=slug, place_id=place_id, place=services.PlaceChange(**values)))


@router.get("/sites/{slug}/places/{place_id}", response=PlaceShape)
def show_place(request: HttpRequest, slug: str, place_id: str) -> dict[str, Any]:
    """Show a place of a site's map."""
    require(signed_in(request), slug, "viewer")
    return asdict(services.find_place(site=slug, place_id=place_id))


@router.patch("/sites/{slug}/places/{place_id}", response=PlaceShape)
def edit_place(request: HttpRequest, slug: str, place_id: str, body: PlaceEdit) -> dict[str, Any]:
    """Change a place: programs that name it follow."""
    require(signed_in(request), slug, "admin")
    change = services.PlaceChange(**body.dict())
    return asdict(services.change_place(site=slug, place_id=place_id, place=change))


@router.delete("/sites/{slug}/places/{place_id}", response={204: None})
def remove_place(request: HttpRequest, slug: str, place_id: str) -> None:
    """Take a place away. Programs that name it cannot run until they name another one."""
    require(signed_in(request), slug, "admin")
    services.remove_place(site=slug, place_id=place_id)

"""Obstacles on a site's floor over HTTP: what its simulated robots meet and no map shows."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any

from django.http import HttpRequest
from ninja import Router
from pydantic import Field

from registry.maps import obstacles
from registry.people.access import require
from registry.requests import Asked, Number, signed_in
from registry.shapes import ObstacleShape

router = Router(tags=["registry"])
Coordinate = Annotated[Number, Field(ge=-1e6, le=1e6)]
Width = Annotated[Number, Field(gt=0, le=1000)]


class ObstacleFields(Asked):
    """Where the middle of an obstacle is, and how wide it is, metres."""

    x: Coordinate
    y: Coordinate
    size_m: Width = 0.5


class ObstacleMove(Asked):
    """Where the middle of an obstacle is from now on, metres; without a width it keeps the one that it has."""

    x: Coordinate
    y: Coordinate
    size_m: Width | None = None


@router.post("/sites/{slug}/obstacles", response={201: ObstacleShape})
def add_obstacle(request: HttpRequest, slug: str, body: ObstacleFields) -> dict[str, Any]:
    """Put an obstacle in the way of simulated robots; they stop before it and say so. Real robots never hear of it."""
    require(signed_in(request), slug, "operator", "run")
    return asdict(obstacles.add_obstacle(site=slug, **body.dict()))


@router.put("/sites/{slug}/obstacles/{int:obstacle}", response=ObstacleShape)
def move_obstacle(request: HttpRequest, slug: str, obstacle: int, body: ObstacleMove) -> dict[str, Any]:
    """Put an obstacle somewhere else, or make it another width."""
    require(signed_in(request), slug, "operator", "run")
    return asdict(obstacles.move_obstacle(site=slug, obstacle=obstacle, **body.dict()))


@router.delete("/sites/{slug}/obstacles/{int:obstacle}", response={204: None})
def remove_obstacle(request: HttpRequest, slug: str, obstacle: int) -> None:
    """Take an obstacle away; robots that have not given up yet go on."""
    require(signed_in(request), slug, "operator", "run")
    obstacles.remove_obstacle(site=slug, obstacle=obstacle)


@router.delete("/sites/{slug}/obstacles", response={204: None})
def remove_obstacles(request: HttpRequest, slug: str) -> None:
    """Take all obstacles of a site away."""
    require(signed_in(request), slug, "operator", "run")
    obstacles.remove_obstacles(site=slug)

"""Maps over HTTP: the site's own with its versions, and the ones that its robots have sent."""

from __future__ import annotations

import gzip
import zlib
from base64 import b64encode
from dataclasses import asdict
from typing import Any

from django.http import HttpRequest, HttpResponse
from ninja import File, Router, Schema
from ninja.files import UploadedFile

from registry import services
from registry.floorplan.comparison import Trouble
from registry.floorplan.map_server import write_pgm, write_yaml
from registry.floorplan.plan import Grid
from registry.floorplan.zone_masks import write_nav2_archive
from registry.people.access import require
from registry.requests import file_response, sends, signed_in
from registry.shapes import MapShape, Origin

router = Router(tags=["registry"])
CELLS, PGM, ZIP = "application/octet-stream", "image/x-portable-graymap", "application/zip"


class MapVersionShape(Schema):
    """One version of a site's map.

    `source` is `upload`, `picture`, `drawing`, `edit`, `demo`, `robot:…`, `version:…` or empty. `tag` is that of the
    cells: no other map has it, not even one of the same number after a backup was brought back.
    """

    version: int
    tag: str
    width: int
    height: int
    resolution_m: float
    source: str
    by: str
    at: str


class OldMapShape(Schema):
    """A version of a site's map without its cells; `tag` is the ETag of these."""

    version: int
    tag: str
    width: int
    height: int
    resolution_m: float
    origin: Origin


class RobotMapShape(Schema):
    """A robot's newest map without its cells; `tag` is the ETag of these, `known` a share from 0 to 1."""

    device: str
    version: int
    tag: str
    width: int
    height: int
    resolution_m: float
    origin: Origin
    known: float
    at: str
    changed_at: str


class MapTroubleShape(Schema):
    """A machine or place that a map does not suit, and whether it is so only with that map."""

    id: str
    name: str
    kind: str
    why: Trouble
    is_new: bool


class MapDifferenceShape(Schema):
    """What changes when the robot's map (`version`) replaces the site's (`replaces`, 0: none), in square metres.

    `tag` and `replaces_tag` are the ETags of their cells, the second empty where the site has no map.
    """

    version: int
    tag: str
    replaces: int
    replaces_tag: str
    floor_gained_m2: float
    floor_lost_m2: float
    walls_gained_m2: float
    walls_lost_m2: float
    troubles: list[MapTroubleShape]


class DrawnLayer(Schema):
    """A layer of a drawing: lines of x, y, x, y … in units of the drawing; `hidden` is off or frozen there."""

    name: str
    hidden: bool
    lines: list[list[float]]


class DrawingShape(Schema):
    """What is drawn in a DXF file: `metres` of its unit (null: it does not say), and how many of what were left out."""

    metres: float | None
    layers: list[DrawnLayer]
    skipped: dict[str, int]


class BroughtMapShape(Schema):
    """A ROS map as it was read; `cells` are those of `…/map/cells`, packed by zlib and written in base64."""

    width: int
    height: int
    resolution_m: float
    origin: Origin
    cells: str


@router.post("/sites/{slug}/map/drawing", response=DrawingShape)
def read_drawing(request: HttpRequest, slug: str, drawing: File[UploadedFile | None] = None) -> dict[str, Any]:
    """Read a DXF drawing as lines by layer, so that a map can be made of it. Nothing is kept."""
    user = signed_in(request)
    require(user, slug, "admin")
    return services.read_brought_drawing(drawing=drawing, by=user)


@router.post("/sites/{slug}/map/read", response=BroughtMapShape)
def read_map_files(
    request: HttpRequest,
    slug: str,
    yaml: File[UploadedFile | None] = None,
    image: File[UploadedFile | None] = None,
    archive: File[UploadedFile | None] = None,
) -> dict[str, Any]:
    """Read a ROS map (two files, or one .zip of both) and send its cells back, to be aligned. Nothing is kept."""
    user = signed_in(request)
    require(user, slug, "admin")
    grid = services.read_upload(files=services.MapFiles(yaml, image, archive), by=user)
    return {**_measures(grid), "cells": b64encode(zlib.compress(grid.cells, 5)).decode()}


@router.get("/sites/{slug}/map", response=MapShape)
def show_map(request: HttpRequest, slug: str) -> dict[str, Any]:
    """Show a site's map without its cells."""
    require(signed_in(request), slug, "viewer")
    found = services.get_map(site=slug)
    grid = found.grid
    return {
        "version": found.version,
        "tag": found.tag,
        **_measures(grid),
        "places": services.list_places(site=slug),
        "zones": services.list_zones(site=slug),
        "obstacles": services.list_obstacles(site=slug),
        "walls": services.get_walls(grid),
    }


def _measures(grid: Grid) -> dict[str, Any]:
    return {
        "width": grid.width,
        "height": grid.height,
        "resolution_m": grid.resolution_m,
        "origin": {"x": grid.origin_x_m, "y": grid.origin_y_m, "yaw": 0.0},
    }


@router.get("/sites/{slug}/map/cells", openapi_extra=sends(CELLS))
def show_cells(request: HttpRequest, slug: str) -> HttpResponse:
    """Send the cells: one byte each, bottom row first, 0 free, 100 occupied, 255 unknown. The ETag is its `tag`."""
    require(signed_in(request), slug, "viewer")
    found = services.get_map(site=slug)
    return _cells(request, found.tag, found.grid)


def _cells(request: HttpRequest, tag: str, grid: Grid) -> HttpResponse:
    if request.headers.get("If-None-Match") == tag:
        return HttpResponse(status=304)
    response = HttpResponse(gzip.compress(grid.cells, 5, mtime=0), content_type=CELLS)
    response["Content-Encoding"] = "gzip"
    response["ETag"] = tag
    response["Cache-Control"] = "private, no-cache"
    return response


@router.get("/sites/{slug}/map.yaml", openapi_extra=sends("application/yaml"))
def download_yaml(request: HttpRequest, slug: str) -> HttpResponse:
    """Send the map's header in the ROS form."""
    require(signed_in(request), slug, "viewer")
    return _yaml(services.get_map(site=slug).grid, slug)


@router.get("/sites/{slug}/map.pgm", openapi_extra=sends(PGM))
def download_pgm(request: HttpRequest, slug: str) -> HttpResponse:
    """Send the map's image in the ROS form."""
    require(signed_in(request), slug, "viewer")
    return file_response(write_pgm(services.get_map(site=slug).grid), f"{slug}.pgm", PGM)


@router.get("/sites/{slug}/map.nav2.zip", openapi_extra=sends(ZIP))
def download_nav2_masks(request: HttpRequest, slug: str) -> HttpResponse:
    """Send the site's keep-out and slow zones as Nav2's masks over the map, with the parameters of its filters."""
    require(signed_in(request), slug, "viewer")
    masks = write_nav2_archive(services.get_map(site=slug).grid, services.list_zones(site=slug))
    return file_response(masks, f"{slug}.nav2.zip", ZIP)


def _yaml(grid: Grid, name: str) -> HttpResponse:
    return file_response(write_yaml(grid, f"{name}.pgm"), f"{name}.yaml", "application/yaml")


@router.get("/sites/{slug}/map/versions", response=list[MapVersionShape])
def list_map_versions(request: HttpRequest, slug: str) -> list[dict[str, Any]]:
    """List the versions of a site's map, the one that holds first; the newest 50 are kept."""
    require(signed_in(request), slug, "viewer")
    return [{**asdict(view), "at": view.at.isoformat()} for view in services.list_map_versions(site=slug)]


@router.get("/sites/{slug}/map/versions/{int:version}", response=OldMapShape)
def show_map_version(request: HttpRequest, slug: str, version: int) -> dict[str, Any]:
    """Show a version of a site's map that is kept, without its cells."""
    require(signed_in(request), slug, "viewer")
    found = services.get_map_version(site=slug, version=version)
    return {"version": found.version, "tag": found.tag, **_measures(found.grid)}


@router.get("/sites/{slug}/map/versions/{int:version}/cells", openapi_extra=sends(CELLS))
def show_version_cells(request: HttpRequest, slug: str, version: int) -> HttpResponse:
    """Send the cells of a version that is kept: one byte each, bottom row first, 0 free, 100 occupied, 255 unknown."""
    require(signed_in(request), slug, "viewer")
    found = services.get_map_version(site=slug, version=version)
    return _cells(request, found.tag, found.grid)


@router.get("/sites/{slug}/devices/{device_id}/map", response=RobotMapShape)
def show_robot_map(request: HttpRequest, slug: str, device_id: str) -> dict[str, Any]:
    """Show the newest map that a robot has sent, without its cells."""
    require(signed_in(request), slug, "viewer")
    facts = services.get_robot_map_facts(site=slug, device_id=device_id)
    times = {"at": facts.at.isoformat(), "changed_at": facts.changed_at.isoformat()}
    return {
        **asdict(facts),
        "tag": facts.tag,
        **times,
        "origin": {"x": facts.origin_x_m, "y": facts.origin_y_m, "yaw": 0.0},
    }


@router.get("/sites/{slug}/devices/{device_id}/map/cells", openapi_extra=sends(CELLS))
def show_robot_cells(request: HttpRequest, slug: str, device_id: str) -> HttpResponse:
    """Send the cells of a robot's map: one byte each, bottom row first, 0 free, 100 occupied, 255 unknown."""
    require(signed_in(request), slug, "viewer")
    found = services.get_robot_map(site=slug, device_id=device_id)
    return _cells(request, found.facts.tag, found.grid)


@router.get("/sites/{slug}/devices/{device_id}/map.yaml", openapi_extra=sends("application/yaml"))
def download_robot_yaml(request: HttpRequest, slug: str, device_id: str) -> HttpResponse:
    """Send the header of a robot's map in the ROS form."""
    require(signed_in(request), slug, "viewer")
    return _yaml(services.get_robot_map(site=slug, device_id=device_id).grid, device_id)


@router.get("/sites/{slug}/devices/{device_id}/map.pgm", openapi_extra=sends(PGM))
def download_robot_pgm(request: HttpRequest, slug: str, device_id: str) -> HttpResponse:
    """Send the image of a robot's map in the ROS form."""
    require(signed_in(request), slug, "viewer")
    return file_response(
        write_pgm(services.get_robot_map(site=slug, device_id=device_id).grid), f"{device_id}.pgm", PGM
    )


@router.get("/sites/{slug}/devices/{device_id}/map/difference", response=MapDifferenceShape)
def show_difference(request: HttpRequest, slug: str, device_id: str) -> dict[str, Any]:
    """Show what would change at the site if the robot's map became its own."""
    user = signed_in(request)
    require(user, slug, "viewer")
    change = services.look_at_robot_map(site=slug, device_id=device_id, by=user)
    replaces = {"replaces": change.replaces.version, "replaces_tag": change.replaces.tag}
    return {**asdict(change.brings), **replaces, **asdict(change.difference)}

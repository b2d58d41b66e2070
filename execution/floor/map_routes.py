"""Another map for a site, over HTTP: brought by a person, sent by a robot or kept from before; and what changes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any, Literal

from django.http import HttpRequest
from ninja import File, Form, Router
from ninja.files import UploadedFile

from editor import services as editor
from execution.errors import ExecutionError
from execution.floor.map_change import change_map
from execution.shapes import BroughtMapDifference, ChangedMap, RestoreMap, UseRobotMap
from registry import services as registry
from registry.requests import refuses, signed_in
from registry.services import require

router = Router(tags=["execution"])
_TAGS: dict[str, Any] = {
    "parameters": [
        {"in": "header", "name": name, "required": False, "schema": {"type": "string"}, "description": told}
        for name, told in (
            ("If-Match", "The ETag of the cells of the map that it replaces."),
            ("If-None-Match", "`*` where the site has no map yet."),
        )
    ],
    **refuses(412, 428),
}
Source = Literal["upload", "picture", "drawing", "edit"]


class MapOvertaken(ExecutionError):
    """The map that somebody changed is not the newest any more."""

    code = "map_overtaken"
    status = 412


class MapTagNeeded(ExecutionError):
    """A map that replaces one without saying which."""

    code = "map_tag_needed"
    status = 428


@router.post("/sites/{slug}/map/upload", response={201: ChangedMap}, openapi_extra=_TAGS)
def upload_map(
    request: HttpRequest,
    slug: str,
    source: Form[Source] = "upload",
    yaml: File[UploadedFile | None] = None,
    image: File[UploadedFile | None] = None,
    archive: File[UploadedFile | None] = None,
) -> dict[str, Any]:
    """Make a ROS map (two files, or one .zip of both) the site's, as a new version; places and devices stay.

    Refused while anything is under way, and where another map than the named one holds by now.
    """
    user = signed_in(request)
    require(user, slug, "admin")
    replaces = _replaced(slug, request.headers)
    grid = registry.read_upload(files=registry.MapFiles(yaml, image, archive), by=user)
    try:
        changed = change_map(
            site=slug,
            change=lambda: registry.save_map(site=slug, grid=grid, source=source, by=user, replaces=replaces),
        )
    except registry.MapChanged as error:
        raise _overtaken() from error
    return {"version": changed.version}


def _replaced(site: str, headers: Mapping[str, str]) -> registry.SeenMap:
    """Return which map is to be replaced. Raises MapTagNeeded, MapOvertaken."""
    tag = headers.get("If-Match", "").strip()
    if not tag and headers.get("If-None-Match", "").strip() != "*":
        raise MapTagNeeded("Say in If-Match which map this replaces, by its ETag, or If-None-Match: * for none.")
    present = registry.find_map(site=site)
    # The second is the tag of the version before: a page that was opened then may have a painted map to save.
    if tag not in ((present.tag, f'"{site}-{present.version}"') if present else ("",)):
        raise _overtaken()
    return registry.SeenMap(present.version, present.tag) if present else registry.SeenMap(0)


def _overtaken() -> MapOvertaken:
    return MapOvertaken("Somebody has changed the site's map meanwhile. Look at theirs, then make your change in it.")


@router.post("/sites/{slug}/map/look", response=BroughtMapDifference)
def look_at_map(
    request: HttpRequest,
    slug: str,
    yaml: File[UploadedFile | None] = None,
    image: File[UploadedFile | None] = None,
    archive: File[UploadedFile | None] = None,
) -> dict[str, Any]:
    """Show what would change at the site if a map became its own: floor, machines, places and programs."""
    user = signed_in(request)
    require(user, slug, "admin")
    grid, replaces, difference = registry.look_at_upload(
        site=slug, files=registry.MapFiles(yaml, image, archive), by=user
    )
    present = registry.find_map(site=slug)
    was = present.grid.standing if present else None
    programs = editor.list_program_troubles(
        site=slug, where=lambda at: "floor" if was and was(at) == grid.standing(at) else grid.standing(at)
    )
    return {"replaces": replaces, **asdict(difference), "programs": [asdict(each) for each in programs]}


@router.post("/sites/{slug}/map/from-device", response={201: ChangedMap})
def use_robot_map(request: HttpRequest, slug: str, body: UseRobotMap) -> dict[str, Any]:
    """Make a robot's map the site's, as a new version; places and devices stay. Refused while anything is under way."""
    user = signed_in(request)
    require(user, slug, "admin")
    changed = change_map(
        site=slug,
        change=lambda: registry.use_robot_map(
            site=slug,
            device_id=body.device,
            brings=registry.SeenMap(body.version, body.tag),
            replaces=registry.SeenMap(body.replaces, body.replaces_tag),
            by=user,
        ),
    )
    return {"version": changed.version}


@router.post("/sites/{slug}/map/restore", response={201: ChangedMap})
def restore_map(request: HttpRequest, slug: str, body: RestoreMap) -> dict[str, Any]:
    """Use an older version of the site's map again, as a new version. Refused while anything is under way."""
    user = signed_in(request)
    require(user, slug, "admin")
    changed = change_map(
        site=slug,
        change=lambda: registry.restore_map(
            site=slug,
            brings=registry.SeenMap(body.version, body.tag),
            replaces=registry.SeenMap(body.replaces, body.replaces_tag),
            by=user,
        ),
    )
    return {"version": changed.version}

"""A site's map changed over HTTP: by what a robot has sent, or back to an older version."""

from __future__ import annotations

from typing import Annotated, Any

from django.http import HttpRequest
from ninja import Field, Router, Schema

from execution import services
from registry import services as registry
from registry.services import require
from registry.shapes import signed_in

router = Router(tags=["execution"])
Version = Annotated[int, Field(ge=0, lt=2**31)]


class UseRobotMap(Schema):
    """Which robot's map, and the versions that were looked at: of the robot's map, and of the site's (0: none)."""

    device: str = Field(max_length=64)
    version: Version
    replaces: Version


class RestoreMap(Schema):
    """Which version of the site's map is to hold again, and which one held when that was decided."""

    version: Version
    replaces: Version


class ChangedMap(Schema):
    """The version that holds now."""

    version: int


@router.post("/sites/{slug}/map/from-device", response=ChangedMap)
def use_robot_map(request: HttpRequest, slug: str, body: UseRobotMap) -> dict[str, Any]:
    """Make a robot's map the site's, as a new version; places and devices stay. Refused while anything is under way."""
    user = signed_in(request)
    require(user, slug, "admin")
    changed = services.change_map(
        site=slug,
        change=lambda: registry.use_robot_map(
            site=slug, device_id=body.device, version=body.version, replaces=body.replaces, by=user
        ),
    )
    return {"version": changed.version}


@router.post("/sites/{slug}/map/restore", response=ChangedMap)
def restore_map(request: HttpRequest, slug: str, body: RestoreMap) -> dict[str, Any]:
    """Use an older version of the site's map again, as a new version. Refused while anything is under way."""
    user = signed_in(request)
    require(user, slug, "admin")
    changed = services.change_map(
        site=slug,
        change=lambda: registry.restore_map(site=slug, version=body.version, replaces=body.replaces, by=user),
    )
    return {"version": changed.version}

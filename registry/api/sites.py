"""Sites over HTTP."""

from __future__ import annotations

from typing import Any

from django.http import HttpRequest
from ninja import File, Form, Router
from ninja.files import UploadedFile

from registry import services
from registry.api.authentication import session_only
from registry.floorplan.map_server import MAX_IMAGE_BYTES, MAX_YAML_BYTES, BadMap
from registry.people.access import require
from registry.shapes import (
    SiteShape,
    signed_in,
)
from registry.sites.views import site_to_json

router = Router(tags=["registry"])


@router.get("/sites", response=list[SiteShape])
def list_sites(request: HttpRequest) -> list[dict[str, Any]]:
    """List the sites where the asker is a member."""
    return [site_to_json(site) for site in services.list_sites(user=signed_in(request))]


@router.post("/sites", response={201: SiteShape}, auth=session_only)
def upload_site(
    request: HttpRequest,
    name: Form[str],
    yaml: File[UploadedFile],
    image: File[UploadedFile | None] = None,
) -> dict[str, Any]:
    """Make a site from a ROS map; the asker becomes its admin."""
    user = signed_in(request)
    site = services.create_site_from_map(
        name=name,
        yaml=_read_upload(yaml, MAX_YAML_BYTES, "The .yaml file"),
        image=_read_upload(image, MAX_IMAGE_BYTES, "The map's image") if image else None,
        admin=user,
    )
    require(user, site.slug, "admin")  # noted: an answer that is given again is given to members of the new site
    return site_to_json(site)


def _read_upload(file: UploadedFile, most: int, what: str) -> bytes:
    if (file.size or 0) > most:
        raise BadMap(f"{what} has {file.size} bytes; {most} is the most. Choose the map's own files.")
    return bytes(file.read())


@router.get("/sites/{slug}", response=SiteShape)
def show_site(request: HttpRequest, slug: str) -> dict[str, Any]:
    """Show a site."""
    access = require(signed_in(request), slug, "viewer")
    return site_to_json(services.get_site(site=slug, role=access.role))

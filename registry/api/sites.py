"""Sites over HTTP."""

from __future__ import annotations

from typing import Any

from django.http import HttpRequest
from ninja import File, Form, Router
from ninja.files import UploadedFile

from registry import services
from registry.api.authentication import session_only
from registry.people.access import require, require_factor
from registry.requests import signed_in
from registry.shapes import SiteShape
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
    yaml: File[UploadedFile | None] = None,
    image: File[UploadedFile | None] = None,
    archive: File[UploadedFile | None] = None,
) -> dict[str, Any]:
    """Make a site, from a ROS map (two files, or one .zip of both) or without a map; the asker becomes its admin.

    A name that another site of the asker has, whatever the letters' case, is refused (409, `name_taken`).
    """
    user = signed_in(request)
    require_factor(user, "admin")
    files = services.MapFiles(yaml, image, archive)
    site = services.create_site_from_map(name=name, files=files, admin=user)
    require(user, site.slug, "admin")  # noted: an answer that is given again is given to members of the new site
    return site_to_json(site)


@router.get("/sites/{slug}", response=SiteShape)
def show_site(request: HttpRequest, slug: str) -> dict[str, Any]:
    """Show a site."""
    access = require(signed_in(request), slug, "viewer")
    return site_to_json(services.get_site(site=slug, role=access.role, held_role=access.held_role))

"""Wall screens over HTTP: made, listed and turned off by admins; opened by whatever holds a link."""

from __future__ import annotations

from dataclasses import asdict
from datetime import datetime
from typing import Any

from django.conf import settings
from django.http import HttpRequest, HttpResponse
from django.utils import timezone
from ninja import Field, Router, Schema
from ninja.errors import HttpError
from ninja.responses import Status
from ninja.utils import check_csrf

from registry.api.authentication import session_only
from registry.audit.actor import client_address
from registry.people import wall_screens
from registry.people.access import require
from registry.people.wall_screens import COOKIE, MOST_DAYS, MOST_NAME, WallScreenView
from registry.requests import Asked, Line, refuses, signed_in

router = Router(tags=["registry"])
PAGE = "/wall#"
"""What stands behind the sign # a browser sends to nobody, so that no log has the code."""
SOCKET = "/ws/wall"
"""The one address that the cookie is sent to: every other call sees nobody."""


class WallScreenShape(Schema):
    """A wall screen without its link; `seen_at` is when it last showed the site, to the minute, null for never."""

    id: int
    name: str
    made_by: str
    made_at: datetime
    expires_at: datetime
    seen_at: datetime | None
    expired: bool


class NewWallScreen(Asked):
    """Where a wall screen hangs, and how many days it shows the site."""

    name: Line = Field(min_length=1, max_length=MOST_NAME)
    days: int = Field(365, ge=1, le=MOST_DAYS)


class MadeWallScreen(WallScreenShape):
    """A new wall screen; `link` is told this once."""

    link: str


class WallCode(Asked):
    """What stands behind the sign # in a wall screen's link."""

    code: Line = Field(min_length=1, max_length=200)


@router.get("/sites/{slug}/wall-screens", response=list[WallScreenShape], auth=session_only)
def list_wall_screens(request: HttpRequest, slug: str) -> list[dict[str, Any]]:
    """List a site's wall screens, the newest first, also those that ended within the last 30 days."""
    require(signed_in(request), slug, "admin")
    return [_to_json(view) for view in wall_screens.list_wall_screens(site=slug)]


@router.post("/sites/{slug}/wall-screens", response={201: MadeWallScreen}, auth=session_only)
def make_wall_screen(
    request: HttpRequest, response: HttpResponse, slug: str, body: NewWallScreen
) -> Status[dict[str, Any]]:
    """Make a link by which a screen shows this site, read only and without names of people, and tell it this once."""
    user = signed_in(request)
    require(user, slug, "admin")
    view, code = wall_screens.make_wall_screen(site=slug, by=user, name=body.name, days=body.days, now=timezone.now())
    response["Cache-Control"] = "no-store"
    return Status(201, {**_to_json(view), "link": request.build_absolute_uri(PAGE) + code})


@router.delete("/sites/{slug}/wall-screens/{int:wall_screen}", response={204: None}, auth=session_only)
def revoke_wall_screen(request: HttpRequest, slug: str, wall_screen: int) -> Status[None]:
    """Turn a wall screen off for good; what shows it goes dark within a second."""
    require(signed_in(request), slug, "admin")
    wall_screens.revoke_wall_screen(site=slug, wall_screen=wall_screen)
    return Status(204, None)


@router.post("/wall/open", response={204: None}, auth=None, openapi_extra=refuses(404))
def open_wall_screen(request: HttpRequest, response: HttpResponse, body: WallCode) -> Status[None]:
    """Exchange the code of a link for a cookie that opens the socket `/ws/wall` and nothing else."""
    if check_csrf(request):
        raise HttpError(403, "The page is out of date. Reload it and open the link again.")
    now = timezone.now()
    opened, key = wall_screens.open_by_code(code=body.code, address=client_address(request), now=now)
    response["Cache-Control"] = "no-store"
    response.set_cookie(
        COOKIE,
        key,
        max_age=opened.expires_at - now,
        path=SOCKET,
        secure=settings.SESSION_COOKIE_SECURE,
        httponly=True,
        samesite="Strict",
    )
    return Status(204, None)


def _to_json(view: WallScreenView) -> dict[str, Any]:
    return {**asdict(view), "expired": view.expires_at <= timezone.now()}

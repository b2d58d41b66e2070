"""A site as a WoT Thing Description Directory (WoT Discovery), for its members."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse, HttpResponseBase
from ninja import Query, Router

from registry import services
from registry.devices.rows import NoSuchDevice
from registry.devices.things import EVENTS, EventName, device_id_of
from registry.people.access import require
from registry.shapes import signed_in
from registry.thing_directory.answers import answer_thing, change_thing, may_see_thing, open_stream, sends
from registry.thing_directory.pages import Page, answer_page, list_page

router = Router(tags=["things"])


@router.get("/sites/{slug}/things", openapi_extra=sends("application/ld+json"))
def list_things(request: HttpRequest, slug: str, page: Query[Page]) -> HttpResponse:
    """List the site's approved devices as Thing Descriptions, a part at a time; the header Link names the next part."""
    require(signed_in(request), slug, "viewer")
    return answer_page(
        base=f"/api/sites/{slug}/things", page=page, listed=list_page(sites=frozenset({slug}), page=page)
    )


@router.get("/sites/{slug}/things/events", openapi_extra=sends("text/event-stream"))
def watch_things(
    request: HttpRequest, slug: str, type: Query[list[EventName] | None] = None, diff: bool = False
) -> HttpResponseBase:
    """Send `thing_created`, `thing_updated` and `thing_deleted` as they happen; with `diff` what changed, too."""
    require(signed_in(request), slug, "viewer")
    return open_stream(request, site=slug, kinds=type or EVENTS, diff=diff)


@router.get("/sites/{slug}/things/{thing}", openapi_extra=sends("application/td+json"))
def show_thing(request: HttpRequest, slug: str, thing: str) -> HttpResponse:
    """Send a device's Thing Description; `thing` is its id, with or without `urn:vipo:device:`."""
    access = require(signed_in(request), slug, "viewer")
    view = services.get_device(site=slug, device_id=device_id_of(thing))
    if not may_see_thing(access, view):
        raise NoSuchDevice(f"This site has no device {view.id!r}.")
    return answer_thing(request, view)


@router.patch("/sites/{slug}/things/{thing}", response={204: None})
def patch_thing(request: HttpRequest, slug: str, thing: str) -> HttpResponse:
    """Change a Thing's `title` or `vipo:location` by a JSON merge patch; the rest the device says itself."""
    return change_thing(request, signed_in(request), slug, device_id_of(thing))

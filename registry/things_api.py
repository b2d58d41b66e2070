"""A site as a WoT Thing Description Directory (WoT Discovery), for its members."""

from __future__ import annotations

import json
from typing import Any, Literal

from django.conf import settings
from django.http import HttpRequest, HttpResponse, StreamingHttpResponse
from django.utils import timezone
from ninja import Field, Query, Router, Schema

from registry import services
from registry.access import require
from registry.api import signed_in
from registry.rdf_text import TD_CONTEXT
from registry.things import device_id_of, read_patch, thing_to_json
from registry.things_events import EVENTS, check_room, stream_events

router = Router(tags=["things"])
DISCOVERY_CONTEXT = "https://www.w3.org/2022/wot/discovery"
MOST_AT_ONCE = 100


def _sends(media_type: str) -> dict[str, Any]:
    return {"responses": {200: {"content": {media_type: {"schema": {"type": "object"}}}}}}


class Page(Schema):
    """Which part of the Things, in which form and order."""

    offset: int = Field(0, ge=0)
    limit: int = Field(50, ge=1, le=MOST_AT_ONCE)
    format: Literal["array", "collection"] = "array"
    sort_by: Literal["id"] = "id"
    sort_order: Literal["asc", "desc"] = "asc"


@router.get("/sites/{slug}/things", openapi_extra=_sends("application/ld+json"))
def list_things(request: HttpRequest, slug: str, page: Query[Page]) -> HttpResponse:
    """List the site's approved devices as Thing Descriptions, a part at a time; the header Link names the next part."""
    require(signed_in(request), slug, "viewer")
    views = sorted(
        services.list_devices(site=slug, lifecycle="approved"), key=lambda v: v.id, reverse=page.sort_order == "desc"
    )
    shown = views[page.offset : page.offset + page.limit]
    members = [thing_to_json(view, settings.VIPO_BROKER_URL) for view in shown]
    following = _address(slug, page, page.offset + page.limit) if page.offset + page.limit < len(views) else ""
    body: Any = members if page.format == "array" else _collection(slug, page, members, len(views), following)
    response = HttpResponse(json.dumps(body, ensure_ascii=False), content_type="application/ld+json")
    if following:
        response["Link"] = f'<{following}>; rel="next"'
    return response


def _address(slug: str, page: Page, offset: int) -> str:
    order = f"&sort_order={page.sort_order}" if page.sort_order == "desc" else ""
    return f"/api/sites/{slug}/things?offset={offset}&limit={page.limit}&format={page.format}{order}"


def _collection(slug: str, page: Page, members: list[dict[str, Any]], total: int, following: str) -> dict[str, Any]:
    body = {
        "@context": [DISCOVERY_CONTEXT, TD_CONTEXT],
        "@type": "ThingCollection",
        "@id": _address(slug, page, page.offset),
        "total": total,
        "members": members,
    }
    return {**body, "next": following} if following else body


@router.get("/sites/{slug}/things/events", openapi_extra=_sends("text/event-stream"))
def watch_things(
    request: HttpRequest,
    slug: str,
    type: Query[list[Literal["thing_created", "thing_updated", "thing_deleted"]] | None] = None,
    diff: bool = False,
) -> StreamingHttpResponse:
    """Send `thing_created`, `thing_updated` and `thing_deleted` as they happen; with `diff` the whole Thing, too."""
    user = signed_in(request)
    require(user, slug, "viewer")
    check_room()
    stream = stream_events(site=slug, user=user, types=type or EVENTS, diff=diff)
    response = StreamingHttpResponse(stream, content_type="text/event-stream")
    response["Cache-Control"] = "no-store"
    response["X-Accel-Buffering"] = "no"
    return response


@router.get("/sites/{slug}/things/{thing}", openapi_extra=_sends("application/td+json"))
def show_thing(request: HttpRequest, slug: str, thing: str) -> HttpResponse:
    """Send a device's Thing Description; `thing` is its id, with or without `urn:vipo:device:`."""
    require(signed_in(request), slug, "viewer")
    view = services.get_device(site=slug, device_id=device_id_of(thing))
    text = json.dumps(thing_to_json(view, settings.VIPO_BROKER_URL), ensure_ascii=False)
    return HttpResponse(text, content_type="application/td+json")


@router.patch("/sites/{slug}/things/{thing}", response={204: None})
def patch_thing(request: HttpRequest, slug: str, thing: str) -> HttpResponse:
    """Change a Thing's `title` or `vipo:location` by a JSON merge patch; the rest the device says itself."""
    user = signed_in(request)
    require(user, slug, "admin")
    patch = read_patch(request.body)
    services.update_device(
        site=slug, device_id=device_id_of(thing), name=patch.name, pose=patch.pose, by=user, at=timezone.now()
    )
    return HttpResponse(status=204)

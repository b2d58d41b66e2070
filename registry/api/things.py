"""A site as a WoT Thing Description Directory (WoT Discovery), for its members."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse, HttpResponseBase
from ninja import Query, Router

from registry import services
from registry.devices.rows import NoSuchDevice
from registry.devices.thing_forms import things_address
from registry.devices.things import EVENTS, EventName, device_id_of
from registry.people.access import require
from registry.requests import refuses, sends, signed_in
from registry.thing_directory.answers import (
    answer_thing,
    answer_value,
    change_thing,
    may_see_thing,
    observer_of,
    open_stream,
    open_values,
    root_of,
)
from registry.thing_directory.pages import Page, answer_page, list_page
from registry.thing_directory.property_values import await_value, get_thing, read_value, read_values

router = Router(tags=["things"])
LIST = {"responses": {**sends("application/ld+json")["responses"], **refuses(501)["responses"]}}
VALUE = {"responses": {200: {"content": {"application/json": {"schema": {"type": ["number", "string", "boolean"]}}}}}}


@router.get("/sites/{slug}/things", openapi_extra=LIST)
def list_things(request: HttpRequest, slug: str, page: Query[Page]) -> HttpResponse:
    """List the site's approved devices as Thing Descriptions, a part at a time; the header Link names the next part."""
    require(signed_in(request), slug, "viewer")
    return answer_page(
        root=root_of(request),
        base=things_address(slug),
        page=page,
        listed=list_page(sites=frozenset({slug}), page=page),
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


@router.patch("/sites/{slug}/things/{thing}", response={204: None}, openapi_extra=refuses(412, 415))
def patch_thing(request: HttpRequest, slug: str, thing: str) -> HttpResponse:
    """Change a Thing's `title` or `vipo:location` by a JSON merge patch; the rest the device says itself."""
    return change_thing(request, signed_in(request), slug, device_id_of(thing))


@router.get("/sites/{slug}/things/{thing}/properties", openapi_extra=sends("application/json"))
def show_values(request: HttpRequest, slug: str, thing: str) -> HttpResponse:
    """Send all properties of a Thing, by name; left out are those of which no value is known that fits."""
    require(signed_in(request), slug, "viewer")
    return answer_value(read_values(get_thing(slug, device_id_of(thing))))


@router.get("/sites/{slug}/things/{thing}/properties/{name}", openapi_extra=VALUE)
def show_value(request: HttpRequest, slug: str, thing: str, name: str) -> HttpResponse:
    """Send what a property is, as the Thing said it last: the value alone, as its schema says."""
    require(signed_in(request), slug, "viewer")
    return answer_value(read_value(get_thing(slug, device_id_of(thing)), name))


@router.get("/sites/{slug}/things/{thing}/properties/{name}/events", openapi_extra=sends("text/event-stream"))
def watch_value(request: HttpRequest, slug: str, thing: str, name: str) -> HttpResponseBase:
    """Send what a property is and each value that follows as server-sent events (subprotocol `sse`)."""
    require(signed_in(request), slug, "viewer")
    return open_values(observer_of(request, slug, device_id_of(thing), name))


@router.get("/sites/{slug}/things/{thing}/properties/{name}/next", openapi_extra=VALUE)
def await_next_value(request: HttpRequest, slug: str, thing: str, name: str) -> HttpResponse:
    """Send the next value of a property, or after 10 s the one that it still is (subprotocol `longpoll`)."""
    require(signed_in(request), slug, "viewer")
    return answer_value(await_value(observer_of(request, slug, device_id_of(thing), name)))


@router.api_operation(["HEAD"], "/sites/{slug}/things/{thing}/properties/{name}/next", include_in_schema=False)
def probe_next_value(request: HttpRequest, slug: str, thing: str, name: str) -> HttpResponse:
    """Say at once that one may wait here, as clients ask before they do."""
    require(signed_in(request), slug, "viewer")
    observer_of(request, slug, device_id_of(thing), name)
    return HttpResponse(content_type="application/json")

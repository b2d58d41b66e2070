"""VIPO as one WoT Thing Description Directory at the addresses of the standard, over all sites of who asks."""

from __future__ import annotations

import json

from django.http import HttpRequest, HttpResponse, HttpResponseBase
from ninja import Query, Router

from registry import services
from registry.devices.rows import NoSuchDevice
from registry.devices.things import EVENTS, EventName, device_id_of
from registry.devices.views import DeviceView
from registry.errors import RegistryError
from registry.people.access import find_access, list_visible
from registry.requests import signed_in
from registry.thing_directory.answers import (
    MERGE_PATCH,
    answer_thing,
    change_thing,
    may_see_thing,
    open_stream,
    root_of,
)
from registry.thing_directory.own_thing import directory_thing
from registry.thing_directory.pages import Page, answer_page, list_page

router = Router(tags=["directory"])
READ = ["GET", "HEAD"]
LIST_TAKES, THING_TAKES = "GET, HEAD, OPTIONS", "GET, HEAD, OPTIONS, PATCH"
HOW_THINGS_COME = (
    "Things are neither made nor deleted here: devices join over MQTT (docs/protocol.md), and admins let them in and "
    "take them out."
)


class NotMadeHere(RegistryError):
    """An attempt to make, replace or delete a Thing over HTTP."""

    code = "not_made_here"
    status = 405


class NotSearchedHere(RegistryError):
    """A search of the standard's that this directory does not offer."""

    code = "not_searched_here"
    status = 501


@router.api_operation(READ, "/.well-known/wot", auth=None)
def show_directory(request: HttpRequest) -> HttpResponse:
    """Describe the directory itself, also to strangers: they learn here how to sign in."""
    body = json.dumps(directory_thing(root_of(request)), ensure_ascii=False)
    return HttpResponse(body, content_type="application/td+json")


@router.api_operation(READ, "/things")
def list_things(request: HttpRequest, page: Query[Page]) -> HttpResponse:
    """List the Things of all sites of which the asker is a member."""
    listed = list_page(sites=list_visible(signed_in(request)), page=page)
    return answer_page(root=root_of(request), base="/things", page=page, listed=listed)


@router.api_operation(READ, "/things/{thing}")
def show_thing(request: HttpRequest, thing: str) -> HttpResponse:
    """Send one of them."""
    return answer_thing(request, _find(request, thing))


@router.patch("/things/{thing}")
def patch_thing(request: HttpRequest, thing: str) -> HttpResponse:
    """Change one of them by a merge patch."""
    view = _find(request, thing)
    return change_thing(request, signed_in(request), view.site, view.id)


@router.api_operation(["POST", "PUT", "PATCH", "DELETE"], "/things")
def refuse_new_thing(request: HttpRequest) -> HttpResponse:
    """Say how Things come."""
    raise NotMadeHere(HOW_THINGS_COME, {"allow": LIST_TAKES})


@router.api_operation(["POST", "PUT", "DELETE"], "/things/{thing}")
def refuse_thing(request: HttpRequest, thing: str) -> HttpResponse:
    """Say how Things come and go."""
    raise NotMadeHere(HOW_THINGS_COME, {"allow": THING_TAKES})


@router.api_operation(["OPTIONS"], "/things", auth=None)
def tell_of_list(request: HttpRequest) -> HttpResponse:
    """Say what can be done with the list."""
    return HttpResponse(status=204, headers={"Allow": LIST_TAKES})


@router.api_operation(["OPTIONS"], "/things/{thing}", auth=None)
def tell_of_thing(request: HttpRequest, thing: str) -> HttpResponse:
    """Say what can be done with a Thing, also with one that is not there."""
    return HttpResponse(status=204, headers={"Allow": THING_TAKES, "Accept-Patch": MERGE_PATCH})


@router.api_operation(READ, "/events")
def watch_all(request: HttpRequest, type: Query[list[EventName] | None] = None, diff: bool = False) -> HttpResponseBase:
    """Send what becomes of Things."""
    return open_stream(request, site=None, kinds=type or EVENTS, diff=diff)


@router.api_operation(READ, "/events/{kind}")
def watch_some(request: HttpRequest, kind: EventName, diff: bool = False) -> HttpResponseBase:
    """Send events of one kind."""
    return open_stream(request, site=None, kinds=(kind,), diff=diff)


@router.api_operation([*READ, "POST"], "/search/{kind}")
def refuse_search(request: HttpRequest, kind: str) -> HttpResponse:
    """Say where one can search."""
    raise NotSearchedHere(
        "This directory has no search. Ask a site: GET /api/sites/{slug}/sparql?query=… (docs/api.md)."
    )


def _find(request: HttpRequest, thing: str) -> DeviceView:
    """Return a listed device that the asker may see. Raises NoSuchDevice, whatever keeps it from being seen."""
    view = services.find_device(device_id=device_id_of(thing))
    user = signed_in(request)
    access = find_access(user, view.site) if view else None
    if view is None or access is None or not may_see_thing(access, view):
        raise NoSuchDevice(f"There is no Thing {thing[:80]!r} that you may see.")
    return view

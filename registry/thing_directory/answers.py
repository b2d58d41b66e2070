"""What a directory of Things answers, be it of one site or of all that somebody may see."""

from __future__ import annotations

import json
from collections.abc import Collection
from contextlib import suppress
from typing import Any

from django.db import transaction
from django.http import HttpRequest, HttpResponse, HttpResponseBase, StreamingHttpResponse
from django.utils import timezone
from django.utils.cache import get_conditional_response

from registry.devices.lifecycle import update_device
from registry.devices.rows import lock_device
from registry.devices.things import read_patch, thing_tag, thing_text
from registry.devices.views import DeviceView, view_of
from registry.errors import RegistryError
from registry.models import User
from registry.people.access import Access, require
from registry.people.sessions import session_of
from registry.thing_directory.event_stream import Listener, check_room, stream_events
from registry.thing_directory.property_values import (
    NoValue,
    Observer,
    UnfitValue,
    get_thing,
    read_value,
    stream_values,
)

MERGE_PATCH = "application/merge-patch+json"


class NotMergePatch(RegistryError):
    """A change that does not say that it is a merge patch."""

    code = "not_merge_patch"
    status = 415


class Changed(RegistryError):
    """The Thing is not any more, or not yet, what the caller believes."""

    code = "changed"
    status = 412


def root_of(request: HttpRequest) -> str:
    """Return where VIPO is served, as who asks has found it."""
    return request.build_absolute_uri("/")


def may_see_thing(access: Access, view: DeviceView) -> bool:
    """Tell whether a member may read a Thing by its id; one that waits for approval is for admins, who decide on it."""
    return view.lifecycle == "approved" or (view.lifecycle == "pending" and access.allows("admin"))


def answer_thing(request: HttpRequest, view: DeviceView) -> HttpResponse:
    """Send a Thing with its entity tag; 304 for who has it already (If-None-Match)."""
    text = thing_text(view, root_of(request))
    response = HttpResponse(text, content_type="application/td+json")
    response["ETag"] = thing_tag(text)
    response["Cache-Control"] = "private, no-cache"
    response["Accept-Patch"] = MERGE_PATCH
    answer = get_conditional_response(request, etag=response["ETag"], response=response)
    assert answer is not None
    return answer


def change_thing(request: HttpRequest, user: User, site: str, device_id: str) -> HttpResponse:
    """Change a Thing by a merge patch, if it is still what the caller knows (If-Match). Admins only."""
    require(user, site, "admin")
    if request.content_type != MERGE_PATCH:
        raise NotMergePatch(f"Send the change as a JSON merge patch: Content-Type: {MERGE_PATCH}.")
    patch = read_patch(request.body)
    with transaction.atomic():
        _check_tag(request, view_of(lock_device(site, device_id), site))
        view = update_device(
            site=site, device_id=device_id, name=patch.name, pose=patch.pose, by=user, at=timezone.now()
        )
    response = HttpResponse(status=204)
    response["ETag"] = thing_tag(thing_text(view, root_of(request)))
    return response


def _check_tag(request: HttpRequest, view: DeviceView) -> None:
    tag = thing_tag(thing_text(view, root_of(request)))
    if get_conditional_response(request, etag=tag) is not None:
        raise Changed("The Thing has changed since you read it. Read it again, then change it with its new ETag.")


def open_stream(request: HttpRequest, *, site: str | None, kinds: Collection[str], diff: bool) -> HttpResponseBase:
    """Open a stream of events; it goes on after the event that the header Last-Event-ID names."""
    listener = Listener(session_of(request), site, kinds, diff, root_of(request))
    check_room(listener.session.person)
    headers = {"Cache-Control": "no-store", "X-Accel-Buffering": "no"}
    if request.method == "HEAD":
        return HttpResponse(content_type="text/event-stream", headers=headers)
    stream = stream_events(listener, request.headers.get("Last-Event-ID", ""))
    return StreamingHttpResponse(stream, content_type="text/event-stream", headers=headers)


def observer_of(request: HttpRequest, site: str, device_id: str, name: str) -> Observer:
    """Return who asks as an observer of a property. Raises NoSuchDevice, NoSuchProperty."""
    with suppress(NoValue, UnfitValue):
        read_value(get_thing(site, device_id), name)
    return Observer(session_of(request), site, device_id, name)


def answer_value(value: Any) -> HttpResponse:
    """Send a value as JSON; nobody keeps it."""
    text = json.dumps(value, ensure_ascii=False, allow_nan=False)
    return HttpResponse(text, content_type="application/json", headers={"Cache-Control": "no-store"})


def open_values(observer: Observer) -> HttpResponseBase:
    """Open a stream of a property's values."""
    check_room(observer.session.person)
    headers = {"Cache-Control": "no-store", "X-Accel-Buffering": "no"}
    return StreamingHttpResponse(stream_values(observer), content_type="text/event-stream", headers=headers)

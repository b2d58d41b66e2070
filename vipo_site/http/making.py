"""What is made gets an address: every call that makes something names it in the header `Location`.

The one table says where each thing is read; the description of the API is made from it, too.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from django.http import HttpRequest
from django.http.response import HttpResponseBase
from django.urls import reverse
from ninja.responses import Status

from registry.requests import LOCATION


@dataclass(frozen=True, slots=True)
class Place:
    """The call that reads a thing: which parts of its address are those of the call that made it, which its fields."""

    call: str
    same: tuple[str, ...]
    fields: Mapping[str, str]


MADE = {
    "upload_site": Place("show_site", (), {"slug": "slug"}),
    "create_token": Place("show_token", ("slug",), {"token_id": "id"}),
    "reserve_device": Place("show_device", ("slug",), {"device_id": "id"}),
    "upload_map": Place("show_map", ("slug",), {}),
    "use_robot_map": Place("show_map", ("slug",), {}),
    "restore_map": Place("show_map", ("slug",), {}),
    "add_place": Place("show_place", ("slug",), {"place_id": "id"}),
    "add_obstacle": Place("show_map", ("slug",), {}),
    "add_zone": Place("show_zone", ("slug",), {"zone_id": "id"}),
    "make_invitation": Place("list_invitations", ("slug",), {}),
    "make_wall_screen": Place("list_wall_screens", ("slug",), {}),
    "begin_second_factor": Place("show_second_factor", (), {}),
    "join_as_new": Place("show_site", (), {"slug": "site"}),
    "create_program": Place("show_program", (), {"program": "id"}),
    "copy_version": Place("show_program", (), {"program": "id"}),
    "pin_version": Place("show_version", ("program",), {"number": "number"}),
    "start_thread": Place("show_thread", ("program",), {"thread": "id"}),
    "comment_on_run": Place("show_thread", (), {"program": "program", "thread": "thread"}),
    "answer_thread": Place("show_thread", ("program", "thread"), {}),
    "add_test": Place("show_test", ("program",), {"test": "id"}),
    "import_tests": Place("list_tests", ("program",), {}),
    "run_tests": Place("show_test_run", ("program",), {"test_run": "id"}),
    "save_function": Place("show_function_version", (), {"function": "id", "number": "version"}),
    "fork_function": Place("show_function_version", (), {"function": "id", "number": "version"}),
    "promote_program": Place("show_program", (), {"program": "id"}),
    "start_run": Place("get_run", (), {"run": "id"}),
    "start_rehearsal": Place("get_rehearsal", (), {"rehearsal": "id"}),
    "call_method": Place("get_call", ("site",), {"call": "id"}),
}
"""Calls that make something. Where work goes on after the answer (202) that is the place to ask how it stands."""
_MADE_AT = "vipo_made_at"


def note_place(call: Callable[..., Any]) -> Callable[..., Any]:
    """Keep where the thing is that a call makes; goes around the call's own function."""
    place = MADE.get(call.__name__)
    if place is None:
        return call

    @functools.wraps(call)
    def call_and_note(request: HttpRequest, *args: Any, **values: Any) -> Any:
        result = call(request, *args, **values)
        body = result.value if isinstance(result, Status) else result
        if not isinstance(body, HttpResponseBase):
            setattr(request, _MADE_AT, _address(place, body, values))
        return result

    return call_and_note


def name_place(run: Callable[..., HttpResponseBase]) -> Callable[..., HttpResponseBase]:
    """Tell where the thing is that a call has made; goes around the whole call."""

    @functools.wraps(run)
    def run_and_name(request: HttpRequest, **values: Any) -> HttpResponseBase:
        response = run(request, **values)
        if response.status_code in (200, 201, 202) and hasattr(request, _MADE_AT):
            response["Location"] = getattr(request, _MADE_AT)
        return response

    return run_and_name


def describe_place(call: dict[str, Any]) -> None:
    """Say in a call's description where what it makes is read, for people and for programs that follow links."""
    place = MADE.get(call["operationId"])
    if place is None:
        return
    known = {part: f"$request.path.{part}" for part in place.same}
    made = {part: f"$response.body#/{field}" for part, field in place.fields.items()}
    for status in {200, 201, 202} & call["responses"].keys():
        answer = call["responses"][status]
        answer["headers"] = {"Location": LOCATION}
        answer["links"] = {place.call: {"operationId": place.call, "parameters": {**known, **made}}}


def _address(place: Place, body: Any, asked: Mapping[str, Any]) -> str:
    read = body.__getitem__ if isinstance(body, Mapping) else functools.partial(getattr, body)
    made = {part: read(field) for part, field in place.fields.items()}
    return reverse(f"api:{place.call}", kwargs={part: asked[part] for part in place.same} | made)

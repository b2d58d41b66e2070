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
class ResourceAddress:
    """The call that reads a thing: which parts of its address are those of the call that made it, which its fields."""

    call: str
    same: tuple[str, ...]
    fields: Mapping[str, str]


MADE = {
    "upload_site": ResourceAddress("show_site", (), {"slug": "slug"}),
    "create_token": ResourceAddress("show_token", ("slug",), {"token_id": "id"}),
    "reserve_device": ResourceAddress("show_device", ("slug",), {"device_id": "id"}),
    "upload_map": ResourceAddress("show_map", ("slug",), {}),
    "use_robot_map": ResourceAddress("show_map", ("slug",), {}),
    "restore_map": ResourceAddress("show_map", ("slug",), {}),
    "add_place": ResourceAddress("show_place", ("slug",), {"place_id": "id"}),
    "add_obstacle": ResourceAddress("show_map", ("slug",), {}),
    "add_zone": ResourceAddress("show_zone", ("slug",), {"zone_id": "id"}),
    "make_invitation": ResourceAddress("list_invitations", ("slug",), {}),
    "make_wall_screen": ResourceAddress("list_wall_screens", ("slug",), {}),
    "begin_second_factor": ResourceAddress("show_second_factor", (), {}),
    "join_as_new": ResourceAddress("show_site", (), {"slug": "site"}),
    "create_program": ResourceAddress("show_program", (), {"program": "id"}),
    "copy_version": ResourceAddress("show_program", (), {"program": "id"}),
    "pin_version": ResourceAddress("show_version", ("program",), {"number": "number"}),
    "start_thread": ResourceAddress("show_thread", ("program",), {"thread": "id"}),
    "comment_on_run": ResourceAddress("show_thread", (), {"program": "program", "thread": "thread"}),
    "answer_thread": ResourceAddress("show_thread", ("program", "thread"), {}),
    "add_test": ResourceAddress("show_test", ("program",), {"test": "id"}),
    "import_tests": ResourceAddress("list_tests", ("program",), {}),
    "run_tests": ResourceAddress("show_test_run", ("program",), {"test_run": "id"}),
    "save_function": ResourceAddress("show_function_version", (), {"function": "id", "number": "version"}),
    "fork_function": ResourceAddress("show_function_version", (), {"function": "id", "number": "version"}),
    "promote_program": ResourceAddress("show_program", (), {"program": "id"}),
    "start_run": ResourceAddress("get_run", (), {"run": "id"}),
    "start_rehearsal": ResourceAddress("get_rehearsal", (), {"rehearsal": "id"}),
    "call_method": ResourceAddress("get_call", ("site",), {"call": "id"}),
}
"""Calls that make something. Where work goes on after the answer (202) that is the place to ask how it stands."""
_MADE_AT = "vipo_made_at"


def note_address(call: Callable[..., Any]) -> Callable[..., Any]:
    """Keep where the thing is that a call makes; goes around the call's own function."""
    address = MADE.get(call.__name__)
    if address is None:
        return call

    @functools.wraps(call)
    def call_and_note(request: HttpRequest, *args: Any, **values: Any) -> Any:
        result = call(request, *args, **values)
        body = result.value if isinstance(result, Status) else result
        if not isinstance(body, HttpResponseBase):
            setattr(request, _MADE_AT, _resolve(address, body, values))
        return result

    return call_and_note


def name_address(run: Callable[..., HttpResponseBase]) -> Callable[..., HttpResponseBase]:
    """Tell where the thing is that a call has made; goes around the whole call."""

    @functools.wraps(run)
    def run_and_name(request: HttpRequest, **values: Any) -> HttpResponseBase:
        response = run(request, **values)
        if response.status_code in (200, 201, 202) and hasattr(request, _MADE_AT):
            response["Location"] = getattr(request, _MADE_AT)
        return response

    return run_and_name


def describe_address(call: dict[str, Any]) -> None:
    """Say in a call's description where what it makes is read, for people and for programs that follow links."""
    address = MADE.get(call["operationId"])
    if address is None:
        return
    known = {part: f"$request.path.{part}" for part in address.same}
    made = {part: f"$response.body#/{field}" for part, field in address.fields.items()}
    for status in {200, 201, 202} & call["responses"].keys():
        answer = call["responses"][status]
        answer["headers"] = {"Location": LOCATION}
        answer["links"] = {address.call: {"operationId": address.call, "parameters": {**known, **made}}}


def _resolve(address: ResourceAddress, body: Any, asked: Mapping[str, Any]) -> str:
    read = body.__getitem__ if isinstance(body, Mapping) else functools.partial(getattr, body)
    made = {part: read(field) for part, field in address.fields.items()}
    return reverse(f"api:{address.call}", kwargs={part: asked[part] for part in address.same} | made)

"""The versions of a program over HTTP."""

from __future__ import annotations

import json
from typing import Any, Literal
from uuid import UUID

from django.http import HttpRequest, HttpResponse
from django.utils.text import slugify
from ninja import Query, Router
from ninja.responses import Status

from editor import services
from editor.errors import BadRequest
from editor.library.shapes import MOST_VERSION
from editor.programs.access import program_for
from editor.programs.views import ProgramView, VersionView
from editor.shapes import ProgramName, ProgramShape
from editor.versions import copying
from editor.versions.restore import Wanted, apply_sent, look_at_restore, names_of, restore
from editor.versions.shapes import (
    ChangedShape,
    ChangesToMake,
    ComparisonShape,
    PinnedVersionShape,
    RestoreAsked,
    VersionShape,
    VersionToPin,
    VersionWords,
    WholeVersionShape,
    changed_to_json,
    comparison_to_json,
    read_sent,
)
from editor.versions.sides import Content, compare_functions, compare_sides
from registry.requests import PartAsked, file_response, refuses, sends, signed_in, tell_rest
from registry.services import require

router = Router(tags=["editor"])
_SENDS_A_FILE = {
    "responses": {**sends("application/json", "text/plain")["responses"], **refuses(409)["responses"]},
}
_MAY_BE_AWAY = refuses(409, 503)
_SIDES = "Compare numbers of versions, or draft, such as ?old=3&new=draft; of another program ?old=ID:3."


@router.get("/programs/{program}/versions", response=list[VersionShape])
def list_versions(
    request: HttpRequest, response: HttpResponse, program: UUID, asked: Query[PartAsked]
) -> list[VersionView]:
    """List a program's versions, the newest first; the header `Link` names the next part."""
    program_for(request.user, program, "viewer")
    return tell_rest(request, response, services.list_versions(program_id=program, page=asked.page()))


@router.post("/programs/{program}/versions", response={200: PinnedVersionShape, 201: PinnedVersionShape})
def pin_version(request: HttpRequest, program: UUID, body: VersionToPin) -> Status[VersionView]:
    """Make the program as it is now a version; the answer is 200 with the last one if nothing has changed since."""
    program_for(request.user, program, "author")
    pinned = services.pin_version(
        program_id=program, user=request.user, name=body.name, message=body.message, cause=body.cause
    )
    return Status(201 if pinned.made else 200, pinned)


@router.get("/programs/{program}/versions/{number}", response=WholeVersionShape, openapi_extra=refuses(409))
def show_version(request: HttpRequest, program: UUID, number: int) -> VersionView:
    """Show a program as it was when it was pinned under a number, with its document."""
    program_for(request.user, program, "viewer")
    return services.find_version(program_id=program, number=number)


@router.patch("/programs/{program}/versions/{number}", response=VersionShape)
def name_version(request: HttpRequest, program: UUID, number: int, body: VersionWords) -> VersionView:
    """Give a version another name and message; what it holds never changes."""
    program_for(request.user, program, "author")
    return services.name_version(program_id=program, number=number, name=body.name, message=body.message)


@router.post("/programs/{program}/versions/{number}/copy", response={201: ProgramShape}, openapi_extra=refuses(409))
def copy_version(request: HttpRequest, program: UUID, number: int, body: ProgramName) -> Status[ProgramView]:
    """Make a new program of a version, at the same site."""
    program_for(request.user, program, "author")
    made = copying.copy_version(program_id=program, number=number, name=body.name, user=request.user)
    return Status(201, made)


@router.get(
    "/programs/{program}/versions/{number}/export",
    openapi_extra=_SENDS_A_FILE,
)
def export_version(
    request: HttpRequest, program: UUID, number: int, form: Literal["document", "script"] = "document"
) -> HttpResponse:
    """Send a version as a file: its document as JSON, or its script."""
    found = program_for(request.user, program, "viewer")
    version = services.find_version(program_id=program, number=number)
    name = f"{slugify(found.name) or 'program'}-v{number}"
    if form == "script":
        return _file(version.script, "text/plain; charset=utf-8", f"{name}.py")
    text = json.dumps(version.document, indent=2, ensure_ascii=False)
    return _file(text, "application/json", f"{name}.json")


def _file(text: str, content_type: str, name: str) -> HttpResponse:
    return file_response(text, name, content_type)


@router.get("/programs/{program}/comparison", response=ComparisonShape)
def compare_versions(request: HttpRequest, program: UUID, old: str, new: str = "draft") -> dict[str, Any]:
    """Compare two versions by their numbers; `draft` is the program as it is drawn now.

    A side of another program that the asker may look at, such as another site's copy, is its id, a colon and that.
    """
    found = program_for(request.user, program, "viewer")
    sides = [_content_of(request, program, each) for each in (old, new)]
    return comparison_to_json(compare_sides(site=found.site, old=sides[0], new=sides[1]))


def _content_of(request: HttpRequest, program: UUID, side: str) -> Content:
    other, colon, version = side.rpartition(":")
    if colon:
        try:
            program = UUID(other)
        except ValueError as error:
            raise BadRequest(_SIDES) from error
        program_for(request.user, program, "viewer")
    if version == "draft":
        return Content(program, None)
    if not (version.isascii() and version.isdigit() and len(version) <= 9):
        raise BadRequest(_SIDES)
    return Content(program, int(version))


@router.post("/programs/{program}/versions/{number}/restore/look", response=ChangedShape, openapi_extra=refuses(409))
def look_at_restoring(request: HttpRequest, program: UUID, number: int, body: RestoreAsked) -> dict[str, Any]:
    """Tell what restoring would change as things are now, and what it needs; nothing is changed."""
    program_for(request.user, program, "author")
    version = services.find_version(program_id=program, number=number)
    return changed_to_json(look_at_restore(version=version, wanted=_wanted(body)))


@router.post("/programs/{program}/versions/{number}/restore", response=ChangedShape, openapi_extra=_MAY_BE_AWAY)
def restore_version(request: HttpRequest, program: UUID, number: int, body: RestoreAsked) -> dict[str, Any]:
    """Draw again what a version held, with what that needs, as an edit of the asker; the answer is what changed."""
    program_for(request.user, program, "author")
    version = services.find_version(program_id=program, number=number)
    return changed_to_json(restore(version=version, wanted=_wanted(body), user=signed_in(request)))


def _wanted(body: RestoreAsked) -> Wanted:
    if not (body.everything or body.constructs or body.fields):
        raise BadRequest("Say what to restore: everything, or constructs as [root, id], or fields as paths.")
    fields = frozenset(tuple(path) for path in body.fields)
    return Wanted(names_of(body.constructs), fields, body.everything)


@router.post("/programs/{program}/changes", response=ChangedShape, openapi_extra=_MAY_BE_AWAY)
def make_changes(request: HttpRequest, program: UUID, body: ChangesToMake) -> dict[str, Any]:
    """Change a program where the old values still stand, such as by what a restore answered, old and new swapped."""
    program_for(request.user, program, "author")
    changes = [read_sent(each) for each in body.changes]
    return changed_to_json(apply_sent(program_id=program, changes=changes, user=signed_in(request)))


@router.get("/library/{function}/sides", response=ComparisonShape)
def compare_function_sides(
    request: HttpRequest, function: UUID, site: str, old: int, new: int | None = None
) -> dict[str, Any]:
    """Compare two versions of a library function as programs of a site, where they can be drawn on its map."""
    require(request.user, site, "viewer")
    numbers = [None if each is None else each if 0 < each < MOST_VERSION else 0 for each in (old, new)]
    compared = compare_functions(
        function_id=function, site=site, user=signed_in(request), old=numbers[0] or 0, new=numbers[1]
    )
    return comparison_to_json(compared)

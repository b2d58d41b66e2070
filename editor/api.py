"""The editor over HTTP: programs; versions, comments, reviews and the library have rooms of their own.

Documents are edited over the socket, or replaced as a whole.
"""

from __future__ import annotations

import base64
import binascii
from collections.abc import Mapping
from typing import Annotated, Any
from uuid import UUID

from django.http import HttpRequest, HttpResponse
from ninja import Field, Query, Router
from ninja.params.functions import Header
from ninja.responses import Status
from pydantic import ValidationError

from editor import services
from editor.comments.routes import router as comments_router
from editor.documents.knowledge import MOST_BYTES as MOST_SNAPSHOT_BYTES
from editor.library.routes import router as library_router
from editor.programs.access import program_for
from editor.programs.views import ProgramView
from editor.promotions.routes import router as promotions_router
from editor.reviews.routes import router as reviews_router
from editor.rooms.content_update import ensure_stored, read_content, write_document, write_script
from editor.shapes import (
    Compiled,
    Document,
    DocumentShape,
    DrawnScriptShape,
    ExpressionShape,
    ExpressionToRead,
    ProgramName,
    ProgramShape,
)
from editor.versions.routes import router as versions_router
from registry.requests import Asked, Line, PartAsked, Repaired, refuses, signed_in, tell_rest
from registry.services import require
from vipo_device.protocol.messages import BadMessage, parse_plain_json
from vipo_device.protocol.texts import cleaned, cleaned_json

router = Router(tags=["editor"])
router.add_router("", versions_router)
router.add_router("", comments_router)
router.add_router("", reviews_router)
router.add_router("", library_router)
router.add_router("", promotions_router)


MOST_DOCUMENT = 8 * 1024 * 1024
IF_MATCH: Any = Header(alias="If-Match", description="The ETag of what was read, as it is.")
TAG = {"description": "Another once the content changes.", "schema": {"type": "string"}}
TEXT: dict[str, Any] = {"type": "string"}
DOCUMENT: dict[str, Any] = {"$ref": "#/components/schemas/DocumentShape"}
TAGGED: dict[str, Any] = {"responses": {200: {"headers": {"ETag": TAG}}}}
_TELLS_SCRIPT: dict[str, Any] = {
    "responses": {200: {"content": {"text/plain": {"schema": TEXT}}, "headers": {"ETag": TAG}}}
}


def _takes(content_type: str, schema: dict[str, Any]) -> dict[str, Any]:
    """Say in the OpenAPI file what a call that writes content takes, and how it may refuse it."""
    body = {"required": True, "content": {content_type: {"schema": schema}}}
    told = {204: {"headers": {"ETag": TAG}}, **refuses(412, 413, 428)["responses"]}
    return {"requestBody": body, "responses": told}


class ProgramsAsked(PartAsked):
    """Which programs are asked for: those whose names have all words of `q`."""

    q: Line = Field("", max_length=200)


class Seen(Asked):
    """How far somebody has seen a program."""

    seen: str = Field(
        max_length=4 * MOST_SNAPSHOT_BYTES // 3 + 4,
        description="A snapshot of the Yjs document, as `Y.encodeSnapshot` writes it, in base64.",
    )


class ScriptText(Asked):
    """A script as somebody edited it."""

    text: Annotated[str, Repaired()]
    base: Annotated[dict[str, Any] | None, Repaired()] = Field(
        None, description="The document that it is drawn over; the current one if none."
    )
    shown: Annotated[str | None, Repaired()] = Field(None, description="The script from which the text was edited.")


@router.get("/sites/{slug}/programs", response=list[ProgramShape])
def list_programs(
    request: HttpRequest, response: HttpResponse, slug: str, asked: Query[ProgramsAsked]
) -> list[ProgramView]:
    """List a site's programs, the last edited first; the header `Link` names the next part."""
    require(request.user, slug, "viewer")
    return tell_rest(request, response, services.list_programs(site=slug, page=asked.page(), words=asked.q))


@router.post("/sites/{slug}/programs", response={201: ProgramShape})
def create_program(request: HttpRequest, slug: str, body: ProgramName) -> Status[ProgramView]:
    """Make an empty program."""
    require(request.user, slug, "author")
    return Status(201, services.create_program(site=slug, name=body.name, user=request.user))


@router.get("/programs/{program}", response=ProgramShape)
def show_program(request: HttpRequest, program: UUID) -> ProgramView:
    """Show a program."""
    return program_for(request.user, program, "viewer")


@router.patch("/programs/{program}", response=ProgramShape)
def rename_program(request: HttpRequest, program: UUID, body: ProgramName) -> ProgramView:
    """Give a program another name."""
    program_for(request.user, program, "author")
    return services.rename_program(program_id=program, name=body.name, user=request.user)


@router.delete("/programs/{program}", response={204: None})
def delete_program(request: HttpRequest, program: UUID) -> Status[None]:
    """Delete a program with its versions."""
    program_for(request.user, program, "author")
    services.delete_program(program_id=program)
    return Status(204, None)


@router.get("/programs/{program}/document", response=Document, openapi_extra=TAGGED)
def show_document(request: HttpRequest, response: HttpResponse, program: UUID) -> Mapping[str, Any]:
    """Show a program's document as it is now; the header `ETag` is what it is written with."""
    program_for(request.user, program, "viewer")
    content = read_content(program_id=program)
    response["ETag"] = content.tag
    return content.document


@router.put("/programs/{program}/document", response={204: None}, openapi_extra=_takes("application/json", DOCUMENT))
def put_document(
    request: HttpRequest, response: HttpResponse, program: UUID, if_match: Annotated[str, IF_MATCH] = ""
) -> Status[None]:
    """Make a document the program's, if it is still what was read; what others change meanwhile is merged."""
    program_for(request.user, program, "author")
    _keep(request, program)
    content = write_document(
        program_id=program, document=_read_document(request.body), tag=if_match, author=signed_in(request).pk
    )
    response["ETag"] = content.tag
    return Status(204, None)


@router.get("/programs/{program}/script", openapi_extra=_TELLS_SCRIPT)
def show_script(request: HttpRequest, program: UUID) -> HttpResponse:
    """Send a program's script as it is now; the header `ETag` is what it is written with."""
    program_for(request.user, program, "viewer")
    content = read_content(program_id=program)
    return HttpResponse(content.script, content_type="text/plain; charset=utf-8", headers={"ETag": content.tag})


@router.put("/programs/{program}/script", response={204: None}, openapi_extra=_takes("text/plain", TEXT))
def put_script(
    request: HttpRequest, response: HttpResponse, program: UUID, if_match: Annotated[str, IF_MATCH] = ""
) -> Status[None]:
    """Make a script the program's, if it is still what was read; `args.diagnostics` says where it is none."""
    program_for(request.user, program, "author")
    try:
        text = cleaned(request.body.decode())
    except UnicodeDecodeError as error:
        raise services.BadRequest("The script is not UTF-8. Send it as text/plain in UTF-8.") from error
    _keep(request, program)
    content = write_script(program_id=program, text=text, tag=if_match, author=signed_in(request).pk)
    response["ETag"] = content.tag
    return Status(204, None)


def _keep(request: HttpRequest, program: UUID) -> None:
    """Make what is there a version before something else takes its place."""
    services.pin_version(program_id=program, user=request.user, cause="import")


def _read_document(body: bytes) -> dict[str, Any]:
    """Return a document that has its shape. Raises BadRequest."""
    try:
        plain: Any = parse_plain_json(body, max_bytes=MOST_DOCUMENT, max_depth=60)
        DocumentShape.model_validate(plain)
    except BadMessage as error:
        raise services.BadRequest(error.fault.about("The document").sentence) from error
    except ValidationError as error:
        where = error.errors(include_url=False)[0]
        path = ".".join(map(str, where["loc"]))
        raise services.BadRequest(f"The document does not fit: {path}: {where['msg']}") from error
    return dict(cleaned_json(plain))


@router.get("/programs/{program}/compiled", response=Compiled)
def show_compiled(request: HttpRequest, program: UUID) -> dict[str, Any]:
    """Show a program compiled for its site, as both are now."""
    program_for(request.user, program, "viewer")
    return services.get_compiled(program_id=program)


@router.post("/programs/{program}/script", response=DrawnScriptShape, openapi_extra=refuses(413))
def draw_script(request: HttpRequest, program: UUID, body: ScriptText) -> services.DrawnScript:
    """Draw a script: the document that it would make of the program, or where it leaves the language."""
    program_for(request.user, program, "author")
    return services.draw_script(program_id=program, text=body.text, base=body.base, shown=body.shown)


@router.post("/programs/{program}/expression", response=ExpressionShape)
def read_expression(request: HttpRequest, program: UUID, body: ExpressionToRead) -> services.ExpressionView:
    """Read a value that an author writes as one line, or print one for whoever may look."""
    if body.text is None:
        program_for(request.user, program, "viewer")
        return services.print_expression(program_id=program, value=body.value, step=body.step, names=body.names)
    program_for(request.user, program, "author")
    return services.read_expression(program_id=program, text=body.text, step=body.step, names=body.names)


@router.post("/programs/{program}/stored", response={204: None}, openapi_extra=refuses(409))
def wait_until_stored(request: HttpRequest, program: UUID, body: Seen) -> Status[None]:
    """Wait until the database holds what somebody sees of a program, so that what is made of it next holds it, too.

    The answer is 409 if that takes longer than a few seconds.
    """
    program_for(request.user, program, "viewer")
    try:
        seen = base64.b64decode(body.seen, validate=True)
    except binascii.Error as error:
        raise services.BadRequest("What was seen is not base64. Send Y.encodeSnapshot(…) in base64.") from error
    ensure_stored(program_id=program, seen=seen)
    return Status(204, None)

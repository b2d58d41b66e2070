"""Tests of programs over HTTP: written by authors, carried out by operators, read by whoever may look."""

from __future__ import annotations

from typing import Annotated, Any, Literal
from uuid import UUID

from django.http import HttpRequest, HttpResponse
from django.utils.text import slugify
from ninja import Router
from ninja.params.functions import Header
from ninja.responses import Status

from editor import services as editor
from editor.services import NoSuchProgram
from execution.program_tests import stored_tests
from execution.program_tests.first_text import first_text
from execution.program_tests.meant_changes import ChangeKey, set_meant
from execution.program_tests.overview import list_version_tests, run_to_json, runs_of, show_run, show_tests
from execution.program_tests.shapes import (
    FirstTextShape,
    MeantChangeToSay,
    ProgramTestsShape,
    TestLookShape,
    TestRunShape,
    TestsToImport,
    TestsToRun,
    TestTextShape,
    TestToWrite,
    VersionTestsShape,
    WholeTestRunShape,
)
from execution.program_tests.test_runs import Asker, Extent, Update, start_tests
from execution.trials.refusals import cause_of_refusal
from registry.requests import file_response, refuses, sends, signed_in
from registry.services import NotAMember, require

router = Router(tags=["execution"])
IF_MATCH: Any = Header(alias="If-Match", description="The ETag of the test that was read, as it is.")
TAG = {"description": "What the test is written with.", "schema": {"type": "string"}}
TAGGED: dict[str, Any] = {"responses": {200: {"headers": {"ETag": TAG}}}}
WRITES: dict[str, Any] = {
    "responses": {200: {"headers": {"ETag": TAG}}, **refuses(409, 412, 428)["responses"]},
}


def _program(request: HttpRequest, program: UUID, role: str, scope: str = "run") -> editor.ProgramView:
    """Return a program if somebody has that role at its site; to strangers it does not exist."""
    found = editor.get_program(program_id=program)
    try:
        require(request.user, found.site, role, scope)
    except NotAMember as error:
        raise NoSuchProgram("There is no such program. It may have been deleted.") from error
    return found


@router.get("/programs/{uuid:program}/tests", response=ProgramTestsShape)
def list_tests(request: HttpRequest, program: UUID) -> dict[str, Any]:
    """Return a program's tests with what came of them last, and which ways through it none of them took."""
    _program(request, program, "viewer", "read")
    return show_tests(program=program, asker=signed_in(request).pk)


@router.post("/programs/{uuid:program}/tests", response={201: TestTextShape}, openapi_extra=refuses(409))
def add_test(request: HttpRequest, response: HttpResponse, program: UUID, body: TestToWrite) -> Status[Any]:
    """Add a test. `args.line` of a refusal is where its text is wrong."""
    _program(request, program, "author")
    made = stored_tests.add_test(program=program, text=body.text, user=signed_in(request))
    response["ETag"] = made.tag
    return Status(201, made)


@router.post("/programs/{uuid:program}/tests/look", response=TestLookShape)
def look_at_test(request: HttpRequest, program: UUID, body: TestToWrite) -> dict[str, Any]:
    """Tell whether a text is a test, and else where it is wrong; nothing is kept."""
    _program(request, program, "author")
    fault = stored_tests.find_fault(text=body.text)
    if fault is None:
        return {"fault": None}
    line, why = fault
    return {"fault": {"line": line, "why": why, "cause": cause_of_refusal(why)}}


@router.get("/programs/{uuid:program}/tests/first", response=FirstTextShape)
def show_first_text(
    request: HttpRequest, program: UUID, of: Literal["nothing", "rehearsal"] = "nothing"
) -> dict[str, Any]:
    """Return the text that a new test may begin with: hardly anything, or made of the program's last rehearsal."""
    _program(request, program, "author")
    text, of_rehearsal = first_text(program=program, of_rehearsal=of == "rehearsal")
    return {"text": text, "of_rehearsal": of_rehearsal}


@router.post("/programs/{uuid:program}/tests/import", response={201: list[TestTextShape]}, openapi_extra=refuses(409))
def import_tests(request: HttpRequest, program: UUID, body: TestsToImport) -> Status[Any]:
    """Add all tests of a file, or none of them."""
    _program(request, program, "author")
    return Status(201, stored_tests.import_tests(program=program, text=body.text, user=signed_in(request)))


@router.get("/programs/{uuid:program}/tests/file", openapi_extra=sends("application/yaml"))
def export_tests(request: HttpRequest, program: UUID) -> HttpResponse:
    """Send a program's tests as a file for `vipo test`, which seeks the program's own file beside it."""
    found = _program(request, program, "viewer", "read")
    name = slugify(found.name) or "program"
    text = stored_tests.file_of_tests(program=program, document=f"{name}.json")
    return file_response(text, f"{name}.yaml", "application/yaml")


@router.get("/programs/{uuid:program}/tests/{uuid:test}", response=TestTextShape, openapi_extra=TAGGED)
def show_test(request: HttpRequest, response: HttpResponse, program: UUID, test: UUID) -> stored_tests.TestText:
    """Return a test; the header `ETag` is what it is written with."""
    _program(request, program, "viewer", "read")
    found = stored_tests.get_test(program=program, test=test)
    response["ETag"] = found.tag
    return found


@router.put("/programs/{uuid:program}/tests/{uuid:test}", response=TestTextShape, openapi_extra=WRITES)
def write_test(
    request: HttpRequest, response: HttpResponse, program: UUID, test: UUID, body: TestToWrite,
    if_match: Annotated[str, IF_MATCH] = "",
) -> stored_tests.TestText:  # fmt: skip
    """Write a test anew, if it is still what was read."""
    _program(request, program, "author")
    written = stored_tests.write_test(program=program, test=test, text=body.text, tag=if_match, user=signed_in(request))
    response["ETag"] = written.tag
    return written


@router.delete("/programs/{uuid:program}/tests/{uuid:test}", response={204: None}, openapi_extra=refuses(412, 428))
def delete_test(
    request: HttpRequest, program: UUID, test: UUID, if_match: Annotated[str, IF_MATCH] = ""
) -> Status[None]:
    """Delete a test with its results, if it is still what was read."""
    _program(request, program, "author")
    stored_tests.delete_test(program=program, test=test, tag=if_match)
    return Status(204, None)


@router.post("/programs/{uuid:program}/tests/meant-changes", response={204: None}, openapi_extra=refuses(409))
def say_change_is_meant(request: HttpRequest, program: UUID, body: MeantChangeToSay) -> Status[None]:
    """Say that it is meant so that no test notices a change of a program as it is now, or that it is not."""
    _program(request, program, "author")
    change = ChangeKey(body.step, body.code, body.name)
    set_meant(program=program, change=change, mark=body.mark, meant=body.meant, user=signed_in(request))
    return Status(204, None)


@router.post("/programs/{uuid:program}/test-runs", response={202: TestRunShape})
def run_tests(request: HttpRequest, program: UUID, body: TestsToRun | None = None) -> Status[dict[str, Any]]:
    """Carry out tests of a program on what is drawn now, on a version or on an update; queued as rehearsals are."""
    _program(request, program, "operator")
    person, body = signed_in(request), body or TestsToRun(tests=None, seeds=0, changes=False, update=None)
    asker = Asker(person.pk, person.display_name)
    extent, update = Extent(body.seeds, body.changes), None
    if body.update is not None:
        update = Update(body.update.library, body.update.version, request.user)
    started = start_tests(
        program=program, asker=asker, tests=body.tests, number=body.version, extent=extent, update=update
    )
    run = runs_of(program).get(pk=started)
    return Status(202, run_to_json(run, person.pk))


@router.get("/programs/{uuid:program}/test-runs/{uuid:test_run}", response=WholeTestRunShape)
def show_test_run(request: HttpRequest, program: UUID, test_run: UUID) -> dict[str, Any]:
    """Return a run of a program's tests, with what came of each test once it is over."""
    _program(request, program, "viewer", "read")
    return show_run(program=program, run=test_run, asker=signed_in(request).pk)


@router.get("/programs/{uuid:program}/version-tests", response=list[VersionTestsShape])
def show_version_tests(request: HttpRequest, program: UUID) -> list[dict[str, Any]]:
    """Return how many tests passed on each version on which all were carried out."""
    _program(request, program, "viewer", "read")
    return list_version_tests(program=program)

"""Execution over HTTP: runs, rehearsals, calls, questions, the stop, routes for drawing."""

from __future__ import annotations

from typing import Any
from uuid import UUID

from django.http import HttpRequest, HttpResponse
from ninja import Query, Router
from ninja.responses import Status

from execution import services
from execution.errors import NotFound, NoWay
from execution.floor.admission_routes import router as admission_router
from execution.floor.exports.routes import router as exports_router
from execution.floor.floor_check_routes import router as floor_check_router
from execution.floor.floor_use_routes import router as floor_use_router
from execution.floor.map_routes import router as map_router
from execution.mirror.measurements import list_of_run
from execution.mirror.routes import router as mirror_router
from execution.mirror.shapes import StepMeasuredShape
from execution.operations.routes import router as operations_router
from execution.program_tests.routes import router as program_tests_router
from execution.rehearsals.shapes import RehearsalShape, RehearsalSummaryShape, StartRehearsal
from execution.rehearsals.views import rehearsal_to_json, whole_rehearsal_to_json
from execution.rehearsals.zone_costs import router as zone_costs_router
from execution.retention.routes import router as retention_router
from execution.runs.comments import begin_thread
from execution.runs.programs import prepare, site_of_program
from execution.runs.routes import router as run_history_router
from execution.shapes import (
    ActionInput,
    ActionStatus,
    AnswerQuestion,
    ArmedShape,
    ArmProgram,
    AskRoute,
    AskRoutes,
    CallMethod,
    CallShape,
    CommentOnRun,
    QuestionShape,
    RouteShape,
    RunsAsked,
    RunShape,
    RunSummaryShape,
    StartRun,
    ThreadBegun,
)
from execution.stand_ins.routes import router as stand_ins_router
from execution.views import (
    armed_to_json,
    call_to_json,
    question_to_json,
    route_to_json,
    run_to_json,
    whole_run_to_json,
)
from registry.requests import LOCATION, file_response, link_to_next, origin_of, refuses, signed_in
from registry.services import NotAMember, require
from registry.shapes import Stop
from vipo_device.descriptions.thing_description import DEVICE_URN

router = Router(tags=["execution"])
router.add_router("", admission_router)
router.add_router("", zone_costs_router)
router.add_router("", floor_check_router)
router.add_router("", floor_use_router)
router.add_router("", map_router)
router.add_router("", exports_router)
router.add_router("", mirror_router)
router.add_router("", operations_router)
router.add_router("", program_tests_router)
router.add_router("", retention_router)
router.add_router("", run_history_router)
router.add_router("", stand_ins_router)
_RECORDINGS = {"json": "application/json", "mcap": "application/octet-stream"}
_SENDS_RECORDING = {
    "responses": {
        409: {},
        200: {
            "content": {
                "application/json": {"schema": {"type": "object"}},
                "application/octet-stream": {"schema": {"type": "string", "format": "binary"}},
            }
        },
    }
}
ABSENT = {
    "program": "There is no such program. It may have been deleted.",
    "question": "There is no such question. Its run may have been deleted.",
    "rehearsal": "There is no such rehearsal. It may have been deleted with its program.",
    "run": "There is no such run. It may have been deleted with its site.",
}


def _require(request: HttpRequest, site: str, role: str, scope: str = "") -> None:
    require(request.user, site, role, scope)


def _require_here(request: HttpRequest, site: str, role: str, what: str, scope: str = "") -> None:
    """Let members through who may; a stranger gets the very answer that they get for what does not exist.

    Tokens do this by `run`.
    """
    try:
        _require(request, site, role, scope or ("read" if role == "viewer" else "run"))
    except NotAMember as error:
        raise NotFound(ABSENT[what]) from error


def _who(request: HttpRequest) -> str:
    return str(getattr(request.user, "display_name", "") or request.user)


@router.post("/programs/{uuid:program}/rehearsals", response={202: RehearsalShape})
def start_rehearsal(request: HttpRequest, program: UUID, body: StartRehearsal | None = None) -> dict[str, Any]:
    """Queue a rehearsal of a program, as it is drawn now or of a version.

    It is refused while the asker or the site has as many as may be.
    """
    _require_here(request, site_of_program(program_id=program), "operator", "program")
    body = body or StartRehearsal()
    prepared = prepare(
        program_id=program,
        user=request.user,
        parameters=body.parameters,
        version=body.version,
        cause="rehearsal",
    )
    person = signed_in(request).pk
    started = services.start_rehearsal(
        prepared=prepared, by=_who(request), person=person, seed=body.seed, driver=body.driver,
        faults=body.faults.model_dump() if body.faults else None,
    )  # fmt: skip
    return whole_rehearsal_to_json(started, person)


@router.get("/rehearsals/{uuid:rehearsal}", response=RehearsalShape)
def get_rehearsal(request: HttpRequest, rehearsal: UUID) -> dict[str, Any]:
    """Return a rehearsal with its result."""
    view = services.get_rehearsal(rehearsal_id=rehearsal)
    _require_here(request, view.site, "viewer", "rehearsal")
    return whole_rehearsal_to_json(view, signed_in(request).pk)


@router.get("/rehearsals/{uuid:rehearsal}/recording", openapi_extra=_SENDS_RECORDING)
def export_rehearsal(request: HttpRequest, rehearsal: UUID, form: services.RecordingForm = "json") -> HttpResponse:
    """Give a rehearsal that is done as a file: JSON with all that is known of it, or MCAP for tools of robots.

    Both are told of in docs/simulation.md.
    """
    _require_here(request, services.get_rehearsal(rehearsal_id=rehearsal).site, "viewer", "rehearsal")
    content = services.export_rehearsal(rehearsal_id=rehearsal, form=form)
    return file_response(content, f"rehearsal-{rehearsal}.{form}", _RECORDINGS[form])


@router.get("/sites/{slug:site}/rehearsals", response=list[RehearsalSummaryShape])
def list_rehearsals(request: HttpRequest, site: str) -> list[dict[str, Any]]:
    """Return the site's rehearsals that are not over: those under way, then those that wait, in their order."""
    _require(request, site, "viewer")
    person = signed_in(request).pk
    return [rehearsal_to_json(view, person) for view in services.list_open_rehearsals(site=site)]


@router.post("/rehearsals/{uuid:rehearsal}/cancel", response=RehearsalSummaryShape)
def cancel_rehearsal(request: HttpRequest, rehearsal: UUID) -> dict[str, Any]:
    """End a rehearsal that waits or is under way; for who has started it, and for operators."""
    view, person = services.get_rehearsal(rehearsal_id=rehearsal), signed_in(request).pk
    least = "viewer" if view.person == person else "operator"
    _require_here(request, view.site, least, "rehearsal", scope="run")
    return rehearsal_to_json(services.cancel_rehearsal(rehearsal_id=rehearsal, by=_who(request)), person)


@router.post("/programs/{uuid:program}/runs", response={202: RunSummaryShape})
def start_run(request: HttpRequest, program: UUID, body: StartRun | None = None) -> dict[str, Any]:
    """Start a run of a program, as it is drawn now or of a version.

    It is refused (not_approved) where approvals are missing that the site demands; an admin gives a reason then.
    """
    site = site_of_program(program_id=program)
    _require_here(request, site, "operator", "program")
    body = body or StartRun()
    if body.emergency.strip():
        _require_here(request, site, "admin", "program", scope="admin")
    fence = services.get_stop(site=site).fence
    prepared = prepare(program_id=program, user=request.user, parameters=body.parameters, version=body.version)
    terms = services.Terms(body.priority, body.not_before, body.deadline)
    run = services.start_run(
        prepared=prepared, by=_who(request), terms=terms, fence=fence, emergency=body.emergency.strip()
    )
    return run_to_json(run)


@router.get("/sites/{slug:site}/runs", response=list[RunSummaryShape])
def list_runs(request: HttpRequest, response: HttpResponse, site: str, asked: Query[RunsAsked]) -> list[dict[str, Any]]:
    """Return the site's runs, the newest first; the header `Link` names the next part where there are older ones."""
    _require(request, site, "viewer")
    which = services.RunFilter(state=asked.state, program=asked.program, since=asked.since, until=asked.until)
    runs, has_older = services.list_runs(site=site, limit=asked.limit, before=asked.before, which=which)
    if has_older:
        response["Link"] = link_to_next(request, before=runs[-1].number)
    return [run_to_json(run) for run in runs]


@router.get("/runs/{uuid:run}", response=RunShape)
def get_run(request: HttpRequest, run: UUID) -> dict[str, Any]:
    """Return a run with its document and compiled form."""
    _require_here(request, services.site_of_run(run_id=run), "viewer", "run")
    return whole_run_to_json(services.get_run(run_id=run))


@router.get("/runs/{uuid:run}/measurements", response=list[StepMeasuredShape])
def list_measurements(request: HttpRequest, run: UUID) -> list[dict[str, Any]]:
    """Return what the steps of a run took, beside what the copies of the devices took; empty without a mirror."""
    _require_here(request, services.site_of_run(run_id=run), "viewer", "run")
    return list_of_run(run=run)


@router.post("/runs/{uuid:run}/threads", response={201: ThreadBegun}, openapi_extra=refuses(409, 429))
def comment_on_run(request: HttpRequest, run: UUID, body: CommentOnRun) -> Status[dict[str, Any]]:
    """Begin a thread of comments about a moment of a run; it is read and answered among those of the run's program."""
    _require_here(request, services.site_of_run(run_id=run), "commenter", "run")
    return Status(201, begin_thread(run_id=run, user=signed_in(request), body=body, origin=origin_of(request)))


@router.post("/runs/{uuid:run}/pause", response=RunSummaryShape)
def pause_run(request: HttpRequest, run: UUID) -> dict[str, Any]:
    """Pause a run."""
    _require_here(request, services.site_of_run(run_id=run), "operator", "run")
    return run_to_json(services.pause_run(run_id=run, by=_who(request)))


@router.post("/runs/{uuid:run}/resume", response=RunSummaryShape)
def resume_run(request: HttpRequest, run: UUID) -> dict[str, Any]:
    """Resume a run."""
    _require_here(request, services.site_of_run(run_id=run), "operator", "run")
    return run_to_json(services.resume_run(run_id=run, by=_who(request)))


@router.post("/runs/{uuid:run}/cancel", response=RunSummaryShape)
def cancel_run(request: HttpRequest, run: UUID) -> dict[str, Any]:
    """Cancel a run."""
    _require_here(request, services.site_of_run(run_id=run), "operator", "run")
    return run_to_json(services.cancel_run(run_id=run, by=_who(request)))


@router.post("/sites/{slug:site}/devices/{device_id}/call", response={202: CallShape})
def call_method(request: HttpRequest, site: str, device_id: str, body: CallMethod) -> dict[str, Any]:
    """Tell a device to carry out one of its methods, outside of any run; follow what comes of it by its id."""
    _require(request, site, "operator")
    called = services.call_method(
        site=site, device_id=device_id, method=body.method, arguments=body.args, by=_who(request)
    )
    return call_to_json(called)


@router.get("/sites/{slug:site}/calls", response=list[CallShape])
def list_open_calls(request: HttpRequest, site: str) -> list[dict[str, Any]]:
    """Return what devices do now because somebody told them to by hand, oldest first."""
    _require(request, site, "viewer")
    return [call_to_json(call) for call in services.list_open_calls(site=site)]


@router.get("/sites/{slug:site}/calls/{uuid:call}", response=CallShape)
def get_call(request: HttpRequest, site: str, call: UUID) -> dict[str, Any]:
    """Return a call and what has come of it."""
    _require(request, site, "viewer")
    return call_to_json(services.get_call(site=site, call_id=call))


@router.post("/sites/{slug:site}/calls/{uuid:call}/cancel", response=CallShape)
def cancel_call(request: HttpRequest, site: str, call: UUID) -> dict[str, Any]:
    """Ask the device to end a call."""
    _require(request, site, "operator")
    return call_to_json(services.cancel_call(site=site, call_id=call))


@router.post(
    "/sites/{slug:site}/things/{thing}/actions/{action}",
    response={200: ActionStatus, 202: ActionStatus},
    exclude_unset=True,
    openapi_extra={"responses": {status: {"headers": {"Location": LOCATION}} for status in (200, 202)}},
)
def invoke_action(
    request: HttpRequest, response: HttpResponse, site: str, thing: str, action: str, body: ActionInput | None = None
) -> Status[dict[str, Any]]:
    """Call a device's method as an action of the Web of Things, and wait 20 s for what comes of it; 202: not over yet.

    The body has the arguments by name, or is empty.
    """
    _require(request, site, "operator")
    device_id = thing.removeprefix(DEVICE_URN)
    given = body.model_dump() if body else {}
    call = services.invoke_action(
        site=site, device_id=device_id, action=action, given=given, person=signed_in(request).pk, by=_who(request)
    )
    address = f"{request.path}/{call.id}"
    response["Location"] = address
    return Status(200 if call.is_over else 202, services.action_to_json(call=call, address=address))


@router.get("/sites/{slug:site}/things/{thing}/actions/{action}/{uuid:call}", response=ActionStatus, exclude_unset=True)
def query_action(request: HttpRequest, site: str, thing: str, action: str, call: UUID) -> dict[str, Any]:
    """Return what has come of an action."""
    _require(request, site, "viewer")
    found = services.find_action(site=site, device_id=thing.removeprefix(DEVICE_URN), action=action, call_id=call)
    return services.action_to_json(call=found, address=request.path)


@router.delete(
    "/sites/{slug:site}/things/{thing}/actions/{action}/{uuid:call}", response={202: ActionStatus}, exclude_unset=True
)
def cancel_action(request: HttpRequest, site: str, thing: str, action: str, call: UUID) -> Status[dict[str, Any]]:
    """Ask the device to end an action; one that is over stays as it is."""
    _require(request, site, "operator")
    services.find_action(site=site, device_id=thing.removeprefix(DEVICE_URN), action=action, call_id=call)
    ended = services.cancel_call(site=site, call_id=call)
    return Status(202, services.action_to_json(call=ended, address=request.path))


@router.get("/sites/{slug:site}/questions", response=list[QuestionShape])
def list_questions(request: HttpRequest, site: str, run: UUID | None = None) -> list[dict[str, Any]]:
    """Return the site's open questions, or all of one run."""
    _require(request, site, "viewer")
    return [question_to_json(question) for question in services.list_questions(site=site, run_id=run)]


@router.post("/questions/{uuid:question}/answer", response=QuestionShape)
def answer_question(request: HttpRequest, question: UUID, body: AnswerQuestion) -> dict[str, Any]:
    """Answer a question; the first answer counts."""
    _require_here(request, services.site_of_question(question_id=question), "operator", "question")
    return question_to_json(services.answer_question(question_id=question, value=body.value, by=_who(request)))


@router.get("/sites/{slug:site}/armed", response=list[ArmedShape])
def list_armed(request: HttpRequest, site: str) -> list[dict[str, Any]]:
    """Return the programs that start by themselves."""
    _require(request, site, "viewer")
    return [armed_to_json(armed) for armed in services.list_armed(site=site)]


@router.post("/programs/{uuid:program}/arm", response=list[ArmedShape])
def arm_program(request: HttpRequest, program: UUID, body: ArmProgram) -> list[dict[str, Any]]:
    """Let a program, as it is drawn now, start by itself, or not any more; returns all that do so at its site."""
    armed_at = None if body.on else services.site_of_armed(program_id=program)
    site = armed_at or site_of_program(program_id=program)
    _require_here(request, site, "operator", "program")
    if body.on:
        fence = services.get_stop(site=site).fence
        prepared = prepare(program_id=program, user=request.user, parameters={})
        services.arm_program(prepared=prepared, by=_who(request), fence=fence)
    else:
        services.disarm_program(program_id=program, site=site)
    return [armed_to_json(armed) for armed in services.list_armed(site=site)]


@router.post("/sites/{slug:site}/stop", response=Stop)
def press_stop(request: HttpRequest, site: str) -> dict[str, Any]:
    """Stop all devices of the site; anybody who may look may do this, but no token that is for reading only."""
    _require(request, site, "viewer", "operate")
    return _stop_to_json(services.press_stop(site=site, by=_who(request)))


@router.post("/sites/{slug:site}/stop/reset", response=Stop)
def reset_stop(request: HttpRequest, site: str) -> dict[str, Any]:
    """End the stop; runs stay paused."""
    _require(request, site, "operator")
    return _stop_to_json(services.reset_stop(site=site, by=_who(request)))


def _stop_to_json(stop: services.StopView) -> dict[str, Any]:
    return {"active": stop.active, "by": stop.by, "at": stop.at.isoformat() if stop.at else None}


@router.post("/sites/{slug:site}/route", response=RouteShape)
def plan_route(request: HttpRequest, site: str, body: AskRoute) -> dict[str, Any]:
    """Return the way that a robot would drive."""
    _require(request, site, "viewer")
    route = services.plan_routes(site=site, pairs=[(body.start, body.to)])[0]
    if route is None:
        raise NoWay("A robot finds no way there. Choose a place that is free and can be reached.")
    return route_to_json(route)


@router.post("/sites/{slug:site}/routes", response=list[RouteShape | None])
def plan_routes(request: HttpRequest, site: str, body: AskRoutes) -> list[dict[str, Any] | None]:
    """Return many ways at once; null where there is none."""
    _require(request, site, "viewer")
    routes = services.plan_routes(site=site, pairs=[(pair.start, pair.to) for pair in body.pairs])
    return [route_to_json(route) if route else None for route in routes]

"""The HTTP API: one router per app, every refusal as problem+json."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any, cast

from django.http import HttpRequest, HttpResponse, JsonResponse
from ninja.errors import HttpError, ValidationError
from ninja.parser import Parser
from ninja.types import DictStrAny

from editor.api import router as editor_router
from execution.api import router as execution_router
from execution.dead_letters_routes import router as dead_letters_router
from registry.api.alerts import router as alerts_router
from registry.api.audit import router as audit_router
from registry.api.authentication import token_or_session
from registry.api.devices import router as devices_router
from registry.api.floor.maps import router as maps_router
from registry.api.floor.obstacles import router as obstacles_router
from registry.api.floor.places import router as places_router
from registry.api.floor.zones import router as zones_router
from registry.api.invitations import router as invitations_router
from registry.api.members import router as members_router
from registry.api.mtconnect import router as mtconnect_router
from registry.api.onboarding import router as onboarding_router
from registry.api.once import begin_once, watch_request
from registry.api.people import router as people_router
from registry.api.second_factor import router as second_factor_router
from registry.api.sign_on import router as sign_on_router
from registry.api.sites import router as sites_router
from registry.api.sparql import router as sparql_router
from registry.api.things import router as things_router
from registry.api.tokens import router as tokens_router
from registry.api.wall_screens import router as wall_screens_router
from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.messages import BadMessage, parse_plain_json
from vipo_site.http.location_header import name_address, note_address
from vipo_site.http.openapi import DescribedAPI

_SEND_JSON = "Send JSON, or what docs/openapi.json names."
FOR_LOAD = frozenset({429, 503})
_FRAMEWORK_SAYS = {
    "Unauthorized": "You are signed out. Sign in again; a program shows a token in the header Authorization, or "
    "signs in with POST /api/sign-in and sends its cookie along (docs/api.md).",
    "CSRF check Failed": "The page is out of date: reload it. A program sends the value of the cookie csrftoken as the "
    "header X-CSRFToken, too; it changes at signing in (docs/api.md).",
    "Cannot parse request body": f"The body of the request cannot be read. {_SEND_JSON}",
}
"""What is said instead of the framework's own refusals: how to mend it."""
_OF_TOKENS = ("invalid_token", "insufficient_scope")
"""Refusals that RFC 6750 wants named in a header, too."""
MOST_BYTES, DEEPEST = 16 * 1024 * 1024, 100
"""Of a body that is JSON; Django refuses larger ones before (settings.DATA_UPLOAD_MAX_MEMORY_SIZE)."""


class StrictParser(Parser):
    """Reads JSON as devices' is read: no key twice, no NaN or Infinity, no number too large; `Asked` reads texts."""

    def parse_body(self, request: HttpRequest) -> DictStrAny:
        """Return the body. Raises BadMessage, which the framework makes a HttpError's cause."""
        return cast("DictStrAny", parse_plain_json(request.body, max_bytes=MOST_BYTES, max_depth=DEEPEST))


api = DescribedAPI(
    title="VIPO", version="1", auth=token_or_session, docs_url=None, urls_namespace="api", parser=StrictParser()
)


def problem(status: int, code: str, detail: str, **more: Any) -> JsonResponse:
    """Return an RFC 9457 answer."""
    body = {
        "type": f"urn:vipo:problem:{code}",
        "title": HTTPStatus(status).phrase,
        "status": status,
        "detail": detail,
        "code": code,
        **more,
    }
    return JsonResponse(body, status=status, content_type="application/problem+json")


@api.exception_handler(VipoError)
def on_refusal(request: HttpRequest, error: VipoError, status: int = 0) -> HttpResponse:
    """Turn an app's refusal into an answer, with its own status unless another is given."""
    more = {"args": dict(error.facts)} if error.facts else {}
    answer = problem(status or error.status, error.code, error.detail, **more)
    if answer.status_code in FOR_LOAD or error.code == "under_way":
        answer["Retry-After"] = str(error.facts.get("retry_after_s", error.retry_after_s))
    if error.code in _OF_TOKENS:
        answer["WWW-Authenticate"] = f'Bearer error="{error.code}"'
    return answer


@api.exception_handler(ValidationError)
def on_bad_request(request: HttpRequest, error: ValidationError, status: int = 422) -> HttpResponse:
    """Say which fields of the request do not fit, and why."""
    fields = [{"field": ".".join(str(p) for p in e["loc"][1:]), "message": e["msg"]} for e in error.errors]
    named = "; ".join(f"{f['field']}: {f['message']}" for f in fields)
    return problem(status, "bad_request", f"The request does not fit: {named}", fields=fields)


@api.exception_handler(HttpError)
def on_http_error(request: HttpRequest, error: HttpError) -> HttpResponse:
    """Turn the framework's own refusals (no session, bad CSRF) into an answer."""
    if isinstance(error.__cause__, BadMessage):
        said = error.__cause__.fault.about("The body").sentence
        return problem(400, "bad_request", f"{said} {_SEND_JSON}")
    code = {401: "signed_out", 403: "not_allowed", 404: "not_found"}.get(error.status_code, "refused")
    response = problem(error.status_code, code, _FRAMEWORK_SAYS.get(str(error), str(error)))
    if error.status_code == 401:
        response["WWW-Authenticate"] = "Bearer"
    return response


api.add_decorator(note_address, mode="operation")
api.add_decorator(begin_once, mode="operation")
api.add_decorator(api.refuse_unknown_names, mode="operation")
api.add_decorator(name_address, mode="view")
api.add_decorator(watch_request, mode="view")
api.add_router("", people_router)
api.add_router("", second_factor_router)
api.add_router("", sign_on_router)
api.add_router("", sites_router)
api.add_router("", tokens_router)
api.add_router("", members_router)
api.add_router("", invitations_router)
api.add_router("", wall_screens_router)
api.add_router("", audit_router)
api.add_router("", devices_router)
api.add_router("", alerts_router)
api.add_router("", onboarding_router)
api.add_router("", maps_router)
api.add_router("", places_router)
api.add_router("", zones_router)
api.add_router("", obstacles_router)
api.add_router("", sparql_router)
api.add_router("", things_router)
api.add_router("", mtconnect_router)
api.add_router("", editor_router)
api.add_router("", execution_router)
api.add_router("", dead_letters_router)

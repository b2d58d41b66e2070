"""The HTTP API: one router per app, every refusal as problem+json."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from django.http import HttpRequest, HttpResponse, JsonResponse
from ninja.errors import HttpError, ValidationError
from ninja.security import django_auth

from editor.api import router as editor_router
from execution.api import router as execution_router
from registry.api.alerts import router as alerts_router
from registry.api.devices import router as devices_router
from registry.api.maps import router as maps_router
from registry.api.mtconnect import router as mtconnect_router
from registry.api.onboarding import router as onboarding_router
from registry.api.people import router as people_router
from registry.api.sites import router as sites_router
from registry.api.sparql import router as sparql_router
from registry.api.things import router as things_router
from vipo_device.protocol.errors import VipoError
from vipo_site.http.openapi import DescribedAPI

_FRAMEWORK_SAYS = {
    "Unauthorized": "You are signed out. Sign in again; a program does so with POST /api/sign-in and sends its cookie "
    "along (docs/api.md).",
    "CSRF check Failed": "The page is out of date: reload it. A program sends the value of the cookie csrftoken as the "
    "header X-CSRFToken, too; it changes at signing in (docs/api.md).",
    "Cannot parse request body": "The body of the request cannot be read. Send JSON, or what docs/openapi.json names.",
}
"""What is said instead of the framework's own refusals: how to mend it."""
api = DescribedAPI(title="VIPO", version="1", auth=django_auth, docs_url=None, urls_namespace="api")


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
    response = problem(status or error.status, error.code, error.detail, **more)
    if "retry_after_s" in error.facts:
        response["Retry-After"] = str(error.facts["retry_after_s"])
    return response


@api.exception_handler(ValidationError)
def on_bad_request(request: HttpRequest, error: ValidationError, status: int = 422) -> HttpResponse:
    """Say which fields of the request do not fit, and why."""
    fields = [{"field": ".".join(str(p) for p in e["loc"][1:]), "message": e["msg"]} for e in error.errors]
    named = "; ".join(f"{f['field']}: {f['message']}" for f in fields)
    return problem(status, "bad_request", f"The request does not fit: {named}", fields=fields)


@api.exception_handler(HttpError)
def on_http_error(request: HttpRequest, error: HttpError) -> HttpResponse:
    """Turn the framework's own refusals (no session, bad CSRF) into an answer."""
    code = {401: "signed_out", 403: "not_allowed", 404: "not_found"}.get(error.status_code, "refused")
    return problem(error.status_code, code, _FRAMEWORK_SAYS.get(str(error), str(error)))


api.add_router("", people_router)
api.add_router("", sites_router)
api.add_router("", devices_router)
api.add_router("", alerts_router)
api.add_router("", onboarding_router)
api.add_router("", maps_router)
api.add_router("", sparql_router)
api.add_router("", things_router)
api.add_router("", mtconnect_router)
api.add_router("", editor_router)
api.add_router("", execution_router)

"""The WoT directory at the addresses of its standard, outside of /api; refusals are told as there."""

from __future__ import annotations

from typing import Any

from django.http import HttpRequest, HttpResponse
from ninja import NinjaAPI
from ninja.errors import HttpError, ValidationError

from registry.api.authentication import token_or_session
from registry.api.directory import router
from registry.api.once import begin_once, watch_request
from vipo_device.protocol.errors import VipoError
from vipo_site.http.api import on_bad_request, on_http_error, on_refusal, problem

directory = NinjaAPI(
    title="VIPO's things", auth=token_or_session, docs_url=None, openapi_url=None, urls_namespace="things"
)
directory.add_decorator(begin_once, mode="operation")
directory.add_decorator(watch_request, mode="view")
directory.add_router("", router)


@directory.exception_handler(VipoError)
def tell_refusal(request: HttpRequest, error: VipoError) -> HttpResponse:
    """Tell a refusal, as 400 what does not fit (WoT Discovery); what is never allowed comes with what is (RFC 9110)."""
    response = on_refusal(request, error, status=400 if error.status == 422 else 0)
    if "allow" in error.facts:
        response["Allow"] = error.facts["allow"]
    return response


@directory.exception_handler(ValidationError)
def tell_bad_request(request: HttpRequest, error: ValidationError) -> HttpResponse:
    """Tell which parts of the request do not fit; the standard wants 400 here."""
    return on_bad_request(request, error, status=400)


@directory.exception_handler(HttpError)
def tell_http_error(request: HttpRequest, error: HttpError) -> HttpResponse:
    """Tell the framework's own refusals; who is not signed in learns how to."""
    if error.status_code == 401:
        how = "Show a token in the header Authorization, or sign in with POST /api/sign-in and send its cookie along "
        response = problem(401, "signed_out", how + "(docs/api.md); /.well-known/wot describes it.")
        response["WWW-Authenticate"] = "Bearer"
        return response
    return on_http_error(request, error)


def directory_urls() -> list[Any]:
    """Return the directory's addresses, without a page of its own at the root."""
    return [pattern for pattern in directory.urls[0] if getattr(pattern, "name", "") != "api-root"]

"""What goes for every answer: the security policy, compression, tags, and refusals told as the API tells its own."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from django.conf import settings
from django.core.exceptions import DisallowedHost
from django.http import HttpRequest, HttpResponse, HttpResponseNotAllowed
from django.http.response import HttpResponseBase
from django.middleware.gzip import GZipMiddleware
from django.middleware.http import ConditionalGetMiddleware
from django.utils.cache import set_response_etag

from vipo_device.descriptions.forms import CONTENT_TYPES
from vipo_device.protocol.texts import find_unfit, refusal_of
from vipo_site.http.api import problem

# Mantine sets styles from scripts; device pictures may come from any address of the web. No script is anybody else's,
# none stands in a page, and what a page links to is its own.
POLICY = "; ".join(
    [
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self' 'unsafe-inline'",
        "img-src 'self' data: blob: http: https:",
        "font-src 'self' data:",
        "connect-src 'self'{sockets}",
        "worker-src 'self'",
        "manifest-src 'self'",
        "object-src 'none'",
        "frame-src 'none'",
        "frame-ancestors 'none'",
        "base-uri 'none'",
        "form-action 'self'",
    ]
)
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=(), payment=(), usb=()",
}
UNREADABLE = (
    "The request cannot be read: it is larger than it may be, or asks for a host that VIPO_HOSTS does not name."
)
WORTH_COMPRESSING = 1024
TEXTS = ("json", "xml")
DESCRIPTIONS = frozenset(CONTENT_TYPES.values())
FAILED = "VIPO failed at this; what went wrong stands in the server's log. Look what holds now before you try again."


def add_headers(headers: Any, sockets: str = "") -> None:
    """Add what a browser is told with every answer; `sockets` is where pages may open them, besides their own address.

    Some browsers do not count a socket of the page's own host as 'self', so pages name it.
    """
    policy = POLICY.format(sockets=f" {sockets}" if sockets else "")
    told = {**HEADERS, "Content-Security-Policy": policy}
    if settings.SECURE_HSTS_SECONDS:
        told["Strict-Transport-Security"] = f"max-age={settings.SECURE_HSTS_SECONDS}"
    for name, value in told.items():
        if name not in headers:
            headers[name] = value


class SecurityHeaders:
    """Adds to each answer what a browser is told with every one."""

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        """Answer, with the headers."""
        response = self.get_response(request)
        add_headers(response.headers, _socket_address(request))
        return response


class FitTexts:
    """Refuses an address with what no text may hold (vipo_device/protocol/texts.py); such a cookie is none."""

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        """Answer what can be read."""
        for name in [name for name, value in request.COOKIES.items() if find_unfit(value, is_line=True)]:
            del request.COOKIES[name]
        if refusal := refusal_of(request.path_info, is_line=True):
            return problem(404, "not_found", f"There is nothing of this address: it {refusal}.")
        if refusal := next(filter(None, map(refusal_of, _query_of(request))), ""):
            return problem(400, "bad_request", f"The query of the address {refusal}.")
        return self.get_response(request)


def _query_of(request: HttpRequest) -> Iterator[str]:
    """Yield the names and values of an address's query, as they are read."""
    for name, values in request.GET.lists():
        yield name
        yield from values


def _socket_address(request: HttpRequest) -> str:
    try:
        return f"{'wss' if request.is_secure() else 'ws'}://{request.get_host()}"
    except DisallowedHost:
        return ""


class TellMethods:
    """Says which methods an address knows: in the answer to OPTIONS, and in the refusal of any other."""

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        """Answer, and tell what the framework refuses without a word."""
        response = self.get_response(request)
        if not isinstance(response, HttpResponseNotAllowed):
            return response
        allowed = ", ".join(sorted({*response["Allow"].split(", "), "OPTIONS"}))
        if request.method == "OPTIONS":
            return HttpResponse(status=204, headers={"Allow": allowed})
        told = problem(405, "no_such_method", f"{str(request.method)[:20]} is not known here; known are {allowed}.")
        told["Allow"] = allowed
        return told


class Compress(GZipMiddleware):
    """Compresses JSON and text for who can read that, with a length that does not tell what a secret in it is like.

    Streams go out as they come. What tells a secret (`no-store`) is left alone, and what has a tag for its very bytes.
    """

    def process_response(self, request: HttpRequest, response: HttpResponseBase) -> HttpResponseBase:
        """Return the answer, compressed if that is worth it."""
        if response.streaming or not isinstance(response, HttpResponse) or len(response.content) < WORTH_COMPRESSING:
            return response
        if "no-store" in response.get("Cache-Control", "") or response.get("ETag", "").startswith('"'):
            return response
        return super().process_response(request, response) if _is_text(response) else response


def _is_text(response: HttpResponse) -> bool:
    kind = response.get("Content-Type", "").partition(";")[0].strip()
    return kind.startswith("text/") or kind.endswith(TEXTS) or kind in DESCRIPTIONS


class TellUnchanged(ConditionalGetMiddleware):
    """Gives what is read a tag by its content, and answers 304 to who has it already; it is kept, but always asked for.

    The tag is weak: the same is told, however it is compressed. Answers with a tag of their own keep it.
    """

    def process_response(self, request: HttpRequest, response: HttpResponseBase) -> HttpResponseBase:
        """Return the answer, or that it has not changed."""
        if request.method != "GET" or response.streaming or response.status_code != 200:
            return response
        if "ETag" not in response and bool(getattr(response, "content", None)) and self.needs_etag(response):
            set_response_etag(response)
            response["ETag"] = f"W/{response['ETag']}"
            response.setdefault("Cache-Control", "private, no-cache")
        return super().process_response(request, response)


def tell_unreadable(request: HttpRequest, exception: Exception) -> HttpResponse:
    """Tell what could not even be read."""
    return problem(400, "bad_request", UNREADABLE)


def tell_failure(request: HttpRequest) -> HttpResponse:
    """Tell a fault of ours."""
    return problem(500, "failed", FAILED)

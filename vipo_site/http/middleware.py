"""What goes for every answer: the content security policy, and refusals and failures told as the API tells its own."""

from __future__ import annotations

from collections.abc import Callable

from django.http import HttpRequest, HttpResponse, HttpResponseNotAllowed

from vipo_site.http.api import problem

# Mantine sets styles from scripts; device pictures may come from any https address.
POLICY = "; ".join(
    [
        "default-src 'self'",
        "style-src 'self' 'unsafe-inline'",
        "img-src 'self' data: blob: http: https:",
        "font-src 'self' data:",
        "connect-src 'self' ws: wss:",
        "worker-src 'self' blob:",
        "frame-ancestors 'none'",
        "base-uri 'self'",
        "form-action 'self'",
    ]
)
UNREADABLE = (
    "The request cannot be read: it is larger than it may be, or asks for a host that VIPO_HOSTS does not name."
)
FAILED = "VIPO failed at this; what went wrong stands in the server's log. Look what holds now before you try again."


class SecurityHeaders:
    """Adds the content security policy to each answer."""

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        """Answer, with the policy."""
        response = self.get_response(request)
        response.headers.setdefault("Content-Security-Policy", POLICY)
        return response


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


def tell_unreadable(request: HttpRequest, exception: Exception) -> HttpResponse:
    """Tell what could not even be read."""
    return problem(400, "bad_request", UNREADABLE)


def tell_failure(request: HttpRequest) -> HttpResponse:
    """Tell a fault of ours."""
    return problem(500, "failed", FAILED)

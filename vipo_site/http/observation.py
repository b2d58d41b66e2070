"""Requests seen from outside: each has an id that its log lines and its answer carry, and is counted by its route."""

from __future__ import annotations

import re
import time
import uuid
from collections.abc import Callable, Mapping
from typing import Any

from django.db import connection
from django.http import HttpRequest, HttpResponse

from registry import services as registry
from vipo_device.kit.log_ids import LogId, add_ids, bind_ids

HEADER = "X-Request-ID"
_IDS = re.compile(r"[A-Za-z0-9._-]{1,64}")
_METHODS = frozenset({"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"})
_NAMES: Mapping[str, LogId] = {"slug": "site", "site": "site", "program": "program", "run": "run", "call": "command",
                               "device": "device", "device_id": "device"}  # fmt: skip
"""What the parts of addresses are called in the log."""
NO_ROUTE, PAGE = "none", "page"


class Observed:
    """Goes around everything else. An id that a proxy or a client sends is kept, if it can stand in a line."""

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        """Answer, and count."""
        asked = request.headers.get(HEADER, "")
        request_id = asked if _IDS.fullmatch(asked) else uuid.uuid4().hex
        queries, began_s = _Queries(), time.perf_counter()
        with bind_ids({"request": request_id}), connection.execute_wrapper(queries):
            response = self.get_response(request)
        _count(request, response.status_code, time.perf_counter() - began_s, queries.count)
        response[HEADER] = request_id
        return response

    def process_view(self, request: HttpRequest, _view: Any, _args: Any, kwargs: Mapping[str, Any]) -> None:
        """Note what the address names, now that it is known."""
        add_ids({_NAMES[name]: value for name, value in kwargs.items() if name in _NAMES})


class _Queries:
    """Counts the questions that a request asks the database."""

    def __init__(self) -> None:
        self.count = 0

    def __call__(self, execute: Callable[..., Any], sql: str, params: Any, many: bool, context: Any) -> Any:
        self.count += 1
        return execute(sql, params, many, context)


def _count(request: HttpRequest, status: int, seconds: float, queries: int) -> None:
    route = route_of(request)
    method = request.method if request.method in _METHODS else "other"
    registry.count(name="http_requests", labels=(str(method), route, str(status)))
    registry.time_spent(name="http_request_seconds", seconds=seconds, labels=(route,))
    if queries:
        registry.count(name="http_database_queries", labels=(route,), by=queries)


def route_of(request: HttpRequest) -> str:
    """Return the address as the table of routes writes it: what stands in it is ours, never what somebody sent."""
    found = request.resolver_match
    if found is None:
        return NO_ROUTE
    return PAGE if found.route.startswith("^") else found.route

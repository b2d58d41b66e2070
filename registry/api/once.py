"""The header Idempotency-Key: whoever does not know whether a request arrived sends it again, and it is done once.

As draft-ietf-httpapi-idempotency-key-header has it. `watch_request` goes around the whole call and keeps its answer,
`begin_once` stands before the call's own function, where it is known who asks.
"""

from __future__ import annotations

import functools
import hashlib
import re
from collections.abc import Callable
from typing import Any

from django.http import HttpRequest, HttpResponse
from django.http.response import HttpResponseBase
from django.utils import timezone

from registry.errors import RegistryError
from registry.models import User
from registry.people.access import noting_needs, require
from registry.people.keyed_requests import KeptAnswer, begin_request, end_request

SAFE = ("GET", "HEAD", "OPTIONS")
KEPT_HEADERS = ("Content-Type", "Location", "ETag")
TELLS_SECRETS = frozenset(
    (
        "create_token",
        "make_invitation",
        "approve_device",
        "rotate_credential",
        "reserve_device",
        "renew_enrolment_key",
        "make_wall_screen",
        "begin_second_factor",
        "confirm_second_factor",
        "renew_recovery_codes",
    )
)
"""Calls whose answer is told this once, and therefore not kept."""
_KEY = re.compile(r'"?([!#-~]{1,255})"?')
_BEGUN = "vipo_keyed_request"


class BadKey(RegistryError):
    """A header Idempotency-Key that cannot be read."""

    code = "bad_idempotency_key"
    status = 400


def begin_once(call: Callable[..., Any]) -> Callable[..., Any]:
    """Let a call be carried out unless its key came before: then give the answer of that time to who may have it."""

    @functools.wraps(call)
    def call_once(request: HttpRequest, *args: Any, **values: Any) -> Any:
        named, user = request.headers.get("Idempotency-Key"), request.user
        if named is None or request.method in SAFE or not isinstance(user, User):
            return call(request, *args, **values)
        found = _KEY.fullmatch(named.strip())
        if found is None:
            raise BadKey("An Idempotency-Key is 1 to 255 visible ASCII characters, such as a random UUID.")
        owner = f"{user.pk}:{user.grant.token_id if user.grant else 0}"
        kept = begin_request(owner=owner, key=found[1], fingerprint=_fingerprint(request), now=timezone.now())
        if kept is not None:
            for need in kept.needs:
                require(user, need.site, need.role, need.scope)
            return HttpResponse(kept.body, status=kept.status, headers={**kept.headers, "Idempotency-Replayed": "true"})
        with noting_needs() as needs:
            setattr(request, _BEGUN, (owner, found[1], call.__name__ in TELLS_SECRETS, needs))
            return call(request, *args, **values)

    return call_once


def watch_request(run: Callable[..., HttpResponseBase]) -> Callable[..., HttpResponseBase]:
    """Keep the answer of a call that `begin_once` has let through; one that fails is kept as failed."""

    @functools.wraps(run)
    def run_watched(request: HttpRequest, **values: Any) -> HttpResponseBase:
        try:
            response = run(request, **values)
        except Exception:
            _end(request, HttpResponse(status=500))
            raise
        _end(request, response)
        return response

    return run_watched


def _end(request: HttpRequest, response: HttpResponseBase) -> None:
    begun = getattr(request, _BEGUN, None)
    if begun is None:
        return
    owner, key, is_secret, needs = begun
    body = response.content if isinstance(response, HttpResponse) else b""
    headers = {name: response[name] for name in KEPT_HEADERS if name in response}
    is_secret = is_secret or "no-store" in response.get("Cache-Control", "")
    answer = KeptAnswer(response.status_code, headers, body, needs)
    end_request(owner=owner, key=key, answer=answer, is_secret=is_secret)


def _fingerprint(request: HttpRequest) -> str:
    """Return a hash of what is asked: method, address and body, of a form its fields and files."""
    said = hashlib.sha256(f"{request.method} {request.get_full_path()}\n".encode())
    if request.content_type == "multipart/form-data":
        for name, values in sorted(request.POST.lists()):
            said.update(repr((name, values)).encode())
        for name, files in sorted(request.FILES.lists()):
            for file in files:
                said.update(f"{name} {file.size}\n".encode())
                for chunk in file.chunks():
                    said.update(chunk)
                file.seek(0)
    else:
        said.update(request.body)
    return said.hexdigest()

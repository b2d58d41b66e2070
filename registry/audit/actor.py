"""Who acts at this moment: whose request is being answered, so that what it changes can say so.

What happens outside of a request (the ticker, the command line, a device's message) has no one but VIPO itself, or
names whom it means.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Literal

from django.http import HttpRequest

from registry.models import ApiToken, User

ActorKind = Literal["person", "token", "device", "vipo"]
MOST_NAME = 100


@dataclass(frozen=True, slots=True)
class Actor:
    """Who did something: what people call them, and from where; `person` is the row of a person or of a token's."""

    kind: ActorKind
    name: str = ""
    person: int | None = None
    address: str = ""
    agent: str = ""


VIPO = Actor("vipo")
_request: ContextVar[HttpRequest | None] = ContextVar("acting_request", default=None)


@contextmanager
def acting(request: HttpRequest) -> Iterator[None]:
    """Let what is changed within the block be the doing of whoever sends this request."""
    token = _request.set(request)
    try:
        yield
    finally:
        _request.reset(token)


def client_address(request: HttpRequest) -> str:
    """Return where a request comes from, as the server that took it says; no header that a client sends counts."""
    return str(request.META.get("REMOTE_ADDR", ""))


def who_acts() -> Actor:
    """Return who acts now; a request of nobody who is signed in has an address alone."""
    request = _request.get()
    if request is None:
        return VIPO
    user = getattr(request, "user", None)
    address, agent = client_address(request)[:64], request.headers.get("User-Agent", "")[:1000]
    if not isinstance(user, User):
        return Actor("vipo", address=address, agent=agent)
    if user.grant:
        token = ApiToken.objects.filter(pk=user.grant.token_id).values_list("name", flat=True).first()
        return Actor("token", (token or "")[:MOST_NAME], user.pk, address, agent)
    return Actor("person", user.display_name[:MOST_NAME], user.pk, address, agent)

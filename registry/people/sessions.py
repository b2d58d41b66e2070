"""Whether who opened a stream or a socket, with a session or a token, may still do so while that goes on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from django.contrib.auth import SESSION_KEY, get_user
from django.contrib.sessions.backends.db import SessionStore
from django.http import HttpRequest
from django.utils import timezone

from registry.models import User
from registry.people.tokens import expiry_of_token, find_person_of_token


@dataclass(frozen=True, slots=True)
class Session:
    """A browser's or program's session, by its key and the id of the person who signed in; or a token's, by its row."""

    key: str
    person: int
    token: int = 0
    until: datetime | None = None
    """When the token ends by itself."""


def session_of(request: HttpRequest) -> Session:
    """Return the session of a request that is signed in, or comes with a token."""
    user = request.user
    if isinstance(user, User) and user.grant:
        return Session("", user.pk, user.grant.token_id, expiry_of_token(token_id=user.grant.token_id))
    return Session(request.session.session_key or "", int(request.session[SESSION_KEY]))


def session_of_socket(scope: Mapping[str, Any]) -> Session | None:
    """Return the session of a socket that is signed in; None where the socket came in without one."""
    key = scope["session"].session_key if "session" in scope else None
    return Session(key, scope["user"].pk) if key else None


def has_ended(session: Session | None) -> bool:
    """Tell whether a socket's session does not stand any more."""
    return session is not None and find_person(session) is None


def find_person(session: Session) -> User | None:
    """Return who is signed in with a session; None once it has ended: signed out, another password, locked out.

    Of a token it is its person, with no more rights than it grants; None once it was revoked or has expired.
    """
    if session.token:
        return find_person_of_token(token_id=session.token, now=timezone.now())
    request = HttpRequest()
    request.session = SessionStore(session.key)
    user = get_user(request)
    return user if isinstance(user, User) and user.pk == session.person and user.is_active else None

"""How a call knows who asks: a token in the header Authorization, or else the cookie of a session."""

from __future__ import annotations

from typing import Any

from django.http import HttpRequest
from django.utils import timezone
from ninja import security
from ninja.security import HttpBearer

from registry.errors import RegistryError
from registry.models import User
from registry.people.open_sessions import note_session
from registry.people.tokens import find_bearer


class NotForTokens(RegistryError):
    """A call by which people look after their account and their tokens, shown a token."""

    code = "not_for_tokens"
    status = 403


class BearerToken(HttpBearer):
    """A token that a person has made for a program; who shows one is nobody else, whatever cookie comes along."""

    def authenticate(self, request: HttpRequest, token: str) -> User:
        """Return the token's person, whose rights at the token's site it bounds. Raises InvalidToken."""
        request.user = find_bearer(token=token, now=timezone.now())
        return request.user


class SessionAuth(security.SessionAuth):
    """A session's cookie; that it is in use is noted for its person."""

    def authenticate(self, request: HttpRequest, key: str | None) -> Any:
        """Return who is signed in, None if nobody is."""
        user = super().authenticate(request, key)
        if isinstance(user, User) and request.session.session_key:
            agent = request.headers.get("User-Agent", "")
            note_session(key=request.session.session_key, user=user, agent=agent, now=timezone.now())
        return user


class SessionOnly(SessionAuth):
    """A session and no token: a token that gets into wrong hands must not make others, or outlive its revocation."""

    def __call__(self, request: HttpRequest) -> Any:
        """Return who is signed in. Raises NotForTokens."""
        if request.headers.get("Authorization", "").partition(" ")[0].lower() == "bearer":
            raise NotForTokens("No token may do this. Sign in yourself (POST /api/sign-in), or use VIPO's pages.")
        return super().__call__(request)


token_or_session = [BearerToken(), SessionAuth()]
session_only = SessionOnly()

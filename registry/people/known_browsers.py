"""Browsers from which somebody has signed in before: a signed cookie for each person, of no use without the password.

It gives who comes from there a count of attempts of their own; guessing elsewhere does not keep them out.
"""

from __future__ import annotations

import hashlib
import secrets

from django.conf import settings
from django.http import HttpRequest, HttpResponse

LASTS_S = 365 * 24 * 3600
PATH = "/api/sign-in"


def find_device(request: HttpRequest, email: str) -> str:
    """Return what this browser is known by for this person; empty where it is not."""
    value = request.get_signed_cookie(_name(email), default="", max_age=LASTS_S)
    return f"browser:{value}" if value else ""


def remember_browser(request: HttpRequest, response: HttpResponse, email: str) -> None:
    """Let the browser be known for this person, who has just signed in from it."""
    known = find_device(request, email).removeprefix("browser:")
    response.set_signed_cookie(
        _name(email),
        known or secrets.token_urlsafe(16),
        max_age=LASTS_S,
        path=PATH,
        secure=bool(settings.SESSION_COOKIE_SECURE),
        httponly=True,
        samesite="Lax",
    )


def _name(email: str) -> str:
    """Return the cookie's name, which tells nobody whose it is, and is part of what is signed."""
    return "vipo_known_" + hashlib.sha256(email.strip().lower().encode(errors="replace")).hexdigest()[:16]

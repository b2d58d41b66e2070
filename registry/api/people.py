"""Signing in and out over HTTP."""

from __future__ import annotations

from ipaddress import ip_address
from pathlib import Path
from typing import Any

from django.conf import settings
from django.contrib.auth import login, logout
from django.http import HttpRequest
from django.middleware.csrf import get_token
from django.utils import timezone
from ninja import Router
from ninja.errors import HttpError
from ninja.utils import check_csrf

from registry.demo.accounts import read_accounts
from registry.devices.things import call_listeners
from registry.live.fanout import EVERY_SITE, publish
from registry.models import User
from registry.people.sign_in import check_sign_in
from registry.shapes import (
    Me,
    SignIn,
)

router = Router(tags=["registry"])


@router.get("/me", response=Me, auth=None)
def show_me(request: HttpRequest) -> dict[str, Any]:
    """Say who is signed in; strangers get the token that signing in needs."""
    user = request.user
    person = None
    if isinstance(user, User):
        person = {"id": user.pk, "name": user.display_name, "initials": user.initials, "email": user.email}
    return {"user": person, "csrf": get_token(request), "demo_accounts": _offered_accounts(request)}


def _offered_accounts(request: HttpRequest) -> list[dict[str, str]]:
    """Return the demo's accounts, to browsers of this machine alone: not to what another program passed on."""
    passed_on = any(name in request.META for name in ("HTTP_X_FORWARDED_FOR", "HTTP_FORWARDED", "HTTP_VIA"))
    try:
        is_here = ip_address(request.META.get("REMOTE_ADDR", "")).is_loopback
    except ValueError:
        is_here = False
    if not settings.VIPO_DEMO_SIGN_IN or passed_on or not is_here:
        return []
    return read_accounts(state=Path(settings.VIPO_STATE_DIR))


@router.post("/sign-in", response=Me, auth=None)
def sign_in(request: HttpRequest, body: SignIn) -> dict[str, Any]:
    """Begin a session."""
    if check_csrf(request):
        raise HttpError(403, "The page is out of date. Reload it and sign in again.")
    address = request.META.get("REMOTE_ADDR", "")
    user = check_sign_in(email=body.email, password=body.password, address=address, now=timezone.now())
    login(request, user)
    return show_me(request)


@router.post("/sign-out", response=Me)
def sign_out(request: HttpRequest) -> dict[str, Any]:
    """End the session."""
    logout(request)
    call_listeners()
    publish(EVERY_SITE, {"type": "members"})
    return show_me(request)

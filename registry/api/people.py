"""Signing in and out over HTTP."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from django.conf import settings
from django.contrib.auth import login, logout
from django.http import HttpRequest, HttpResponse
from django.middleware.csrf import get_token
from django.utils import timezone
from ninja import Router
from ninja.errors import HttpError
from ninja.utils import check_csrf

from registry.api.authentication import session_only
from registry.devices.things import call_listeners
from registry.live.fanout import EVERY_SITE, publish
from registry.models import User
from registry.people.sign_in import check_sign_in
from registry.shapes import (
    Me,
    SignIn,
)
from registry.sites.quota import may_create_sites

router = Router(tags=["registry"])


@router.get("/me", response=Me, auth=None)
def show_me(request: HttpRequest, response: HttpResponse) -> dict[str, Any]:
    """Say who is signed in; strangers get the token that signing in needs."""
    response["Cache-Control"] = "no-store"
    return _me(request)


def _me(request: HttpRequest) -> dict[str, Any]:
    user = request.user
    person = None
    if isinstance(user, User):
        person = {"id": user.pk, "name": user.display_name, "initials": user.initials, "email": user.email}
    may_create = isinstance(user, User) and may_create_sites(user)
    rest = {"csrf": get_token(request), "demo_accounts": _demo_accounts()}
    return {"user": person, "may_create_sites": may_create, **rest}


def _demo_accounts() -> list[dict[str, str]]:
    path = Path(settings.VIPO_STATE_DIR) / "demo-accounts.json"
    if not settings.VIPO_DEMO or not path.exists():
        return []
    accounts: list[dict[str, str]] = json.loads(path.read_text())
    return accounts


@router.post("/sign-in", response=Me, auth=None)
def sign_in(request: HttpRequest, body: SignIn) -> dict[str, Any]:
    """Begin a session."""
    if check_csrf(request):
        raise HttpError(403, "The page is out of date. Reload it and sign in again.")
    address = request.META.get("REMOTE_ADDR", "")
    user = check_sign_in(email=body.email, password=body.password, address=address, now=timezone.now())
    login(request, user)
    return _me(request)


@router.post("/sign-out", response=Me, auth=session_only)
def sign_out(request: HttpRequest) -> dict[str, Any]:
    """End the session."""
    logout(request)
    call_listeners()
    publish(EVERY_SITE, {"type": "members"})
    return _me(request)

"""Signing in and out over HTTP."""

from __future__ import annotations

from dataclasses import asdict
from datetime import datetime
from ipaddress import ip_address
from pathlib import Path
from typing import Any

from django.conf import settings
from django.contrib.auth import login, logout, update_session_auth_hash
from django.db import transaction
from django.http import HttpRequest, HttpResponse
from django.middleware.csrf import get_token
from django.utils import timezone
from ninja import Field, Query, Router, Schema
from ninja.errors import HttpError
from ninja.responses import Status
from ninja.utils import check_csrf

from registry.api.authentication import session_only
from registry.audit.actor import client_address
from registry.demo.accounts import read_accounts
from registry.devices.things import call_listeners
from registry.live.fanout import EVERY_SITE, publish
from registry.models import User
from registry.people.backends import PASSWORDS
from registry.people.known_browsers import find_device, remember_browser
from registry.people.open_sessions import end_session, follow_session, list_open_sessions, note_session
from registry.people.sign_in import MOST_NAME, change_password, check_own_password, check_sign_in, rename_person
from registry.people.sign_in import sign_out_everywhere as end_all_sessions
from registry.people.sign_on.provider_client import sign_out_address
from registry.people.sign_on.providers import list_providers
from registry.requests import Asked, Flag, Line, PartAsked, signed_in, tell_rest
from registry.shapes import Me, NewPassword, SignIn
from registry.sites.mail import can_mail
from registry.sites.quota import may_create_sites

router = Router(tags=["registry"])


@router.get("/me", response=Me, auth=None)
def show_me(request: HttpRequest, response: HttpResponse) -> dict[str, Any]:
    """Say who is signed in; strangers get the token that signing in needs."""
    response["Cache-Control"] = "no-store"
    return tell_me(request)


def tell_me(request: HttpRequest) -> dict[str, Any]:
    """Return who is signed in, as `Me` says it."""
    user = request.user
    person = None
    if isinstance(user, User):
        person = {"id": user.pk, "name": user.display_name, "initials": user.initials, "email": user.email}
    may_create = isinstance(user, User) and may_create_sites(user)
    rest = {"csrf": get_token(request), "demo_accounts": _offered_accounts(request)}
    return {"user": person, "may_create_sites": may_create, **rest}


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
def sign_in(request: HttpRequest, response: HttpResponse, body: SignIn) -> dict[str, Any]:
    """Begin a session; too many wrong passwords or codes are refused for a while, which `Retry-After` names.

    Of whom a second factor is asked, the answer without `code` is 401, `second_factor_needed`.
    """
    if check_csrf(request):
        raise HttpError(403, "The page is out of date. Reload it and sign in again.")
    user = check_sign_in(
        email=body.email,
        password=body.password,
        address=client_address(request),
        now=timezone.now(),
        device=find_device(request, body.email),
        code=body.code,
    )
    begin_session(request, response, user)
    return tell_me(request)


def begin_session(request: HttpRequest, response: HttpResponse, user: User, backend: str = PASSWORDS) -> None:
    """Let somebody be signed in from here on, and this browser be known to be theirs."""
    login(request, user, backend=backend)
    request.session.save()
    note_session(
        key=str(request.session.session_key),
        user=user,
        agent=request.headers.get("User-Agent", ""),
        now=timezone.now(),
    )
    remember_browser(request, response, user.email)


class SignedOut(Me):
    """Nobody any more; `provider_sign_out` is where the browser goes to be signed out at its provider, too.

    It is empty where there is none, or the server's settings do not ask for that.
    """

    provider_sign_out: str


@router.post("/sign-out", response=SignedOut, auth=session_only)
def sign_out(request: HttpRequest) -> dict[str, Any]:
    """End the session."""
    kept = request.session.get("sign_on") or {}
    logout(request)
    call_listeners()
    publish(EVERY_SITE, {"type": "members"})
    return {**tell_me(request), "provider_sign_out": _provider_sign_out(request, kept)}


def _provider_sign_out(request: HttpRequest, kept: dict[str, str]) -> str:
    provider = next((each for each in list_providers() if each.name == kept.get("provider") and each.signs_out), None)
    if provider is None:
        return ""
    back = request.build_absolute_uri("/sign-in")
    return sign_out_address(provider, id_token=kept.get("id_token", ""), back=back)


def signed_on_at(request: HttpRequest) -> datetime | None:
    """Return when this session was begun by a provider; None where it was not."""
    kept = request.session.get("sign_on") or {}
    return datetime.fromisoformat(kept["at"]) if "at" in kept else None


@router.post("/me/password", response=Me, auth=session_only)
def change_my_password(request: HttpRequest, body: NewPassword) -> dict[str, Any]:
    """Change the own password; all other sessions end, and this one goes on under another key."""
    user = signed_in(request)
    check_own_password(user=user, password=body.old, address=client_address(request), now=timezone.now())
    with transaction.atomic():
        former = str(request.session.session_key)
        change_password(email=user.email, password=body.new)
        user.refresh_from_db(fields=["password"])
        update_session_auth_hash(request, user)
        request.session.save()
        follow_session(old=former, new=str(request.session.session_key))
    return tell_me(request)


class MyName(Asked):
    """What somebody wants to be called."""

    name: Line = Field(min_length=1, max_length=MOST_NAME, pattern=r"\S")


@router.put("/me/name", response=Me, auth=session_only)
def change_my_name(request: HttpRequest, body: MyName) -> dict[str, Any]:
    """Change what others call the asker; what was written down before keeps the name that it has."""
    rename_person(user=signed_in(request), name=" ".join(body.name.split()))
    return tell_me(request)


@router.post("/me/sign-out-everywhere", response=Me, auth=session_only)
def sign_out_everywhere(request: HttpRequest) -> dict[str, Any]:
    """End all sessions of who asks, this one too."""
    end_all_sessions(user=signed_in(request))
    logout(request)
    return tell_me(request)


class OwnSession(Schema):
    """One of the asker's sessions; `here` marks the one that asks. `browser` and `system` may be empty.

    `begun_at` is when it signed in, `seen_at` when it last asked for something, to the minute.
    """

    id: int
    browser: str
    system: str
    begun_at: datetime
    seen_at: datetime
    here: bool


@router.get("/me/sessions", response=list[OwnSession], auth=session_only)
def list_my_sessions(request: HttpRequest, response: HttpResponse, asked: Query[PartAsked]) -> list[dict[str, Any]]:
    """List the asker's own sessions, the one that began last first; the header `Link` names the next part."""
    found = list_open_sessions(user=signed_in(request), page=asked.page())
    here = request.session.session_key
    return [{**asdict(view), "here": view.key == here} for view in tell_rest(request, response, found)]


@router.delete("/me/sessions/{session}", response={204: None}, auth=session_only)
def end_my_session(request: HttpRequest, session: int) -> Status[None]:
    """End one of the asker's own sessions; its sockets and streams close within 3 s."""
    end_session(user=signed_in(request), session_id=session)
    call_listeners()
    return Status(204, None)


class MyMail(Schema):
    """Whether somebody wants by e-mail what others write to them; `can_mail` says whether this server sends any."""

    wanted: bool
    can_mail: bool


class MyMailChoice(Asked):
    """Whether somebody wants by e-mail what others write to them."""

    wanted: Flag


@router.get("/me/mail", response=MyMail, auth=session_only)
def show_my_mail(request: HttpRequest) -> dict[str, bool]:
    """Tell whether comments that call the asker, and that they have not read, come by e-mail."""
    return {"wanted": signed_in(request).wants_mail, "can_mail": can_mail()}


@router.put("/me/mail", response={204: None}, auth=session_only)
def choose_my_mail(request: HttpRequest, body: MyMailChoice) -> Status[None]:
    """Choose whether comments come by e-mail."""
    User.objects.filter(pk=signed_in(request).pk).update(wants_mail=body.wanted)
    return Status(204, None)

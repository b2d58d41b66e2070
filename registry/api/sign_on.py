"""Single sign-on over HTTP: begun by a page, finished by the page that the provider sends the browser back to."""

from __future__ import annotations

from dataclasses import asdict
from datetime import datetime
from functools import partial
from typing import Annotated, Any

from django.conf import settings
from django.http import HttpRequest, HttpResponse
from django.utils import timezone
from ninja import Field, Router, Schema
from ninja.errors import HttpError
from ninja.responses import Status
from ninja.utils import check_csrf

from registry.api.authentication import session_only
from registry.api.people import begin_session, signed_on_at, tell_me
from registry.audit.actor import client_address
from registry.models import User
from registry.people.backends import PASSWORDS, TWO_FACTORS
from registry.people.known_browsers import PATH, find_device
from registry.people.sign_in import checking_own_password
from registry.people.sign_on import bindings
from registry.people.sign_on.attempts import LASTS, Begun, Purpose
from registry.people.sign_on.provider_sessions import bind_session, end_provider_sessions
from registry.people.sign_on.providers import Provider, find_provider, list_providers
from registry.requests import Asked, AsTyped, Line, refuses, signed_in
from registry.shapes import Me
from registry.sites.sign_on import Answer, Arrival, begin_sign_on, finish_sign_on

router = Router(tags=["registry"])
COOKIE = "vipo_sign_on"
PAGE = "/sign-on/"
"""The page that a provider sends browsers back to, with its name."""

_LOGOUT_BODY = {
    "required": True,
    "content": {
        "application/x-www-form-urlencoded": {
            "schema": {
                "type": "object",
                "properties": {"logout_token": {"type": "string", "maxLength": 16384}},
                "required": ["logout_token"],
            }
        }
    },
}


class ProviderShape(Schema):
    """A provider that people may sign in by; `title` is what its button says."""

    name: str
    title: str


class SignOnWanted(Asked):
    """Where to go afterwards (a page of VIPO's own), and the code of an invitation, if somebody comes by one."""

    next: Line = Field("", max_length=500)
    invitation: Line = Field("", max_length=200)


class SignOnAddress(Schema):
    """Where the browser goes now."""

    address: str


class SignOnAnswer(Asked):
    """What the provider gave the browser along, and a code of the second factor where that is asked for."""

    state: Line = Field(max_length=200)
    code: Line = Field("", max_length=4000)
    iss: Line = Field("", max_length=500)
    error: Line = Field("", max_length=200)
    factor: Line = Field("", max_length=40)


class SignedOn(Me):
    """Who is signed in now, and the page to go to."""

    next: str


class LinkWanted(Asked):
    """By whom the asker wants to sign in, and their password; empty where they have none."""

    provider: Line = Field(max_length=40)
    password: Annotated[str, AsTyped()] = Field("", max_length=1000)


class SignOnShape(Schema):
    """An account of a provider by which the asker signs in; `label` is what it calls them."""

    id: int
    provider: str
    title: str
    label: str
    linked_at: datetime
    used_at: datetime | None


class SignOnList(Schema):
    """Whether the asker has a password, and by which accounts of providers they sign in beside."""

    has_password: bool
    sign_ons: list[SignOnShape]


@router.get("/sign-in/providers", response=list[ProviderShape], auth=None)
def list_sign_on_providers(request: HttpRequest) -> list[dict[str, str]]:
    """List by whom people may sign in here, in the order of their buttons."""
    return [{"name": each.name, "title": each.title} for each in list_providers()]


@router.post(
    "/sign-in/providers/{provider}", response=SignOnAddress, auth=None, openapi_extra=refuses(403, 404, 410, 429, 503)
)
def begin_provider_sign_on(
    request: HttpRequest, response: HttpResponse, provider: str, body: SignOnWanted
) -> dict[str, str]:
    """Begin a sign-on: tell where to send the browser, which comes back to `/sign-on/{provider}` within ten minutes."""
    _require_page(request)
    found = find_provider(provider)
    return _begin(request, response, found, Purpose(next=body.next, link_code=body.invitation))


@router.post(
    "/sign-in/providers/{provider}/finish",
    response=SignedOn,
    auth=None,
    openapi_extra=refuses(401, 403, 404, 409, 410, 429, 503),
)
def finish_provider_sign_on(
    request: HttpRequest, response: HttpResponse, provider: str, body: SignOnAnswer
) -> dict[str, Any]:
    """Finish a sign-on with what the provider gave along; this begins a session, or links the asker's account.

    Of whom a second factor is asked, the answer without `factor` is 401, `second_factor_needed`; the same is sent again
    with it then.
    """
    _require_page(request)
    found = find_provider(provider)
    user = request.user
    answer = Answer(
        begun=Begun(body.state, request.COOKIES.get(COOKIE, "")),
        code=body.code,
        error=body.error,
        issuer=body.iss,
        back=_back(request, found),
        factor=body.factor,
        who=user if isinstance(user, User) else None,
    )
    arrival = finish_sign_on(
        provider=found,
        answer=answer,
        address=client_address(request),
        device_of=partial(find_device, request),
        now=timezone.now(),
    )
    if arrival.is_new_session:
        _let_in(request, response, found, arrival)
    response["Cache-Control"] = "no-store"
    return {**tell_me(request), "next": arrival.next}


@router.post(
    "/sign-in/providers/{provider}/logout",
    response={204: None},
    auth=None,
    openapi_extra={**refuses(400, 404, 503), "requestBody": _LOGOUT_BODY},
)
def end_sessions_of_provider(request: HttpRequest, response: HttpResponse, provider: str) -> Status[None]:
    """End the sessions that a provider's logout token names (OpenID Connect Back-Channel Logout 1.0).

    A provider calls this itself, with a form; what proves that it is the provider is the token's signature.
    """
    end_provider_sessions(provider=find_provider(provider), token=request.POST.get("logout_token", ""))
    response["Cache-Control"] = "no-store"
    return Status(204, None)


@router.get("/me/sign-ons", response=SignOnList, auth=session_only)
def list_my_sign_ons(request: HttpRequest) -> dict[str, Any]:
    """Say by which ways the asker signs in."""
    user = signed_in(request)
    found = [asdict(view) for view in bindings.list_sign_ons(user=user)]
    return {"has_password": user.has_usable_password(), "sign_ons": found}


@router.post("/me/sign-ons", response=SignOnAddress, auth=session_only, openapi_extra=refuses(404, 429, 503))
def begin_linking(request: HttpRequest, response: HttpResponse, body: LinkWanted) -> dict[str, str]:
    """Begin to link the asker's account with one of a provider; goes on and ends as a sign-on does."""
    user, now = signed_in(request), timezone.now()
    address, seen = client_address(request), signed_on_at(request)
    with checking_own_password(user=user, password=body.password, address=address, now=now, signed_on_at=seen):
        return _begin(request, response, find_provider(body.provider), Purpose(next="/account", link_to=user))


@router.delete("/me/sign-ons/{int:sign_on}", response={204: None}, auth=session_only, openapi_extra=refuses(409))
def remove_my_sign_on(request: HttpRequest, sign_on: int) -> Status[None]:
    """Take a link away; all sessions of the asker end, this one too. Nobody's only way in can be taken away (409)."""
    bindings.unlink(user=signed_in(request), sign_on=sign_on)
    return Status(204, None)


def _begin(request: HttpRequest, response: HttpResponse, provider: Provider, purpose: Purpose) -> dict[str, str]:
    address, begun = begin_sign_on(
        provider=provider,
        browser=request.COOKIES.get(COOKIE, ""),
        purpose=purpose,
        address=client_address(request),
        back=_back(request, provider),
        now=timezone.now(),
    )
    response.set_cookie(
        COOKIE,
        begun.browser,
        max_age=int(LASTS.total_seconds()),
        path=PATH,
        secure=bool(settings.SESSION_COOKIE_SECURE),
        httponly=True,
        samesite="Strict",
    )
    response["Cache-Control"] = "no-store"
    return {"address": address}


def _let_in(request: HttpRequest, response: HttpResponse, provider: Provider, arrival: Arrival) -> None:
    """Begin the session, which keeps by whom, when, and what signs out there."""
    has_factor = arrival.identity.has_factor
    begin_session(request, response, arrival.user, TWO_FACTORS if has_factor else PASSWORDS)
    kept = {"provider": provider.name, "at": timezone.now().isoformat(), "id_token": arrival.identity.id_token}
    request.session["sign_on"] = kept
    request.session.save()
    bind_session(key=str(request.session.session_key), identity=arrival.identity)


def _back(request: HttpRequest, provider: Provider) -> str:
    return request.build_absolute_uri(PAGE + provider.name)


def _require_page(request: HttpRequest) -> None:
    """Let only VIPO's own pages begin and finish: no other site signs anybody in as somebody else."""
    if check_csrf(request):
        raise HttpError(403, "The page is out of date. Reload it and sign in again.")

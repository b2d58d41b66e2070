"""One's own second factor over HTTP: set up, confirmed, turned off; its recovery codes; no token may."""

from __future__ import annotations

from dataclasses import asdict
from datetime import datetime
from typing import Annotated, Any, Literal

from django.contrib.auth import update_session_auth_hash
from django.db import transaction
from django.http import HttpRequest, HttpResponse
from django.utils import timezone
from ninja import Field, Router, Schema
from ninja.responses import Status

from registry.api.authentication import session_only
from registry.api.people import signed_on_at
from registry.audit.actor import client_address
from registry.people import second_factor
from registry.people.access import require
from registry.people.open_sessions import follow_session
from registry.people.sign_in import checking_own_password
from registry.requests import Asked, AsTyped, Line, refuses, signed_in
from registry.sites import factor_rule

router = Router(tags=["registry"])


class FactorShape(Schema):
    """Since when the asker has a second factor, null for none, and how many recovery codes are left."""

    since: datetime | None
    recovery_codes: int


class OwnPassword(Asked):
    """The password that somebody has; empty where they have none, and have just signed in by their provider."""

    password: Annotated[str, AsTyped()] = Field(max_length=1000)


class PasswordAndCode(OwnPassword):
    """The password that somebody has, and a code of their app or a recovery code."""

    code: Line = Field(max_length=40)


class NewFactorShape(Schema):
    """What an app is given; told this once. `picture` is a QR code of `address`, as a data URI."""

    secret: str
    address: str
    picture: str


class RecoveryCodes(Schema):
    """Ten codes that stand in for the app, each once; told this once."""

    codes: list[str]


DemandRole = Literal["commenter", "operator", "author", "admin"]


class FactorRuleShape(Schema):
    """From which role on a site demands a second factor, null for none; `of_server`: from which on every site does."""

    demanded_from: DemandRole | None
    of_server: DemandRole | None


class FactorRuleWanted(Asked):
    """From which role on a second factor is to be demanded, null for nobody."""

    demanded_from: DemandRole | None


@router.get("/sites/{slug}/second-factor", response=FactorRuleShape, auth=session_only)
def show_factor_rule(request: HttpRequest, slug: str) -> dict[str, Any]:
    """Say of whom a site demands a second factor."""
    require(signed_in(request), slug, "admin")
    return _rule_to_json(factor_rule.get_factor_rule(site=slug))


@router.put("/sites/{slug}/second-factor", response=FactorRuleShape, auth=session_only, openapi_extra=refuses(409))
def set_factor_rule(request: HttpRequest, slug: str, body: FactorRuleWanted) -> dict[str, Any]:
    """Demand a second factor from a role on; who lacks one looks only from now on, until it is set up."""
    user = signed_in(request)
    require(user, slug, "admin")
    return _rule_to_json(factor_rule.set_factor_rule(site=slug, demanded_from=body.demanded_from or "", by=user))


def _rule_to_json(rule: factor_rule.FactorRule) -> dict[str, Any]:
    return {"demanded_from": rule.demanded_from or None, "of_server": rule.of_server or None}


@router.get("/me/second-factor", response=FactorShape, auth=session_only)
def show_second_factor(request: HttpRequest, response: HttpResponse) -> dict[str, Any]:
    """Say whether the asker has a second factor."""
    response["Cache-Control"] = "no-store"
    return asdict(second_factor.show_factor(user=signed_in(request)))


@router.post("/me/second-factor", response={201: NewFactorShape}, auth=session_only)
def begin_second_factor(request: HttpRequest, response: HttpResponse, body: OwnPassword) -> Status[dict[str, Any]]:
    """Make a secret for an authenticator app; it counts once a code of it was sent to `…/confirm`."""
    user = signed_in(request)
    with checking_own_password(
        user=user,
        password=body.password,
        address=client_address(request),
        now=timezone.now(),
        signed_on_at=signed_on_at(request),
    ):
        made = second_factor.begin_factor(user=user)
    response["Cache-Control"] = "no-store"
    return Status(201, asdict(made))


@router.post("/me/second-factor/confirm", response=RecoveryCodes, auth=session_only)
def confirm_second_factor(request: HttpRequest, response: HttpResponse, body: PasswordAndCode) -> dict[str, Any]:
    """Turn the second factor on by a code of the app; all other sessions end, and this one goes on."""
    user, now = signed_in(request), timezone.now()
    with (
        checking_own_password(
            user=user,
            password=body.password,
            address=client_address(request),
            now=now,
            signed_on_at=signed_on_at(request),
        ),
        transaction.atomic(),
    ):
        former = str(request.session.session_key)
        codes = second_factor.confirm_factor(user=user, code=body.code, now=now)
        user.refresh_from_db(fields=["session_generation"])
        update_session_auth_hash(request, user)
        request.session.save()
        follow_session(old=former, new=str(request.session.session_key))
    response["Cache-Control"] = "no-store"
    return {"codes": list(codes)}


@router.post("/me/second-factor/recovery-codes", response=RecoveryCodes, auth=session_only)
def renew_recovery_codes(request: HttpRequest, response: HttpResponse, body: PasswordAndCode) -> dict[str, Any]:
    """Give ten other recovery codes; those before end."""
    user, now = signed_in(request), timezone.now()
    with checking_own_password(
        user=user, password=body.password, address=client_address(request), now=now, signed_on_at=signed_on_at(request)
    ):
        codes = second_factor.renew_recovery_codes(user=user, code=body.code, now=now)
    response["Cache-Control"] = "no-store"
    return {"codes": list(codes)}


@router.post("/me/second-factor/off", response=FactorShape, auth=session_only)
def turn_off_second_factor(request: HttpRequest, body: PasswordAndCode) -> dict[str, Any]:
    """Turn the second factor off; sessions and tokens go on."""
    user, now = signed_in(request), timezone.now()
    with checking_own_password(
        user=user, password=body.password, address=client_address(request), now=now, signed_on_at=signed_on_at(request)
    ):
        second_factor.turn_off_factor(user=user, code=body.code, now=now)
    return {"since": None, "recovery_codes": 0}

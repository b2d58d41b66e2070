"""Tokens over HTTP, for people who are signed in: no token may make, see or revoke tokens."""

from __future__ import annotations

from datetime import datetime
from typing import Any, Literal

from django.http import HttpRequest, HttpResponse
from django.utils import timezone
from ninja import Field, Router, Schema
from ninja.responses import Status

from registry.api.authentication import session_only
from registry.dashboards import accounts
from registry.models import User
from registry.people import tokens
from registry.people.access import require
from registry.people.tokens import MOST_DAYS, MOST_NAME, TokenView
from registry.requests import Asked, Line, signed_in

router = Router(tags=["registry"])
Scope = Literal["read", "operate", "run", "admin", "broker"]


class TokenShape(Schema):
    """A token without its secret; `mine` says whether it is the asker's own."""

    id: str
    name: str
    scopes: list[Scope]
    person: str
    mine: bool
    created_at: datetime
    expires_at: datetime
    last_used_at: datetime | None
    expired: bool


class NewToken(Asked):
    """What a token is for, what it may do, and how long; `broker`, with `read` alone, lets it in over MQTT, too."""

    name: Line = Field(min_length=1, max_length=MOST_NAME)
    scopes: list[Scope] = Field(min_length=1, max_length=4)
    days: int = Field(90, ge=1, le=MOST_DAYS)


class BrokerWay(Schema):
    """How a program comes in to MQTT by a token, its password, and what it may hear; `address` is empty if unknown."""

    address: str
    username: str
    topics: str


class MadeToken(TokenShape):
    """A new token; `token` is its text, told this once."""

    token: str
    broker: BrokerWay | None


@router.get("/sites/{slug}/tokens", response=list[TokenShape], auth=session_only)
def list_tokens(request: HttpRequest, slug: str) -> list[dict[str, Any]]:
    """List the asker's tokens at a site, to its admins those of all members; the newest first."""
    user = signed_in(request)
    access = require(user, slug, "viewer")
    found = tokens.list_tokens(site=slug, user=None if access.allows("admin") else user)
    return [_to_json(view, user) for view in found]


@router.post("/sites/{slug}/tokens", response={201: MadeToken}, auth=session_only)
def create_token(request: HttpRequest, response: HttpResponse, slug: str, body: NewToken) -> Status[dict[str, Any]]:
    """Make a token by which a program asks as the asker at this site, and tell it this once."""
    user = signed_in(request)
    require(user, slug, "viewer")
    view, text = accounts.create_token(
        user=user, site=slug, name=body.name, scopes=body.scopes, days=body.days, now=timezone.now()
    )
    response["Cache-Control"] = "no-store"
    return Status(201, {**_to_json(view, user), "token": text, "broker": accounts.broker_of(view=view)})


@router.get("/sites/{slug}/tokens/{token_id}", response=TokenShape, auth=session_only)
def show_token(request: HttpRequest, slug: str, token_id: str) -> dict[str, Any]:
    """Show one of the asker's tokens, to an admin of the site anybody's."""
    user = signed_in(request)
    access = require(user, slug, "viewer")
    found = tokens.find_token(token_id=token_id, site=slug, user=None if access.allows("admin") else user)
    return _to_json(found, user)


@router.delete("/sites/{slug}/tokens/{token_id}", response={204: None}, auth=session_only)
def revoke_token(request: HttpRequest, slug: str, token_id: str) -> Status[None]:
    """End one of the asker's tokens at once, as an admin of the site anybody's."""
    user = signed_in(request)
    access = require(user, slug, "viewer")
    accounts.revoke_token(token_id=token_id, site=slug, user=None if access.allows("admin") else user)
    return Status(204, None)


def _to_json(view: TokenView, user: User) -> dict[str, Any]:
    return {
        "id": view.id,
        "name": view.name,
        "scopes": list(view.scopes),
        "person": view.person,
        "mine": view.person_id == user.pk,
        "created_at": view.created_at,
        "expires_at": view.expires_at,
        "last_used_at": view.last_used_at,
        "expired": view.expires_at <= timezone.now(),
    }

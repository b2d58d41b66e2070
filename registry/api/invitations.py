"""Invitations over HTTP: made, listed and revoked by admins; looked at and accepted by who holds a link."""

from __future__ import annotations

from dataclasses import asdict
from datetime import datetime
from typing import Annotated, Any, Literal

from django.http import HttpRequest, HttpResponse
from django.utils import timezone
from ninja import Field, Router, Schema
from ninja.errors import HttpError
from ninja.responses import Status
from ninja.utils import check_csrf

from registry import services
from registry.api.authentication import session_only
from registry.api.people import begin_session
from registry.audit.actor import client_address
from registry.models import User
from registry.people.access import require
from registry.requests import Asked, AsTyped, Line, refuses, signed_in
from registry.shapes import Role
from registry.sites import invitations
from registry.sites.invitations import MOST_DAYS, MOST_USES, InvitationView, Wanted
from registry.sites.mail import can_mail, mail_invitation

router = Router(tags=["registry"])
PAGE = "/invitation#"
"""What stands behind the sign # a browser sends to nobody, so that no log has the code."""


class InvitationShape(Schema):
    """An invitation without its link; `people` are those who came by it and are members still."""

    id: int
    role: Role
    email: str
    made_by: str
    mine: bool
    made_at: datetime
    expires_at: datetime
    uses: int
    used: int
    state: Literal["open", "used_up", "expired", "revoked"]
    people: list[str]


class InvitationList(Schema):
    """A site's invitations, the newest first; `can_mail` says whether the server may send them by e-mail."""

    can_mail: bool
    invitations: list[InvitationShape]


class NewInvitation(Asked):
    """For which role an invitation is, how many days and people; with `email` it is sent there."""

    role: Role
    days: int = Field(7, ge=1, le=MOST_DAYS)
    uses: int = Field(1, ge=1, le=MOST_USES)
    email: Line = Field("", max_length=254)


class MadeInvitation(InvitationShape):
    """A new invitation; `link` is told this once. `mailed` says whether the mail server took it, null for no mail."""

    link: str
    mailed: bool | None


class LinkCode(Asked):
    """What stands behind the sign # in a link."""

    code: Line = Field(min_length=1, max_length=200)


class OfferShape(Schema):
    """What a link offers."""

    site: str
    site_name: str
    role: Role
    invited_by: str
    expires_at: datetime


class NewPerson(LinkCode):
    """Who comes in by a link without having an account."""

    name: Line = Field(min_length=1, max_length=100)
    email: Line = Field(max_length=254)
    password: Annotated[str, AsTyped()] = Field(max_length=1000)


class Joined(Schema):
    """The site that somebody has come in to."""

    site: str


@router.get("/sites/{slug}/invitations", response=InvitationList, auth=session_only)
def list_invitations(request: HttpRequest, slug: str) -> dict[str, Any]:
    """List a site's invitations, also those that ended within the last 30 days."""
    user = signed_in(request)
    require(user, slug, "admin")
    found = invitations.list_invitations(site=slug, now=timezone.now())
    return {"can_mail": can_mail(), "invitations": [_to_json(view, user) for view in found]}


@router.post("/sites/{slug}/invitations", response={201: MadeInvitation}, auth=session_only)
def make_invitation(
    request: HttpRequest, response: HttpResponse, slug: str, body: NewInvitation
) -> Status[dict[str, Any]]:
    """Make a link by which people join a site, tell it this once, and send it by e-mail if that is asked for."""
    user = signed_in(request)
    require(user, slug, "admin")
    if body.email.strip() and not can_mail():
        raise invitations.BadInvitation(
            "This server sends no e-mail. Make a link without an address, and hand it over yourself."
        )
    wanted = Wanted(body.role, body.days, body.uses, body.email)
    view, code = invitations.make_invitation(site=slug, by=user, wanted=wanted, now=timezone.now())
    link = request.build_absolute_uri(PAGE) + code
    response["Cache-Control"] = "no-store"
    mailed = _mail(view, link, slug) if view.email else None
    return Status(201, {**_to_json(view, user), "link": link, "mailed": mailed})


def _mail(view: InvitationView, link: str, slug: str) -> bool:
    name = services.get_site(site=slug).name
    until = f"{view.expires_at:%Y-%m-%d %H:%M} UTC"
    return mail_invitation(to=view.email, link=link, by=view.made_by, site=name, until=until)


@router.delete("/sites/{slug}/invitations/{int:invitation}", response={204: None}, auth=session_only)
def revoke_invitation(request: HttpRequest, slug: str, invitation: int) -> Status[None]:
    """End an invitation at once; who came by it stays."""
    require(signed_in(request), slug, "admin")
    invitations.revoke_invitation(site=slug, invitation=invitation, now=timezone.now())
    return Status(204, None)


@router.post("/invitations/look", response=OfferShape, auth=None, openapi_extra=refuses(404, 410))
def look_at_invitation(request: HttpRequest, response: HttpResponse, body: LinkCode) -> dict[str, Any]:
    """Say what a link offers; one that has ended says so (410), and one that is none tells of no site (404)."""
    _require_page(request)
    response["Cache-Control"] = "no-store"
    found = invitations.look_at_link(code=body.code, address=client_address(request), now=timezone.now())
    return asdict(found)


@router.post("/invitations/accept", response=Joined, auth=session_only, openapi_extra=refuses(404, 410))
def accept_invitation(request: HttpRequest, body: LinkCode) -> dict[str, str]:
    """Join a site by a link as who is signed in."""
    user, address = signed_in(request), client_address(request)
    return {"site": invitations.accept_invitation(code=body.code, user=user, address=address, now=timezone.now())}


@router.post("/invitations/join", response={201: Joined}, auth=None, openapi_extra=refuses(404, 410))
def join_as_new(request: HttpRequest, response: HttpResponse, body: NewPerson) -> Status[dict[str, str]]:
    """Make an account by a link, join the site, and begin a session."""
    _require_page(request)
    user, site = invitations.join_as_new(
        code=body.code,
        person=invitations.NewPerson(body.name, body.email, body.password),
        address=client_address(request),
        now=timezone.now(),
    )
    begin_session(request, response, user)
    response["Cache-Control"] = "no-store"
    return Status(201, {"site": site})


def _require_page(request: HttpRequest) -> None:
    """Let only VIPO's own pages, or a program that has read /api/me, ask for a person who has no session."""
    if check_csrf(request):
        raise HttpError(403, "The page is out of date. Reload it and open the link again.")


def _to_json(view: InvitationView, user: User) -> dict[str, Any]:
    return {**asdict(view), "mine": view.made_by_id == user.pk}

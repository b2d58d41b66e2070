"""The members of a site over HTTP: seen, changed, removed; who may do what."""

from __future__ import annotations

from dataclasses import asdict
from datetime import datetime
from typing import Any

from django.http import HttpRequest
from ninja import Router, Schema
from ninja.responses import Status
from pydantic import AwareDatetime

from registry.api.authentication import session_only
from registry.models import User
from registry.people.access import require
from registry.people.rights import DEEDS
from registry.requests import Asked, signed_in
from registry.shapes import Role
from registry.sites import members

router = Router(tags=["registry"])


class MemberShape(Schema):
    """A member of a site; `me` marks who asks.

    `seen_at` is when a page of theirs last showed the site, to the minute; `ends_at` when their access ends, null for
    no end; `came_by` who invited them, if they came by a link; `is_closed` says that they sign in no more,
    `second_factor` whether they have one, `has_password` and `sign_in_by` by which ways they sign in: the latter are
    titles of providers.
    """

    id: int
    name: str
    initials: str
    email: str
    role: Role
    joined_at: datetime | None
    seen_at: datetime | None
    ends_at: datetime | None
    came_by: str
    is_closed: bool
    second_factor: bool
    has_password: bool
    sign_in_by: list[str]
    me: bool


class EndingShape(Schema):
    """What ends when a member is removed: tokens by name, open invitations, and whether all their sessions do.

    The wall screens that they made, by name, are left: they go on until somebody turns them off.
    """

    tokens: list[str]
    invitations: int
    signs_out: bool
    wall_screens_left: list[str]


class MemberDetail(MemberShape):
    """A member, and what ends when they are removed."""

    ending: EndingShape


class MemberChange(Asked):
    """What is to be another; what is left out stays, and `ends_at: null` takes the end of access away."""

    role: Role | None = None
    ends_at: AwareDatetime | None = None


class DeedShape(Schema):
    """Something that people do at a site, and the roles that may."""

    name: str
    roles: list[Role]


@router.get("/rights", response=list[DeedShape])
def list_rights(request: HttpRequest) -> list[dict[str, Any]]:
    """Say which role may do what at a site."""
    return [{"name": deed.name, "roles": deed.roles} for deed in DEEDS if deed.roles]


@router.get("/sites/{slug}/members", response=list[MemberShape], auth=session_only)
def list_members(request: HttpRequest, slug: str) -> list[dict[str, Any]]:
    """List the members of a site by name; to others than its admins themselves alone."""
    user = signed_in(request)
    access = require(user, slug, "viewer")
    found = members.list_members(site=slug, only=None if access.allows("admin") else user)
    return [_to_json(member, user) for member in found]


@router.get("/sites/{slug}/members/{int:person}", response=MemberDetail, auth=session_only)
def show_member(request: HttpRequest, slug: str, person: int) -> dict[str, Any]:
    """Show a member, and what ends when they are removed."""
    user = signed_in(request)
    require(user, slug, "admin")
    member = members.get_member(site=slug, person=person)
    return {**_to_json(member, user), "ending": asdict(members.what_ends(site=slug, person=person))}


@router.patch("/sites/{slug}/members/{int:person}", response=MemberShape, auth=session_only)
def change_member(request: HttpRequest, slug: str, person: int, body: MemberChange) -> dict[str, Any]:
    """Give a member another role or end of access, at once and in open pages, too; the last admin stays one (409)."""
    user = signed_in(request)
    require(user, slug, "admin")
    changed = members.change_member(
        site=slug,
        person=person,
        by=user,
        role=body.role,
        ends_at=body.ends_at,
        sets_end="ends_at" in body.model_fields_set,
    )
    return _to_json(changed, user)


@router.delete("/sites/{slug}/members/{int:person}", response=EndingShape, auth=session_only)
def remove_member(request: HttpRequest, slug: str, person: int) -> dict[str, Any]:
    """Remove a member, and say what has ended with that; the last admin stays (409)."""
    user = signed_in(request)
    require(user, slug, "admin")
    return asdict(members.drop_member(site=slug, person=person, by=user))


@router.delete("/sites/{slug}/members/{int:person}/second-factor", response={204: None}, auth=session_only)
def reset_second_factor(request: HttpRequest, slug: str, person: int) -> Status[None]:
    """Take the second factor away from a member who has lost it, as an admin of all their sites; their sessions end."""
    user = signed_in(request)
    require(user, slug, "admin")
    members.reset_second_factor(site=slug, person=person, by=user)
    return Status(204, None)


@router.post("/sites/{slug}/leave", response={204: None}, auth=session_only)
def leave_site(request: HttpRequest, slug: str) -> Status[None]:
    """Leave a site, with one's tokens; the last admin stays (409)."""
    user = signed_in(request)
    require(user, slug, "viewer")
    members.leave_site(site=slug, user=user)
    return Status(204, None)


def _to_json(member: members.MemberView, user: User) -> dict[str, Any]:
    return {**asdict(member), "me": member.id == user.pk}

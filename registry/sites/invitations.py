"""Invitations: links by which people join a site, for so many days and so many of them.

A link is told once; its hash is kept, and the code in it is random, so that a slow hash would add nothing. It gives
nobody more than its maker may do at the moment when it is used, and ends when its maker may invite no more.
"""

from __future__ import annotations

import hashlib
import secrets
from dataclasses import asdict, dataclass, replace
from datetime import datetime, timedelta
from typing import Literal

from django.core.exceptions import ValidationError
from django.core.validators import validate_email
from django.db import transaction
from django.db.models import F, Q, QuerySet

from registry.audit.record import note_act
from registry.errors import RegistryError
from registry.live.fanout import publish
from registry.models import Invitation, Membership, Site, User
from registry.people.access import NotAllowed, NotAMember, allows, find_access
from registry.people.demanded_factor import is_vouched_for
from registry.people.sign_in import create_user
from registry.people.throttle import Attempt, counted, network_of

MOST_DAYS = 90
MOST_USES = 100
MOST_OPEN = 50
KEPT_ENDED = timedelta(days=30)
State = Literal["open", "used_up", "expired", "revoked"]


class BadInvitation(RegistryError):
    """An invitation that cannot be made so."""

    code = "bad_invitation"
    status = 422


class TooManyInvitations(RegistryError):
    """The site has as many open invitations as it may."""

    code = "too_many_invitations"
    status = 409


class NoSuchInvitation(RegistryError):
    """There is no such invitation at the site."""

    code = "not_found"
    status = 404


class UnknownLink(RegistryError):
    """A link that is none; whether it ever was one, and of which site, is not said."""

    code = "unknown_link"
    status = 404


class LinkOver(RegistryError):
    """A link that was right and lets nobody in any more; `why` says it in other languages."""

    code = "link_over"
    status = 410


class AlreadyMember(RegistryError):
    """Somebody who takes part already."""

    code = "already_member"
    status = 409


@dataclass(frozen=True, slots=True)
class Wanted:
    """What an invitation is to be: for which role, how many days and people, and whom it is sent to, if anybody."""

    role: str
    days: int
    uses: int
    email: str = ""


@dataclass(frozen=True, slots=True)
class NewPerson:
    """Who comes by a link and has no account yet."""

    name: str
    email: str
    password: str


@dataclass(frozen=True, slots=True)
class InvitationView:
    """An invitation without its code; `people` are those who came by it and are members still."""

    id: int
    role: str
    email: str
    made_by: str
    made_by_id: int | None
    made_at: datetime
    expires_at: datetime
    uses: int
    used: int
    state: State
    people: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Offer:
    """What a link offers to who holds it."""

    site: str
    site_name: str
    role: str
    invited_by: str
    expires_at: datetime


def make_invitation(*, site: str, by: User, wanted: Wanted, now: datetime) -> tuple[InvitationView, str]:
    """Make an invitation; return it, and the code of its link, which nobody can be told again.

    Raises BadInvitation, NotAllowed, TooManyInvitations.
    """
    if not 1 <= wanted.days <= MOST_DAYS or not 1 <= wanted.uses <= MOST_USES:
        raise BadInvitation(f"An invitation lasts 1 to {MOST_DAYS} days and is for 1 to {MOST_USES} people.")
    wanted = replace(wanted, email=_read_email(wanted.email))
    code = secrets.token_urlsafe(24)
    with transaction.atomic():
        row = Site.objects.select_for_update(no_key=True).get(slug=site)
        _require_may_give(by, row, wanted.role)
        if _open(now).filter(site=row).count() >= MOST_OPEN:
            raise TooManyInvitations(f"This site has {MOST_OPEN} open invitations. Revoke one that nobody needs.")
        made = Invitation.objects.create(
            site=row,
            role=wanted.role,
            code_hash=_hash(code),
            email=wanted.email,
            made_by=by,
            made_at=now,
            expires_at=now + timedelta(days=wanted.days),
            uses=wanted.uses,
        )
        note_act(site_id=row.pk, code="invitation_made", facts=asdict(wanted))
    return _view(made, now), code


def _read_email(email: str) -> str:
    email = email.strip().lower()
    try:
        if email:
            validate_email(email)
    except ValidationError as error:
        raise BadInvitation("That is no e-mail address. Check it, or make a link and hand it over yourself.") from error
    return email


def _require_may_give(by: User, site: Site, role: str) -> None:
    access = find_access(by, site)
    if access is None:
        raise NotAMember("There is no such site, or you are not one of its members. Ask its admin to add you.")
    if not access.allows("admin") or not allows(access.role, role):
        raise NotAllowed(f"You are {access.role} of this site; to invite people needs the role admin. Ask an admin.")


def list_invitations(*, site: str, now: datetime) -> tuple[InvitationView, ...]:
    """Return the invitations of a site, the newest first; those that ended long ago are forgotten."""
    rows = Invitation.objects.filter(site__slug=site).select_related("made_by").prefetch_related("came__user")
    return tuple(_view(row, now) for row in rows.order_by("-made_at", "-pk")[:200])


def revoke_invitation(*, site: str, invitation: int, now: datetime) -> None:
    """End an invitation at once; one that has ended stays as it is. Raises NoSuchInvitation."""
    with transaction.atomic():
        row = Invitation.objects.select_for_update().filter(site__slug=site, pk=invitation).first()
        if row is None:
            raise NoSuchInvitation("There is no such invitation here. It may be forgotten already.")
        _revoke(row, now)


def revoke_invitations_of(*, user: User, now: datetime) -> None:
    """End all open invitations that somebody has made, at all sites. Called in a transaction."""
    for row in Invitation.objects.select_for_update().filter(made_by=user).order_by("pk"):
        _revoke(row, now, by=user.display_name)


def _revoke(row: Invitation, now: datetime, by: str = "") -> None:
    """End an invitation whose row is locked, in the name of `by` where nobody acts; one that ended stays as it is."""
    if _state(row, now) == "open":
        row.revoked_at = now
        row.save(update_fields=["revoked_at"])
        facts = {"role": row.role, "used": row.used}
        note_act(site_id=row.site_id, code="invitation_revoked", by=by, facts=facts)


def look_at_link(*, code: str, address: str, now: datetime) -> Offer:
    """Return what a link offers. Raises UnknownLink, LinkOver, TooManyAttempts."""
    row = _find(code, address, now)
    _require_open(row, now)
    maker = row.made_by.display_name if row.made_by else ""
    return Offer(row.site.slug, row.site.name, row.role, maker, row.expires_at)


def accept_invitation(*, code: str, user: User, address: str, now: datetime) -> str:
    """Make somebody a member by a link; return the site's slug.

    Raises UnknownLink, LinkOver, AlreadyMember, TooManyAttempts.
    """
    found = _find(code, address, now)
    with transaction.atomic():
        return _take_in(_lock_open(found, now), user, now)


def find_open_link(*, code: str, address: str, now: datetime) -> Invitation:
    """Return the invitation of a link that may still be used. Raises UnknownLink, LinkOver, TooManyAttempts."""
    row = _find(code, address, now)
    _require_open(row, now)
    return row


def take_in(*, invitation: Invitation, user: User, now: datetime) -> str:
    """Make somebody a member by an invitation that was found before; a member stays one. Returns the site's slug.

    Called in a transaction. Raises LinkOver.
    """
    row = _lock_open(invitation, now)
    if find_access(user, row.site) is not None:
        return row.site.slug
    return _take_in(row, user, now)


def join_as_new(*, code: str, person: NewPerson, address: str, now: datetime) -> tuple[User, str]:
    """Make an account for somebody who has a link, and make them a member; return them, and the site's slug.

    Raises UnknownLink, LinkOver, BadPerson, BadPassword, TooManyAttempts.
    """
    found = _find(code, address, now)
    with transaction.atomic():
        row = _lock_open(found, now)
        user = create_user(email=person.email, password=person.password, display_name=person.name)
        return user, _take_in(row, user, now)


def prune_invitations(*, now: datetime) -> int:
    """Forget those that ended long ago; returns how many."""
    long_ago = now - KEPT_ENDED
    return Invitation.objects.filter(Q(expires_at__lt=long_ago) | Q(revoked_at__lt=long_ago)).delete()[0]


def _find(code: str, address: str, now: datetime) -> Invitation:
    """Return the invitation of a code; wrong ones are counted for the network that they come from."""
    network = network_of(address)
    with counted(Attempt(f"link:{network}", address), now, "link"):
        row = Invitation.objects.select_related("site", "made_by").filter(code_hash=_hash(code)).first()
        if row is None:
            raise UnknownLink("This is no invitation. Check that you have the whole link, or ask for another one.")
        return row


def _lock_open(found: Invitation, now: datetime) -> Invitation:
    rows = Invitation.objects.select_for_update(of=("self",)).select_related("site", "made_by")
    row = rows.filter(pk=found.pk).first()
    if row is None:
        raise LinkOver(_OVER["expired"], {"why": "expired"})
    _require_open(row, now)
    return row


_OVER: dict[str, str] = {
    "used_up": "This invitation was used as often as it may be. Ask for another one.",
    "expired": "This invitation has expired. Ask for another one.",
    "revoked": "This invitation was revoked. Ask for another one.",
}


def _require_open(row: Invitation, now: datetime) -> None:
    state = _state(row, now)
    if row.made_by:  # who made it does not ask here: what counts is how they came last
        row.made_by.has_two_factors = is_vouched_for(row.made_by)
    access = find_access(row.made_by, row.site) if row.made_by else None
    if state == "open" and (access is None or not access.allows("admin") or not allows(access.role, row.role)):
        state = "revoked"
    if state != "open":
        raise LinkOver(_OVER[state], {"why": state})


def _take_in(row: Invitation, user: User, now: datetime) -> str:
    """Make somebody a member. The invitation's row is locked and open."""
    if find_access(user, row.site) is not None:
        raise AlreadyMember("You are a member of this site already. Ask an admin of it if you need another role.")
    member, _ = Membership.objects.update_or_create(
        site=row.site,
        user=user,
        defaults={"role": row.role, "joined_at": now, "ends_at": None, "came_by": row},
    )
    Invitation.objects.filter(pk=row.pk).update(used=F("used") + 1)
    maker = row.made_by.display_name if row.made_by else ""
    facts = {"role": member.role, "invited_by": maker}
    note_act(site_id=row.site_id, code="joined", by=user.display_name, facts=facts)
    transaction.on_commit(lambda: publish(row.site.slug, {"type": "members"}))
    return row.site.slug


def _open(now: datetime) -> QuerySet[Invitation]:
    return Invitation.objects.filter(revoked_at=None, expires_at__gt=now, used__lt=F("uses"))


def _state(row: Invitation, now: datetime) -> State:
    if row.revoked_at is not None:
        return "revoked"
    if row.used >= row.uses:
        return "used_up"
    return "open" if row.expires_at > now else "expired"


def _hash(code: str) -> str:
    return hashlib.sha256(code.encode(errors="replace")).hexdigest()


def _view(row: Invitation, now: datetime) -> InvitationView:
    return InvitationView(
        id=row.pk,
        role=row.role,
        email=row.email,
        made_by=row.made_by.display_name if row.made_by else "",
        made_by_id=row.made_by_id,
        made_at=row.made_at,
        expires_at=row.expires_at,
        uses=row.uses,
        used=row.used,
        state=_state(row, now),
        people=tuple(member.user.display_name for member in row.came.all()),
    )

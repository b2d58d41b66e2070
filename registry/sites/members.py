"""The members of a site: who they are, what they may do and until when; changed, removed, left.

Whoever changes it locks the site's row first and is looked at again then, so that of two admins who lower each other
at once one is told. A site that has an admin whose access does not end keeps one: only whoever runs this VIPO
server may take the last one away (`set_member`, `remove_member`).
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, timedelta

from django.db import transaction
from django.db.models import F, QuerySet
from django.utils import timezone

from registry.audit.record import note_act
from registry.errors import RegistryError
from registry.live.fanout import EVERY_SITE, publish
from registry.models import ApiToken, Invitation, Membership, Site, User
from registry.people.access import ROLES, NotAllowed, NotAMember, allows, find_access, has_not_ended, require
from registry.people.second_factor import reset_factor
from registry.people.sign_on.providers import title_of
from registry.people.wall_screens import list_walls_of
from registry.sites.sites import BadName, UnknownPerson, find_site

LONGEST = timedelta(days=3660)


class LastAdmin(RegistryError):
    """A change after which nobody could look after the site any more."""

    code = "last_admin"
    status = 409


class BadEnd(RegistryError):
    """An end of access that is past, or too far away."""

    code = "bad_end"
    status = 422


class NoSuchMember(RegistryError):
    """Somebody who is no member, or none any more."""

    code = "not_found"
    status = 404


_MOST_IDS = 2**63
"""No row has a number that the databases could not keep."""


@dataclass(frozen=True, slots=True)
class MemberView:
    """A member; `came_by` is who invited them, if they came by a link, `is_closed` says that they sign in no more.

    `second_factor` tells whether they have one, `sign_in_by` the titles of the providers that they sign in by, and
    `has_password` whether they sign in by a password, too.
    """

    id: int
    name: str
    initials: str
    email: str
    role: str
    joined_at: datetime | None
    seen_at: datetime | None
    ends_at: datetime | None
    came_by: str
    is_closed: bool
    second_factor: bool
    has_password: bool
    sign_in_by: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class PersonView:
    """A member as others may see them: by name, without an address."""

    id: int
    name: str
    initials: str


@dataclass(frozen=True, slots=True)
class Ending:
    """What ends with somebody's part in a site; `signs_out`: it is their only one, so their sessions end, too.

    `wall_screens_left` are those that they made, by name: they go on, and whoever kept a link goes on watching.
    """

    tokens: tuple[str, ...]
    invitations: int
    signs_out: bool
    wall_screens_left: tuple[str, ...]


def list_people(*, site: str) -> tuple[PersonView, ...]:
    """Return the members of a site whose access has not ended, by name."""
    rows = Membership.objects.filter(has_not_ended(), site__slug=site, user__is_active=True)
    found = rows.select_related("user").order_by("user__display_name", "user_id")
    return tuple(PersonView(row.user.pk, row.user.display_name, row.user.initials) for row in found)


def list_members(*, site: str, only: User | None = None) -> tuple[MemberView, ...]:
    """Return the members of a site by name, or one of them alone; also those whose access has ended."""
    rows = Membership.objects.filter(site__slug=site).select_related("user__second_factor", "came_by__made_by")
    rows = rows.prefetch_related("user__sign_ons")
    if only is not None:
        rows = rows.filter(user_id=only.pk)
    return tuple(_view(row) for row in rows.order_by("user__display_name", "user__email"))


def get_member(*, site: str, person: int) -> MemberView:
    """Return a member. Raises NoSuchMember."""
    return _view(_find(_rows(site), person))


def what_ends(*, site: str, person: int) -> Ending:
    """Return what ends when this member is removed. Raises NoSuchMember."""
    return _ending(_find(_rows(site), person))


def change_member(
    *,
    site: str,
    person: int,
    by: User,
    role: str | None = None,
    ends_at: datetime | None = None,
    sets_end: bool = False,
) -> MemberView:
    """Give a member another role, or another end of access (with `sets_end`; None: no end), at once.

    Raises NoSuchMember, LastAdmin, BadEnd; NotAMember and NotAllowed if `by` is no admin any more.
    """
    now = timezone.now()
    if sets_end and ends_at is not None and not now < ends_at < now + LONGEST:
        raise BadEnd("The end of access must be in the future and at most ten years ahead. Choose another day.")
    with transaction.atomic():
        _lock(site)
        require(by, site, "admin")
        member = _find(_rows(site).select_for_update(of=("self",)), person)
        if (role is not None and role != Membership.Role.ADMIN) or (sets_end and ends_at is not None):
            _require_other_admin(member)
        if role is not None:
            _set_role(member, role)
        if sets_end and ends_at != member.ends_at:
            member.ends_at = ends_at
            member.save(update_fields=["ends_at"])
            until = ends_at.isoformat(timespec="minutes") if ends_at else None
            note_act(
                site_id=member.site_id,
                code="access_end_set",
                facts={"person": member.user.display_name, "until": until},
            )
        _tell(site)
    return _view(member)


def reset_second_factor(*, site: str, person: int, by: User) -> None:
    """Take the second factor away from a member who has lost it, as an admin of all their sites; their sessions end.

    Raises NoSuchMember, NotAMember, NotAllowed, NoFactor.
    """
    with transaction.atomic():
        require(by, site, "admin")
        member = _find(_rows(site), person)
        theirs = Membership.objects.filter(user_id=member.user_id).values_list("site__slug", flat=True)
        if any((access := find_access(by, each)) is None or not access.allows("admin") for each in theirs):
            raise NotAllowed(
                f"{member.user.display_name} is a member of sites that are not yours. Whoever runs this VIPO "
                "server can reset the second factor: vipo account EMAIL --no-second-factor"
            )
        reset_factor(user=member.user)


def drop_member(*, site: str, person: int, by: User) -> Ending:
    """Remove a member with all that they have open here; their name stays where it stood.

    Of whom it was the only site the sessions end, too. Raises NoSuchMember, LastAdmin; NotAMember and NotAllowed if
    `by` is no admin any more.
    """
    with transaction.atomic():
        _lock(site)
        require(by, site, "admin")
        member = _find(_rows(site).select_for_update(of=("self",)), person)
        _require_other_admin(member)
        ending = _ending(member)
        _remove(member, "member_removed", tokens=list(ending.tokens))
        if ending.signs_out:
            User.objects.filter(pk=member.user_id).update(session_generation=F("session_generation") + 1)
            transaction.on_commit(lambda: publish(EVERY_SITE, {"type": "members"}))
    return ending


def leave_site(*, site: str, user: User) -> None:
    """Let somebody leave a site themselves, with their tokens. Raises NoSuchMember, LastAdmin."""
    with transaction.atomic():
        _lock(site)
        member = _find(_rows(site).select_for_update(of=("self",)), user.pk)
        _require_other_admin(member)
        _remove(member, "member_left", tokens=list(_ending(member).tokens))


def set_member(*, site: str, email: str, role: str) -> None:
    """Make a person a member, or change their role, as whoever runs this VIPO server may.

    Access that had ended is given anew. Raises UnknownPerson, BadName, NotAMember.
    """
    if role not in ROLES:
        raise BadName(f"There is no role {role[:20]!r}. Choose {', '.join(ROLES)}.")
    user = User.objects.filter(email=email.strip().lower()).first()
    if user is None:
        raise UnknownPerson(f"Nobody signs in as {email[:100]!r}. Check the address.")
    with transaction.atomic():
        row = _lock(site)
        member = _rows(site).select_for_update(of=("self",)).filter(user_id=user.pk).first()
        if member is None:
            Membership.objects.create(site=row, user=user, role=role, joined_at=timezone.now())
            note_act(site_id=row.pk, code="member_added", facts={"person": user.display_name, "role": role})
        else:
            _set_role(member, role)
            _rows(site).filter(pk=member.pk, ends_at__lte=timezone.now()).update(ends_at=None)
        _tell(site)


def remove_member(*, site: str, email: str) -> None:
    """End a membership and its tokens, as whoever runs this VIPO server may; open pages of the site are closed."""
    find_site(site)
    with transaction.atomic():
        _lock(site)
        member = _rows(site).select_for_update(of=("self",)).filter(user__email=email.strip().lower()).first()
        if member is not None:
            _remove(member, "member_removed", tokens=list(_ending(member).tokens))


def _lock(site: str) -> Site:
    row = Site.objects.select_for_update(no_key=True).filter(slug=site).first()
    if row is None:
        raise NotAMember(f"There is no site {site[:64]!r}.")
    return row


def _rows(site: str) -> QuerySet[Membership]:
    return Membership.objects.filter(site__slug=site).select_related("user", "site", "came_by__made_by")


def _find(rows: QuerySet[Membership], person: int) -> Membership:
    member = rows.filter(user__pk=person).first() if person < _MOST_IDS else None
    if member is None:
        raise NoSuchMember("There is no such member. They may have left, or been removed.")
    return member


def _require_other_admin(member: Membership) -> None:
    """Refuse to take away the only admin whose access does not end. The site's row is locked."""
    lasting = Membership.objects.filter(site_id=member.site_id, role=Membership.Role.ADMIN, ends_at=None)
    lasting = lasting.filter(user__is_active=True)
    if lasting.filter(pk=member.pk).exists() and not lasting.exclude(pk=member.pk).exists():
        raise LastAdmin(
            f"{member.user.display_name} is the last admin of this site. Make somebody else an admin first, without an "
            "end of access."
        )


def _set_role(member: Membership, role: str) -> None:
    before = member.role
    if role == before:
        return
    member.role = role
    member.save(update_fields=["role"])
    facts = {"person": member.user.display_name, "before": before, "after": role}
    note_act(site_id=member.site_id, code="role_changed", facts=facts)
    if not allows(role, Membership.Role.ADMIN):
        _revoke_invitations(member)


def _remove(member: Membership, code: str, *, tokens: list[str]) -> None:
    _revoke_invitations(member)
    note_act(site_id=member.site_id, code=code, facts={"person": member.user.display_name, "tokens": tokens})
    _tell(member.site.slug)
    Membership.objects.filter(pk=member.pk).delete()


def _open_invitations(member: Membership) -> QuerySet[Invitation]:
    rows = Invitation.objects.filter(site_id=member.site_id, made_by_id=member.user_id, revoked_at=None)
    return rows.filter(expires_at__gt=timezone.now(), used__lt=F("uses"))


def _revoke_invitations(member: Membership) -> None:
    """End the links of who may invite no more."""
    _open_invitations(member).update(revoked_at=timezone.now())


def _ending(member: Membership) -> Ending:
    tokens = ApiToken.objects.filter(membership=member, expires_at__gt=timezone.now()).order_by("pk")
    elsewhere = Membership.objects.filter(user_id=member.user_id).exclude(pk=member.pk)
    return Ending(
        tuple(tokens.values_list("name", flat=True)),
        _open_invitations(member).count(),
        not elsewhere.exists(),
        list_walls_of(site=member.site.slug, user=member.user, now=timezone.now()),
    )


def _tell(site: str) -> None:
    """Have the watches of all processes look at once, when it is done."""
    transaction.on_commit(lambda: publish(site, {"type": "members"}))


def _view(row: Membership) -> MemberView:
    maker = row.came_by.made_by if row.came_by else None
    return MemberView(
        id=row.user_id,
        name=row.user.display_name,
        initials=row.user.initials,
        email=row.user.email,
        role=row.role,
        joined_at=row.joined_at,
        seen_at=row.seen_at,
        ends_at=row.ends_at,
        came_by=maker.display_name if maker else "",
        is_closed=not row.user.is_active,
        has_password=row.user.has_usable_password(),
        sign_in_by=tuple(title_of(sign_on.provider) for sign_on in row.user.sign_ons.all()),
        second_factor=bool((factor := getattr(row.user, "second_factor", None)) and factor.confirmed_at),
    )

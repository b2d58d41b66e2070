"""Who may do what at a site, signed in themselves or by a token."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import TYPE_CHECKING

from django.db.models import Q
from django.utils import timezone

from registry.errors import RegistryError
from registry.models import Membership, Site, User
from registry.people.demanded_factor import LOOKS, has_two_factors, is_demanded, is_held_back
from registry.people.roles import ROLES as ROLES
from registry.people.roles import allows as allows

if TYPE_CHECKING:
    from django.contrib.auth.base_user import AbstractBaseUser
    from django.contrib.auth.models import AnonymousUser
    from django.db.models import QuerySet

SCOPES = ("read", "operate", "run", "admin")
"""What a token may be for. `read` is part of all others, and `admin` has all others in it, but `operate` (devices,
stop, alerts) and `run` (programs and runs) stand side by side."""
_SCOPE_OF = {"viewer": "read", "commenter": "run", "operator": "operate", "author": "run", "admin": "admin"}
_STRETCHES_TO = {_SCOPE_OF[role]: role for role in ROLES}
"""The highest role that a token of each scope stretches to."""


class NotAMember(RegistryError):
    """The site does not exist, or the user has no part in it; the two look the same from outside."""

    code = "not_found"
    status = 404


class NotAllowed(RegistryError):
    """The user is a member whose role does not allow this."""

    code = "not_allowed"
    status = 403


class FactorDemanded(NotAllowed):
    """The role would allow it, but the site demands a second factor of it, which the user lacks."""

    code = "second_factor_demanded"


class OutOfScope(NotAllowed):
    """The person may do this, but has not given the token that right (RFC 6750)."""

    code = "insufficient_scope"


@dataclass(frozen=True, slots=True)
class Access:
    """A user's standing at a site; `scopes` are those of the token that was shown, None without one.

    `held_role` is the role that they would have if they had the second factor that is demanded of them; else empty.
    """

    site_id: int
    site: str
    role: str
    scopes: frozenset[str] | None = None
    held_role: str = ""

    def allows(self, role: str, scope: str = "") -> bool:
        """Tell whether this standing includes that role, and a token that scope (unless named, the role's own)."""
        return allows(self.role, role) and self.has_scope(scope or scope_of(role))

    def has_scope(self, scope: str) -> bool:
        """Tell whether this is in the token's scopes; without a token everything is."""
        return self.scopes is None or scope == "read" or not self.scopes.isdisjoint({scope, "admin"})


def scope_of(role: str) -> str:
    """Return the scope that what a role may do needs, where nothing else is said."""
    return _SCOPE_OF[role]


def has_not_ended(prefix: str = "") -> Q:
    """Return what holds for memberships, reached by this path, whose access has not ended."""
    return Q(**{f"{prefix}ends_at": None}) | Q(**{f"{prefix}ends_at__gt": timezone.now()})


def list_memberships(user: AbstractBaseUser | AnonymousUser) -> QuerySet[Membership]:
    """Return where the user belongs to; a token belongs to one site alone."""
    if not user.is_authenticated or not isinstance(user, User):
        return Membership.objects.none()
    rows = Membership.objects.select_related("site")
    memberships = rows.filter(has_not_ended(), user_id=user.pk, user__is_active=True)
    return memberships.filter(site_id=user.grant.site_id) if user.grant else memberships


def access_of(user: User, member: Membership) -> Access:
    """Return the standing of a member: the lesser of their role and of what their token's scopes stretch to.

    Who lacks a second factor that the site demands of their role looks only.
    """
    is_held = is_held_back(user, member)
    role, held = (LOOKS, member.role) if is_held else (member.role, "")
    if user.grant is None:
        return Access(member.site_id, member.site.slug, role, held_role=held)
    widest = max((_STRETCHES_TO[scope] for scope in user.grant.scopes | {"read"}), key=ROLES.index)
    held = min(widest, held, key=ROLES.index) if held else ""
    return Access(member.site_id, member.site.slug, min(widest, role, key=ROLES.index), user.grant.scopes, held)


def find_access(user: AbstractBaseUser | AnonymousUser, site: str | Site) -> Access | None:
    """Return the user's standing at a site (a slug or the Site), or None for strangers."""
    if not isinstance(user, User) or (isinstance(site, str) and "\0" in site):
        return None
    memberships = list_memberships(user)
    found = memberships.filter(site=site) if isinstance(site, Site) else memberships.filter(site__slug=site)
    member = found.first()
    return access_of(user, member) if member else None


def list_with_role(*, site: str, role: str) -> frozenset[int]:
    """Return the ids of those who have this role at a site now, or one that may do more."""
    rows = Membership.objects.filter(has_not_ended(), site__slug=site, user__is_active=True)
    return frozenset(rows.filter(role__in=ROLES[ROLES.index(role) :]).values_list("user_id", flat=True))


@dataclass(frozen=True, slots=True)
class Need:
    """What was required of somebody: a role and a token's scope at a site."""

    site: str
    role: str
    scope: str


_noted: ContextVar[list[Need] | None] = ContextVar("noted_needs", default=None)


@contextmanager
def noting_needs() -> Iterator[list[Need]]:
    """Give the list of what is required and granted within the block, so that it can be required again later."""
    needs: list[Need] = []
    token = _noted.set(needs)
    try:
        yield needs
    finally:
        _noted.reset(token)


def require(user: AbstractBaseUser | AnonymousUser, site: str | Site, role: str, scope: str = "") -> Access:
    """Return the user's standing, or raise NotAMember (404), NotAllowed or OutOfScope (403).

    `scope` is what a token must be for, where that is not what the role stands for.
    """
    access = find_access(user, site)
    if access is None:
        raise NotAMember("There is no such site, or you are not one of its members. Ask its admin to add you.")
    wanted = scope or scope_of(role)
    if not access.has_scope(wanted):
        raise OutOfScope(f"This token is not for this; make one with the scope {wanted} (docs/api.md, Tokens).")
    if access.held_role and not access.allows(role, wanted) and allows(access.held_role, role):
        raise FactorDemanded(
            f"This site demands a second factor of the role {access.held_role}. Set one up on the page of your "
            "account; until then you may look, and press Stop all."
        )
    if not access.allows(role, wanted):
        raise NotAllowed(f"You are {access.role} of this site; this needs the role {role}. Ask an admin for it.")
    if (noted := _noted.get()) is not None:
        noted.append(Need(access.site, role, wanted))
    return access


def require_factor(user: User, role: str) -> None:
    """Refuse who lacks the second factor that the whole server demands of a role. Raises FactorDemanded."""
    if is_demanded("", role) and not has_two_factors(user):
        raise FactorDemanded(
            f"This server demands a second factor of the role {role}. Set one up on the page of your account first."
        )


def list_visible(user: AbstractBaseUser | AnonymousUser) -> frozenset[str]:
    """Return the slugs of the sites of which the user is a member."""
    return frozenset(list_memberships(user).values_list("site__slug", flat=True))

"""Who may do what at a site."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from registry.errors import RegistryError
from registry.models import Membership, Site

if TYPE_CHECKING:
    from django.contrib.auth.base_user import AbstractBaseUser
    from django.contrib.auth.models import AnonymousUser

ROLES = ("viewer", "operator", "author", "admin")


class NotAMember(RegistryError):
    """The site does not exist, or the user has no part in it; the two look the same from outside."""

    code = "not_found"
    status = 404


class NotAllowed(RegistryError):
    """The user is a member whose role does not allow this."""

    code = "not_allowed"
    status = 403


def allows(has: str, role: str) -> bool:
    """Tell whether somebody who has one role may do what another one may."""
    return ROLES.index(has) >= ROLES.index(role)


@dataclass(frozen=True, slots=True)
class Access:
    """A user's standing at a site."""

    site_id: int
    site: str
    role: str

    def allows(self, role: str) -> bool:
        """Tell whether this standing includes that role."""
        return allows(self.role, role)


def find_access(user: AbstractBaseUser | AnonymousUser, site: str | Site) -> Access | None:
    """Return the user's standing at a site (a slug or the Site), or None for strangers."""
    if not user.is_authenticated or (isinstance(site, str) and "\0" in site):
        return None
    memberships = Membership.objects.filter(user_id=user.pk, user__is_active=True)
    found = memberships.filter(site=site) if isinstance(site, Site) else memberships.filter(site__slug=site)
    member = found.select_related("site").first()
    return Access(member.site_id, member.site.slug, member.role) if member else None


def require(user: AbstractBaseUser | AnonymousUser, site: str | Site, role: str) -> Access:
    """Return the user's standing, or raise NotAMember (404) or NotAllowed (403)."""
    access = find_access(user, site)
    if access is None:
        raise NotAMember("There is no such site, or you are not one of its members. Ask its admin to add you.")
    if not access.allows(role):
        raise NotAllowed(f"You are {access.role} of this site; this needs the role {role}. Ask an admin for it.")
    return access


def list_visible(user: AbstractBaseUser | AnonymousUser) -> frozenset[str]:
    """Return the slugs of the sites of which the user is a member."""
    if not user.is_authenticated:
        return frozenset()
    memberships = Membership.objects.filter(user_id=user.pk, user__is_active=True)
    return frozenset(memberships.values_list("site__slug", flat=True))

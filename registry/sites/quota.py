"""How many sites a person may make: none, unless somebody with the server's terminal has given them the right."""

from __future__ import annotations

from registry.errors import RegistryError
from registry.models import Site, User

MOST_SITES = 1000
USUAL_SITES = 10
"""What somebody gets who had made sites before there was such a right, and the demo's admin."""


class MayNotCreateSites(RegistryError):
    """Somebody without the right wants to make a site."""

    code = "may_not_create_sites"
    status = 403


class SiteQuotaReached(RegistryError):
    """Somebody has made as many sites as they may."""

    code = "site_quota_reached"
    status = 403


class BadQuota(RegistryError):
    """A number of sites that nobody can be given."""

    code = "bad_quota"
    status = 422


def may_create_sites(user: User) -> bool:
    """Tell whether a person has the right to make one more site."""
    return _made_by(user) < user.site_quota


def require_site_quota(user: User) -> None:
    """Raise MayNotCreateSites or SiteQuotaReached unless a person may make one more site."""
    if not user.site_quota:
        raise MayNotCreateSites(
            "You may not make sites. Ask whoever runs this VIPO server for it: `vipo account … --sites 1`."
        )
    if not may_create_sites(user):
        raise SiteQuotaReached(
            f"You have made {user.site_quota} sites, which is as many as you may. "
            "Ask whoever runs this VIPO server for more: `vipo account … --sites`."
        )


def lock_site_quota(user: User) -> None:
    """Let a person make one site at a time, and only one that they may; call it within a transaction."""
    require_site_quota(User.objects.select_for_update().get(pk=user.pk))


def set_site_quota(*, email: str, sites: int) -> None:
    """Let a person make so many sites in all; 0 takes the right away, and leaves the sites that are there."""
    if not 0 <= sites <= MOST_SITES:
        raise BadQuota(f"A person may make 0 to {MOST_SITES} sites, not {sites}.")
    User.objects.filter(email=email.strip().lower()).update(site_quota=sites)


def _made_by(user: User) -> int:
    return Site.objects.filter(made_by_id=user.pk).count()

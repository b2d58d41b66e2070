"""Of whom a site, or the whole server, demands a second factor, and what they may do until they have one.

Who lacks it looks, as a viewer does, and may press Stop all; docs/adr/0070 says why not less. The provider of a sign-on
may vouch for one, by the server's settings: then it is the session that has it, and the person's tokens as long as the
provider did so when it was used last.
"""

from __future__ import annotations

from django.conf import settings

from registry.models import Membership, SecondFactor, SignOn, User
from registry.people.roles import ROLES, allows

DEMANDS = ROLES[1:]
"""The roles from which on it can be demanded; whoever only looks needs none."""
LOOKS = ROLES[0]


def demanded_from(of_site: str) -> str:
    """Return the least role of which it is demanded at a site, by itself or by the server; empty for none."""
    named = [role for role in (of_site, settings.VIPO_SECOND_FACTOR) if role]
    return min(named, key=ROLES.index, default="")


def is_demanded(of_site: str, role: str) -> bool:
    """Tell whether a site demands it of this role."""
    least = demanded_from(of_site)
    return bool(least) and allows(role, least)


def role_until_then(of_site: str, role: str, *, has_factor: bool) -> str:
    """Return what somebody of a role may do at a site, whether they have one or not."""
    return LOOKS if not has_factor and is_demanded(of_site, role) else role


def has_two_factors(user: User) -> bool:
    """Tell whether somebody who asks has a second factor: their own, or their provider's for this session or token."""
    if user.has_two_factors or SecondFactor.objects.filter(user_id=user.pk).exclude(confirmed_at=None).exists():
        return True
    return user.grant is not None and is_vouched_for(user)


def is_vouched_for(user: User) -> bool:
    """Tell whether a person's provider vouched for a second factor when it was used last."""
    return SignOn.objects.filter(user_id=user.pk, had_factor=True).exists()


def is_held_back(user: User, member: Membership) -> bool:
    """Tell whether a member lacks a second factor that is demanded of them."""
    return is_demanded(member.site.second_factor_from, member.role) and not has_two_factors(user)

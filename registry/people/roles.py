"""The roles of a site, without any framework: each may do all that the ones before it may."""

from __future__ import annotations

ROLES = ("viewer", "commenter", "operator", "author", "admin")


def allows(has: str, role: str) -> bool:
    """Tell whether somebody who has one role may do what another one may."""
    return ROLES.index(has) >= ROLES.index(role)

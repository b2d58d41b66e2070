"""Who sees a function of the library, and who may change it."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from django.db.models import Q

from editor.models import LibraryFunction
from registry import services as registry

ME, SITE, EVERYONE = (choice.value for choice in LibraryFunction.Visibility)


def seen_by(user: Any) -> Q:
    """Return what holds for the functions that somebody sees; None is the installation itself, which sees all.

    At their own sites that is what is the site's or everyone's, and of what its author alone sees their own; an admin
    sees what an author who is gone left behind. Of other sites it is what everyone sees. A token sees its site alone.
    """
    if user is None:
        return Q()
    sites = registry.list_sites(user=user)
    mine = Q(site__slug__in=[site.slug for site in sites])
    administered = Q(site__slug__in=[site.slug for site in sites if site.role == "admin"])
    there = (mine & (~Q(visibility=ME) | Q(author=user.pk))) | (administered & Q(author=None))
    return there if user.grant else there | Q(visibility=EVERYONE)


def changer(user: Any) -> Callable[[LibraryFunction], bool]:
    """Return what tells whether somebody may change a function and save its next version.

    Its author may while they may draw at its site, and the site's admins, but not what its author alone sees. The
    standing at each site is read once.
    """
    if user is None:
        return lambda _row: True

    @cache
    def standing(site: str) -> registry.Access | None:
        return registry.find_access(user, site)

    def may_change(row: LibraryFunction) -> bool:
        access = standing(row.site.slug)
        if access is None:
            return False
        if row.author_id == user.pk:
            return access.allows("author")
        return access.allows("admin", "run") and (row.visibility != ME or row.author_id is None)

    return may_change

"""From which role on a site demands a second factor: read and set by its admins."""

from __future__ import annotations

from dataclasses import dataclass

from django.conf import settings
from django.db import transaction

from registry.audit.record import note_act
from registry.errors import RegistryError
from registry.live.fanout import publish
from registry.models import Site, User
from registry.people.access import require
from registry.people.demanded_factor import DEMANDS, has_two_factors
from registry.sites.sites import find_site


class OwnFactorFirst(RegistryError):
    """An admin who lacks a second factor would hold themselves back."""

    code = "own_factor_first"
    status = 409


class BadDemand(RegistryError):
    """A role of which no second factor can be demanded."""

    code = "bad_demand"
    status = 422


@dataclass(frozen=True, slots=True)
class FactorRule:
    """The least role of which the site demands it, and of which the server does at all sites; empty for none."""

    demanded_from: str
    of_server: str


def get_factor_rule(*, site: str) -> FactorRule:
    """Return of whom a second factor is demanded at a site. Raises NotAMember."""
    return FactorRule(find_site(site).second_factor_from, settings.VIPO_SECOND_FACTOR)


def set_factor_rule(*, site: str, demanded_from: str, by: User) -> FactorRule:
    """Demand it from a role on, or of nobody (empty); at once, in open pages and for tokens, too.

    Raises OwnFactorFirst, BadDemand; NotAMember and NotAllowed if `by` is no admin any more.
    """
    if demanded_from and demanded_from not in DEMANDS:
        raise BadDemand(f"A second factor is demanded from one of these roles on: {', '.join(DEMANDS)}.")
    with transaction.atomic():
        row = Site.objects.select_for_update(no_key=True).get(pk=find_site(site).pk)
        require(by, row, "admin")
        if demanded_from and not has_two_factors(by):
            raise OwnFactorFirst("You have no second factor yourself. Set one up on the page of your account first.")
        if row.second_factor_from != demanded_from:
            row.second_factor_from = demanded_from
            row.save(update_fields=["second_factor_from"])
            note_act(site_id=row.pk, code="second_factor_demanded", facts={"role": demanded_from})
            transaction.on_commit(lambda: publish(site, {"type": "members"}))
    return get_factor_rule(site=site)

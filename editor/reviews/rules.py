"""What a site demands before a program may run on its devices: how many approvals, and of whom."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, cast

from django.db import transaction

from editor.errors import BadRequest
from editor.models import ReviewRule
from registry import services as registry

LeastRole = Literal["operator", "author", "admin"]
MOST_APPROVALS = 9


@dataclass(frozen=True, slots=True)
class Rule:
    """How many approvals are demanded (0: none), and the least role that may give one."""

    approvals: int = 0
    least_role: LeastRole = "author"


def get_rule(*, site: str) -> Rule:
    """Return what a site demands; a site that has chosen nothing demands nothing."""
    row = ReviewRule.objects.filter(site__slug=site).first()
    return _view(row) if row else Rule()


def set_rule(*, site: str, approvals: int | None = None, least_role: LeastRole | None = None) -> Rule:
    """Choose what a site demands from now on, None as before; runs that are under way go on. Raises BadRequest."""
    if approvals is not None and not 0 <= approvals <= MOST_APPROVALS:
        raise BadRequest(f"A site demands 0 to {MOST_APPROVALS} approvals. Choose such a number.")
    with transaction.atomic():
        row = _lock(site)
        before = _view(row)
        rule = Rule(
            before.approvals if approvals is None else approvals,
            before.least_role if least_role is None else least_role,
        )
        if rule == before:
            return rule
        row.approvals, row.least_role = rule.approvals, rule.least_role
        row.save(update_fields=["approvals", "least_role"])
        facts = {"count": rule.approvals, "role": rule.least_role}
        registry.note_act(site_id=row.site_id, code="review_rule_set", facts=facts)
        transaction.on_commit(lambda: registry.publish(site, {"type": "review"}))
    return rule


def hold_rule(site: str) -> Rule:
    """Return what a site demands, and keep that and its approvals as they are until the transaction ends."""
    return _view(_lock(site))


def _lock(site: str) -> ReviewRule:
    row, _ = ReviewRule.objects.select_for_update().get_or_create(site_id=registry.get_site_id(site=site))
    return row


def _view(row: ReviewRule) -> Rule:
    return Rule(row.approvals, cast(LeastRole, row.least_role))

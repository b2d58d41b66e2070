"""The record: a line is written in the transaction of the change that it tells of; neither is without the other.

No code changes a line, and the database refuses it (migration 0020); old ones are forgotten as a whole.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from datetime import datetime, timedelta

from django.conf import settings
from django.utils import timezone

from registry.audit.actor import MOST_NAME, Actor, who_acts
from registry.audit.codes import KIND_OF
from registry.models import AuditLine

LEAST_DAYS = 30


def note_act(
    *,
    site_id: int | None,
    code: str,
    facts: Mapping[str, object] | None = None,
    actor: Actor | None = None,
    by: str = "",
    at: datetime | None = None,
) -> None:
    """Write what is being done at a site, or at the server (`site_id` None); `facts` are what its sentence names.

    Whoever acts in this request did it, unless `actor` says otherwise. `by` is a person's name where only that is
    known for certain: it counts where nobody acts now, or another person does.
    """
    who = actor or who_acts()
    if by and who.kind == "vipo":
        who = replace(who, kind="person", name=by[:MOST_NAME])
    elif by and who.kind == "person" and who.name != by:
        who = Actor("person", by[:MOST_NAME])
    AuditLine.objects.create(
        site_id=site_id,
        at=at or timezone.now(),
        kind=KIND_OF[code],
        code=code,
        actor_kind=who.kind,
        actor=who.name,
        person_id=who.person,
        address=who.address,
        agent=who.agent,
        facts=dict(facts or {}),
    )


def device_acts(device_id: str) -> Actor:
    """Return a device as who does something."""
    return Actor("device", device_id[:MOST_NAME])


def prune_audit(*, now: datetime) -> int:
    """Forget lines that are older than the server keeps them (`VIPO_AUDIT_DAYS`); returns how many."""
    days = max(LEAST_DAYS, int(settings.VIPO_AUDIT_DAYS))
    return AuditLine.objects.filter(at__lt=now - timedelta(days=days)).delete()[0]

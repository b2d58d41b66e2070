"""For how long each site keeps what has ended: the server's settings, or what an admin of the site has chosen."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, timedelta

from django.conf import settings
from django.db import transaction

from execution.errors import BadKeeping
from execution.models import Keeping
from registry import services as registry

KINDS = ("runs", "rehearsals", "calls")
LEAST_DAYS, MOST_DAYS = 1, 36_500
FOR_EVER = 0


@dataclass(frozen=True, slots=True)
class KeepingView:
    """Times of keeping by kind, in days (0: for ever), which of them the site has chosen, and what went wrong last."""

    days: dict[str, int]
    chosen: dict[str, int | None]
    trouble: str
    trouble_at: datetime | None

    def limit(self, kind: str, now: datetime) -> datetime | None:
        """Return before when something must have ended to be archived; None where it is kept for ever."""
        days = self.days[kind]
        return now - timedelta(days=max(days, LEAST_DAYS)) if days else None


def default_days() -> dict[str, int]:
    """Return the server's times of keeping by kind, in days."""
    return {
        "runs": settings.VIPO_KEEP_RUNS_DAYS,
        "rehearsals": settings.VIPO_KEEP_REHEARSALS_DAYS,
        "calls": settings.VIPO_KEEP_CALLS_DAYS,
    }


def get_keeping(*, site: str) -> KeepingView:
    """Return for how long a site keeps what has ended."""
    row = Keeping.objects.filter(site__slug=site).first() or Keeping()
    chosen: dict[str, int | None] = {kind: getattr(row, f"{kind}_days") for kind in KINDS}
    days = {kind: default if chosen[kind] is None else chosen[kind] for kind, default in default_days().items()}
    return KeepingView({kind: each or 0 for kind, each in days.items()}, chosen, row.trouble, row.trouble_at)


def set_keeping(*, site: str, chosen: dict[str, int | None]) -> KeepingView:
    """Choose for how many days a site keeps each kind: 0 for ever, None as the server's settings say.

    A choice that is another than before is in the record, with the times that hold from then on.

    Raises:
        BadKeeping: a number of days that is below 0 or beyond a hundred years.
    """
    for days in chosen.values():
        if days is not None and not 0 <= days <= MOST_DAYS:
            raise BadKeeping(f"Choose 1 to {MOST_DAYS} days, or 0 to keep everything for ever.")
    columns = {f"{kind}_days": chosen[kind] for kind in KINDS if kind in chosen}
    with transaction.atomic():
        site_id = registry.get_site_id(site=site)
        row, _ = Keeping.objects.select_for_update().get_or_create(site_id=site_id)
        if any(getattr(row, column) != days for column, days in columns.items()):
            Keeping.objects.filter(pk=row.pk).update(**columns)
            registry.note_act(site_id=site_id, code="keeping_set", facts=get_keeping(site=site).days)
        return get_keeping(site=site)


def count_in_trouble() -> int:
    """Return at how many sites histories could not be archived the last time."""
    return Keeping.objects.exclude(trouble="").count()


def note_trouble(*, site: str, text: str, at: datetime) -> None:
    """Write down why a site's histories could not be archived; an empty text says that they could."""
    if text:
        said = {"trouble": text[:300], "trouble_at": at}
        Keeping.objects.update_or_create(site_id=registry.get_site_id(site=site), defaults=said)
    else:
        Keeping.objects.filter(site__slug=site).exclude(trouble="").update(trouble="", trouble_at=None)

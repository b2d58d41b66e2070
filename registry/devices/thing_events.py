"""What became of Things, in the order in which it was decided; the newest thousand are kept for who was away."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from django.conf import settings
from django.db import connection, transaction
from django.db.models import Max

from registry.devices.things import what_became
from registry.devices.views import DeviceView
from registry.live.fanout import publish
from registry.models import Site, ThingEvent

THINGS = ":things"
"""Where it is called out that there is news; no site has such a name."""
MOST_KEPT = 1000
_ORDER_LOCK = 0x7468696E67


@dataclass(frozen=True, slots=True)
class ThingNews:
    """What became of a Thing; `change` as things.what_became says it. Later news have greater ids."""

    id: int
    kind: str
    device_id: str
    change: Mapping[str, Any]


def record_thing(before: DeviceView | None, after: DeviceView) -> None:
    """Write what became of a device's Thing, if anything did; call it within the transaction that changes it."""
    record_things([(before, after)])


def record_things(changes: Sequence[tuple[DeviceView | None, DeviceView]]) -> None:
    """Write what became of devices' Things, if anything did; call it within the transaction that changes them."""
    became = [(after, what_became(before, after, settings.VIPO_BROKER_URL)) for before, after in changes]
    told = [(after, news) for after, news in became if news is not None]
    if not told:
        return
    _wait_for_turn()
    sites = dict(Site.objects.filter(slug__in={after.site for after, _ in told}).values_list("slug", "pk"))
    rows = ThingEvent.objects.bulk_create(
        ThingEvent(site_id=sites[after.site], device_id=after.id, kind=kind, change=change)
        for after, (kind, change) in told
    )
    ThingEvent.objects.filter(pk__lte=rows[-1].pk - MOST_KEPT).delete()
    transaction.on_commit(call_listeners)


def _wait_for_turn() -> None:
    """See to it that ids become visible in their order: a reader never finds a lower one later."""
    if connection.vendor == "postgresql":
        with connection.cursor() as cursor:
            cursor.execute("SELECT pg_advisory_xact_lock(%s)", [_ORDER_LOCK])


def call_listeners() -> None:
    """Let those who listen look for news, and whether they may still hear them."""
    publish(THINGS, {"type": "things"})


def newest_news() -> int:
    """Return the newest id; 0 before the first."""
    return ThingEvent.objects.aggregate(newest=Max("pk"))["newest"] or 0


def is_kept_since(after: int) -> bool:
    """Tell whether all that came after that id is still there."""
    newest = newest_news()
    return newest - MOST_KEPT <= after <= newest


def read_news(*, after: int, sites: Collection[str], most: int) -> tuple[ThingNews, ...]:
    """Return at most that many news of these sites that came after that id, oldest first."""
    rows = ThingEvent.objects.filter(pk__gt=after, site__slug__in=sites).order_by("pk")[:most]
    return tuple(ThingNews(row.pk, row.kind, row.device_id, row.change) for row in rows)

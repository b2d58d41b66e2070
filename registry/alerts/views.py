"""Alerts as people and programs see them, and how browsers are told of them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Literal, cast

from django.db import transaction
from django.db.models import QuerySet

from registry.alerts.causes import CAUSES, AlertCode, sentence_of
from registry.live.fanout import publish_all
from registry.models import DeviceAlert

MOST_TOLD = 50
"""More changes at once are told as one message, upon which the list is fetched anew."""
OWN_FIELDS = ("code", "args", "count", "first_at", "last_at", "over_at", "seen_at", "device_id", "seen_by_id")
AlertState = Literal["open", "seen", "over"]


@dataclass(frozen=True, slots=True)
class AlertView:
    """An alert as it is now; `state` is open (nobody has seen it), seen, or over."""

    id: int
    site: str
    device_id: str
    code: AlertCode
    args: Mapping[str, Any]
    count: int
    first_at: datetime
    last_at: datetime
    over_at: datetime | None
    seen_by: str
    seen_at: datetime | None

    @property
    def state(self) -> AlertState:
        """Whether people still have to look at it."""
        return "over" if self.over_at else "seen" if self.seen_at else "open"


def readable(role: str) -> QuerySet[DeviceAlert]:
    """Return the alerts that concern this role, ready to be shown."""
    hidden = [] if role == "admin" else [code for code, cause in CAUSES.items() if cause.role == "admin"]
    rows = DeviceAlert.objects.select_related("device__site", "seen_by").exclude(code__in=hidden)
    return rows.only("device__site__slug", "seen_by__display_name", *OWN_FIELDS)


def view_of(row: DeviceAlert) -> AlertView:
    """Return an alert as it is now."""
    return AlertView(
        id=row.pk,
        site=row.device.site.slug,
        device_id=row.device_id,
        code=cast(AlertCode, row.code),
        args=row.args,
        count=row.count,
        first_at=row.first_at,
        last_at=row.last_at,
        over_at=row.over_at,
        seen_by=row.seen_by.display_name if row.seen_by else "",
        seen_at=row.seen_at,
    )


def publish_alerts(ids: Collection[int]) -> None:
    """Tell the browsers of these alerts, once the transaction holds."""
    if not ids:
        return
    by_site: defaultdict[str, list[dict[str, Any]]] = defaultdict(list)
    for row in readable("admin").filter(pk__in=ids).order_by("pk"):
        view = view_of(row)
        by_site[view.site].append({"type": "alert", "alert": alert_to_json(view)})
    news = [
        (site, message)
        for site, messages in by_site.items()
        for message in (messages if len(messages) <= MOST_TOLD else [{"type": "alerts"}])
    ]
    transaction.on_commit(lambda: publish_all(news))


def alert_to_json(alert: AlertView) -> dict[str, Any]:
    """Return an alert as the API and the sockets say it."""
    cause = CAUSES[alert.code]
    return {
        "id": alert.id,
        "device": alert.device_id,
        "code": alert.code,
        "severity": cause.severity,
        "role": cause.role,
        "args": dict(alert.args),
        "text": sentence_of(alert.code, alert.args),
        "count": alert.count,
        "state": alert.state,
        "first_at": alert.first_at.isoformat(),
        "last_at": alert.last_at.isoformat(),
        "over_at": alert.over_at.isoformat() if alert.over_at else None,
        "seen_by": alert.seen_by,
        "seen_at": alert.seen_at.isoformat() if alert.seen_at else None,
    }

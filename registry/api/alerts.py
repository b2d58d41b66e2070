"""Alerts over HTTP."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from django.http import HttpRequest, HttpResponse
from django.utils import timezone
from ninja import Field, Query, Router, Schema

from registry import services
from registry.alerts.causes import AlertCode, Severity
from registry.alerts.inbox import NoSuchAlert
from registry.alerts.views import AlertState
from registry.people.access import find_access, require
from registry.requests import Line, PartAsked, Unchecked, signed_in, tell_rest

router = Router(tags=["registry"])


class AlertShape(Schema):
    """Something about a device that people should know; `text` is the English sentence, `args` what it is made of.

    `count` says how often it was raised since `first_at`, `role` the least role that it concerns.
    """

    id: int
    device: str
    code: AlertCode
    severity: Severity
    role: Literal["viewer", "admin"]
    args: Annotated[Any, Unchecked(dict[str, Any])]
    text: str
    count: int
    state: AlertState
    first_at: str
    last_at: str
    over_at: str | None
    seen_by: str
    seen_at: str | None


class AlertsAsked(PartAsked):
    """Which alerts are asked for: those that are not over, or those in one `state`; of one device, if it is named."""

    state: AlertState | None = None
    device: Line = Field("", max_length=64)


@router.get("/sites/{slug}/alerts", response=list[AlertShape])
def list_alerts(
    request: HttpRequest, response: HttpResponse, slug: str, asked: Query[AlertsAsked]
) -> list[dict[str, Any]]:
    """List a site's alerts, the latest first; the header `Link` names the next part."""
    access = require(signed_in(request), slug, "viewer")
    found = services.list_alerts(site=slug, state=asked.state, role=access.role, device=asked.device, page=asked.page())
    return [services.alert_to_json(alert) for alert in tell_rest(request, response, found)]


@router.post("/sites/{slug}/alerts/seen", response=list[AlertShape])
def mark_all_seen(request: HttpRequest, slug: str) -> list[dict[str, Any]]:
    """Say that the asker has seen all open alerts of a site; answers with those that are not over."""
    user = signed_in(request)
    access = require(user, slug, "operator")
    seen = services.mark_all_seen(site=slug, by=user, at=timezone.now(), role=access.role)
    return [services.alert_to_json(alert) for alert in seen]


@router.post("/alerts/{int:alert_id}/seen", response=AlertShape)
def mark_seen(request: HttpRequest, alert_id: int) -> dict[str, Any]:
    """Say that the asker has seen an alert; of several people the first one stays named."""
    user = signed_in(request)
    alert = services.find_alert(alert_id=alert_id)
    access = find_access(user, alert.site)
    body = services.alert_to_json(alert)
    if access is None or not access.allows(body["role"]):
        raise NoSuchAlert
    require(user, alert.site, "operator")
    return services.alert_to_json(services.mark_alert_seen(alert_id=alert_id, by=user, at=timezone.now()))

"""What people do with alerts: list them and mark them as seen; the old ones are forgotten."""

from __future__ import annotations

from collections.abc import Collection
from datetime import datetime, timedelta

from django.db import transaction

from registry.alerts.causes import AlertCode
from registry.alerts.views import AlertState, AlertView, publish_alerts, readable, view_of
from registry.bounds.pagination import Listed, Page, take_page
from registry.errors import RegistryError
from registry.models import DeviceAlert, Site, User
from registry.sites.sites import find_site

KEPT_FOR = timedelta(days=30)
KEPT_AT_MOST = 1000
ALL = Page(limit=1000)


class NoSuchAlert(RegistryError):
    """No such alert, or not for this person."""

    code = "not_found"
    status = 404

    def __init__(self) -> None:
        super().__init__("There is no such alert. It may have been forgotten; load the list again.")


def list_open_alerts(*, codes: Collection[AlertCode]) -> tuple[AlertView, ...]:
    """Return the alerts of these codes that are not over, of all sites."""
    return tuple(view_of(row) for row in readable("admin").filter(code__in=codes, over_at=None))


def list_alerts(
    *, site: str, state: AlertState | None = None, role: str = "admin", device: str = "", page: Page = ALL
) -> Listed[AlertView]:
    """Return the site's alerts that concern this role, the latest first; those that are not over unless `state` says.

    Of one device, if it is named. Raises NotAMember where there is no such site, BadMark.
    """
    rows = readable(role).filter(device__site=find_site(site))
    if device:
        rows = rows.filter(device=device)
    match state:
        case "over":
            rows = rows.exclude(over_at=None)
        case "seen":
            rows = rows.filter(over_at=None).exclude(seen_at=None)
        case "open":
            rows = rows.filter(over_at=None, seen_at=None)
        case _:
            rows = rows.filter(over_at=None)
    return take_page(rows=rows, by="-last_at", page=page, view=view_of)


def count_open_alerts(*, site: str, role: str) -> int:
    """Return how many of the site's alerts that concern this role are not over."""
    return readable(role).filter(device__site__slug=site, over_at=None).count()


def find_alert(*, alert_id: int) -> AlertView:
    """Return one alert. Raises NoSuchAlert."""
    row = readable("admin").filter(pk=alert_id).first()
    if row is None:
        raise NoSuchAlert
    return view_of(row)


def mark_alert_seen(*, alert_id: int, by: User, at: datetime) -> AlertView:
    """Say that somebody has seen an alert; the first one stays named. Raises NoSuchAlert."""
    with transaction.atomic():
        if DeviceAlert.objects.filter(pk=alert_id, seen_at=None).update(seen_at=at, seen_by=by):
            publish_alerts([alert_id])
    return find_alert(alert_id=alert_id)


def mark_all_seen(*, site: str, by: User, at: datetime, role: str) -> tuple[AlertView, ...]:
    """Say that somebody has seen all open alerts of a site that concern this role; return what is not over."""
    with transaction.atomic():
        unseen = readable(role).filter(device__site=find_site(site), over_at=None, seen_at=None)
        ids = list(unseen.values_list("pk", flat=True))
        DeviceAlert.objects.filter(pk__in=ids, seen_at=None).update(seen_at=at, seen_by=by)
        publish_alerts(ids)
    return list_alerts(site=site, role=role)


def prune_alerts(*, now: datetime) -> int:
    """Forget what was over 30 days ago, and of each site all but the 1,000 that were over last; return how many."""
    count = DeviceAlert.objects.filter(over_at__lt=now - KEPT_FOR).delete()[0]
    for site in Site.objects.values_list("pk", flat=True):
        over = DeviceAlert.objects.filter(device__site=site).exclude(over_at=None).order_by("-over_at", "-pk")
        too_old = list(over.values_list("pk", flat=True)[KEPT_AT_MOST:])
        count += DeviceAlert.objects.filter(pk__in=too_old).delete()[0]
    return count

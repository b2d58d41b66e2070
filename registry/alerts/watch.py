"""Causes of alerts that last: looked for every second in what the registry knows, whatever was said in between.

So a device that changes its mind a hundred times a second costs no more than one that stays calm, and its alert
changes at most every `CALM`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, Final

from django.conf import settings
from django.db.models import Q

from registry.alerts.alerts import Raised, end_alerts, raise_alerts, reword_alert
from registry.alerts.causes import CAUSES, LOW_BATTERY_PERCENT, AlertCode, is_battery_low
from registry.models import Device, DeviceAlert, DeviceEvent

CALM = timedelta(seconds=10)
BLIP = timedelta(seconds=5)
"""A device that is back within this time was not away."""
START_GRACE = timedelta(minutes=1)
"""So long after the watch began devices may still come back that only VIPO itself had lost."""
PENDING_PATIENCE = timedelta(hours=1)
PENDING_GONE = timedelta(days=1)
MOST_CHARACTERS = 300
OFFLINE: Final = "offline"
AT_WORK: Final = "offline_at_work"
REFUSED: Final = "description_refused"
TOLD = ("error", "warning", "battery_low")
LASTING = frozenset({OFFLINE, AT_WORK, "newcomer_waits", *TOLD})
Key = tuple[str, str]
Causes = dict[tuple[str, AlertCode], dict[str, Any]]


@dataclass(frozen=True, slots=True)
class _Open:
    """An alert that is open."""

    id: int
    args: Mapping[str, Any]
    last_at: datetime
    lifecycle: str


def watch_devices(*, now: datetime, since: datetime, at_work: Collection[str]) -> None:
    """Raise and end alerts by how devices are; `since` is when this watch began, `at_work` who is needed now."""
    there = _list_open()
    away = dict(_list_away())
    causes = {**_find_away(away, there, now, since, at_work), **_find_told(), **_find_pending(now)}
    raise_alerts(raised=[Raised(device, code, now, args) for (device, code), args in causes.items()
                         if (device, code) not in there])  # fmt: skip
    for (device, code), args in causes.items():
        alert = there.get((device, code))
        if alert is not None and alert.args != args and now - alert.last_at >= CALM:
            reword_alert(alert_id=alert.id, args=args, at=now)
    kept = {key for key in there if key in causes or (key[0] in away and key[1] in TOLD)}
    end_alerts(ids=list(_over(there, kept, now)), at=now)


def _list_open() -> dict[Key, _Open]:
    rows = DeviceAlert.objects.filter(over_at=None)
    fields = rows.values_list("pk", "device_id", "code", "args", "last_at", "device__lifecycle")
    return {(device, code): _Open(pk, args, last, lifecycle) for pk, device, code, args, last, lifecycle in fields}


def _list_away() -> Iterator[tuple[str, datetime]]:
    """Yield the devices that should be there, with when they spoke last; one without a key is not expected."""
    rows = Device.objects.filter(lifecycle="approved", online=False, description__isnull=False)
    rows = rows.exclude(ends_before__isnull=False, credential_hash="")
    for device, seen in rows.values_list("pk", "last_seen_at"):
        if seen is not None:
            yield device, seen


def _find_away(
    away: Mapping[str, datetime], there: Mapping[Key, _Open], now: datetime, since: datetime, at_work: Collection[str]
) -> Causes:
    """Who left during work stays so until it is back; nobody has two alerts for one absence.

    An absence counts from when the device was heard last, also where another process watched then or none did; whom
    VIPO itself had lost has `START_GRACE` to be heard again.
    """
    limit = timedelta(seconds=settings.VIPO_OFFLINE_ALERT_S)
    has_watched = now - since >= START_GRACE
    found: Causes = {}
    for device, seen in away.items():
        absence = now - seen
        if (device, AT_WORK) in there or (has_watched and device in at_work and absence >= BLIP):
            found[device, AT_WORK] = {}
        elif (device, OFFLINE) in there or (has_watched and absence >= limit):
            found[device, OFFLINE] = {}
    return found


def _find_told() -> Causes:
    """Find what devices say of themselves: an error, a warning, little charge."""
    told = Q(properties__has_key="error") | Q(properties__has_key="warning")
    rows = Device.objects.filter(told | Q(properties__battery__lt=LOW_BATTERY_PERCENT), online=True)
    found: Causes = {}
    charges: dict[str, Any] = {}
    for device, said in rows.filter(lifecycle="approved").values_list("pk", "properties"):
        for code in ("error", "warning"):
            if trouble := said.get(code):
                found[device, code] = {} if trouble is True else {"why": str(trouble)[:MOST_CHARACTERS]}
        if "battery" in said:
            charges[device] = said["battery"]
    for device, unit in _battery_units(charges):
        if is_battery_low(charges[device], unit):
            found[device, "battery_low"] = {}
    return found


def _battery_units(devices: Collection[str]) -> Iterator[tuple[str, str]]:
    """Yield in which unit each of some devices says how full its battery is; empty where it has none."""
    rows = Device.objects.filter(pk__in=devices).values_list("pk", "description") if devices else ()
    for device, description in rows:
        said = (description or {}).get("properties", ())
        yield device, next((each.get("unit", "") for each in said if each["name"] == "battery"), "")


def _find_pending(now: datetime) -> Causes:
    """Find who has waited long for a decision, and was there within the last day."""
    rows = Device.objects.filter(lifecycle="pending", description__isnull=False)
    rows = rows.filter(first_seen_at__lt=now - PENDING_PATIENCE, last_seen_at__gt=now - PENDING_GONE)
    lately = DeviceEvent.objects.filter(kind="readmitted", at__gt=now - PENDING_PATIENCE)
    return {(pk, "newcomer_waits"): {} for pk in rows.exclude(events__in=lately).values_list("pk", flat=True)}


def _over(there: Mapping[Key, _Open], kept: Collection[Key], now: datetime) -> Iterator[int]:
    """Yield the alerts whose cause has ended: gone for what lasts, quiet for long for the rest, mended, taken out."""
    mended = _find_mended(there)
    for key, alert in there.items():
        quiet = CAUSES[key[1]].quiet  # type: ignore[index] # rows have no other codes
        has_ended = key in mended or (quiet is not None and now - alert.last_at >= quiet)
        if key[1] in LASTING:
            has_ended = key not in kept and now - alert.last_at >= CALM
        if has_ended or alert.lifecycle == "retired":
            yield alert.id


def _find_mended(there: Mapping[Key, _Open]) -> set[Key]:
    """Find the devices whose description was taken after one had been refused, whichever process took it."""
    refused = {device: alert for (device, code), alert in there.items() if code == REFUSED}
    if not refused:
        return set()
    taken = DeviceEvent.objects.filter(device__in=list(refused), kind="described")
    return {(device, REFUSED) for device, at in taken.values_list("device_id", "at") if at > refused[device].last_at}

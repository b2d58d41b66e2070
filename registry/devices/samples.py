"""What properties were: on change, one row for each property and minute, kept for seven days and the last one before.

What has changed is told by the device's row before and after, since any process may hear a device next. Readings are
gathered in the process and written some seconds later, many at once: taking in a state costs no statement more. What a
process that is killed had gathered, at most `FLUSH_S`, is lost; so each process takes in all of a device that it hears
for the first time.
"""

from __future__ import annotations

import json
import logging
import threading
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from django.db import DatabaseError, InterfaceError, connection, transaction
from django.db.models import Count, F, OuterRef, Subquery
from django.db.models.functions import Greatest

from registry.devices.views import DeviceView, effective_description
from registry.models import Device, Sample, SampleClock
from vipo_device.protocol.description import MOST_PROPERTIES, Scalar

log = logging.getLogger(__name__)
FLUSH_S = 10.0
KEPT_FOR = timedelta(days=7)
MOST_WAITING = 200_000
MOST_REMEMBERED = 200_000
MOST_A_MINUTE = 1_000
"""So many rows a device may begin within a minute: one that is named anew all the time fills no disk."""
ROWS_AT_ONCE = 100
PRUNE_AT_ONCE = 10_000
PRUNE_S = 0.5
"""So long it may go on forgetting at once: timers wait meanwhile."""
MOST_KEPT_BEFORE = MOST_PROPERTIES + 2
"""So many properties of a device may have a row from before the seven days, whether it still describes them or not."""
DONE, ONLINE = "$done", "$online"
"""What a device says of itself besides its properties; no property's name begins so."""
Key = tuple[str, str, int]


@dataclass(slots=True)
class Bucket:
    """A property within one minute; `at_ms` is when it was last said, in milliseconds since 1970."""

    value: Scalar
    minimum: float | None
    maximum: float | None
    at_ms: int

    def take(self, value: Scalar, at_ms: int) -> None:
        """Take in another value; what it is in the end is the one that was said last."""
        number = _number(value)
        if number is not None:
            self.minimum = number if self.minimum is None else min(self.minimum, number)
            self.maximum = number if self.maximum is None else max(self.maximum, number)
        if at_ms >= self.at_ms:
            self.value, self.at_ms = value, at_ms


class SampleBuffer:
    """Gathers what changed until it is written; may be used from several threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._waiting: dict[Key, Bucket] = {}
        self._heard: set[str] = set()
        self._since: float | None = None
        self._minute = 0
        self._begun: Counter[str] = Counter()

    def note(self, before: DeviceView | None, after: DeviceView, at: datetime, now: float) -> None:
        """Take in what is new of a device; `now` in seconds of a clock that only goes forward."""
        at_ms = _time_after(before, at)
        with self._lock:
            is_known = before is not None and before.lifecycle == "approved" and after.id in self._heard
            known = _readings(before) if before is not None and is_known else {}
            for name, value in _readings(after).items():
                if known.get(name, _NOTHING) != value:
                    self._add(after.id, name, value, at_ms)
            if self._waiting and self._since is None:
                self._since = now
            if len(self._heard) >= MOST_REMEMBERED:
                self._heard.clear()
            self._heard.add(after.id)

    def _add(self, device: str, name: str, value: Scalar, at_ms: int) -> None:
        key = (device, name, at_ms // 60_000)
        bucket = self._waiting.get(key)
        if bucket is not None:
            bucket.take(value, at_ms)
        elif len(self._waiting) < MOST_WAITING and self._may_begin(device, key[2]):
            number = _number(value)
            self._waiting[key] = Bucket(value, number, number, at_ms)

    def _may_begin(self, device: str, minute: int) -> bool:
        is_clock_put_back = minute < self._minute - 1
        if minute > self._minute or is_clock_put_back:
            self._minute = minute
            self._begun.clear()
        self._begun[device] += 1
        return self._begun[device] <= MOST_A_MINUTE

    def take(self, now: float, *, all_of_it: bool = False) -> dict[Key, Bucket]:
        """Return what is due to be written, and forget it."""
        with self._lock:
            if self._since is None or (now - self._since < FLUSH_S and not all_of_it):
                return {}
            taken, self._waiting, self._since = self._waiting, {}, None
            return taken

    def give_back(self, taken: dict[Key, Bucket], now: float) -> None:
        """Keep what could not be written for the next time."""
        with self._lock:
            for key, bucket in self._waiting.items():
                older = taken.get(key)
                if older is not None:
                    older.take(bucket.value, bucket.at_ms)
                    older.minimum = _least(older.minimum, bucket.minimum)
                    older.maximum = _greatest(older.maximum, bucket.maximum)
            self._waiting = {**self._waiting, **taken}
            self._since = now


_NOTHING = object()
_buffer = SampleBuffer()


def _readings(view: DeviceView) -> dict[str, Scalar]:
    """Return what is kept of a device: the properties that it describes, whether it is done, whether it is there."""
    told = view.readings
    described = {p.name: told[p.name] for p in view.canonical.properties[:MOST_PROPERTIES] if p.name in told}
    return {**described, DONE: view.done, ONLINE: view.online}


def _time_after(before: DeviceView | None, at: datetime) -> int:
    """Return a time in milliseconds since 1970, later than what another process took in a moment ago."""
    at_ms = int(at.timestamp() * 1000)
    seen = before.last_seen_at if before is not None else None
    return at_ms if seen is None or seen <= at else int(seen.timestamp() * 1000) + 1


def _number(value: Scalar) -> float | None:
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None


def _least(a: float | None, b: float | None) -> float | None:
    return min((v for v in (a, b) if v is not None), default=None)


def _greatest(a: float | None, b: float | None) -> float | None:
    return max((v for v in (a, b) if v is not None), default=None)


def note_samples(*, before: DeviceView | None, after: DeviceView, at: datetime) -> None:
    """Take in what is new of a device that takes part, or did so until now; it is written by `flush_samples`.

    `before` and `after` are as its row had it, under its lock; None before it had described itself.
    """
    if after.lifecycle == "approved" or (before is not None and before.lifecycle == "approved"):
        _buffer.note(before, after, at, time.monotonic())


def write_samples(*, changes: Sequence[tuple[DeviceView, DeviceView]], at: datetime) -> None:
    """Take in what is new of devices, (before, after), and write it at once: where nobody would write it later.

    What the database does not take now goes with what is written here next.
    """
    for before, after in changes:
        note_samples(before=before, after=after, at=at)
    if changes:
        flush_samples(all_of_it=True)


def write_when_committed(*, before: DeviceView, after: DeviceView, at: datetime) -> None:
    """Write what is new of a device once the transaction holds, in a process that hears no devices."""
    transaction.on_commit(lambda: write_samples(changes=[(before, after)], at=at))


def flush_samples(*, all_of_it: bool = False) -> int:
    """Write what has been gathered for a while, or all of it; return how many rows that were."""
    taken = _buffer.take(time.monotonic(), all_of_it=all_of_it)
    if not taken:
        return 0
    try:
        _write(taken)
    except (DatabaseError, InterfaceError) as error:
        log.warning("Samples wait: the database does not take them now: %s", error)
        _buffer.give_back(taken, time.monotonic())
        return 0
    return len(taken)


_ROW = "(%s, %s, %s, %s, %s, %s, %s, %s)"
_INSERT = "INSERT INTO registry_sample (device_id, property, minute, value, minimum, maximum, at_ms, seq) VALUES "
_JOIN = """
ON CONFLICT (device_id, property, minute) DO UPDATE SET
    value = CASE WHEN excluded.at_ms >= registry_sample.at_ms THEN excluded.value ELSE registry_sample.value END,
    at_ms = CASE WHEN excluded.at_ms >= registry_sample.at_ms THEN excluded.at_ms ELSE registry_sample.at_ms END,
    seq = excluded.seq,
    minimum = CASE WHEN registry_sample.minimum < excluded.minimum THEN registry_sample.minimum
              ELSE COALESCE(excluded.minimum, registry_sample.minimum) END,
    maximum = CASE WHEN registry_sample.maximum > excluded.maximum THEN registry_sample.maximum
              ELSE COALESCE(excluded.maximum, registry_sample.maximum) END
"""


def _write(taken: dict[Key, Bucket]) -> None:
    """Write rows in the order of their times; the clock's row is locked meanwhile, so numbers appear in order."""
    rows = sorted(taken.items(), key=lambda item: item[1].at_ms)
    with transaction.atomic(), connection.cursor() as cursor:
        known = set(Device.objects.filter(id__in={key[0] for key in taken}).values_list("id", flat=True))
        first = _take_numbers(len(rows))
        values = [
            (device, name, minute, json.dumps(b.value), b.minimum, b.maximum, b.at_ms, first + offset)
            for offset, ((device, name, minute), b) in enumerate(rows)
            if device in known
        ]
        for begin in range(0, len(values), ROWS_AT_ONCE):
            part = values[begin : begin + ROWS_AT_ONCE]
            cursor.execute(_INSERT + ", ".join([_ROW] * len(part)) + _JOIN, [field for row in part for field in row])


def _take_numbers(count: int) -> int:
    """Return the first of so many numbers that nobody else gets.

    They follow the clock on the wall, in milliseconds: a restored backup, which knows an older number, gives none anew.
    """
    SampleClock.objects.get_or_create(pk=1)
    at_least = Greatest(F("next"), int(time.time() * 1000))
    SampleClock.objects.filter(pk=1).update(next=at_least + count)
    return SampleClock.objects.get(pk=1).next - count


def first_minute(now: datetime) -> int:
    """Return the first minute since 1970 of which everything is kept."""
    return int((now - KEPT_FOR).timestamp() // 60)


def prune_samples(*, now: datetime) -> bool:
    """Forget what is older than seven days, save what held when they began; False if not all could be forgotten yet."""
    first, began = first_minute(now), time.monotonic()
    while _forget_followed(first) == PRUNE_AT_ONCE:
        if time.monotonic() - began >= PRUNE_S:
            return False
    _forget_undescribed(first)
    return True


def _forget_followed(first: int) -> int:
    """Forget old rows, so many at once, that another old one of the same property follows; return how many."""
    old = Sample.objects.filter(minute__lt=first)
    same = old.filter(device=OuterRef("device"), property=OuterRef("property")).order_by("-minute")
    followed = old.filter(minute__lt=Subquery(same.values("minute")[:1])).order_by("minute")
    return Sample.objects.filter(pk__in=followed.values("pk")[:PRUNE_AT_ONCE]).delete()[0]


def _forget_undescribed(first: int) -> None:
    """Forget the old rows of what a device no longer describes, where it has many: its names may be others each day."""
    old = Sample.objects.filter(minute__lt=first).order_by()
    many = old.values("device").annotate(rows=Count("pk")).filter(rows__gt=MOST_KEPT_BEFORE)
    for device in Device.objects.filter(pk__in=many.values("device")).defer("source"):
        told = (
            {p.name for p in effective_description(device).properties[:MOST_PROPERTIES]} if device.description else ()
        )
        old.filter(device=device).exclude(property__in=[*told, DONE, ONLINE]).delete()

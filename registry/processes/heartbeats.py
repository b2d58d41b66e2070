"""Heartbeats as others read them: who beats, who is silent, who has said goodbye."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from typing import Any, Literal

from django.db.models import DateTimeField, ExpressionWrapper, F
from django.db.models.functions import Now
from django.db.models.query import QuerySet

from registry.models import Heartbeat

SILENT_AFTER = timedelta(seconds=10)
FORGOTTEN_AFTER = timedelta(minutes=15)
"""So long after its last beat a process is no longer shown."""
ProcessState = Literal["beats", "silent", "ended"]


@dataclass(frozen=True, slots=True)
class ProcessView:
    """A process as it was seen at `now`, by the database's clock; `counters` are empty unless they were asked for."""

    id: str
    kind: str
    name: str
    machine: str
    process: int
    version: str
    activity: str
    since: datetime
    at: datetime
    now: datetime
    ended_at: datetime | None = None
    clock_apart_s: float | None = None
    counters: Mapping[str, Any] = field(default_factory=dict)

    @property
    def age_s(self) -> float:
        """How long ago the last beat was, in seconds."""
        return max(0.0, (self.now - self.at).total_seconds())

    @property
    def state(self) -> ProcessState:
        """Whether it works, as far as is known."""
        if self.ended_at is not None:
            return "ended"
        return "silent" if self.now - self.at > SILENT_AFTER else "beats"


def list_processes(*, with_counters: bool = False) -> tuple[ProcessView, ...]:
    """Return the processes that beat within the last 15 minutes, by kind and name, with one question."""
    rows = _not_older_than(FORGOTTEN_AFTER).annotate(now=Now()).order_by("kind", "name", "since")
    return tuple(_view(row) for row in (rows if with_counters else rows.defer("counters")))


def read_time() -> datetime:
    """Return what time it is by the database's clock."""
    clock = Heartbeat.objects.annotate(now=Now()).values_list("now", flat=True).order_by()
    found: datetime | None = clock.first()
    return found or datetime.now(UTC)


def forget_predecessors(*, kind: str, name: str) -> None:
    """Forget those of this name that are silent or ended: whoever begins now has taken their place."""
    silent = Heartbeat.objects.filter(kind=kind, name=name).exclude(pk__in=_beating().values("pk"))
    silent.delete()


def prune_processes() -> int:
    """Forget those that nobody has heard of for 15 minutes; return how many."""
    there = _not_older_than(FORGOTTEN_AFTER)
    return Heartbeat.objects.exclude(pk__in=there.values("pk")).delete()[0]


def _not_older_than(age: timedelta) -> QuerySet[Heartbeat]:
    """Return the rows whose last beat is not older; Django writes the age in the way of each database."""
    due = ExpressionWrapper(F("at") + age, output_field=DateTimeField())
    return Heartbeat.objects.annotate(due=due).filter(due__gte=Now())


def _beating() -> QuerySet[Heartbeat]:
    return _not_older_than(SILENT_AFTER).filter(ended_at=None)


def _view(row: Any) -> ProcessView:
    names = ("kind", "name", "machine", "process", "version", "activity", "since", "at", "ended_at", "clock_apart_s")
    deferred = row.get_deferred_fields()
    counters = {} if "counters" in deferred else row.counters
    return ProcessView(id=str(row.pk), now=row.now, counters=counters, **{name: getattr(row, name) for name in names})


def kinds_of(processes: Iterable[ProcessView], state: ProcessState) -> frozenset[str]:
    """Return the kinds of which some process is in this state."""
    return frozenset(process.kind for process in processes if process.state == state)

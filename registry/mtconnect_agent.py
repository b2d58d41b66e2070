"""A site as an MTConnect agent: what is asked of it becomes a document, what is asked wrongly an error document."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import datetime, timedelta

from django.db.models import Max, QuerySet

from registry import mtconnect
from registry.joining import list_devices
from registry.models import Sample, SampleClock
from registry.mtconnect import Agent, ErrorCode, Observation, Sequences
from registry.sites import find_site
from registry.views import DeviceView

DEFAULT_COUNT = 100
MOST_COUNT = 5_000
LATELY = timedelta(hours=1)
"""Readings that have not changed for so long have the first number that can be asked for."""


class AgentError(Exception):
    """What is asked wrongly: a code of MTConnect's, and a sentence."""

    def __init__(self, code: ErrorCode, sentence: str) -> None:
        super().__init__(sentence)
        self.code, self.sentence = code, sentence


def agent_of(*, site: str, now: datetime) -> Agent:
    """Return who answers for a site."""
    return Agent(site, int(find_site(site).created_at.timestamp()), now)


def _devices(site: str) -> tuple[DeviceView, ...]:
    devices = list_devices(site=site, lifecycle="approved")
    if not devices:
        raise AgentError("NO_DEVICE", "This site has no approved device yet.")
    return devices


def probe_site(*, agent: Agent) -> bytes:
    """Return which devices there are. Raises AgentError."""
    return mtconnect.write_devices(agent, _devices(agent.site))


def current_of_site(*, agent: Agent) -> bytes:
    """Return how the devices are. Raises AgentError."""
    devices = _devices(agent.site)
    since = int((agent.at - LATELY).timestamp() // 60)
    lately = _rows(agent.site).filter(minute__gte=since).values_list("device_id", "property")
    latest = lately.annotate(Max("at_ms"), Max("seq"))
    numbers = (Observation(device, name, "", at_ms, seq) for device, name, at_ms, seq in latest)
    first, following = _bounds(agent.site)
    return mtconnect.write_current(agent, Sequences(first, max(first, following - 1), following), devices, numbers)


def sample_of_site(*, agent: Agent, begin: str | None, count: str | None) -> bytes:
    """Return what the devices have said from a sequence number on, so many observations at most. Raises AgentError."""
    devices = _devices(agent.site)
    first, following = _bounds(agent.site)
    start, most = _whole("from", begin, first), _whole("count", count, DEFAULT_COUNT)
    if not first <= start <= following:
        raise AgentError("OUT_OF_RANGE", f"`from` must lie between {first} and {following}, not at {start}.")
    if not 1 <= most <= MOST_COUNT:
        raise AgentError("OUT_OF_RANGE", f"`count` must lie between 1 and {MOST_COUNT}, not at {most}.")
    shown = list(_observations(_rows(agent.site).filter(seq__gte=start, seq__lt=following).order_by("seq")[:most]))
    going_on = shown[-1].sequence + 1 if len(shown) == most else following
    return mtconnect.write_samples(agent, Sequences(first, max(first, following - 1), going_on), devices, shown)


def _whole(name: str, text: str | None, default: int) -> int:
    if text is None:
        return default
    if not text.isascii() or not text.removeprefix("-").isdigit() or len(text) > 18:
        raise AgentError("INVALID_REQUEST", f"`{name}` must be a whole number, not {text[:40]!r}.")
    return int(text)


def _rows(site: str) -> QuerySet[Sample]:
    return Sample.objects.filter(device__site__slug=site, device__lifecycle="approved")


def _bounds(site: str) -> tuple[int, int]:
    """Return the first number that is kept, and the one that the next observation will have."""
    clock = SampleClock.objects.filter(pk=1).first()
    following = clock.next if clock else 1
    oldest = _rows(site).order_by("seq").values_list("seq", flat=True).first()
    return oldest or following, following


def _observations(rows: Iterable[Sample]) -> Iterable[Observation]:
    for row in rows:
        yield Observation(row.device_id, row.property, row.value, row.at_ms, row.seq)

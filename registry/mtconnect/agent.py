"""A site as an MTConnect agent: what is asked of it becomes a document, what is asked wrongly an error document."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta

from django.db import connection
from django.db.models import Max, Q, QuerySet

from registry.devices.queries import get_device, list_devices
from registry.devices.rows import NoSuchDevice
from registry.devices.samples import DONE, ONLINE, first_minute
from registry.devices.views import DeviceView
from registry.models import Sample, SampleClock
from registry.mtconnect import documents
from registry.mtconnect.data_items import items_of
from registry.mtconnect.documents import Agent, ErrorCode, Observation, Sequences, Situation
from registry.mtconnect.xpath import BadPath, choose, read_path
from registry.sites.sites import find_site
from vipo_device.protocol.description import Scalar

DEFAULT_COUNT = 100
MOST_COUNT = 5_000
LATELY = timedelta(hours=1)
"""Readings that have not changed for so long have the first number that can be asked for."""


class AgentError(Exception):
    """What is asked wrongly: a code of MTConnect's, and a sentence."""

    def __init__(self, code: ErrorCode, sentence: str) -> None:
        super().__init__(sentence)
        self.code, self.sentence = code, sentence


@dataclass(frozen=True, slots=True)
class Question:
    """What is asked, as texts: of which device (its name or uuid; empty: of all), which items, and of when."""

    device: str = ""
    path: str | None = None
    begin: str | None = None
    count: str | None = None
    at: str | None = None


@dataclass(frozen=True, slots=True)
class Answer:
    """A document, and with which number to go on."""

    document: bytes
    next: int


def agent_of(*, site: str, now: datetime) -> Agent:
    """Return who answers for a site."""
    return Agent(site, int(find_site(site).created_at.timestamp()), now)


def probe_site(agent: Agent, question: Question) -> Answer:
    """Return which devices there are. Raises AgentError."""
    return Answer(documents.write_devices(agent, _devices(agent.site, question.device)), 1)


def current_of_site(agent: Agent, question: Question) -> Answer:
    """Return how the devices are, or how they were when an observation was made. Raises AgentError."""
    devices = _devices(agent.site, question.device)
    wanted = _wanted(devices, question.path)
    first, following = _bounds(agent)
    sequences = Sequences(first, max(first, following - 1), following)
    situation = Situation(devices, _numbers(agent, devices if question.device else ()))
    if question.at is not None:
        situation = look_back(devices, whole("at", question.at, first, first, sequences.last))
    return Answer(documents.write_current(agent, sequences, situation, wanted), following)


def sample_of_site(agent: Agent, question: Question) -> Answer:
    """Return what the devices have said from a sequence number on, so many observations at most. Raises AgentError."""
    devices = _devices(agent.site, question.device)
    wanted = _wanted(devices, question.path)
    first, following = _bounds(agent)
    start = whole("from", question.begin, first, first, following)
    most = whole("count", question.count, DEFAULT_COUNT, 1, MOST_COUNT)
    rows = _rows(agent.site).filter(_chosen(devices, wanted), seq__gte=start, seq__lt=following)
    shown = list(_observations(rows.order_by("seq")[:most]))
    going_on = shown[-1].sequence + 1 if len(shown) == most else following
    sequences = Sequences(first, max(first, following - 1), going_on)
    return Answer(documents.write_samples(agent, sequences, devices, shown, wanted), going_on)


def next_number() -> int:
    """Return the number that the next observation will have."""
    clock = SampleClock.objects.filter(pk=1).first()
    return clock.next if clock else 1


def whole(name: str, text: str | None, default: int, least: int, most: int) -> int:
    """Read a whole number within limits. Raises AgentError."""
    if text is None:
        return default
    if not text.isascii() or not text.removeprefix("-").isdigit() or len(text) > 18:
        raise AgentError("INVALID_REQUEST", f"`{name}` must be a whole number, not {text[:40]!r}.")
    if not least <= int(text) <= most:
        raise AgentError("OUT_OF_RANGE", f"`{name}` must lie between {least} and {most}, not at {int(text)}.")
    return int(text)


def _devices(site: str, named: str) -> tuple[DeviceView, ...]:
    if named:
        return (_device(site, named),)
    devices = list_devices(site=site, lifecycle="approved")
    if not devices:
        raise AgentError("NO_DEVICE", "This site has no approved device yet.")
    return devices


def _device(site: str, named: str) -> DeviceView:
    try:
        view = get_device(site=site, device_id=named.removeprefix(documents.uuid_of("")))
    except NoSuchDevice:
        view = None
    if view is None or view.lifecycle != "approved":
        raise AgentError("NO_DEVICE", f"This site has no approved device {named[:80]!r}. `probe` lists those it has.")
    return view


def _wanted(devices: Iterable[DeviceView], path: str | None) -> set[str]:
    """Return the ids of the items that a path chooses. Raises AgentError."""
    if path is None:
        return {item.id for view in devices for item in items_of(view)}
    try:
        wanted = choose(read_path(path), documents.document_of(devices))
    except BadPath as error:
        raise AgentError("INVALID_PATH", str(error)) from error
    if not wanted:
        raise AgentError("INVALID_PATH", "`path` chooses nothing that the devices tell. `probe` shows what they tell.")
    return wanted


def _chosen(devices: Iterable[DeviceView], wanted: set[str]) -> Q:
    """Return which rows belong to the items; devices of which the same is asked go together."""
    together: defaultdict[frozenset[str], list[str]] = defaultdict(list)
    for view in devices:
        together[frozenset(item.source for item in items_of(view) if item.id in wanted)].append(view.id)
    rows = Q(pk__in=())
    for names, ids in together.items():
        rows |= Q(device_id__in=ids, property__in=names)
    return rows


def _rows(site: str) -> QuerySet[Sample]:
    return Sample.objects.filter(device__site__slug=site, device__lifecycle="approved")


def _numbers(agent: Agent, devices: Sequence[DeviceView]) -> Iterable[Observation]:
    """Give the numbers of what was told lately, by these devices or (none given) by all."""
    since = int((agent.at - LATELY).timestamp() // 60)
    lately = _rows(agent.site).filter(minute__gte=since)
    if devices:
        lately = lately.filter(device_id__in=[view.id for view in devices])
    newest = lately.values_list("device_id", "property").annotate(Max("at_ms"), Max("seq"))
    for device, name, at_ms, seq in newest:
        yield Observation(device, name, "", at_ms, seq)


def _bounds(agent: Agent) -> tuple[int, int]:
    """Return the number from which on everything is kept, and the one that the next observation will have.

    All sites share the numbers: where this one was silent, what others said is kept no shorter.
    """
    following = next_number()
    kept = Sample.objects.filter(minute__gte=first_minute(agent.at)).order_by("minute", "seq")
    return kept.values_list("seq", flat=True).first() or following, following


def _observations(rows: Iterable[Sample]) -> Iterable[Observation]:
    for row in rows:
        yield Observation(row.device_id, row.property, row.value, row.at_ms, row.seq)


AT_ONCE = 100
_ONE = (
    "SELECT * FROM (SELECT device_id, property, value, at_ms, seq FROM registry_sample "
    "WHERE device_id = %s AND property = %s AND seq <= %s AND minute <= %s ORDER BY minute DESC LIMIT 1) AS last"
)


def look_back(devices: Sequence[DeviceView], sequence: int) -> Situation:
    """Return how devices were at a sequence number; a reading of which nothing is kept until then has no value."""
    row = Sample.objects.filter(seq__lte=sequence).order_by("-seq").first()
    minute, at_ms = (row.minute, row.at_ms) if row else (0, 0)
    names = [(view.id, item.source) for view in devices for item in items_of(view) if item.source]
    seen = tuple(_last_rows(names, sequence, minute + 1))
    readings: dict[str, dict[str, Scalar]] = {view.id: {} for view in devices}
    for o in seen:
        readings[o.device][o.property] = json.loads(o.value)
    at = datetime.fromtimestamp(at_ms / 1000, UTC)
    return Situation(tuple(_as_it_was(view, readings[view.id], at) for view in devices), seen, placed=False)


def _as_it_was(view: DeviceView, told: dict[str, Scalar], at: datetime) -> DeviceView:
    online, done = told.pop(ONLINE, False), told.pop(DONE, True)
    return replace(view, online=bool(online), done=bool(done), readings=told, last_seen_at=at)


def _last_rows(names: Sequence[tuple[str, str]], sequence: int, minute: int) -> Iterator[Observation]:
    """Give the last observation of each reading; the index that each row is found by stands in the constraint."""
    with connection.cursor() as cursor:
        for begin in range(0, len(names), AT_ONCE):
            part = names[begin : begin + AT_ONCE]
            asked = [value for device, name in part for value in (device, name, sequence, minute)]
            cursor.execute(" UNION ALL ".join([_ONE] * len(part)), asked)
            for device, name, value, at_ms, seq in cursor.fetchall():
                yield Observation(device, name, value, at_ms, seq)

"""What devices say of themselves is kept: many descriptions with a few statements, each with a fate of its own.

What cannot be read is refused before anything is locked; rows are locked in the order of their ids. Where the
registry refuses one of many within the transaction, it is rolled back, and each is taken in by itself.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from django.conf import settings
from django.db import connection, transaction

from registry.devices.history import MOST_CHARACTERS, describe_change, history_text, line_of_history, write_lines
from registry.devices.legacy_topics import claim_topics
from registry.devices.rows import BadDevice, NoSuchDevice, announce_all, check_id
from registry.devices.samples import note_samples
from registry.devices.views import DeviceView, view_of
from registry.models import Device, DeviceEvent, Site, TopicClaim
from registry.sites.namespaces import OF_IDS, find_foreign
from vipo_device.descriptions.changes import list_changes
from vipo_device.descriptions.forms import CONTENT_TYPES
from vipo_device.descriptions.reader import Reading, hash_of_json, read, source_hash
from vipo_device.protocol.description import description_from_json, description_to_json
from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.faults import Fault, facts_of, refusal_facts
from vipo_device.protocol.topics import list_legacy_methods

MOST_LINES = 8
SEEN_EVERY = timedelta(seconds=5)
WRITE_DESCRIPTION = """
    UPDATE registry_device SET site_id = %s, done = %s, description = %s, description_hash = %s, source = %s,
    source_hash = %s, source_type = %s, first_seen_at = %s, last_seen_at = %s WHERE id = %s
"""


@dataclass(frozen=True, slots=True)
class DescriptionMessage:
    """A description that came in."""

    device_id: str
    payload: bytes
    at: datetime


@dataclass(frozen=True, slots=True)
class _News:
    """A description that was read and may be kept."""

    said: DescriptionMessage
    reading: Reading


Fate = DeviceView | VipoError
"""The device as it is now, or why its description was refused."""


def find_unchanged(*, descriptions: Mapping[str, bytes], at: datetime) -> frozenset[str]:
    """Return which of these devices have described themselves in these very bytes before, and note that they spoke."""
    digests = {device: source_hash(payload) for device, payload in descriptions.items()}
    rows = Device.objects.filter(pk__in=list(digests), description__isnull=False)
    known = rows.values_list("pk", "source_hash", "last_seen_at")
    same = {device: seen for device, digest, seen in known if digests[device] == digest}
    quiet = [device for device, seen in same.items() if seen is None or at - seen >= SEEN_EVERY]
    if quiet:
        Device.objects.filter(pk__in=quiet).update(last_seen_at=at)
    return frozenset(same)


def ingest_description(*, device_id: str, payload: bytes, at: datetime) -> DeviceView:
    """Take in what a device says of itself; an unknown one becomes pending. Raises BadDescription, BadDevice."""
    digest = source_hash(payload)
    known = Device.objects.filter(pk=device_id, source_hash=digest, description__isnull=False).select_related("site")
    if known.update(last_seen_at=at):
        device = known.get()
        return view_of(device, device.site.slug)
    (fate,) = ingest_descriptions(descriptions=[DescriptionMessage(device_id, payload, at)])
    if isinstance(fate, VipoError):
        raise fate
    return fate


def ingest_descriptions(*, descriptions: Sequence[DescriptionMessage]) -> tuple[Fate, ...]:
    """Take in descriptions of different devices, at most one of each; return what came of each, in the same order."""
    fates: dict[str, Fate] = {}
    found: list[_News] = []
    for each in descriptions:
        try:
            check_id(each.device_id)
            found.append(_News(each, read(each.payload, device_id=each.device_id)))
        except VipoError as error:
            fates[each.device_id] = error
    sites = _find_sites(found)
    homeless = _make_rows(found, sites)
    together, alone = _part([news for news in found if news.said.device_id not in homeless])
    for some in (together, *([news] for news in alone)):
        fates |= _take(some, sites)
    return tuple((fates | homeless)[each.device_id] for each in descriptions)


def _part(found: Sequence[_News]) -> tuple[list[_News], list[_News]]:
    """Set aside those who ask for topics that are not theirs yet, which others may have."""
    asking = {news.said.device_id: {m.topic for m in list_legacy_methods(news.reading.description)} for news in found}
    who = [device for device, topics in asking.items() if topics]
    claims = TopicClaim.objects.filter(device__in=who).values_list("device", "topic") if who else ()
    for device, topic in claims:
        asking[device].discard(topic)
    alone = [news for news in found if asking[news.said.device_id]]
    return [news for news in found if not asking[news.said.device_id]], alone


def _find_sites(found: Sequence[_News]) -> dict[str, Site]:
    slugs = {news.reading.description.site for news in found} | {settings.VIPO_DEFAULT_SITE}
    return {site.slug: site for site in Site.objects.filter(slug__in=slugs)} if found else {}


def _site_for(slug: str, sites: Mapping[str, Site]) -> Site:
    site = sites.get(slug) or sites.get(settings.VIPO_DEFAULT_SITE)
    if site is None:
        raise BadDevice(*refusal_facts("no_site", site=slug[:64]))
    return site


def _make_rows(found: Sequence[_News], sites: Mapping[str, Site]) -> dict[str, Fate]:
    """Make rows for devices that nobody knows, before any is locked; return who has no site to stand at.

    Nobody comes to a site that may not give this id: whoever may connect as another site's device stays there.
    """
    ids = [news.said.device_id for news in found]
    there = set(Device.objects.filter(pk__in=ids).values_list("pk", flat=True)) if ids else set()
    rows, homeless = list[Device](), dict[str, Fate]()
    for news in sorted(found, key=lambda each: each.said.device_id):
        if news.said.device_id in there:
            continue
        try:
            site = _site_for(news.reading.description.site, sites)
        except BadDevice as error:
            homeless[news.said.device_id] = error
        else:
            rows.append(Device(pk=news.said.device_id, site=site, first_seen_at=news.said.at))
    sites_of = {row.pk: row.site for row in rows}
    for name in find_foreign(sites_of, OF_IDS):
        homeless[name] = BadDevice(*refusal_facts("id_of_site", device=name, site=sites_of[name].slug))
    Device.objects.bulk_create([row for row in rows if row.pk not in homeless], ignore_conflicts=True)
    return homeless


def _take(some: list[_News], sites: Mapping[str, Site]) -> dict[str, Fate]:
    if not some:
        return {}
    said = {news.said.device_id: news for news in some}
    try:
        with transaction.atomic():
            fates, changes = _take_locked(said, sites)
    except VipoError as error:
        if len(some) == 1:
            return {some[0].said.device_id: error}
    else:
        for before, after in changes:
            note_samples(before=before, after=after, at=said[after.id].said.at)
        return fates
    return {device: fate for news in some for device, fate in _take([news], sites).items()}


def _take_locked(
    some: Mapping[str, _News], sites: Mapping[str, Site]
) -> tuple[dict[str, Fate], list[tuple[DeviceView | None, DeviceView]]]:
    fates: dict[str, Fate] = {name: NoSuchDevice(f"The device {name} was taken away.") for name in some}
    rows = _lock_rows(list(some))
    changes: list[tuple[DeviceView | None, DeviceView]] = []
    lines: list[DeviceEvent] = []
    for device in rows:
        news = some[device.pk]
        before = view_of(device, device.site.slug) if device.description else None
        lines += _describe(device, news, sites)
        fates[device.pk] = after = view_of(device, device.site.slug)
        changes.append((before, after))
    _write(rows)
    write_lines(lines)
    announce_all(changes)
    return fates, changes


def _lock_rows(ids: list[str]) -> list[Device]:
    rows = Device.objects.select_for_update(of=("self",)).select_related("site").filter(pk__in=ids)
    return list(rows.defer("source").order_by("pk"))


def _describe(device: Device, news: _News, sites: Mapping[str, Site]) -> list[DeviceEvent]:
    """Put a description into its row, and return the lines for the history, oldest first."""
    description, form, at = news.reading.description, news.reading.form, news.said.at
    before, after = device.description, description_to_json(description)
    old = description_from_json(before) if before else None
    claim_topics(device, old, description, at)
    if form == "paper" and before and before.get("done") != after.get("done"):
        device.done = description.done
    device.description, device.description_hash = after, hash_of_json(after)
    device.source, device.source_hash = news.said.payload, source_hash(news.said.payload)
    device.source_type = CONTENT_TYPES[form]
    device.first_seen_at, device.last_seen_at = device.first_seen_at or at, at
    if not (words := describe_change(old, description)):
        return []
    news_line = line_of_history(device, at, "described", words, changes=list_changes(before, after) if before else ())
    packs = reversed(_packed(news.reading.notes))
    mended = [history_text("mended", text=" ".join(n.text for n in pack), **facts_of(pack)) for pack in packs]
    return [news_line, *(line_of_history(device, at, "mended", words) for words in mended)]


def _write(devices: list[Device]) -> None:
    """Write the rows with one prepared statement, only what a description changes."""
    when = connection.ops.adapt_datetimefield_value
    rows: list[tuple[Any, ...]] = [
        (d.site_id, d.done, json.dumps(d.description), d.description_hash, d.source, d.source_hash, d.source_type,
         when(d.first_seen_at), when(d.last_seen_at), d.pk)
        for d in devices
    ]  # fmt: skip
    with connection.cursor() as cursor:
        cursor.executemany(WRITE_DESCRIPTION, rows)


def _packed(notes: tuple[Fault, ...]) -> list[list[Fault]]:
    """Put what was mended into few lines of history, none longer than one may be."""
    packs: list[list[Fault]] = []
    for note in notes:
        if packs and sum(len(each.text) + 1 for each in packs[-1]) + len(note.text) <= MOST_CHARACTERS:
            packs[-1].append(note)
        elif len(packs) < MOST_LINES:
            packs.append([note])
    return packs

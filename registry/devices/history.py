"""A device's history: which lines there are, an English sentence each, and what a screen says them from elsewhere.

The newest 200 lines of each device are kept, and besides them 100 each of the kinds that a device can have written as
often as it likes: that it came and left, what it reported, how it describes itself. So it pushes nothing else out.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from datetime import datetime, timedelta
from typing import Any

from django.db.models import Count, Q

from registry.audit.record import note_act
from registry.models import Device, DeviceEvent, User
from vipo_device.descriptions.changes import Change
from vipo_device.protocol.description import Description

MOST_EVENTS = 200
MOST_OF_NOISY = 100
COMINGS = frozenset({"online", "offline", "flapping"})
REPORTS = frozenset({"problem", "error", "recovered", "map"})
DAMPED = frozenset({"described", "mended", "topic_asked", "topic_withdrawn"})
"""What a device can have written as often as it likes, by saying something else of itself each time."""
_IS_DAMPED = Q(kind__in=DAMPED, by=None)
_NOISY = (Q(kind__in=COMINGS), Q(kind__in=REPORTS), _IS_DAMPED)
_LIMITS = ((~(_NOISY[0] | _NOISY[1] | _NOISY[2]), MOST_EVENTS), *((noisy, MOST_OF_NOISY) for noisy in _NOISY))
"""Which lines of a history are counted together, and how many of them are kept."""
MOST_DAMPED, DAMPED_FOR = 10, timedelta(minutes=10)
EVENTS_TO_SPARE = 20
"""How many more a history may have before it is cut, where many devices speak at once."""
MOST_CHARACTERS = 300
SENTENCES: Mapping[str, str] = {
    "expected": "Added, and given a key",
    "approved": "Approved",
    "rejected": "Rejected",
    "retired": "Retired",
    "readmitted": "May come back",
    "revoked": "Its key was revoked",
    "credential": "New key given",
    "knocked": "Enrolled with the enrolment key and brought a key of its own",
    "online": "Came online",
    "offline": "Left",
    "silent": "Said nothing for {seconds} s",
    "flapping": "Comes and leaves all the time; not every time is written down",
    "error": "Reports an error: {text}",
    "recovered": "Reports no error any more",
    "described_often": "Describes itself anew all the time; not every time is written down",
    "simulated": "Simulated from now on; the device itself is told nothing",
    "real_again": "Not simulated any more",
    "problem": "{text}",
    "mended": "{text}",
    "renamed": "Renamed from {before} to {after}",
    "moved": "Moved to {x:.2f}, {y:.2f}",
    "own_place": "Stands where it says itself again: {x:.2f}, {y:.2f}",
    "map": "Sent its map: {width} by {height} m",
    "topic_asked": "Asks for the topic {topic} for {method}",
    "topic_confirmed": "The topic {topic} was confirmed for {method}",
    "topic_withdrawn": "The topic {topic} for {method} was withdrawn",
    "described_first": "Described itself for the first time: {name}, {class}",
}
"""The English of each code that is one sentence; a changed description is put together of `PARTS`."""
PARTS: Mapping[str, str] = {
    "added_method": "added method {name}",
    "removed_method": "removed method {name}",
    "added_property": "added property {name}",
    "removed_property": "removed property {name}",
    "called": "calls itself {name}",
    "stands": "says it stands at {x:.2f}, {y:.2f}",
    "changed": "changed its description",
}
MOST_PARTS = 20


@dataclass(frozen=True, slots=True)
class HistoryText:
    """A line of history in English, with its code and arguments."""

    text: str
    code: str = ""
    args: Mapping[str, Any] = field(default_factory=dict)


def history_text(code: str, **args: Any) -> HistoryText:
    """Return the line of a code with its arguments."""
    return HistoryText(SENTENCES[code].format_map(args), code, args)


def describe_change(before: Description | None, after: Description) -> HistoryText | None:
    """Say what changed in a description; None when its meaning is the same."""
    if before is None:
        return history_text("described_first", name=after.name, **{"class": after.device_class or after.kind})
    parts = _parts(before, after)
    if not parts and replace(before, done=after.done) != after:
        parts = [{"code": "changed"}]
    text = "; ".join(PARTS[part["code"]].format_map(part) for part in parts)
    return HistoryText(text[:1].upper() + text[1:], "described", {"parts": parts[:MOST_PARTS]}) if parts else None


def _parts(before: Description, after: Description) -> list[dict[str, Any]]:
    parts = [
        *_names("method", [m.name for m in before.methods], [m.name for m in after.methods]),
        *_names("property", [p.name for p in before.properties], [p.name for p in after.properties]),
    ]
    if before.name != after.name:
        parts.append({"code": "called", "name": after.name})
    if before.pose != after.pose:
        parts.append({"code": "stands", "x": after.pose.x, "y": after.pose.y})
    return parts


def _names(what: str, before: list[str], after: list[str]) -> list[dict[str, Any]]:
    added, gone = [n for n in after if n not in before], [n for n in before if n not in after]
    return [
        *({"code": f"added_{what}", "name": name} for name in added),
        *({"code": f"removed_{what}", "name": name} for name in gone),
    ]


def line_of_history(
    device: Device,
    at: datetime,
    kind: str,
    words: HistoryText | str,
    by: User | None = None,
    *,
    changes: tuple[Change, ...] = (),
) -> DeviceEvent:
    """Return a line of a device's history, which is not written yet; bare words have no code."""
    line = words if isinstance(words, HistoryText) else HistoryText(words)
    told = {"text": line.text[:MOST_CHARACTERS], "code": line.code, "args": dict(line.args)}
    differences = [asdict(change) for change in changes]
    return DeviceEvent(device=device, at=at, kind=kind, by=by, changes=differences, **told)


def write_event(
    device: Device,
    at: datetime,
    kind: str,
    words: HistoryText | str,
    by: User | None = None,
    *,
    changes: tuple[Change, ...] = (),
) -> None:
    """Add a line of history and forget the oldest that are too many; leave out what a device says all the time."""
    for line in _damped([line_of_history(device, at, kind, words, by, changes=changes)]):
        line.save(force_insert=True)
        _forget_old(device.pk, *_limit_of(line))


def write_lines(lines: Sequence[DeviceEvent]) -> None:
    """Add lines of history of many devices, oldest first; old ones are forgotten where there are 20 too many."""
    lines = _damped(lines)
    if not lines:
        return
    DeviceEvent.objects.bulk_create(lines)
    kept = DeviceEvent.objects.filter(device__in={line.device_id for line in lines}).order_by()
    for those, most in {_limit_of(line) for line in lines}:
        counts = kept.filter(those).values_list("device").annotate(lines=Count("pk"))
        for device_id, _ in counts.filter(lines__gt=most + EVENTS_TO_SPARE):
            _forget_old(device_id, those, most)


def _damped(lines: Sequence[DeviceEvent]) -> list[DeviceEvent]:
    """Leave out lines by which a device would push its other history out: ten within ten minutes are kept.

    The tenth says that there may be more.
    """
    spoken = {line.device_id for line in lines if _is_damped(line)}
    if not spoken:
        return list(lines)
    since = max(line.at for line in lines) - DAMPED_FOR
    lately = DeviceEvent.objects.filter(device__in=spoken, at__gt=since, kind__in=DAMPED, by=None).order_by()
    counts = Counter(dict(lately.values_list("device").annotate(lines=Count("pk"))))
    kept = []
    for line in lines:
        counts[line.device_id] += _is_damped(line)
        if not _is_damped(line) or counts[line.device_id] < MOST_DAMPED:
            kept.append(line)
        elif counts[line.device_id] == MOST_DAMPED:
            kept.append(line_of_history(line.device, line.at, "described", history_text("described_often")))
    return kept


def _is_damped(line: DeviceEvent) -> bool:
    return line.kind in DAMPED and line.by_id is None


def _limit_of(line: DeviceEvent) -> tuple[Q, int]:
    """Return which lines are counted together with one, and how many of them are kept."""
    if _is_damped(line):
        return _LIMITS[3]
    return _LIMITS[1 if line.kind in COMINGS else 2 if line.kind in REPORTS else 0]


def _forget_old(device_id: str, those: Q, most: int) -> None:
    own = DeviceEvent.objects.filter(those, device=device_id)
    for key in list(own.order_by("-pk").values_list("pk", flat=True)[most:][:1]):
        own.filter(pk__lte=key).delete()


def note_decision(device: Device, code: str) -> None:
    """Write into the record of the site what somebody has decided about a device; whoever acts now did."""
    note_act(site_id=device.site_id, code=code, facts={"device": device.id})

"""What is written into a device's history: an English sentence, with what a screen says it from in another language."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from vipo_device.protocol.description import Description

SENTENCES: Mapping[str, str] = {
    "expected": "Added, and given a key",
    "approved": "Approved",
    "rejected": "Rejected",
    "retired": "Retired",
    "readmitted": "May come back",
    "revoked": "Its key was revoked",
    "credential": "Got a new key",
    "knocked": "Knocked with the join key and brought a key of its own",
    "online": "Came online",
    "offline": "Left",
    "silent": "HistoryText nothing for {seconds} s",
    "flapping": "Comes and leaves all the time; not every time is written down",
    "error": "Reports an error: {text}",
    "recovered": "Reports no error any more",
    "problem": "{text}",
    "mended": "{text}",
    "renamed": "Renamed from {before} to {after}",
    "moved": "Moved to {x:.2f}, {y:.2f}",
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

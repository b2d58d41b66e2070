"""What a device is doing in a few words, with what a screen says it from in another language; pure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from vipo_device.protocol.description import Description, Scalar


@dataclass(frozen=True, slots=True)
class Activity:
    """A code with its arguments, and the English words; a device's own words have the code `said`."""

    code: str = ""
    text: str = ""
    args: Mapping[str, Scalar] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Seen:
    """What is known of an approved device that is online: its readings, load, and whether it is done."""

    description: Description
    readings: Mapping[str, Scalar]
    carrying: Mapping[str, int]
    done: bool


NOTHING = Activity()
NOT_TRUSTED = Activity("not_trusted", "Not trusted yet")


def activity_of(seen: Seen) -> Activity:
    """Return what it is doing: its trouble first, then its load, then its work or what it has in store."""
    for trouble in ("error", "warning"):
        if text := seen.readings.get(trouble):
            return Activity("said", str(text), {"text": str(text)})
    if seen.carrying:
        load = sorted(seen.carrying.items())
        words = ", ".join(counted(count, name) for name, count in load)
        return Activity("carrying", f"Carrying {words}", dict(load))
    return _idle(seen) if seen.done else _busy(seen)


def _busy(seen: Seen) -> Activity:
    progress = seen.readings.get("jobStatus")
    if isinstance(progress, int | float):
        return Activity("working_percent", f"Working, {progress:.0f} %", {"percent": round(progress)})
    return Activity("driving", "Driving") if seen.description.kind == "robot" else Activity("working", "Working")


def _idle(seen: Seen) -> Activity:
    stock, slots = seen.readings.get("stock"), seen.readings.get("freeSlots")
    if isinstance(stock, int | float):
        return _stock(round(stock), seen.description.gives)
    if isinstance(slots, int | float):
        return Activity("slots", f"{slots:.0f} slots free", {"count": round(slots)})
    return Activity("ready", "Ready")


def _stock(count: int, gives: tuple[str, ...]) -> Activity:
    if len(gives) == 1:
        return Activity("stock", counted(count, gives[0]), {"count": count, "object": gives[0]})
    # Of a device that gives several things nobody knows how many of each it has.
    return Activity("objects", counted(count, "object"), {"count": count})


def counted(count: int, name: str) -> str:
    """Return `1 box`, `2 boxes`, `3 cans`."""
    plural = name + ("es" if name.endswith(("x", "s", "ch", "sh")) else "s")
    return f"{count} {name if count == 1 else plural}"

"""A site as a directory of W3C Things: which there are, what may be changed of one, and when one has changed."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from typing import Any, Literal

from registry.capability import Pose
from registry.errors import RegistryError
from registry.thing import DEVICE_URN, thing_of
from registry.views import DeviceView

EventName = Literal["thing_created", "thing_updated", "thing_deleted"]
PATCHABLE = ("title", "vipo:location")
_TELLING = (
    "kind",
    "name",
    "description",
    "image",
    "device_class",
    "size",
    "radius_m",
    "gives",
    "takes",
    "capacity",
    "simulated",
    "methods",
    "lifecycle",
)
"""What of a device, as the API says it, stands in its Thing Description, too."""


class BadThingPatch(RegistryError):
    """A change of a Thing that is no merge patch, or of what is not for people to change."""

    code = "bad_thing_patch"
    status = 400


@dataclass(frozen=True, slots=True)
class ThingPatch:
    """What people may say of a Thing; None stays as it is, an empty name is the device's own again."""

    name: str | None
    pose: Pose | None


def thing_to_json(view: DeviceView, broker: str) -> dict[str, Any]:
    """Return a device as a Thing Description, with the name and place that hold."""
    return thing_of(view.canonical, broker)


def device_id_of(thing: str) -> str:
    """Return the device's id of a Thing's, which may be given with or without its `urn:vipo:device:`."""
    return thing.removeprefix(DEVICE_URN)


def read_patch(body: bytes) -> ThingPatch:
    """Read a JSON merge patch (RFC 7396) of `title` and `vipo:location`. Raises BadThingPatch."""
    try:
        patch = json.loads(body)
    except (ValueError, RecursionError) as error:
        raise BadThingPatch('The patch is not JSON. Send a JSON object, such as {"title": "Oven"}.') from error
    if not isinstance(patch, dict) or not patch:
        raise BadThingPatch("A merge patch is a JSON object with at least one field.")
    if strange := [name for name in patch if name not in PATCHABLE]:
        raise BadThingPatch(
            f"{strange[0][:64]!r} cannot be changed here: the device says it itself. Change {' or '.join(PATCHABLE)}."
        )
    return ThingPatch(_title(patch), _pose(patch))


def _title(patch: Mapping[str, Any]) -> str | None:
    title = patch.get("title", "")
    if title is not None and not isinstance(title, str):
        raise BadThingPatch("`title` must be a text, or null for the device's own.")
    return (title or "") if "title" in patch else None


def _pose(patch: Mapping[str, Any]) -> Pose | None:
    if "vipo:location" not in patch:
        return None
    numbers = patch["vipo:location"]
    if not isinstance(numbers, list) or len(numbers) not in (2, 3, 4) or not all(map(_is_number, numbers)):
        raise BadThingPatch(
            "`vipo:location` must be [x, y, z, theta] in metres and radians; z and theta may be left out."
        )
    return Pose(*map(float, numbers))


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)


@dataclass(slots=True)
class ThingWatch:
    """Turns what is said of a site's devices into what has become of its Things."""

    known: dict[str, dict[str, Any]] = field(default_factory=dict)

    def begin(self, devices: list[dict[str, Any]]) -> None:
        """Take in the site's devices as they are now."""
        self.known = {device["id"]: _told(device, {}) for device in devices}

    def take(self, message: Mapping[str, Any]) -> tuple[EventName, str] | None:
        """Take in a live message; return what has become of which device's Thing, if anything has."""
        if message["type"] == "device_removed":
            gone = self.known.pop(message["id"], None)
            return ("thing_deleted", message["id"]) if _is_listed(gone) else None
        if message["type"] != "device":
            return None
        device = message["device"]
        before = self.known.get(device["id"])
        after = _told(device, before or {})
        self.known[device["id"]] = after
        if _is_listed(after):
            changed: EventName = "thing_updated" if _is_listed(before) else "thing_created"
            return (changed, device["id"]) if after != before else None
        return ("thing_deleted", device["id"]) if _is_listed(before) else None


def _is_listed(told: Mapping[str, Any] | None) -> bool:
    return told is not None and told.get("lifecycle") == "approved"


def _told(device: Mapping[str, Any], before: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the Thing says, after a change: not readings, and not where a robot drives."""
    after = {**before, **{name: device[name] for name in _TELLING if name in device}}
    if "properties" in device:
        after["properties"] = [{k: v for k, v in each.items() if k != "value"} for each in device["properties"]]
    if "location" in device and after.get("kind") == "machine":
        after["location"] = device["location"]
    return after

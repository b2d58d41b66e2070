"""A site as plain JSON and back: what a program file holds beside its document."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, get_args

from editor.language.site.signature import signature_from_json, signature_to_json
from editor.language.site.surroundings import (
    DeviceFacts,
    FloorFacts,
    LibraryFacts,
    PlaceFacts,
    Surroundings,
    ZoneFacts,
    ZoneRule,
)
from vipo_device.protocol.description import description_from_json, description_to_json

LIFECYCLES = ("pending", "approved", "retired")
PLACE_KINDS = ("dock", "room", "point")
ZONE_RULES: tuple[ZoneRule, ...] = get_args(ZoneRule)
"""What zones of a site's floor ask; passages of doors belong to programs."""
MOST_ROBOTS = 20
FEWEST_CORNERS = 3
_STATE = frozenset({"lifecycle", "online", "readings", "standing_at"})


class UnreadableSite(ValueError):
    """The JSON is no site; the message says what is wrong with it."""


def surroundings_to_json(surroundings: Surroundings) -> dict[str, Any]:
    """Return a site as plain JSON: `devices` (canonical descriptions, with how they are), `places`, `zones` if any."""
    devices = [_device_to_json(facts) for _, facts in sorted(surroundings.devices.items())]
    body = {"devices": devices, "places": [_place_to_json(p) for _, p in sorted(surroundings.places.items())]}
    if surroundings.zones:
        body["zones"] = [zone_to_json(zone) for zone in surroundings.zones]
    if surroundings.library is not None:
        body["library"] = [_library_to_json(name, facts) for name, facts in sorted(surroundings.library.items())]
    return body


def _library_to_json(name: str, facts: LibraryFacts) -> dict[str, Any]:
    versions = [
        {"number": number, **signature_to_json(signature)} for number, signature in sorted(facts.versions.items())
    ]
    return {"id": name, "name": facts.name, "versions": versions}


def _device_to_json(facts: DeviceFacts) -> dict[str, Any]:
    body = description_to_json(facts.description)
    if facts.lifecycle != "approved":
        body["lifecycle"] = facts.lifecycle
    if not facts.online:
        body["online"] = False
    if facts.readings:
        body["readings"] = dict(facts.readings)
    if facts.standing_at is not None:
        body["standing_at"] = facts.standing_at
    return body


def _place_to_json(place: PlaceFacts) -> dict[str, Any]:
    return {"id": place.id, "name": place.name, "kind": place.kind, "x": place.x, "y": place.y, "theta": place.theta}


def surroundings_from_json(body: object, floor: FloorFacts | None = None) -> Surroundings:
    """Return the site in the JSON, with what the map says if that is known.

    Raises:
        UnreadableSite: it is not what `surroundings_to_json` writes.
    """
    if not isinstance(body, Mapping):
        raise UnreadableSite("A site must be a JSON object with “devices” and “places”.")
    devices = [_device_from_json(item) for item in _listed(body, "devices")]
    places = [_place_from_json(item) for item in _listed(body, "places")]
    zones = tuple(sorted((zone_from_json(item) for item in _listed(body, "zones")), key=lambda zone: zone.id))
    library = dict(_library_from_json(item) for item in _listed(body, "library")) if "library" in body else None
    by_id = {facts.description.id: facts for facts in devices}
    return Surroundings(by_id, {p.id: p for p in places}, floor, library, zones)


def _library_from_json(body: Mapping[str, Any]) -> tuple[str, LibraryFacts]:
    name = body.get("id")
    try:
        versions = {int(version["number"]): signature_from_json(version) for version in _listed(body, "versions")}
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise UnreadableSite(f"The versions of library function {name} cannot be read: {error}.") from error
    if not isinstance(name, str) or not name:
        raise UnreadableSite("A function of the library needs an id.")
    return name, LibraryFacts(str(body.get("name", name)), versions)


def _listed(body: Mapping[str, Any], name: str) -> list[Mapping[str, Any]]:
    items = body.get(name, [])
    if not isinstance(items, list) or not all(isinstance(item, Mapping) for item in items):
        raise UnreadableSite(f"“{name}” of a site must be a list of objects.")
    return items


def _device_from_json(body: Mapping[str, Any]) -> DeviceFacts:
    name = body.get("id", "without an id")
    try:
        description = description_from_json({key: value for key, value in body.items() if key not in _STATE})
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise UnreadableSite(f"The description of device {name} cannot be read: {error}.") from error
    lifecycle, standing = body.get("lifecycle", "approved"), body.get("standing_at")
    readings = body.get("readings", {})
    if lifecycle not in LIFECYCLES:
        raise UnreadableSite(f"The lifecycle of device {name} must be one of {', '.join(LIFECYCLES)}.")
    if not isinstance(readings, Mapping) or not isinstance(standing, str | None):
        raise UnreadableSite(f"The readings or the place of device {name} cannot be read.")
    return DeviceFacts(description, lifecycle, body.get("online", True) is True, dict(readings), standing)


def _place_from_json(body: Mapping[str, Any]) -> PlaceFacts:
    name, numbers = body.get("id"), [body.get("x"), body.get("y"), body.get("theta", 0.0)]
    good = all(isinstance(n, int | float) and math.isfinite(n) for n in numbers)
    if not isinstance(name, str) or not name or not good or body.get("kind") not in PLACE_KINDS:
        raise UnreadableSite(f"Place {name} needs an id, x and y in metres, and a kind: {', '.join(PLACE_KINDS)}.")
    x, y, theta = (float(n) for n in numbers if isinstance(n, int | float))
    return PlaceFacts(name, str(body.get("name", name)), body["kind"], x, y, theta)


def zone_to_json(zone: ZoneFacts) -> dict[str, Any]:
    """Return a zone of a site's floor as plain JSON; what concerns some rules alone only where it says something."""
    body: dict[str, Any] = {"id": zone.id, "name": zone.name, "rule": zone.rule}
    body["points"] = [list(point) for point in zone.points]
    if zone.speed_m_s is not None:
        body["speed_m_s"] = zone.speed_m_s
    if zone.heading_deg is not None:
        body["heading_deg"] = zone.heading_deg
    return body if zone.robots == 1 else {**body, "robots": zone.robots}


def zone_from_json(body: Mapping[str, Any]) -> ZoneFacts:
    """Read a zone of a site's floor. Raises UnreadableSite."""
    name, points, rule, robots = body.get("id"), body.get("points"), body.get("rule"), body.get("robots", 1)
    corners = [_corner(point) for point in points] if isinstance(points, list) else []
    good = isinstance(name, str) and name and len(corners) >= FEWEST_CORNERS and None not in corners
    speed_m_s = _number(body.get("speed_m_s")) if rule == "slow" else None
    heading_deg = _number(body.get("heading_deg")) if rule == "one_way" else None
    lacks = (rule == "slow" and speed_m_s is None) or (rule == "one_way" and heading_deg is None)
    if not good or lacks or rule not in ZONE_RULES:
        raise UnreadableSite(
            f"Zone {name} needs an id, a rule: {', '.join(ZONE_RULES)}, points: at least {FEWEST_CORNERS} [x, y] in"
            " metres, for slow a speed_m_s, and for one_way a heading_deg."
        )
    if not isinstance(robots, int) or isinstance(robots, bool) or not 1 <= robots <= MOST_ROBOTS:
        raise UnreadableSite(
            f"Zone {name} must say with a whole number from 1 to {MOST_ROBOTS} how many robots may be in it at once."
        )
    outline = tuple(corner for corner in corners if corner is not None)
    turned = None if heading_deg is None else heading_deg % 360
    return ZoneFacts(str(name), str(body.get("name", name)), rule, outline, speed_m_s, robots, turned)


def _corner(point: object) -> tuple[float, float] | None:
    if not isinstance(point, list | tuple) or len(point) != 2 or not all(map(_is_finite, point)):
        return None
    return (float(point[0]), float(point[1]))


def _number(value: object) -> float | None:
    """Return a number as it is said; None for what is none."""
    return float(value) if isinstance(value, int | float) and _is_finite(value) else None


def _is_finite(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)

"""A site as its floor sees it: the layout of map, places, zones and devices, worked out when one is another."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, replace
from math import cos, pi, sin
from typing import Any, Literal

from editor import services as editor
from editor.language.site.surroundings import PlaceFacts
from execution.traffic.layout import Layout, make_layout
from execution.traffic.messages import FloorZone, site_zones
from registry import services as registry
from registry.floorplan.plan import Grid
from vipo_device.protocol.description import Description, Pose

_MadeOf = tuple[Grid, tuple[Description, ...], tuple[PlaceFacts, ...], tuple[FloorZone, ...], tuple[FloorZone, ...]]
STILL_M = 0.05
"""Within a grid of this a real robot that is simulated for a while counts as standing where it stood."""


@dataclass(frozen=True, slots=True)
class _Known:
    """A site's layout, with what it was made of; `stamp` tells the same without the descriptions (None: cannot)."""

    stamp: tuple[object, ...] | None
    made_of: _MadeOf
    layout: Layout


_layouts: dict[str, _Known] = {}


def get_layout(slug: str) -> Layout:
    """Return the layout of a site as its map, places, zones and approved devices are now; raises NoMap."""
    return look_at_site(slug)[0]


def look_at_site(slug: str) -> tuple[Layout, tuple[registry.PositionView, ...]]:
    """Return the layout and where the devices are; what these say of themselves is read only when it is news."""
    positions = registry.list_positions(site=slug, lifecycle="approved")
    places = tuple(place_facts(place) for place in registry.list_places(site=slug))
    zones = tuple(map(_floor_zone, registry.list_zones(site=slug)))
    grid = registry.get_map(site=slug, to_plan=True).grid
    stamp = _stamp(grid, positions, places, zones)
    known = _layouts.get(slug)
    if known is not None and stamp is not None and known.stamp == stamp:
        return known.layout, positions
    placed = registry.list_placed(site=slug, lifecycle="approved")
    positions = tuple(position for position, _ in placed)
    at_home = tuple(replace(d, pose=Pose(0, 0)) if d.kind == "robot" else d for _, d in placed)
    made_of = (grid, at_home, places, zones, find_bodies(placed))
    layout = _layout_of(known, made_of)
    _layouts[slug] = _Known(_stamp(grid, positions, places, zones), made_of, layout)
    return layout, positions


def get_floor(slug: str) -> tuple[Grid, Layout, tuple[PlaceFacts, ...]]:
    """Return the map of a site, its layout and its places as they belong together; raises NoMap."""
    look_at_site(slug)
    known = _layouts[slug]
    return known.made_of[0], known.layout, known.made_of[2]


def _floor_zone(zone: registry.ZoneView) -> FloorZone:
    """Return a zone as the floor knows it, with how long it is open."""
    (known,) = site_zones([editor.zone_facts(zone=zone)])
    return replace(known, open_until=zone.open_until.timestamp()) if zone.open_until else known


def _layout_of(known: _Known | None, made_of: _MadeOf) -> Layout:
    """Return the layout; what is known already is taken as far as it is the same: a zone changes no lattice."""
    grid, at_home, places, zones, bodies = made_of
    if known is None or known.made_of[:3] != made_of[:3]:
        return replace(make_layout(grid, at_home, places, zones), bodies=bodies)
    return known.layout if known.made_of == made_of else replace(known.layout, zones=zones, bodies=bodies)


def find_bodies(
    placed: Iterable[tuple[registry.PositionView | registry.DeviceView, Description]],
) -> tuple[FloorZone, ...]:
    """Return where real robots stand that are simulated for a while: all others keep out."""
    return tuple(
        FloorZone(f"body/{robot.id}", described.name, "keep_out", _outline(at, described.radius_m))
        for robot, described in placed
        if (at := _standing(robot)) is not None
    )


def _standing(robot: registry.PositionView | registry.DeviceView) -> tuple[float, float] | None:
    """Return where the real one of a simulated robot stands, metres; small movements of it do not count."""
    pose = robot.stands_at
    return None if pose is None else (round(pose.x / STILL_M) * STILL_M, round(pose.y / STILL_M) * STILL_M)


def _outline(at: tuple[float, float], radius_m: float) -> tuple[tuple[float, float], ...]:
    """Return eight corners around a round body, metres."""
    return tuple((at[0] + radius_m * cos(k * pi / 4), at[1] + radius_m * sin(k * pi / 4)) for k in range(8))


def _stamp(
    grid: Grid,
    positions: tuple[registry.PositionView, ...],
    places: tuple[PlaceFacts, ...],
    zones: tuple[FloorZone, ...],
) -> tuple[object, ...] | None:
    """Return what differs whenever a layout would; robots are at home wherever they are."""
    if not all(position.version for position in positions):
        return None
    made_of = tuple((p.id, p.version, _standing(p) if p.kind == "robot" else p.pose) for p in positions)
    return (grid, made_of, places, zones)


def place_facts(place: registry.PlaceView) -> PlaceFacts:
    """Return a place as the language and traffic see it."""
    kind: Literal["dock", "room", "point"] = (
        "dock" if place.kind == "dock" else "room" if place.kind == "room" else "point"
    )
    return PlaceFacts(place.id, place.name, kind, place.x, place.y, place.theta)


def places_to_json(*, site: str) -> list[dict[str, Any]]:
    """Return the places of a site as they are now, as runs keep them; raises NotAMember."""
    return [asdict(place_facts(place)) for place in registry.list_places(site=site)]


def places_from_json(kept: Iterable[Mapping[str, Any]]) -> tuple[PlaceFacts, ...]:
    """Return the places that a run has kept."""
    return tuple(PlaceFacts(*(place[name] for name in ("id", "name", "kind", "x", "y", "theta"))) for place in kept)

"""A site as its floor sees it: the layout of map, places and devices, worked out only when one of these is another."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from editor.language.site.surroundings import PlaceFacts
from execution.traffic.layout import Layout, make_layout
from registry import services as registry
from vipo_device.protocol.description import Description, Pose


@dataclass(frozen=True, slots=True)
class _Known:
    """A site's layout, with what it was made of; `stamp` tells the same without the descriptions (None: cannot)."""

    stamp: tuple[object, ...] | None
    made_of: tuple[int, tuple[Description, ...], tuple[PlaceFacts, ...]]
    layout: Layout


_layouts: dict[str, _Known] = {}


def get_layout(slug: str) -> Layout:
    """Return the layout of a site as its map, places and approved devices are now; raises NoMap."""
    return look_at_site(slug)[0]


def look_at_site(slug: str) -> tuple[Layout, tuple[registry.PositionView, ...]]:
    """Return the layout and where the devices are; what these say of themselves is read only when it is news."""
    positions = registry.list_positions(site=slug, lifecycle="approved")
    places = tuple(place_facts(place) for place in registry.list_places(site=slug))
    site_map = registry.get_map(site=slug)
    known, stamp = _layouts.get(slug), _stamp(site_map.version, positions, places)
    if known is not None and stamp is not None and known.stamp == stamp:
        return known.layout, positions
    placed = registry.list_placed(site=slug, lifecycle="approved")
    positions = tuple(position for position, _ in placed)
    at_home = tuple(replace(d, pose=Pose(0, 0)) if d.kind == "robot" else d for _, d in placed)
    made_of = (site_map.version, at_home, places)
    is_same = known is not None and known.made_of == made_of
    layout = known.layout if known is not None and is_same else make_layout(site_map.grid, at_home, places)
    _layouts[slug] = _Known(_stamp(site_map.version, positions, places), made_of, layout)
    return layout, positions


def _stamp(
    version: int, positions: tuple[registry.PositionView, ...], places: tuple[PlaceFacts, ...]
) -> tuple[object, ...] | None:
    """Return what differs whenever a layout would; robots are at home wherever they are."""
    if not all(position.version for position in positions):
        return None
    return (version, tuple((p.id, p.version, None if p.kind == "robot" else p.pose) for p in positions), places)


def place_facts(place: registry.PlaceView) -> PlaceFacts:
    """Return a place as the language and traffic see it."""
    kind: Literal["dock", "room", "point"] = (
        "dock" if place.kind == "dock" else "room" if place.kind == "room" else "point"
    )
    return PlaceFacts(place.id, place.name, kind, place.x, place.y, place.theta)

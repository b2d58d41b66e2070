"""The named places of a site, as its admins make, change and remove them.

A place and a device of a site never have the same id, for robots are sent to either by its id.
A place stands over the map and stays where it is when the map becomes another one. Whoever shows or checks anything
with a map hears of a change as of a new map.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from django.db import transaction

from registry.audit.record import note_act
from registry.errors import RegistryError
from registry.floorplan.plan import Grid
from registry.live.fanout import publish
from registry.maps.names import Naming
from registry.maps.site_maps import find_map, get_map
from registry.models import Device, Place
from registry.sites.sites import find_site, list_places, lock_site
from registry.sites.views import PlaceView

MOST_PLACES = 500
_WALL = 100
_NO_ROOM = "There is a wall at {x:.2f}, {y:.2f}. Put the place where a robot can stand."
_OFF = "The place is off the map at {x:.2f}, {y:.2f}. Put it on the floor."


class BadPlace(RegistryError):
    """A place that cannot be so."""

    code = "bad_place"
    status = 422


class NoSuchPlace(RegistryError):
    """A place that is not, or no longer, at the site."""

    code = "no_such_place"
    status = 404


class PlaceTaken(RegistryError):
    """A name or id that another place of the site has, or the id of one of its devices."""

    code = "place_taken"
    status = 409


@dataclass(frozen=True, slots=True)
class PlaceChange:
    """What is to be another about a place; None leaves it. Metres and radians in the map frame."""

    name: str | None = None
    kind: str | None = None
    x: float | None = None
    y: float | None = None
    theta: float | None = None


def add_place(*, site: str, place: PlaceChange, place_id: str = "") -> PlaceView:
    """Make a place; its id is made of its name, if none is wished. Raises BadPlace, PlaceTaken, NoMap, NotAMember."""
    version, grid = _map_of(site)
    with transaction.atomic():
        row = lock_site(site)
        keys = set(Place.objects.filter(site=row).values_list("key", flat=True))
        devices = set(Device.objects.filter(site=row).values_list("pk", flat=True))
        key = _naming().new_key(place_id, place.name or "", keys, devices)
        made = Place(site=row, key=key, kind=Place.Kind.POINT, x=0.0, y=0.0)
        _change(made, place, grid)
        made.save(force_insert=True)
        note_act(site_id=row.pk, code="place_added", facts={"place": made.name})
        _tell(site, version)
    return find_place(site=site, place_id=made.key)


def change_place(*, site: str, place_id: str, place: PlaceChange) -> PlaceView:
    """Change what is named of a place. Raises NoSuchPlace, BadPlace, PlaceTaken, NoMap, NotAMember."""
    version, grid = _map_of(site)
    with transaction.atomic():
        lock_site(site)
        row = _lock(site, place_id)
        _change(row, place, grid)
        row.save()
        note_act(site_id=row.site_id, code="place_changed", facts={"place": row.name})
        _tell(site, version)
    return find_place(site=site, place_id=place_id)


def remove_place(*, site: str, place_id: str) -> None:
    """Take a place away; programs that name it are told of it. Raises NoSuchPlace, NotAMember."""
    with transaction.atomic():
        lock_site(site)
        row = _lock(site, place_id)
        note_act(site_id=row.site_id, code="place_removed", facts={"place": row.name})
        row.delete()
        known = find_map(site=site)
        _tell(site, known.version if known else 0)


def find_place(*, site: str, place_id: str) -> PlaceView:
    """Return a place of a site. Raises NoSuchPlace, NotAMember."""
    found = next((place for place in list_places(site=site) if place.id == place_id), None)
    if found is None:
        raise _missing(place_id)
    return found


def _map_of(site: str) -> tuple[int, Grid]:
    found = get_map(site=site)
    return found.version, found.grid


def _lock(site: str, place_id: str) -> Place:
    row = Place.objects.select_for_update().filter(site=find_site(site), key=place_id).first()
    if row is None:
        raise _missing(place_id)
    return row


def _missing(place_id: str) -> NoSuchPlace:
    return NoSuchPlace(f"There is no place {place_id[:64]!r} at this site. Somebody may have removed it.")


def _tell(site: str, version: int) -> None:
    transaction.on_commit(lambda: publish(site, {"type": "map", "version": version}))


def _change(row: Place, place: PlaceChange, grid: Grid) -> None:
    """Write what is named into the row. Raises BadPlace, PlaceTaken."""
    if place.name is not None or not row.name:
        row.name = _checked_name(place.name or "", row)
    if place.kind is not None:
        row.kind = _checked_kind(place.kind)
    x, y = (row.x if place.x is None else place.x), (row.y if place.y is None else place.y)
    if (x, y) != (row.x, row.y):
        row.label = None  # the name was written for where it stood
    row.x, row.y = round(x, 3), round(y, 3)
    if place.theta is not None:
        row.theta = round(math.remainder(place.theta, math.tau), 4)
    _check_floor(row, grid)


def _naming() -> Naming:
    return Naming("place", MOST_PLACES, BadPlace, PlaceTaken)


def _checked_name(name: str, row: Place) -> str:
    others = Place.objects.filter(site_id=row.site_id).exclude(key=row.key).values_list("name", flat=True)
    return _naming().checked_name(name, others)


def _checked_kind(kind: str) -> str:
    if kind not in Place.Kind.values:
        raise BadPlace(f"A place is a {', a '.join(Place.Kind.values)}; {kind[:20]!r} is none of them.")
    return kind


def _check_floor(row: Place, grid: Grid) -> None:
    """Refuse a place off the map, and one in a wall where a robot shall stand. Raises BadPlace."""
    args = {"x": row.x, "y": row.y}
    cell = grid.cell_of(row.x, row.y)
    if cell is None:
        raise BadPlace(_OFF.format(**args), {"why": "off", **args})
    if row.kind != Place.Kind.ROOM and grid.cells[cell[0] * grid.width + cell[1]] == _WALL:
        raise BadPlace(_NO_ROOM.format(**args), {"why": "wall", **args})

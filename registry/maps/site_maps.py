"""A site's own map: its versions, its walls and floor, and what each was made from.

A new map is always a new version; none is written over.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from datetime import datetime

from django.db import transaction
from django.utils import timezone

from registry.audit.record import note_act
from registry.devices.queries import list_devices
from registry.devices.views import effective_description
from registry.errors import RegistryError
from registry.floorplan.comparison import MapDifference, NamedPoint, compare_maps
from registry.floorplan.extent import why_too_large
from registry.floorplan.map_server import check_extent, check_size
from registry.floorplan.plan import FREE, Box, FloorPlan, Grid, wall_boxes
from registry.live.fanout import publish
from registry.maps.kept_work import KeptWork
from registry.maps.robot_maps import SeenMap, get_robot_map, map_tag
from registry.models import Device, Site, SiteMap, User
from registry.sites.sites import find_site, list_places
from vipo_device.protocol.description import Description

MOST_VERSIONS = 50
FRAME = ("width", "height", "resolution_m", "origin_x_m", "origin_y_m")
"""Where a map lies: two that differ in one of these say other things of a point."""
MOST_KEPT_CELLS = 20_000_000
"""Of each kind of work; a floor takes about twenty bytes for each cell, the others one."""
_grids: KeptWork[Grid] = KeptWork(MOST_KEPT_CELLS)
_walls: KeptWork[tuple[Box, ...]] = KeptWork(MOST_KEPT_CELLS)
_floors: KeptWork[FloorPlan] = KeptWork(MOST_KEPT_CELLS)


class NoMap(RegistryError):
    """The site has no map yet."""

    code = "no_map"
    status = 404


class MapTooLarge(NoMap):
    """The site's map is from before its metres were looked at: for who plans on it there is none."""

    code = "bad_map"
    status = 422


class MapChanged(RegistryError):
    """The map that somebody looked at is not the newest any more."""

    code = "map_changed"
    status = 409


@dataclass(frozen=True, slots=True)
class MapView:
    """A site's map; `made_at` tells apart two of the same number, of which a restored backup has forgotten one."""

    site: str
    version: int
    grid: Grid
    made_at: datetime

    @property
    def tag(self) -> str:
        """The ETag of its cells: no other map has it, not even one of the same number."""
        return map_tag(self.site, self.version, self.made_at)


@dataclass(frozen=True, slots=True)
class MapVersionView:
    """One version of a site's map.

    `source` is `upload`, `picture`, `drawing`, `edit`, `demo`, `robot:…`, `version:…` or empty.
    """

    version: int
    tag: str
    width: int
    height: int
    resolution_m: float
    source: str
    by: str
    at: datetime


@dataclass(frozen=True, slots=True)
class RobotMapChange:
    """What changes when a robot's map takes the place of the site's."""

    brings: SeenMap
    replaces: SeenMap
    difference: MapDifference


def list_map_versions(*, site: str) -> tuple[MapVersionView, ...]:
    """Return the versions of a site's map that are kept, the one that holds first."""
    rows = SiteMap.objects.filter(site=find_site(site)).select_related("by").defer("packed_cells")
    return tuple(
        MapVersionView(
            row.version,
            map_tag(site, row.version, row.created_at),
            row.width,
            row.height,
            row.resolution_m,
            row.source,
            row.by.display_name if row.by else "",
            row.created_at,
        )
        for row in rows.order_by("-version")
    )


def compare_robot_map(*, site: str, device_id: str) -> RobotMapChange:
    """Return what changes from the site's map to the robot's, and which maps these are.

    Raises NoSuchDevice, NoRobotMap.
    """
    view = get_robot_map(site=site, device_id=device_id)
    present, difference = compare_with_site(site=site, grid=view.grid)
    replaces = SeenMap(present.version, present.tag) if present else SeenMap(0)
    return RobotMapChange(SeenMap(view.facts.version, view.facts.tag), replaces, difference)


def compare_with_site(*, site: str, grid: Grid) -> tuple[MapView | None, MapDifference]:
    """Return the site's map (None: it has none) and what changes from it to a grid. Raises NotAMember."""
    present = find_map(site=site)
    devices = [device.canonical for device in list_devices(site=site, lifecycle="approved")]
    places = [NamedPoint(p.id, p.name, p.x, p.y, p.kind) for p in list_places(site=site)]
    return present, compare_maps(present.grid if present else None, grid, devices, places)


def find_map(*, site: str) -> MapView | None:
    """Return the site's newest map, or None when it has none."""
    try:
        return get_map(site=site)
    except NoMap:
        return None


def use_robot_map(*, site: str, device_id: str, brings: SeenMap, replaces: SeenMap, by: User) -> MapView:
    """Make a robot's map the site's; places and devices stay where they are. `brings` and `replaces` were seen.

    Raises NoSuchDevice, NoRobotMap, BadMap, MapChanged.
    """
    view = get_robot_map(site=site, device_id=device_id)
    if not brings.is_still(view.facts.version, view.facts.tag):
        raise MapChanged("The robot has sent a newer map meanwhile. Look at it again, then decide.", {"why": "robot"})
    check_size(view.grid.width, view.grid.height)
    return save_map(site=site, grid=view.grid, source=f"robot:{device_id}", by=by, replaces=replaces)


def restore_map(*, site: str, brings: SeenMap, replaces: SeenMap, by: User) -> MapView:
    """Use an older version of the site's map again, as a new version; `brings` and `replaces` were seen.

    Raises NoMap, BadMap, MapChanged.
    """
    found = get_map_version(site=site, version=brings.version)
    if not brings.is_still(found.version, found.tag):
        raise MapChanged("That version is another map by now. Look at the list again, then decide.", {"why": "version"})
    return save_map(site=site, grid=found.grid, source=f"version:{found.version}", by=by, replaces=replaces)


def get_map_version(*, site: str, version: int) -> MapView:
    """Return a version of a site's map that is kept. Raises NoMap."""
    rows = SiteMap.objects.filter(site=find_site(site), version=version)
    row = rows.values_list("pk", "created_at").first()
    if row is None:
        raise NoMap(f"Version {version} of this site's map is not kept. Choose one of the list.")
    return MapView(site, version, _grid(*row), row[1])


def save_map(
    *, site: str, grid: Grid, source: str = "", by: User | None = None, replaces: SeenMap | None = None
) -> MapView:
    """Make a grid the site's map, as a new version, and tell browsers; the oldest beyond 50 versions are forgotten.

    `replaces` is the one that the caller has seen. Raises MapChanged when another one holds by now, and BadMap when it
    has more floor than can be planned on.
    """
    check_extent(grid)
    with transaction.atomic():
        row = Site.objects.select_for_update().get(slug=site)
        last = SiteMap.objects.filter(site=row).defer("packed_cells").order_by("-version").first()
        latest = last.version if last else 0
        if replaces is not None:
            _require_newest(site, last, replaces)
        frame = {field: getattr(grid, field) for field in FRAME}
        lies_so_still = last is not None and all(getattr(last, field) == value for field, value in frame.items())
        saved = SiteMap.objects.create(
            site=row,
            version=latest + 1,
            **frame,
            frame_since=last.frame_since if last is not None and lies_so_still else timezone.now(),
            packed_cells=zlib.compress(grid.cells, 6),
            source=source,
            by=by,
        )
        SiteMap.objects.filter(site=row, version__lte=saved.version - MOST_VERSIONS).delete()
        note_act(site_id=row.pk, code="map_published", facts={"version": saved.version, "source": source})
        transaction.on_commit(lambda: publish(site, {"type": "map", "version": saved.version}))
    return MapView(site, saved.version, grid, saved.created_at)


def _require_newest(site: str, last: SiteMap | None, replaces: SeenMap) -> None:
    holds = (last.version, map_tag(site, last.version, last.created_at)) if last else (0, "")
    if not replaces.is_still(*holds):
        raise MapChanged(
            "Somebody has changed the site's map meanwhile. Look at it again, then decide.", {"why": "site"}
        )


def get_map(*, site: str, to_plan: bool = False) -> MapView:
    """Return the site's newest map. Raises NoMap, and of who is `to_plan` on it MapTooLarge, which is one, too."""
    versions = SiteMap.objects.filter(site__slug=site).order_by("-version")
    latest = versions.values_list("pk", "version", "created_at").first()
    if latest is None:
        raise _no_map(site)
    key, version, made_at = latest
    grid = _grid(key, made_at)
    if to_plan and (why := why_too_large(grid, lambda: grid.cells.count(FREE))):
        raise MapTooLarge(why)
    return MapView(site, version, grid, made_at)


def _no_map(site: str) -> NoMap:
    """Return what is told of a site without a map; raises NotAMember where there is no such site."""
    find_site(site)
    return NoMap("This site has no map yet. Upload one, or take one from a robot.")


def get_map_frame(*, site: str) -> tuple[datetime, float, float]:
    """Return since when the site's map lies as it does, and how wide and high it is in metres; raises NoMap.

    Points from before were said of a map of another size, resolution or origin.
    """
    versions = SiteMap.objects.filter(site__slug=site).order_by("-version")
    latest = versions.values_list("frame_since", "width", "height", "resolution_m").first()
    if latest is None:
        raise _no_map(site)
    since, width, height, resolution_m = latest
    return since, width * resolution_m, height * resolution_m


def _grid(map_id: int, created_at: datetime) -> Grid:
    """Unpack a map once in each process: it never changes; the time tells apart rows that were given the same key."""
    return _grids.get((map_id, created_at), lambda: _unpack(map_id), _cells_of)


def _unpack(map_id: int) -> Grid:
    row = SiteMap.objects.get(pk=map_id)
    return Grid(row.width, row.height, row.resolution_m, row.origin_x_m, row.origin_y_m, row.cells)


def _cells_of(grid: Grid) -> int:
    return grid.width * grid.height


def get_walls(grid: Grid) -> tuple[Box, ...]:
    """Return the walls of a grid as boxes, worked out once."""
    return _walls.get(grid, lambda: wall_boxes(grid), lambda _walls: _cells_of(grid))


def get_floor_plan(*, site: str) -> FloorPlan:
    """Return what the map says about points and ways, approved machines being obstacles. Raises NoMap, MapTooLarge."""
    rows = Device.objects.filter(site__slug=site, lifecycle=Device.Lifecycle.APPROVED).order_by("id")
    described = [effective_description(d) for d in rows if d.description]
    return _floor(get_map(site=site, to_plan=True).grid, tuple(d for d in described if d.kind == "machine"))


def _floor(grid: Grid, machines: tuple[Description, ...]) -> FloorPlan:
    return _floors.get((grid, machines), lambda: FloorPlan(grid, machines), lambda floor: _cells_of(floor.grid))

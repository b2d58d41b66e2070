"""Versions of a site's map: a robot's map becomes the newest one, an older one is used again, none is written over."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from registry.devices.joining import list_devices
from registry.devices.views import MapView
from registry.floorplan.comparison import MapDifference, NamedPoint, compare_maps
from registry.floorplan.map_server import check_size
from registry.floorplan.plan import Grid
from registry.maps.robot_maps import get_robot_map
from registry.models import SiteMap, User
from registry.sites.sites import MapChanged, NoMap, find_site, get_map, list_places, save_map


@dataclass(frozen=True, slots=True)
class MapVersionView:
    """One version of a site's map; `source` is `upload`, `demo`, `robot:<id>`, `version:<number>` or empty."""

    version: int
    width: int
    height: int
    resolution_m: float
    source: str
    by: str
    at: datetime


def list_map_versions(*, site: str) -> tuple[MapVersionView, ...]:
    """Return the versions of a site's map that are kept, the one that holds first."""
    rows = SiteMap.objects.filter(site=find_site(site)).select_related("by").defer("packed_cells")
    return tuple(
        MapVersionView(
            row.version,
            row.width,
            row.height,
            row.resolution_m,
            row.source,
            row.by.display_name if row.by else "",
            row.created_at,
        )
        for row in rows.order_by("-version")
    )


def compare_robot_map(*, site: str, device_id: str) -> tuple[int, int, MapDifference]:
    """Return the robot's version, the site's version (0: it has no map) and what changes from this one to that one.

    Raises NoSuchDevice, NoRobotMap.
    """
    view = get_robot_map(site=site, device_id=device_id)
    present = find_map(site=site)
    devices = [device.canonical for device in list_devices(site=site, lifecycle="approved")]
    places = [NamedPoint(p.id, p.name, p.x, p.y) for p in list_places(site=site)]
    difference = compare_maps(present.grid if present else None, view.grid, devices, places)
    return view.facts.version, present.version if present else 0, difference


def find_map(*, site: str) -> MapView | None:
    """Return the site's newest map, or None when it has none."""
    try:
        return get_map(site=site)
    except NoMap:
        return None


def use_robot_map(*, site: str, device_id: str, version: int, replaces: int, by: User) -> MapView:
    """Make a robot's map the site's; places and devices stay where they are. `version` and `replaces` were seen.

    Raises NoSuchDevice, NoRobotMap, BadMap, MapChanged.
    """
    view = get_robot_map(site=site, device_id=device_id)
    if view.facts.version != version:
        raise MapChanged("The robot has sent a newer map meanwhile. Look at it again, then decide.", {"why": "robot"})
    check_size(view.grid.width, view.grid.height)
    return save_map(site=site, grid=view.grid, source=f"robot:{device_id}", by=by, replaces=replaces)


def restore_map(*, site: str, version: int, replaces: int, by: User) -> MapView:
    """Use an older version of the site's map again, as a new version. Raises NoMap, MapChanged."""
    row = SiteMap.objects.filter(site=find_site(site), version=version).first()
    if row is None:
        raise NoMap(f"Version {version} of this site's map is not kept. Choose one of the list.")
    grid = Grid(row.width, row.height, row.resolution_m, row.origin_x_m, row.origin_y_m, row.cells)
    return save_map(site=site, grid=grid, source=f"version:{version}", by=by, replaces=replaces)

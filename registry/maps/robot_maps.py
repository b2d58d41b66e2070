"""The newest map of each robot: kept as it came, shown, and held against the site's map."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from datetime import datetime, timedelta

from django.db import transaction

from registry.devices.history import history_text, write_event
from registry.devices.queries import get_device
from registry.errors import RegistryError
from registry.floorplan.map_message import plain_grid
from registry.floorplan.plan import UNKNOWN, Grid
from registry.live.fanout import publish
from registry.models import Device, DeviceEvent, RobotMap

EVENT_EVERY = timedelta(hours=1)


class NoRobotMap(RegistryError):
    """The device has sent no map."""

    code = "no_robot_map"
    status = 404


def map_tag(owner: str, version: int, made_at: datetime) -> str:
    """Return the ETag of a map of a site or a robot; a number comes a second time once a backup is brought back."""
    return f'"{owner}-{version}-{made_at:%Y%m%d%H%M%S%f}"'


@dataclass(frozen=True, slots=True)
class SeenMap:
    """A map as somebody has seen it: its number (0: there was none) and its tag; empty: they were not told it."""

    version: int
    tag: str = ""

    def is_still(self, version: int, tag: str) -> bool:
        """Tell whether it is the map that has this number and tag by now."""
        return self.version == version and self.tag in ("", tag)


@dataclass(frozen=True, slots=True)
class RobotMapFacts:
    """A robot's map without its cells: metres; `known` is a share from 0 to 1; it last differed at `changed_at`."""

    device: str
    version: int
    width: int
    height: int
    resolution_m: float
    origin_x_m: float
    origin_y_m: float
    known: float
    at: datetime
    changed_at: datetime

    @property
    def tag(self) -> str:
        """The ETag of its cells: no other map has it, not even one of the same number."""
        return map_tag(self.device, self.version, self.at)


@dataclass(frozen=True, slots=True)
class RobotMapView:
    """A robot's map; its cells are of the three kinds that maps have here."""

    facts: RobotMapFacts
    grid: Grid


def keep_robot_map(*, device: Device, grid: Grid, packed: bytes, at: datetime) -> None:
    """Keep a map as its robot's newest and tell browsers; call it under a lock that only this robot's maps take."""
    before = RobotMap.objects.filter(pk=device.pk).first()
    fields = {
        "width": grid.width,
        "height": grid.height,
        "resolution_m": grid.resolution_m,
        "origin_x_m": grid.origin_x_m,
        "origin_y_m": grid.origin_y_m,
        "packed_cells": packed,
    }
    is_same = before is not None and all(_plain(getattr(before, name)) == value for name, value in fields.items())
    changed_at = before.changed_at if before and is_same else at
    version = (before.version if before else 0) + 1
    known = len(grid.cells) - plain_grid(grid).cells.count(UNKNOWN)
    told = {**fields, "version": version, "known_cells": known, "at": at, "changed_at": changed_at}
    RobotMap.objects.update_or_create(device=device, defaults=told)
    _note(device, grid, at)
    site = device.site.slug
    transaction.on_commit(lambda: publish(site, {"type": "robot_map", "device": device.pk, "version": version}))


def _plain(value: object) -> object:
    return bytes(value) if isinstance(value, memoryview) else value


def _note(device: Device, grid: Grid, at: datetime) -> None:
    """Write into the history that a map came, at most once an hour: a robot that explores sends one every 10 s."""
    if not DeviceEvent.objects.filter(device=device, kind="map", at__gt=at - EVENT_EVERY).exists():
        width_m, height_m = (round(cells * grid.resolution_m, 1) for cells in (grid.width, grid.height))
        write_event(device, at, "map", history_text("map", width=width_m, height=height_m))


def get_robot_map_facts(*, site: str, device_id: str) -> RobotMapFacts:
    """Return what there is to know about a robot's newest map. Raises NoSuchDevice, NoRobotMap."""
    return _facts(_find(site, device_id, with_cells=False))


def get_robot_map(*, site: str, device_id: str) -> RobotMapView:
    """Return a robot's newest map. Raises NoSuchDevice, NoRobotMap."""
    row = _find(site, device_id, with_cells=True)
    cells = zlib.decompress(bytes(row.packed_cells))
    grid = Grid(row.width, row.height, row.resolution_m, row.origin_x_m, row.origin_y_m, cells)
    return RobotMapView(_facts(row), plain_grid(grid))


def _find(site: str, device_id: str, *, with_cells: bool) -> RobotMap:
    device = get_device(site=site, device_id=device_id)
    rows = RobotMap.objects.filter(device_id=device.id)
    row = (rows if with_cells else rows.defer("packed_cells")).first()
    if row is None:
        raise NoRobotMap(f"{device.name} has sent no map yet. A robot's agent sends it once its navigation has one.")
    return row


def _facts(row: RobotMap) -> RobotMapFacts:
    return RobotMapFacts(
        device=row.device_id,
        version=row.version,
        width=row.width,
        height=row.height,
        resolution_m=row.resolution_m,
        origin_x_m=row.origin_x_m,
        origin_y_m=row.origin_y_m,
        known=row.known_cells / (row.width * row.height),
        at=row.at,
        changed_at=row.changed_at,
    )

"""Reads of just the devices and columns that are asked for: one statement each, and no description is taken apart.

Unknown ids are left out, as are devices that nobody described yet, and retired ones.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any, NamedTuple

from django.db.models import QuerySet

from registry.devices.views import place_of_real, pose_that_holds, view_of
from registry.models import Device
from vipo_device.protocol.description import Description, Pose, Scalar


@dataclass(frozen=True, slots=True)
class ReadingsView:
    """What a device said last: its properties' values, whether it is done, and when it spoke."""

    values: Mapping[str, Scalar]
    done: bool
    last_seen_at: datetime | None


@dataclass(frozen=True, slots=True)
class PositionView:
    """Where a device is and whether it is there; `version` stands for its name, description and methods.

    Two of the same id and version differ in nothing but place and state. It is empty where none can be told.
    `stands_at` is where a real robot is whose stand-in speaks.
    """

    id: str
    kind: str
    pose: Pose
    online: bool
    version: str
    stands_at: Pose | None = None


def get_device_names(*, site: str, ids: Collection[str]) -> Mapping[str, str]:
    """Return what these devices are called, by id."""
    rows = _rows(site, ids).values_list("id", "name_override", "description__name")
    return {device: given or own for device, given, own in rows}


def list_device_ids(*, site: str, lifecycle: str | None = None) -> tuple[str, ...]:
    """Return the ids of the site's devices, in their order."""
    return tuple(_rows(site, None, lifecycle).values_list("id", flat=True))


def get_readings(*, site: str, ids: Collection[str] | None = None) -> Mapping[str, ReadingsView]:
    """Return what these devices (None: all of the site) said last, by id."""
    rows = _rows(site, ids).values_list("id", "properties", "done", "last_seen_at")
    return {device: ReadingsView(values, done, at) for device, values, done, at in rows}


def list_positions(
    *, site: str, ids: Collection[str] | None = None, lifecycle: str | None = None
) -> tuple[PositionView, ...]:
    """Return where these devices (None: all of the site) are, by id."""
    rows = _rows(site, ids, lifecycle).values_list(*_POSITION)
    return tuple(_position(_Row(*row)) for row in rows)


def list_placed(*, site: str, lifecycle: str | None = None) -> tuple[tuple[PositionView, Description], ...]:
    """Return the site's devices by id, with what each of them is; a pair comes from one look at its row."""
    rows = _rows(site, None, lifecycle).defer("source")
    return tuple((_position_of(row), view_of(row, site).canonical) for row in rows)


def _rows(site: str, ids: Collection[str] | None, lifecycle: str | None = None) -> QuerySet[Device]:
    rows = Device.objects.filter(site__slug=site, description__isnull=False).order_by("id")
    rows = rows.filter(lifecycle=lifecycle) if lifecycle else rows.exclude(lifecycle=Device.Lifecycle.RETIRED)
    return rows if ids is None else rows.filter(pk__in=ids)


_POSITION = (
    "id", "description__kind", "description__pose", "pose", "pose_override", "online", "aside",
    "description_hash", "name_override", "granted",
)  # fmt: skip


class _Row(NamedTuple):
    """What `_POSITION` asks of a row."""

    device: str
    kind: str
    own: Mapping[str, float]
    measured: Mapping[str, float] | None
    placed: Mapping[str, float] | None
    online: bool
    aside: Mapping[str, Any] | None
    description_hash: str
    name_override: str
    granted: Mapping[str, str]


def _position(row: _Row) -> PositionView:
    pose = Pose(**(pose_that_holds(row.kind, row.measured, row.placed) or row.own))
    version = (row.description_hash, row.name_override, row.granted)
    stands_at = place_of_real(row.kind, row.aside)
    return PositionView(
        row.device, row.kind, pose, row.online, repr(version) if row.description_hash else "", stands_at
    )


def _position_of(row: Device) -> PositionView:
    said = row.description or {}
    state = (row.pose, row.pose_override, row.online, row.aside)
    return _position(
        _Row(row.id, said["kind"], said["pose"], *state, row.description_hash, row.name_override, row.granted)
    )

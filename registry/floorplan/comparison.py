"""What would change if another map held: floor, walls, machines that could not be served, places off the floor."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import cos, sin
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from registry.floorplan.plan import FREE, OCCUPIED, UNKNOWN, FloorPlan, Grid, cells_array
from vipo_device.protocol.description import Description, Pose

Trouble = Literal["outside", "walled", "unreachable"]
DEFAULT_RADIUS_M = 0.18
MOST_WALLED = 0.5
SAMPLES = 9
Cells = NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class MapTrouble:
    """A machine or place that the new map does not suit, and why; `is_new` tells that the present map suits it."""

    id: str
    name: str
    kind: Literal["machine", "place"]
    why: Trouble
    is_new: bool


@dataclass(frozen=True, slots=True)
class MapDifference:
    """What changes from the present map (if there is one) to another, in square metres, and whom it would trouble."""

    floor_gained_m2: float
    floor_lost_m2: float
    walls_gained_m2: float
    walls_lost_m2: float
    troubles: tuple[MapTrouble, ...]


@dataclass(frozen=True, slots=True)
class NamedPoint:
    """A named place of the site; metres. Robots stand at it unless it is a room, which only has its name there."""

    id: str
    name: str
    x: float
    y: float
    kind: str = "point"


Subject = Description | NamedPoint


def compare_maps(
    before: Grid | None, after: Grid, devices: Sequence[Description], places: Iterable[NamedPoint]
) -> MapDifference:
    """Return what changes on the floor; both grids stand in the same map frame, whatever their cells' sizes."""
    floor_gained_m2, walls_gained_m2 = _only_in(after, before)
    floor_lost_m2, walls_lost_m2 = (0.0, 0.0) if before is None else _only_in(before, after)
    troubles = tuple(_troubles(before, after, devices, list(places)))
    return MapDifference(floor_gained_m2, floor_lost_m2, walls_gained_m2, walls_lost_m2, troubles)


def _only_in(here: Grid, there: Grid | None) -> tuple[float, float]:
    """Return how much floor and wall a grid has where another (None: there is none) has it not, in square metres."""
    cells, seen = cells_array(here), None if there is None else _seen_from(here, there)
    counts = (
        int(np.count_nonzero(cells == kind if seen is None else (cells == kind) & (seen != kind)))
        for kind in (FREE, OCCUPIED)
    )
    floor, walls = (round(float(count) * here.resolution_m**2, 2) for count in counts)
    return floor, walls


def _seen_from(grid: Grid, other: Grid) -> Cells:
    """Return the other grid's cells at the middles of this one's; unknown where it has none."""
    xs = grid.origin_x_m + (np.arange(grid.width) + 0.5) * grid.resolution_m
    ys = grid.origin_y_m + (np.arange(grid.height) + 0.5) * grid.resolution_m
    columns = np.floor((xs - other.origin_x_m) / other.resolution_m).astype(np.int64)
    rows = np.floor((ys - other.origin_y_m) / other.resolution_m).astype(np.int64)
    inside_x, inside_y = (columns >= 0) & (columns < other.width), (rows >= 0) & (rows < other.height)
    seen = np.full((grid.height, grid.width), UNKNOWN, np.uint8)
    found = cells_array(other)[np.ix_(rows[inside_y], columns[inside_x])]
    seen[np.ix_(inside_y, inside_x)] = found
    return seen


def _troubles(
    before: Grid | None, after: Grid, devices: Sequence[Description], places: Sequence[NamedPoint]
) -> Iterable[MapTrouble]:
    """Yield whom the new map does not suit: one floor at a time, since that of a large map takes much memory."""
    machines = [device for device in devices if device.kind == "machine"]
    radius_m = max((d.radius_m for d in devices if d.kind == "robot"), default=0.0) or DEFAULT_RADIUS_M
    now = _why_each(after, machines, [*machines, *places], radius_m)
    troubled = [subject for subject, _ in now]
    was = {} if before is None or not troubled else dict(_why_each(before, machines, troubled, radius_m))
    for subject, why in now:
        kind: Literal["machine", "place"] = "machine" if isinstance(subject, Description) else "place"
        yield MapTrouble(subject.id, subject.name, kind, why, before is None or subject not in was)


def _why_each(
    grid: Grid, machines: Sequence[Description], subjects: Sequence[Subject], radius_m: float
) -> list[tuple[Subject, Trouble]]:
    """Return those of the machines and places that a map does not suit, and why."""
    floor = FloorPlan(grid, machines)
    reasons = (
        _trouble_of_machine(floor, each, radius_m)
        if isinstance(each, Description)
        else _trouble_of_place(floor, each, radius_m)
        for each in subjects
    )
    return [(each, why) for each, why in zip(subjects, reasons, strict=True) if why]


def _trouble_of_machine(floor: FloorPlan, machine: Description, radius_m: float) -> Trouble | None:
    """A machine's outline may be walls, as a laser sees it, but not its inside; there must be room beside it."""
    if not floor.is_inside(machine.pose.x, machine.pose.y):
        return "outside"
    if _walled_share(floor.grid, machine) > MOST_WALLED:
        return "walled"
    return "unreachable" if floor.station(machine.id, radius_m) is None else None


def _walled_share(grid: Grid, machine: Description) -> float:
    """Return how much of a machine's body (0 to 1, by samples) the map shows as wall."""
    pose, cells = machine.pose, cells_array(grid)
    ahead, aside = cos(pose.theta), sin(pose.theta)
    steps = [(n + 0.5) / SAMPLES - 0.5 for n in range(SAMPLES)]
    offsets = [(dx * machine.size.x, dy * machine.size.y) for dx in steps for dy in steps]
    at = [(pose.x + dx * ahead - dy * aside, pose.y + dx * aside + dy * ahead) for dx, dy in offsets]
    found = [cell for point in at if (cell := grid.cell_of(*point)) is not None]
    return sum(1 for cell in found if cells[cell] == OCCUPIED) / len(at)


def _trouble_of_place(floor: FloorPlan, place: NamedPoint, radius_m: float) -> Trouble | None:
    if not floor.is_inside(place.x, place.y):
        return "outside"
    if place.kind == "room":
        return None
    if not floor.is_free(place.x, place.y, radius_m):
        return "walled"
    return None if floor.is_open(Pose(place.x, place.y), radius_m) else "unreachable"

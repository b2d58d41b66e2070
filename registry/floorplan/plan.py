"""The floor as numbers: clearance, walls as boxes, where a robot can stand and which way it can go."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from math import cos, hypot, pi, sin
from typing import Literal
from zlib import crc32

import numpy as np
import scipy
from numpy.typing import NDArray

from registry.floorplan.coverage import CannotCover, plan_lanes
from registry.floorplan.lattice import Ground, Lattice, attach, make_lattice
from registry.floorplan.of_radius import ByRadius
from vipo_device.protocol.description import Description, Pose

FREE, OCCUPIED, UNKNOWN = 0, 100, 255
STATION_GAP_M = 0.15
BAND_ROWS = 256
"""Numbers of all cells are worked out in bands of so many rows: what stands between takes little memory."""
COMFORT_M = 0.3
MOST_RUNS = 50_000
MOST_COVERS = 200
"""Of so many zones it is kept at a time whether they can be covered."""
Box = tuple[float, float, float, float]
Corners = tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class Grid:
    """An occupancy grid: `cells` row by row from the bottom row up, 0 free, 100 occupied, 255 unknown."""

    width: int
    height: int
    resolution_m: float
    origin_x_m: float
    origin_y_m: float
    cells: bytes

    def cell_of(self, x_m: float, y_m: float) -> tuple[int, int] | None:
        """Return (row, column) of the cell that holds the point, or None off the map."""
        column = int((x_m - self.origin_x_m) // self.resolution_m)
        row = int((y_m - self.origin_y_m) // self.resolution_m)
        return (row, column) if 0 <= row < self.height and 0 <= column < self.width else None

    def standing(self, point: tuple[float, float]) -> Literal["floor", "wall", "outside"]:
        """Tell what is at a point in metres; unknown cells count as floor, on which somebody may draw."""
        cell = self.cell_of(*point)
        if cell is None:
            return "outside"
        return "wall" if self.cells[cell[0] * self.width + cell[1]] == OCCUPIED else "floor"

    def centre_of(self, row: int, column: int) -> tuple[float, float]:
        """Return the middle of a cell in metres."""
        return self.origin_x_m + (column + 0.5) * self.resolution_m, self.origin_y_m + (row + 0.5) * self.resolution_m


def cells_array(grid: Grid) -> NDArray[np.uint8]:
    """Return the cells as an array [row from the bottom, column]; read-only, no copy."""
    return np.frombuffer(grid.cells, dtype=np.uint8).reshape(grid.height, grid.width)


def clearance_m(grid: Grid) -> NDArray[np.float64]:
    """Return, for each cell [row, column], the way from its middle to the edge of the nearest non-free cell in metres.

    Unknown cells and everything off the map count as wall; non-free cells have 0.
    """
    free = np.pad(cells_array(grid) == FREE, 1, constant_values=False)
    nearest = scipy.ndimage.distance_transform_edt(free, return_distances=False, return_indices=True)[:, 1:-1, 1:-1]
    columns = np.arange(1, grid.width + 1)[None, :]
    found = np.empty((grid.height, grid.width))
    for top in range(0, grid.height, BAND_ROWS):
        band = nearest[:, top : top + BAND_ROWS]
        up = (band[0] - np.arange(top + 1, top + 1 + band.shape[1])[:, None]).astype(np.float64)
        aside = (band[1] - columns).astype(np.float64)
        found[top : top + BAND_ROWS] = np.maximum(np.sqrt(up * up + aside * aside) - 0.5, 0.0) * grid.resolution_m
    return found


def wall_boxes(grid: Grid) -> tuple[Box, ...]:
    """Return rectangles (x1, y1, x2, y2) in metres that together cover the occupied cells exactly, none twice.

    A map that is speckled all over is covered by larger cells, so that there are never more than 50,000 rectangles.
    """
    occupied, scale = cells_array(grid) == OCCUPIED, 1
    while min(runs := (_count_runs(occupied), _count_runs(occupied.T))) > MOST_RUNS:
        occupied, scale = _halved(occupied), 2 * scale
    covers = []
    if runs[0] <= MOST_RUNS:
        covers.append(_merged_runs(occupied))
    if runs[1] <= MOST_RUNS:
        covers.append([(c1, r1, c2, r2) for r1, c1, r2, c2 in _merged_runs(occupied.T)])
    return tuple(_box_m(grid, cells, scale) for cells in min(covers, key=len))


def _count_runs(occupied: NDArray[np.bool_]) -> int:
    """Return how many runs of occupied cells the rows have, without looking at each."""
    return int(np.count_nonzero(occupied[:, 0]) + np.count_nonzero(occupied[:, 1:] & ~occupied[:, :-1]))


def _halved(occupied: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return a grid of half the size; a cell is occupied where any of its four was."""
    height, width = occupied.shape
    even = np.pad(occupied, ((0, height % 2), (0, width % 2)))
    halved: NDArray[np.bool_] = even[::2, ::2] | even[1::2, ::2] | even[::2, 1::2] | even[1::2, 1::2]
    return halved


def _box_m(grid: Grid, cells: tuple[int, int, int, int], scale: int) -> Box:
    row1, column1, row2, column2 = (scale * side for side in cells)
    row2, column2 = min(row2, grid.height), min(column2, grid.width)
    side, left, bottom = grid.resolution_m, grid.origin_x_m, grid.origin_y_m
    return (
        round(left + column1 * side, 4),
        round(bottom + row1 * side, 4),
        round(left + column2 * side, 4),
        round(bottom + row2 * side, 4),
    )


def _merged_runs(occupied: NDArray[np.bool_]) -> list[tuple[int, int, int, int]]:
    """Join equal runs of neighbouring rows; (row1, column1, row2, column2), ends not included."""
    done: list[tuple[int, int, int, int]] = []
    open_since: dict[tuple[int, int], int] = {}
    for row in range(occupied.shape[0] + 1):
        runs = set(_runs(occupied[row])) if row < occupied.shape[0] else set()
        ended = [run for run in open_since if run not in runs]
        done.extend((open_since.pop(run), run[0], row, run[1]) for run in ended)
        for run in runs:
            open_since.setdefault(run, row)
    return sorted(done)


def _runs(line: NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate(([False], line, [False])).astype(np.int8)))
    return ((int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True))


def device_footprints(devices: Iterable[Description]) -> dict[str, Corners]:
    """Return the outline of each machine on the floor: four corners in metres, anticlockwise; robots have none."""
    return {d.id: _corners(d) for d in devices if d.kind == "machine" and d.size.x > 0 and d.size.y > 0}


def _corners(device: Description) -> Corners:
    half_x, half_y = device.size.x / 2, device.size.y / 2
    return tuple(
        _from_device(device.pose, dx, dy)
        for dx, dy in ((-half_x, -half_y), (half_x, -half_y), (half_x, half_y), (-half_x, half_y))
    )


def _from_device(pose: Pose, dx: float, dy: float) -> tuple[float, float]:
    turn_x, turn_y = cos(pose.theta), sin(pose.theta)
    return (pose.x + dx * turn_x - dy * turn_y, pose.y + dx * turn_y + dy * turn_x)


def machine_beside(devices: Iterable[Description], robot: Description, reach_m: float = 0.35) -> str | None:
    """Return the machine at which the robot stands: the nearest whose body is within its radius and `reach_m`."""
    beside = [
        (distance, device.id)
        for device in devices
        if device.kind == "machine" and (distance := _gap_m(device, robot.pose)) <= robot.radius_m + reach_m
    ]
    return min(beside)[1] if beside else None


def _gap_m(device: Description, point: Pose) -> float:
    """Return the distance from a point to a device's footprint, 0 inside it."""
    dx, dy = point.x - device.pose.x, point.y - device.pose.y
    ahead, aside = cos(device.pose.theta), sin(device.pose.theta)
    along, across = dx * ahead + dy * aside, dy * ahead - dx * aside
    return hypot(max(abs(along) - device.size.x / 2, 0.0), max(abs(across) - device.size.y / 2, 0.0))


def with_devices(grid: Grid, devices: Iterable[Description]) -> Grid:
    """Return the grid with the machines' footprints occupied."""
    cells = cells_array(grid).copy()
    for device in devices:
        if device.kind == "machine":
            _occupy(grid, cells, device)
    return replace(grid, cells=cells.tobytes())


def _occupy(grid: Grid, cells: NDArray[np.uint8], device: Description, top: int = 0, left: int = 0) -> None:
    """Mark the cells that the machine's outline touches; `cells` are those of the grid from a row and column on."""
    reach_m = hypot(device.size.x, device.size.y) / 2 + grid.resolution_m
    height, width = cells.shape
    rows = _span(device.pose.y - grid.origin_y_m, reach_m, grid.resolution_m, (top, top + height))
    columns = _span(device.pose.x - grid.origin_x_m, reach_m, grid.resolution_m, (left, left + width))
    if rows.start == rows.stop or columns.start == columns.stop:
        return
    y = grid.origin_y_m + (np.arange(rows.start, rows.stop) + 0.5) * grid.resolution_m - device.pose.y
    x = grid.origin_x_m + (np.arange(columns.start, columns.stop) + 0.5) * grid.resolution_m - device.pose.x
    turn_x, turn_y = cos(device.pose.theta), sin(device.pose.theta)
    along = np.abs(x[None, :] * turn_x + y[:, None] * turn_y)
    across = np.abs(y[:, None] * turn_x - x[None, :] * turn_y)
    touch_m = grid.resolution_m / 2 - 1e-9
    touched = cells[rows.start - top : rows.stop - top, columns.start - left : columns.stop - left]
    touched[(along < device.size.x / 2 + touch_m) & (across < device.size.y / 2 + touch_m)] = OCCUPIED


def _span(middle_m: float, reach_m: float, resolution_m: float, within: tuple[int, int]) -> slice:
    first = int((middle_m - reach_m) // resolution_m)
    last = int((middle_m + reach_m) // resolution_m) + 1
    low, high = within
    return slice(min(max(first, low), high), min(max(last, low), high))


def stations(grid: Grid, devices: Iterable[Description], radius_m: float) -> dict[str, Pose]:
    """Return where a robot of that radius stands to serve each machine, facing it.

    It is outside the middle of a side: the roomier of front and back (-y and +y of the machine's own frame), else of
    right and left; sides with room to spare first, then narrower ones, then off the middle. A machine that nothing can
    reach has no station.
    """
    devices = list(devices)
    plan = FloorPlan(grid, devices)
    found = {}
    for device in devices:
        if device.kind == "machine" and (pose := _station(plan, device, radius_m)):
            found[device.id] = pose
    return found


def points_beside(device: Description, radius_m: float) -> tuple[tuple[float, float], ...]:
    """Return where the middle of a robot of that radius would be in front of, behind, right and left of a machine."""
    front_and_back, right_and_left = _sides(device, radius_m + STATION_GAP_M, 0.0)
    return tuple((pose.x, pose.y) for pose in (*front_and_back, *right_and_left))


def _station(plan: FloorPlan, device: Description, radius_m: float) -> Pose | None:
    gap_m = radius_m + STATION_GAP_M
    for spare_m in (COMFORT_M, 0.05):
        for shift in (0.0, -0.25, 0.25):
            for pair in _sides(device, gap_m, shift):
                open_poses = [p for p in pair if plan.is_open(p, radius_m)]
                rooms = [(plan.room_beside_m(device, p), -i, p) for i, p in enumerate(open_poses)]
                if rooms and (best := max(rooms, key=lambda r: r[:2]))[0] >= radius_m + spare_m:
                    return best[2]
    return None


def _sides(device: Description, gap_m: float, shift: float) -> tuple[tuple[Pose, Pose], tuple[Pose, Pose]]:
    """((front, back), (right, left)): outside the middle of each side, or `shift` of its length off the middle."""
    out_x, out_y = device.size.x / 2 + gap_m, device.size.y / 2 + gap_m
    along_x, along_y = shift * device.size.x, shift * device.size.y
    return (
        (_facing(device.pose, along_x, -out_y, pi / 2), _facing(device.pose, along_x, out_y, -pi / 2)),
        (_facing(device.pose, out_x, along_y, pi), _facing(device.pose, -out_x, along_y, 0.0)),
    )


def _facing(machine: Pose, dx: float, dy: float, facing: float) -> Pose:
    x, y = _from_device(machine, dx, dy)
    theta = (machine.theta + facing + pi) % (2 * pi) - pi
    return Pose(round(x, 4), round(y, 4), 0.0, round(theta, 6))


class FloorPlan:
    """What the map says about points and ways, the machines' footprints being obstacles like walls."""

    def __init__(self, grid: Grid, devices: Iterable[Description] = ()) -> None:
        self.grid = grid
        self.mark = f"{grid.width} {grid.origin_x_m} {grid.origin_y_m} {grid.resolution_m} {crc32(grid.cells)}"
        """What tells this map from others, the same in all processes."""
        self._devices = tuple(devices)
        self.clearance_m = clearance_m(with_devices(grid, self._devices))
        self._by_radius = ByRadius()
        self._covers: dict[object, str] = {}

    def __reduce__(self) -> tuple[type[FloorPlan], tuple[Grid, tuple[Description, ...]]]:
        """Be sent to another process as what it was made of; what follows from that is worked out there."""
        return FloorPlan, (self.grid, self._devices)

    @cached_property
    def known_m(self) -> Box:
        """What is known of the map, all of it where nothing is: left, bottom, right and top in metres."""
        known = cells_array(self.grid) != UNKNOWN
        rows, columns = scipy.ndimage.find_objects((known if known.any() else ~known).astype(np.int8))[0]
        return _box_m(self.grid, (rows.start, columns.start, rows.stop, columns.stop), 1)

    def is_inside(self, x_m: float, y_m: float) -> bool:
        """Tell whether the point lies on the map."""
        return self.grid.cell_of(x_m, y_m) is not None

    def is_free(self, x_m: float, y_m: float, radius_m: float) -> bool:
        """Tell whether a robot of that radius can stand at the point."""
        cell = self.grid.cell_of(x_m, y_m)
        return cell is not None and bool(self.clearance_m[cell] >= radius_m)

    def is_reachable(self, from_xy: tuple[float, float], to_xy: tuple[float, float], radius_m: float) -> bool:
        """Tell whether a robot of that radius finds a way.

        Where it starts may be a little too near to a wall; where it goes may not.
        """
        goal = self.grid.cell_of(*to_xy)
        if goal is None or self.clearance_m[goal] < radius_m:
            return False
        region = self.regions(radius_m)[goal]
        return bool(region) and region in self._regions_around(from_xy, radius_m)

    def can_stop(self, x_m: float, y_m: float, radius_m: float) -> bool:
        """Tell whether traffic lets robots drive to a point, `radius_m` being the largest robot's of the site."""
        return attach(*self._traffic_of(radius_m), (x_m, y_m)) is not None

    def why_not_covered(self, outline: tuple[tuple[float, float], ...], lane_m: float, radius_m: float) -> str:
        """Return why robots cannot cover a zone in lanes so wide: outside, nothing, too_many; empty: they can.

        `radius_m` is the largest robot's of the site.
        """
        key = (outline, lane_m, radius_m)
        if key not in self._covers:
            if len(self._covers) >= MOST_COVERS:
                self._covers.clear()
            try:
                plan_lanes(*self._traffic_of(radius_m), outline, lane_m)
                self._covers[key] = ""
            except CannotCover as error:
                self._covers[key] = error.code
        return self._covers[key]

    def _traffic_of(self, radius_m: float) -> tuple[Ground, Lattice]:
        kept = self._by_radius[radius_m]
        if kept.traffic is None:
            ground = Ground(self.grid, self.clearance_m, radius_m)
            kept.traffic = ground, make_lattice(ground)
        return kept.traffic

    def regions(self, radius_m: float) -> NDArray[np.int32]:
        """Return the number of the connected region of each cell where the robot's middle may be; 0 is nowhere."""
        kept = self._by_radius[radius_m]
        if kept.regions is None:
            kept.regions = scipy.ndimage.label(self.clearance_m >= radius_m)[0]
        return kept.regions

    def main_region(self, radius_m: float) -> int:
        """Return the number of the largest region in which a robot of that radius can drive about; 0: there is none."""
        kept = self._by_radius[radius_m]
        if kept.main_region is None:
            labels = self.regions(radius_m)
            sizes = np.zeros(int(labels.max(initial=0)) + 1, dtype=np.int64)
            for top in range(0, labels.shape[0], BAND_ROWS):
                sizes += np.bincount(labels[top : top + BAND_ROWS].ravel(), minlength=sizes.size)
            kept.main_region = 1 + int(np.argmax(sizes[1:])) if sizes.size > 1 else 0
        return kept.main_region

    def station(self, device_id: str, radius_m: float) -> tuple[float, float] | None:
        """Return where a robot of that radius stands to serve a machine; None when it has no room to."""
        kept = self._by_radius[radius_m].stations
        if device_id not in kept:
            found = next((device for device in self._devices if device.id == device_id), None)
            kept[device_id] = None if found is None else _station(self, found, radius_m)
        pose = kept[device_id]
        return None if pose is None else (pose.x, pose.y)

    def has_machine(self, device_id: str) -> bool:
        """Tell whether the machine stands on this floor."""
        return any(device.id == device_id for device in self._devices)

    def is_open(self, pose: Pose, radius_m: float) -> bool:
        """Tell whether the pose's cell lies in the largest region in which a robot of that radius can drive."""
        cell, main = self.grid.cell_of(pose.x, pose.y), self.main_region(radius_m)
        return cell is not None and main > 0 and int(self.regions(radius_m)[cell]) == main

    def room_beside_m(self, device: Description, pose: Pose) -> float:
        """Return how far the pose is from everything but the device itself, in metres."""
        others = [d for d in self._devices if d.kind == "machine" and d.id != device.id]
        cell = self.grid.cell_of(pose.x, pose.y)
        return 0.0 if cell is None else _clearance_near(self.grid, others, cell)

    def _regions_around(self, xy: tuple[float, float], radius_m: float) -> set[int]:
        reach = max(1, round(radius_m / self.grid.resolution_m))
        cell = self.grid.cell_of(*xy)
        if cell is None:
            return set()
        rows, columns = (slice(max(0, middle - reach), middle + reach + 1) for middle in cell)
        return set(np.unique(self.regions(radius_m)[rows, columns]).tolist())


def _clearance_near(grid: Grid, machines: Iterable[Description], cell: tuple[int, int], reach_m: float = 1.5) -> float:
    """Return the clearance of one cell among walls and machines, looking no farther than `reach_m`."""
    reach = round(reach_m / grid.resolution_m)
    row, column = cell
    top, left = max(0, row - reach - 1), max(0, column - reach - 1)
    cells = cells_array(grid)[top : row + reach + 2, left : column + reach + 2].copy()
    for machine in machines:
        _occupy(grid, cells, machine, top, left)
    # what lies off the map is wall; what the window cuts off is too far away to count
    edges = ((row <= reach, row + reach + 1 >= grid.height), (column <= reach, column + reach + 1 >= grid.width))
    free = np.pad(cells == FREE, [(int(low), int(high)) for low, high in edges], constant_values=False)
    if free.all():
        return reach_m
    rows, columns = np.nonzero(~free)
    nearest = np.hypot(rows - (row - top + edges[0][0]), columns - (column - left + edges[1][0])).min()
    return max(0.0, (float(nearest) - 0.5) * grid.resolution_m)

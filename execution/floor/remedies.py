"""What would mend a finding of the floor check: a small move of a place or a machine after which it is gone.

Pure. A move is proposed only where the floor, checked anew, has lost the finding and got no other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import takewhile
from math import ceil, cos, hypot, pi, sin

import numpy as np
from numpy.typing import NDArray

from editor.language.site.surroundings import PlaceFacts
from execution.floor.floor_check import Finding, FloorCheck, check_floor
from execution.traffic.layout import Layout, make_layout
from execution.traffic.zones import shut_cells
from registry.floorplan.lattice import STANDING_MARGIN_M, Ground, Point
from registry.floorplan.plan import FREE, Grid, cells_array, device_footprints
from registry.floorplan.zone_masks import cells_touched
from vipo_device.protocol.description import Description

STEP_M = 0.05
"""Moves are whole numbers of these steps."""
RINGS = (2, 4, 7, 10, 15, 20)
"""So many steps off places are tried first, up to a metre; what mends is then brought back towards the place."""
DIRECTIONS = 16
AXES = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))
MACHINE_STEPS = (0, 1, 2, 4, 8)
"""By so many steps beyond what is lacking a machine is tried: each is a floor of its own, with other clearances."""
_MOVED_PLACES = {"together": ("target", "other"), "in_the_way": ("other", "target")}
_BY_MAP = frozenset({"no_room", "too_narrow", "no_way", "off_lattice"})
"""What the map says. What zones do is mended where they are drawn."""
_AT_TARGET = frozenset({"no_room", "off_lattice"})
"""What is wrong at the machine itself, so that it may be the one to move."""


@dataclass(frozen=True, slots=True)
class Remedy:
    """A place or machine that is moved to a point in metres, so many metres from where it is."""

    target: str
    at: Point
    by_m: float


@dataclass(frozen=True)
class CheckedFloor:
    """A floor, laid out for its robots, with its places and what was found on it."""

    grid: Grid
    layout: Layout
    places: tuple[PlaceFacts, ...]
    check: FloorCheck

    @cached_property
    def taken(self) -> NDArray[np.bool_]:
        """Which cells [row, column] of the map are no free floor."""
        return np.asarray(cells_array(self.grid) != FREE)

    @cached_property
    def found(self) -> frozenset[tuple[str, str, str | None]]:
        """What tells its findings apart: codes, targets and others."""
        return frozenset(map(_key, self.check.findings))


_Trial = Callable[[CheckedFloor], FloorCheck]
"""Checks a floor with something moved on it."""


@dataclass(frozen=True)
class _Search:
    """What is looked for: a move after which the floor has lost the finding, and `own` has got no other one.

    `own` is the same floor for the site's own robots, where the first is for others. `is_over` ends it early.
    """

    floor: CheckedFloor
    finding: Finding
    own: CheckedFloor | None
    is_over: Callable[[], bool]

    def first(self, trials: Iterable[tuple[Point, _Trial]]) -> Point | None:
        """Return the first point that mends; None where none does, or time was over before."""
        going = takewhile(lambda _: not self.is_over(), trials)
        return next((at for at, trial in going if self._mends(trial)), None)

    def _mends(self, trial: _Trial) -> bool:
        wanted = self.floor.found - {_key(self.finding)}
        if not {_key(each) for each in trial(self.floor).findings} <= wanted:
            return False
        return self.own is None or {_key(each) for each in trial(self.own).findings} <= self.own.found


def find_remedies(
    floor: CheckedFloor,
    finding: Finding,
    own: CheckedFloor | None = None,
    is_over: Callable[[], bool] = lambda: False,
) -> tuple[Remedy, ...]:
    """Return what would mend a finding, the smallest move first; nothing where none of a metre was found.

    Where the floor was checked for another width, `own` is that of the site's own robots, which must find nothing new
    either. The search ends early when `is_over` says so.
    """
    search = _Search(floor, finding, own, is_over)
    places = {place.id: place for place in floor.places}
    names = [getattr(finding, role) for role in _MOVED_PLACES.get(finding.code, ())]
    if finding.code in _BY_MAP:
        names = [finding.target]
    found = [_move_place(search, places[name]) for name in names if name in places]
    if finding.code in _BY_MAP:
        found += [_move_machine(search, device, ways) for device, ways in _movable_machines(floor, finding)]
    return tuple(sorted((each for each in found if each), key=lambda each: each.by_m))


def _key(finding: Finding) -> tuple[str, str, str | None]:
    return finding.code, finding.target, finding.other


def _move_place(search: _Search, place: PlaceFacts) -> Remedy | None:
    """Move a place in all directions, farther and farther, then bring it back as far as that still mends."""
    at = search.first(_stands(search, place, _around(place.x, place.y)))
    if at is None:
        return None
    start = (place.x, place.y)
    steps = round(_distance(start, at) / STEP_M)
    near = [_between(start, at, step / steps) for step in range(1, steps)]
    nearer = search.first(_stands(search, place, near)) or at
    return Remedy(place.id, nearer, _distance(start, nearer))


def _around(x: float, y: float) -> Iterator[Point]:
    """Go through points around one, the nearest first; along the axes before all other directions."""
    turns = sorted((2 * pi * number / DIRECTIONS for number in range(DIRECTIONS)), key=lambda turn: turn % (pi / 2) > 0)
    for ring in RINGS:
        for turn in turns:
            yield (round(x + ring * STEP_M * cos(turn), 2), round(y + ring * STEP_M * sin(turn), 2))


def _between(start: Point, end: Point, share: float) -> Point:
    x, y = ((end[axis] - start[axis]) * share + start[axis] for axis in (0, 1))
    return (round(x, 2), round(y, 2))


def _stands(search: _Search, place: PlaceFacts, points: Iterable[Point]) -> Iterator[tuple[Point, _Trial]]:
    """Go through those of the points where a robot could stand that keeps no other from standing.

    None is behind a wall: a dock stays in its room.
    """
    layout, finding = search.floor.layout, search.finding
    shut, needs_m = shut_cells(layout, layout.zones), layout.ground.radius_m + STANDING_MARGIN_M
    near = {each.target if each.other == place.id else each.other for each in search.floor.check.findings
            if each.code == "together" and place.id in (each.target, each.other)}  # fmt: skip
    mended = {finding.target, finding.other} if finding.code == "together" else set()
    stops = {each.id for each in search.floor.places if each.kind != "room"} - {place.id} - (near - mended)
    others = [spot for name, spot in layout.places.items() if name in stops]
    for at in points:
        if layout.ground.room_m(at) < needs_m or not _leads_straight(layout.ground, (place.x, place.y), at):
            continue
        moved = replace(place, x=at[0], y=at[1])
        spot = layout.with_place(moved).places.get(place.id)
        if spot is not None and spot.cell not in shut and not any(spot.body & other.body for other in others):
            yield at, partial(_check_with_place, moved)


def _leads_straight(ground: Ground, start: Point, end: Point) -> bool:
    """Tell whether nothing lies between two points, but for what the first one may stand in."""
    count = max(2, ceil(2 * _distance(start, end) / ground.grid.resolution_m))
    free = [ground.room_m(_between(start, end, step / count)) > 0.0 for step in range(count + 1)]
    return all(free[free.index(True) :]) if True in free else False


def _check_with_place(moved: PlaceFacts, floor: CheckedFloor) -> FloorCheck:
    places = tuple(moved if each.id == moved.id else each for each in floor.places)
    return check_floor(floor.grid, floor.layout.with_place(moved), places, with_widths=False)


def _movable_machines(floor: CheckedFloor, finding: Finding) -> Iterator[tuple[Description, tuple[Point, ...]]]:
    """Go through the machines that may stand in the way, with the directions in which each would make room."""
    devices = floor.layout.devices
    ways: dict[str, Point] = {}
    for number, name in enumerate(finding.beside):
        if name is not None:
            far = finding.sides[1 - number] if len(finding.sides) > 1 else finding.at
            ways.setdefault(name, _direction(far, finding.sides[number]))
    for name, way in ways.items():
        yield devices[name], (_along_axis(way), way)
    if finding.code in _AT_TARGET and finding.target in devices and finding.target not in ways:
        yield devices[finding.target], AXES


def _along_axis(way: Point) -> Point:
    """Return the direction along an axis of the map that is nearest: what stands straight stays in line."""
    return max(AXES, key=lambda axis: axis[0] * way[0] + axis[1] * way[1])


def _direction(start: Point, end: Point) -> Point:
    far = hypot(end[0] - start[0], end[1] - start[1])
    return ((end[0] - start[0]) / far, (end[1] - start[1]) / far) if far else AXES[0]


def _move_machine(search: _Search, machine: Description, directions: tuple[Point, ...]) -> Remedy | None:
    at = search.first(_put(search, machine, directions))
    return at and Remedy(machine.id, at, _distance((machine.pose.x, machine.pose.y), at))


def _put(search: _Search, machine: Description, directions: tuple[Point, ...]) -> Iterator[tuple[Point, _Trial]]:
    """Go through the points where a machine would have room, from what is lacking on."""
    short_m = (search.finding.needs_m or 0.0) - (search.finding.width_m or 0.0)
    first = max(1, ceil(round(short_m / STEP_M, 6)))
    room = _Room(search.floor, machine)
    for step in (first + more for more in MACHINE_STEPS if first + more <= RINGS[-1]):
        for way_x, way_y in directions:
            at = (round(machine.pose.x + step * STEP_M * way_x, 2), round(machine.pose.y + step * STEP_M * way_y, 2))
            moved = replace(machine, pose=replace(machine.pose, x=at[0], y=at[1]))
            if room.has(moved):
                yield at, partial(_check_with_machine, moved)


def _check_with_machine(moved: Description, floor: CheckedFloor) -> FloorCheck:
    devices = [moved if device.id == moved.id else device for device in floor.layout.devices.values()]
    layout = make_layout(floor.grid, devices, floor.places, floor.layout.zones)
    return check_floor(floor.grid, replace(layout, bodies=floor.layout.bodies), floor.places, with_widths=False)


class _Room:
    """Whether a machine stands on no more of walls, of other machines and of what is off the map than where it is."""

    def __init__(self, floor: CheckedFloor, machine: Description) -> None:
        self._grid, self._taken = floor.grid, floor.taken.copy()
        others = [device for device in floor.layout.devices.values() if device.id != machine.id]
        for outline in device_footprints(others).values():
            self._taken |= cells_touched(floor.grid, outline)
        self._before = self._covered(machine)

    def has(self, moved: Description) -> bool:
        return all(now <= before for now, before in zip(self._covered(moved), self._before, strict=True))

    def _covered(self, machine: Description) -> tuple[int, int]:
        """Return how many cells that are taken it covers, and how many of its corners are off the map."""
        (outline,) = device_footprints([machine]).values()
        outside = sum(self._grid.cell_of(*corner) is None for corner in outline)
        return int((cells_touched(self._grid, outline) & self._taken).sum()), outside


def _distance(start: Point, end: Point) -> float:
    return round(hypot(end[0] - start[0], end[1] - start[1]), 2)

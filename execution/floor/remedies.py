"""What would mend a finding of the floor check: the least move of a place or a machine after which it is gone.

Pure. A move is proposed only where the floor, checked anew, has lost the finding and got no other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import islice
from math import ceil, cos, hypot, pi, sin

import numpy as np
from numpy.typing import NDArray

from editor.language.site.surroundings import PlaceFacts
from execution.floor.floor_check import Finding, FloorCheck, check_floor
from execution.traffic.layout import Layout, make_layout
from execution.traffic.zones import shut_cells
from registry.floorplan.lattice import STANDING_MARGIN_M, Point
from registry.floorplan.plan import FREE, Grid, cells_array, device_footprints
from registry.floorplan.zone_masks import cells_touched
from vipo_device.protocol.description import Description

STEP_M, FARTHEST_M = 0.05, 1.0
"""Moves are tried in such steps, up to so far."""
DIRECTIONS = 16
AXES = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))
MACHINE_STEPS = 6
"""So many distances are tried of a machine: each is a floor of its own, with other clearances."""
MOST_TRIALS = 24
MOST_SPOTS_TRIED = 1_200
"""A floor is checked so often for one move at most, and a large one only as often as makes so many spots."""
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
    def trials(self) -> int:
        """How often it is checked anew for one move at most."""
        spots = len(self.layout.stations) + len(self.layout.places)
        return max(3, min(MOST_TRIALS, MOST_SPOTS_TRIED // max(1, spots)))

    @cached_property
    def taken(self) -> NDArray[np.bool_]:
        """Which cells [row, column] of the map are no free floor."""
        return np.asarray(cells_array(self.grid) != FREE)


def find_remedies(floor: CheckedFloor, finding: Finding) -> tuple[Remedy, ...]:
    """Return what would mend a finding, the least move first; nothing where no move of a metre does."""
    places = {place.id: place for place in floor.places}
    names = [getattr(finding, role) for role in _MOVED_PLACES.get(finding.code, ())]
    if finding.code in _BY_MAP:
        names = [finding.target]
    found = [_move_place(floor, finding, places[name]) for name in names if name in places]
    if finding.code in _BY_MAP:
        found += [_move_machine(floor, finding, device, ways) for device, ways in _movable_machines(floor, finding)]
    return tuple(sorted((each for each in found if each), key=lambda each: each.by_m))


def _is_mended(floor: CheckedFloor, finding: Finding, now: FloorCheck) -> bool:
    before = {_key(each) for each in floor.check.findings}
    return {_key(each) for each in now.findings} <= before - {_key(finding)}


def _key(finding: Finding) -> tuple[str, str, str | None]:
    return finding.code, finding.target, finding.other


def _least(
    floor: CheckedFloor, finding: Finding, trials: Iterable[tuple[Point, Callable[[], FloorCheck]]]
) -> Point | None:
    """Return the first point with which the finding is gone."""
    for at, check in islice(trials, floor.trials):
        if _is_mended(floor, finding, check()):
            return at
    return None


def _move_place(floor: CheckedFloor, finding: Finding, place: PlaceFacts) -> Remedy | None:
    at = _least(floor, finding, _places_to_stand(floor, finding, place))
    return at and Remedy(place.id, at, _distance((place.x, place.y), at))


def _places_to_stand(
    floor: CheckedFloor, finding: Finding, place: PlaceFacts
) -> Iterator[tuple[Point, Callable[[], FloorCheck]]]:
    """Go through the points around a place where a robot could stand that keeps no other from standing."""
    layout, shut = floor.layout, shut_cells(floor.layout, floor.layout.zones)
    needs_m = layout.ground.radius_m + STANDING_MARGIN_M
    already = {each.target if each.other == place.id else each.other for each in floor.check.findings
               if each.code == "together" and place.id in (each.target, each.other)}  # fmt: skip
    apart = already - ({finding.target, finding.other} if finding.code == "together" else set())
    others = [spot for name, spot in layout.places.items() if name != place.id and name not in apart]
    for at in _points_around(place.x, place.y):
        if layout.ground.room_m(at) < needs_m:
            continue
        moved = replace(place, x=at[0], y=at[1])
        trial = layout.with_place(moved)
        spot = trial.places.get(place.id)
        if spot is None or spot.cell in shut or any(spot.body & other.body for other in others):
            continue
        places = tuple(moved if each.id == place.id else each for each in floor.places)
        yield at, partial(check_floor, floor.grid, trial, places)


def _points_around(x: float, y: float) -> Iterator[Point]:
    """Go through points around one, the nearest first; along the axes before all other directions."""
    turns = sorted((2 * pi * number / DIRECTIONS for number in range(DIRECTIONS)), key=lambda turn: turn % (pi / 2) > 0)
    for step in range(1, round(FARTHEST_M / STEP_M) + 1):
        for turn in turns:
            yield (round(x + step * STEP_M * cos(turn), 2), round(y + step * STEP_M * sin(turn), 2))


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


def _move_machine(
    floor: CheckedFloor, finding: Finding, machine: Description, directions: tuple[Point, ...]
) -> Remedy | None:
    at = _least(floor, finding, _places_to_put(floor, finding, machine, directions))
    return at and Remedy(machine.id, at, _distance((machine.pose.x, machine.pose.y), at))


def _places_to_put(
    floor: CheckedFloor, finding: Finding, machine: Description, directions: tuple[Point, ...]
) -> Iterator[tuple[Point, Callable[[], FloorCheck]]]:
    """Go through the points where a machine would have room, from what is lacking on."""
    short_m = (finding.needs_m or 0.0) - (finding.width_m or 0.0)
    first = max(1, ceil(round(short_m / STEP_M, 6)))
    others = [device for device in floor.layout.devices.values() if device.id != machine.id]
    room = _Room(floor, machine, others)
    for step in range(first, first + MACHINE_STEPS):
        for way_x, way_y in directions if step * STEP_M <= FARTHEST_M else ():
            at = (round(machine.pose.x + step * STEP_M * way_x, 2), round(machine.pose.y + step * STEP_M * way_y, 2))
            moved = _put(machine, at)
            if room.has(moved):
                yield at, partial(_check_with, floor, [*others, moved])


def _put(machine: Description, at: Point) -> Description:
    return replace(machine, pose=replace(machine.pose, x=at[0], y=at[1]))


def _check_with(floor: CheckedFloor, devices: list[Description]) -> FloorCheck:
    layout = make_layout(floor.grid, devices, floor.places, floor.layout.zones)
    return check_floor(floor.grid, replace(layout, bodies=floor.layout.bodies), floor.places)


class _Room:
    """Whether a machine stands on no more of walls and other machines than where it is."""

    def __init__(self, floor: CheckedFloor, machine: Description, others: Iterable[Description]) -> None:
        self._grid, self._taken = floor.grid, floor.taken.copy()
        for outline in device_footprints(others).values():
            self._taken |= cells_touched(floor.grid, outline)
        self._before = self._covered(machine)

    def has(self, moved: Description) -> bool:
        return self._covered(moved) <= self._before

    def _covered(self, machine: Description) -> int:
        (outline,) = device_footprints([machine]).values()
        return int((cells_touched(self._grid, outline) & self._taken).sum())


def _distance(start: Point, end: Point) -> float:
    return round(hypot(end[0] - start[0], end[1] - start[1]), 2)

"""Where new steps stand on the map: near the devices they speak of, off devices and off other steps.

What a loop or a Try holds stands below its head, in one column; a free area for all of it is looked for at once.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from editor.language.constructs.record import Construct, Field
from editor.language.constructs.table import CONSTRUCTS, STEPS
from editor.language.document.catches import KINDS_OF
from editor.language.document.outline import mapping
from editor.language.expressions.nodes import Point
from editor.language.expressions.values import read_point
from editor.language.site.surroundings import Surroundings

GAP_M = 0.35
"""Between two steps, above and beside each other."""
PADDING_M = 0.25
_OFF_WALLS_M = 0.1
_ROBOT_M, _NAME_M = 1.1, 0.7
"""A robot at home, and its name below it."""
_CELL_M = 2.5
_FIRST: Point = (1.0, -1.0)
"""Below it stands the first step of a script that names no device and no point, as on the editor's map."""
_STEP_X_M, _STEP_Y_M = 0.9, 0.5
_REACH = 14
_MOST_MISSES = 3
"""After so many steps without a free place the floor counts as full."""
_BRANCH_SIDES = {"then": 0.0, "else": -1.0, "a": -1.0, "b": 1.0, "finally": 1.5} | dict.fromkeys(KINDS_OF, 1.0)
_OFFSETS = sorted(
    ((x * _STEP_X_M, y * _STEP_Y_M) for x in range(-_REACH, _REACH + 1) for y in range(-_REACH, _REACH + 1)),
    key=lambda offset: (round(abs(offset[0]) + abs(offset[1]), 2), offset[1], offset[0]),
)


@dataclass(frozen=True, slots=True)
class Area:
    """A rectangle by its middle, in metres."""

    x: float
    y: float
    room: Room

    def covers(self, other: Area) -> bool:
        """Tell whether the two have a part in common."""
        reach_x = (self.room.width_m + other.room.width_m) / 2
        reach_y = (self.room.height_m + other.room.height_m) / 2
        return abs(self.x - other.x) < reach_x and abs(self.y - other.y) < reach_y

    def shared_m2(self, other: Area) -> float:
        """Return how large the part is that the two have in common."""
        across = _shared_m(self.x, self.room.width_m, other.x, other.room.width_m)
        return across * _shared_m(self.y, self.room.height_m, other.y, other.room.height_m)


@dataclass(slots=True)
class Layout:
    """The places that are taken; each new step gets the nearest free one."""

    surroundings: Surroundings
    cells: dict[tuple[int, int], list[Area]] = field(default_factory=dict)
    """What is taken, by the cells that it touches."""
    first: Point | None = None
    last: Area = field(init=False)
    tried: dict[tuple[Point, Room], int] = field(default_factory=dict)
    """How many places around a wanted one are known to be taken."""
    misses: int = 0

    def __post_init__(self) -> None:
        self.last = Area(*self._first_spot(), Room(0.0, 0.0))
        for facts in self.surroundings.devices.values():
            x, y, size = facts.description.pose.x, facts.description.pose.y, facts.description.size
            if facts.description.kind == "robot":
                self._take(Area(x, y - _NAME_M / 2, Room(_ROBOT_M, _ROBOT_M + _NAME_M)))
            else:
                self._take(Area(x, y, Room(size.x, max(0.1, size.y - 0.2))))

    def _first_spot(self) -> Point:
        """Return the usual spot, or on a floor that does not hold it one as far inside its top left."""
        floor = self.surroundings.floor
        if floor is None:
            return _FIRST
        left, bottom, right, top = floor.known_m
        inside = left < _FIRST[0] < right and bottom < _FIRST[1] < top
        return _FIRST if inside else _rounded((left + _FIRST[0], top + _FIRST[1]))

    def occupy(self, point: Point | None, room: Room) -> None:
        """Keep a place for a step that stands there already."""
        if point is not None:
            self.first = self.first or point
            self._take(Area(point[0], point[1], room))

    def follow(self, point: Point | None, room: Room) -> None:
        """Put the next step that has no place of its own below this one."""
        if point is not None:
            self.last = Area(point[0], point[1], room)

    def enter(self, head: Area, branch: str) -> None:
        """Go into a branch of the step that stands there: its first step stands below, or below and aside."""
        aside = _BRANCH_SIDES.get(branch, 0.0) * (head.room.width_m / 2 + 1.5)
        self.last = Area(head.x + aside, head.y, head.room)

    def start(self) -> list[float]:
        """Return a place for the start."""
        first = self.first or (self.last.x, self.last.y)
        return [round(first[0], 2), round(first[1] + 1.6, 2)]

    def put(self, kind: str, params: Mapping[str, object], block: Room) -> list[float]:
        """Return a free place for a step; the block is its room with all that stands below it in its frame."""
        own = room_of(kind, params)
        wanted = self._wanted(kind, params, own)
        below = (block.height_m - own.height_m) / 2
        x, y = self._free_near((wanted[0], round(wanted[1] - below, 2)), block)
        return self._stand((x, round(y + below, 2)), own)

    def put_below(self, kind: str, params: Mapping[str, object]) -> list[float]:
        """Return the place right below the last step, for a step in a frame."""
        own = room_of(kind, params)
        return self._stand(self._below(own), own)

    def _stand(self, point: Point, room: Room) -> list[float]:
        self.occupy(point, room)
        self.last = Area(point[0], point[1], room)
        return list(point)

    def keep_block(self, head: Area, block: Room) -> None:
        """Keep the whole area of a frame for what stands in it."""
        middle = head.y + head.room.height_m / 2 - block.height_m / 2
        self._take(Area(head.x, middle, Room(block.width_m + 2 * PADDING_M, block.height_m + 2 * PADDING_M)))

    def _below(self, own: Room) -> Point:
        return self.last.x, round(self.last.y - (self.last.room.height_m + own.height_m) / 2 - GAP_M, 2)

    def _wanted(self, kind: str, params: Mapping[str, object], own: Room) -> Point:
        named = [self._where(params.get(name)) for name in ("source", "target", "at", "device", "to")]
        known = [point for point in named if point is not None]
        if not known:
            return self._below(own)
        if kind == "operate":
            height = self._height(mapping(params.get("device")).get("device"))
            return known[0][0], known[0][1] + height / 2 + own.height_m / 2
        return sum(x for x, _ in known) / len(known), sum(y for _, y in known) / len(known)

    def _where(self, place: object) -> Point | None:
        named = mapping(place)
        device = self.surroundings.devices.get(str(named.get("device")))
        if device is not None:
            return device.description.pose.x, device.description.pose.y
        known = self.surroundings.places.get(str(named.get("place")))
        return read_point(named.get("point")) if known is None else (known.x, known.y)

    def _height(self, device: object) -> float:
        facts = self.surroundings.devices.get(str(device))
        return 1.0 if facts is None else facts.description.size.y

    def _free_near(self, wanted: Point, room: Room) -> Point:
        """Look around the wanted place, the nearest first; where all is taken, where least is covered.

        A floor on which that has happened several times counts as full: there the wanted place is taken as it is.
        """
        key = wanted, room
        for index in range(self.tried.get(key, 0), len(_OFFSETS) if self.misses < _MOST_MISSES else 0):
            dx, dy = _OFFSETS[index]
            point = _rounded((wanted[0] + dx, wanted[1] + dy))
            if self._is_free(point, room):
                self.tried[key] = index
                return point
        self.misses += 1
        return self._least_covering(wanted, room) if self.misses < _MOST_MISSES else _rounded(wanted)

    def _least_covering(self, wanted: Point, room: Room) -> Point:
        """Return the place on the map, the nearest of equal ones, that covers least; as wanted if there is none."""
        points = [_rounded((wanted[0] + dx, wanted[1] + dy)) for dx, dy in _OFFSETS]
        on_floor = [point for point in points if self._is_on_floor(*point, room)]
        return min(
            on_floor, key=lambda point: self._covered_m2(Area(point[0], point[1], room)), default=_rounded(wanted)
        )

    def _covered_m2(self, area: Area) -> float:
        taken = {id(each): each for cell in _cells(area) for each in self.cells.get(cell, ())}
        return sum(area.shared_m2(each) for each in taken.values())

    def _is_free(self, point: Point, room: Room) -> bool:
        x, y = point
        if not self._is_on_floor(x, y, room):
            return False
        area = Area(x, y, Room(room.width_m + GAP_M, room.height_m + GAP_M / 2))
        return not any(area.covers(each) for cell in _cells(area) for each in self.cells.get(cell, ()))

    def _is_on_floor(self, x: float, y: float, room: Room) -> bool:
        """Tell whether its middle stands off walls and no end beyond the map."""
        floor = self.surroundings.floor
        if floor is None:
            return True
        half_x, half_y = room.width_m / 2, room.height_m / 2
        ends = ((x - half_x, y), (x + half_x, y), (x, y - half_y), (x, y + half_y))
        return floor.is_free(x, y, _OFF_WALLS_M) and all(floor.is_inside(*end) for end in ends)

    def _take(self, area: Area) -> None:
        for cell in _cells(area):
            self.cells.setdefault(cell, []).append(area)


def _rounded(point: Point) -> Point:
    return round(point[0], 2), round(point[1], 2)


def _shared_m(middle: float, width: float, other: float, other_width: float) -> float:
    """Return how long the part is that two stretches have in common."""
    right, left = min(middle + width / 2, other + other_width / 2), max(middle - width / 2, other - other_width / 2)
    return max(0.0, right - left)


def _cells(area: Area) -> Iterator[tuple[int, int]]:
    left, right = (math.floor((area.x + side * area.room.width_m / 2) / _CELL_M) for side in (-1, 1))
    bottom, top = (math.floor((area.y + side * area.room.height_m / 2) / _CELL_M) for side in (-1, 1))
    return ((column, row) for column in range(left, right + 1) for row in range(bottom, top + 1))


HEIGHT_M, LETTER_M, ENDS_M = 0.7, 0.15, 1.7
"""A chip's height, a letter's width, and the room for number, icon and padding."""
LONGEST_SENTENCE, LONGEST = 30, 44
SAYS_HOW_MANY = 18
"""Letters that a chip has for how many branches end a Parallel."""
FRAMES = frozenset(construct.kind for construct in STEPS if construct.look.shape == "header")
"""Kinds whose body stands in a frame below their head."""


@dataclass(frozen=True, slots=True)
class Room:
    """Width and height in metres."""

    width_m: float
    height_m: float


def room_of(kind: str, params: Mapping[str, object]) -> Room:
    """Return the room that a step needs; an If's with its condition beside it."""
    known = CONSTRUCTS.get(kind)
    height_m = 1.4 if known is not None and known.look.tall else HEIGHT_M
    if known is not None and known.look.shape == "diamond":
        return Room(1.4 + 2 * LETTER_M * min(letters(params.get("condition")), 20), height_m)
    text = min(_letters_shown(known, params) if known else 8 + letters(params), LONGEST)
    return Room(round(ENDS_M + LETTER_M * text, 2), height_m)


def _letters_shown(construct: Construct, params: Mapping[str, object]) -> int:
    form = next(
        (form for form in construct.forms if form.marked_by and params.get(form.marked_by)), construct.forms[-1]
    )
    shown = (field for field in form.fields if field.shown)
    return construct.look.letters + sum(_letters_of(field, construct.kind, params.get(field.name)) for field in shown)


def _letters_of(field: Field, kind: str, value: object) -> int:
    if field.type == "arguments":
        named = 1 if kind == "call" else 0
        return sum(3 + named * (1 + len(name)) + letters(given) for name, given in mapping(value).items())
    if field.type == "whole":
        return 0 if value is None else SAYS_HOW_MANY
    return min(letters(value), LONGEST_SENTENCE) if field.wanted == "text" else letters(value)


def letters(value: object) -> int:
    """Return about how many letters a value is written with."""
    if isinstance(value, Mapping):
        return sum(letters(part) for part in value.values())
    if isinstance(value, list | tuple):
        return sum(2 + letters(part) for part in value)
    return 0 if value is None else len(str(value))

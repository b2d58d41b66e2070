"""How a floor was used, out of the journals of runs: where robots drove, and what waiting before zones cost; pure.

What is counted:

- A *drive* is what a line "way" of a journal says: the path on which a robot of the run set out. Where the robot has
  set out anew in the same run, and from a point of that path, the path is counted as far as there; else all of it, also
  where the run ended before the robot had arrived. Where it went to make room for others is in no journal.
- A square of the floor is counted once for each drive that comes through it, however often it does.
- A *wait* before a zone that is taken begins with a line of the code "zone_taken" and ends with the next line of the
  same step that says something else: that it goes on, that it waits for something else, that it was not done; or with
  the run. A line that only says that others are in the zone by now goes on with the wait that there is. A wait of no
  length is none.

Nothing is counted of lines that are not read: those from before the days that are asked for, and those of runs that
are in an archive.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from itertools import pairwise
from math import floor, hypot

SQUARE_M = 0.25
"""The side of the squares in which drives are counted, on floors on which these are not too many."""
MOST_SQUARES = 40_000
ON_PATH_M = 0.5
"""So near to a path a point counts as being on it: journals have tidy lines, whose ends are up to a cell aside."""
SLOT_MIN = 10
BUSY_SLOTS = 3
SLOTS = 24 * 60 // SLOT_MIN
_SLOT_S = SLOT_MIN * 60.0
_DAY_S = 24 * 3600.0
_HAIR = 1e-6
"""A path along the border of squares counts as being on the one side all along, whatever its last digits are."""
Point = tuple[float, float]
Path = Sequence[Point]
Square = tuple[int, int]


@dataclass(frozen=True, slots=True)
class JournalLine:
    """A line of a run's journal, as far as it tells of a drive (`path`, metres) or what a step waits for.

    `zone` is the key of the zone before which the step waits, empty if it waits for nothing or for something else.
    """

    run: str
    at: datetime
    step: str = ""
    robot: str = ""
    zone: str = ""
    path: Path = ()


@dataclass(frozen=True, slots=True)
class Drive:
    """A polyline in metres along which a robot drove."""

    path: Path


@dataclass(frozen=True, slots=True)
class ZoneWait:
    """A stretch of waiting before a zone; where `goes_on` it ends only with the next one, and is a part of that."""

    zone: str
    begun_at: datetime
    ended_at: datetime
    goes_on: bool = False


@dataclass(frozen=True, slots=True)
class ZoneUse:
    """How often anybody waited before a zone, for how many seconds in all, and when most.

    `busiest_min` is where the half hour of the day begins in which the most waiting was, over all days: minutes since
    midnight, in steps of ten; it may go beyond midnight. None where nobody waited.
    """

    waits: int = 0
    waited_s: float = 0.0
    busiest_min: int | None = None


@dataclass(slots=True)
class _Tally:
    """What is known of a zone so far; `slots` is seconds in each ten minutes of the day."""

    waits: int = 0
    waited_s: float = 0.0
    slots: list[float] = field(default_factory=lambda: [0.0] * SLOTS)


def read_back(lines: Iterable[JournalLine], ends: Mapping[str, datetime]) -> Iterator[Drive | ZoneWait]:
    """Yield drives and waits out of journals that are read backwards: the lines of each run, the last one first.

    `ends` says until when each run is known: when it ended, or now.
    """
    set_out_next: dict[tuple[str, str], Point] = {}
    said_next: dict[tuple[str, str], JournalLine] = {}
    for line in lines:
        if line.path:
            yield Drive(cut(line.path, set_out_next.get((line.run, line.robot))))
            set_out_next[line.run, line.robot] = line.path[0]
            continue
        said = said_next.get((line.run, line.step))
        said_next[line.run, line.step] = line
        if line.zone:
            goes_on = said is not None and (said.zone, said.robot) == (line.zone, line.robot)
            yield ZoneWait(line.zone, line.at, said.at if said else ends[line.run], goes_on)


def cut(path: Path, at: Point | None) -> Path:
    """Return a path as far as the point nearest to `at`, the later one of two; all of it if `at` is not on it."""
    if at is None:
        return path
    nearest, driven = ON_PATH_M, path
    for index, (a, b) in enumerate(pairwise(path)):
        on_leg = _nearest_of(a, b, at)
        if (off := hypot(on_leg[0] - at[0], on_leg[1] - at[1])) <= nearest:
            nearest, driven = off, [*path[: index + 1], on_leg]
    return driven


def _nearest_of(a: Point, b: Point, to: Point) -> Point:
    dx, dy = b[0] - a[0], b[1] - a[1]
    square = dx * dx + dy * dy
    share = ((to[0] - a[0]) * dx + (to[1] - a[1]) * dy) / square if square else 0.0
    share = min(1.0, max(0.0, share))
    return a[0] + share * dx, a[1] + share * dy


def square_for(width_m: float, height_m: float) -> float:
    """Return the side of the squares in which drives are counted on a floor so large: larger ones on large floors."""
    side = SQUARE_M
    while (width_m / side) * (height_m / side) > MOST_SQUARES:
        side *= 2
    return side


def squares_of(path: Path, square_m: float = SQUARE_M) -> frozenset[Square]:
    """Return the squares that a path comes through; none if it leads nowhere."""
    found: set[Square] = set()
    for a, b in pairwise(path):
        if tuple(a) != tuple(b):
            (ax, ay), (bx, by) = ((x / square_m, y / square_m) for x, y in (a, b))
            shares = sorted({0.0, 1.0, *_borders(ax, bx), *_borders(ay, by)})
            middles = [(share + after) / 2 for share, after in pairwise(shares)]
            found |= {(_index(ax + m * (bx - ax)), _index(ay + m * (by - ay))) for m in middles}
    return frozenset(found)


def _borders(a: float, b: float) -> Iterator[float]:
    """Yield at which shares of the way from `a` to `b`, in squares, a border between squares is crossed."""
    low, high = sorted((_index(a), _index(b)))
    for border in range(low + 1, high + 1):
        share = (border - a) / (b - a)
        if 0.0 < share < 1.0:
            yield share


def _index(squares: float) -> int:
    return floor(squares + _HAIR)


def heat_of(drives: Iterable[Drive], square_m: float = SQUARE_M) -> Mapping[Square, int]:
    """Return how often robots drove through each square (column, row).

    The square (0, 0) has its lower left corner in the origin of the map's frame; columns count along x, rows along y.
    """
    paths = Counter(tuple((x, y) for x, y in drive.path) for drive in drives)
    heat: Counter[Square] = Counter()
    for path, count in paths.items():
        for square in squares_of(path, square_m):
            heat[square] += count
    return heat


def zones_of(waits: Iterable[ZoneWait], utc_offset_min: int) -> Mapping[str, ZoneUse]:
    """Return what zones cost, by their keys, in days that begin so many minutes before those of UTC."""
    zones: dict[str, _Tally] = {}
    for wait in waits:
        _add_wait(zones.setdefault(wait.zone, _Tally()), wait, utc_offset_min)
    waited = {key: tally for key, tally in zones.items() if tally.waits}
    return {key: ZoneUse(t.waits, round(t.waited_s, 1), _busiest(t.slots)) for key, t in waited.items()}


def _add_wait(tally: _Tally, wait: ZoneWait, utc_offset_min: int) -> None:
    seconds = (wait.ended_at - wait.begun_at).total_seconds()
    if seconds > 0:
        tally.waits += not wait.goes_on
        tally.waited_s += seconds
        _fill(tally.slots, (wait.begun_at.timestamp() + utc_offset_min * 60) % _DAY_S, seconds)


def _fill(slots: list[float], since_midnight_s: float, seconds: float) -> None:
    """Share out a wait among the slots of the day in which it was."""
    days, left = divmod(seconds, _DAY_S)
    if days:
        slots[:] = [slot + days * _SLOT_S for slot in slots]
    at = since_midnight_s
    while left > _HAIR:
        index = floor(at / _SLOT_S + _HAIR)
        part = min(left, (index + 1) * _SLOT_S - at)
        slots[index % SLOTS] += part
        at, left = at + part, left - part


def _busiest(slots: Sequence[float]) -> int:
    """Return where the half hour with the most waiting begins; of equal ones that whose middle has more of it."""

    def worth(first: int) -> tuple[float, float]:
        parts = [slots[(first + more) % SLOTS] for more in range(BUSY_SLOTS)]
        return round(sum(parts), 3), round(parts[BUSY_SLOTS // 2], 3)

    return SLOT_MIN * max(range(SLOTS), key=worth)

"""Watches how near robots come to walls, machines and each other, and reports once for each meeting."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from math import hypot

from simulation.actors import Motion
from simulation.proximity import REACH_M, Crowd, Near, Obstacles
from simulation.scene import Layout
from simulation.world import Contact

TOUCH_M = 0.003
"""Bodies in physics keep a hair's breadth apart when they push each other."""
NEAR_ROBOT_M = 0.10
NEAR_THING_M = 0.02
CLOSING_M_S = 1.2
"""The least that is reckoned with: people push robots, too."""
LOOK_S = 0.7
"""The longest that nobody looks, with nothing in reach."""
PARTING_M = 0.01
LINGERS_S = 1.0
Away = tuple[float, float]


@dataclass(slots=True)
class Meeting:
    """A robot near something: the closest so far, and what was reported of it."""

    closest: Near
    since_s: float
    reported: bool = False
    reported_touch: bool = False


class NearnessWatch:
    """Contacts: one when two bodies touch, one when they came nearer than they should and part again."""

    def __init__(self, layout: Layout, motions: Mapping[str, Motion]) -> None:
        self.touching: dict[str, list[Away]] = {}
        self._motions = motions
        self._radii_m = {r.id: r.radius_m for r in layout.robots}
        self._obstacles = Obstacles([*layout.walls, *layout.machines], max(self._radii_m.values(), default=0.0))
        fastest_m_s = max((r.speed_m_s for r in layout.robots), default=0.0)
        self._closing_m_s = {r.id: max(CLOSING_M_S, r.speed_m_s + fastest_m_s) for r in layout.robots}
        self._crowd = Crowd(self._radii_m)
        for name, motion in motions.items():
            self._crowd.put(name, motion.x, motion.y)
        self._look_at_s = dict.fromkeys(motions, 0.0)
        self._meetings: dict[tuple[str, str], Meeting] = {}
        self._touched: dict[str, str] = {}

    def touched_by(self, robot: str) -> str:
        """Return the name of what the robot touches, or an empty text."""
        return self._touched.get(robot, "")

    def look(self, t_s: float, moving: Iterable[str]) -> list[Contact]:
        """Look at the robots that move, and return what is to be reported."""
        contacts: list[Contact] = []
        for robot in moving:
            motion = self._motions[robot]
            self._crowd.put(robot, motion.x, motion.y)
        for robot in moving:
            if t_s >= self._look_at_s[robot]:
                contacts.extend(self._look_around(t_s, robot))
        return contacts

    def _look_around(self, t_s: float, robot: str) -> Iterator[Contact]:
        motion = self._motions[robot]
        things = self._obstacles.near(motion.x, motion.y, self._radii_m[robot])
        around = [(n, NEAR_THING_M) for n in _nearest_each(things)]
        around += [(n, NEAR_ROBOT_M) for n in self._crowd.near(robot)]
        # Nothing can come near sooner than this, so nobody needs to look before.
        spare_m = min((n.gap_m - limit for n, limit in around), default=REACH_M - NEAR_ROBOT_M)
        self._look_at_s[robot] = t_s + min(LOOK_S, max(0.0, spare_m / self._closing_m_s[robot]))
        near = {n.other: n for n, limit in around if n.gap_m < limit}
        self._note_touch(robot, motion, [n for n in near.values() if n.gap_m <= TOUCH_M])
        for other in [o for r, o in self._meetings if r == robot and o not in near]:
            yield from self._part(t_s, robot, other)
        for other, now in near.items():
            yield from self._meet(t_s, robot, other, now)

    def _note_touch(self, robot: str, motion: Motion, touched: list[Near]) -> None:
        self.touching.pop(robot, None)
        self._touched.pop(robot, None)
        if touched:
            self.touching[robot] = [_away_from(motion, n) for n in touched]
            self._touched[robot] = touched[0].other

    def _meet(self, t_s: float, robot: str, other: str, now: Near) -> Iterator[Contact]:
        meeting = self._meetings.setdefault((robot, other), Meeting(now, t_s))
        parting = now.gap_m > meeting.closest.gap_m + PARTING_M
        if now.gap_m < meeting.closest.gap_m:
            meeting.closest = now
        if now.gap_m <= TOUCH_M and not meeting.reported_touch:
            meeting.reported = meeting.reported_touch = True
            yield self._contact(t_s, robot, now)
        elif not meeting.reported and (parting or t_s - meeting.since_s > LINGERS_S):
            meeting.reported = True
            yield self._contact(t_s, robot, meeting.closest)

    def _part(self, t_s: float, robot: str, other: str) -> Iterator[Contact]:
        meeting = self._meetings.pop((robot, other))
        if not meeting.reported:
            yield self._contact(t_s, robot, meeting.closest)

    def _contact(self, t_s: float, robot: str, near: Near) -> Contact:
        motion = self._motions[robot]
        x, y = (motion.x + near.x) / 2, (motion.y + near.y) / 2
        gap_m = near.gap_m if near.gap_m > TOUCH_M else min(0.0, near.gap_m)
        return Contact(t_s, robot, near.other, round(gap_m, 4), round(x, 3), round(y, 3))


def _nearest_each(things: list[Near]) -> list[Near]:
    """Keep the nearest of those with the same name: a wall is made of many boxes."""
    nearest: dict[str, Near] = {}
    for thing in things:
        known = nearest.get(thing.other)
        if known is None or thing.gap_m < known.gap_m:
            nearest[thing.other] = thing
    return list(nearest.values())


def _away_from(motion: Motion, near: Near) -> Away:
    x, y = motion.x - near.x, motion.y - near.y
    length = hypot(x, y) or 1.0
    return x / length, y / length

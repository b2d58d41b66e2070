"""The robot's mind: from odometry and scans to a map, and to how fast to drive and turn. It never sees the truth."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import atan2, cos, hypot
from typing import Literal

import numpy as np

from registry.floorplan.plan import Grid
from simulation.actors.follower import wrapped
from simulation.mapping.exploration import (
    Goal,
    Ground,
    Paths,
    Point,
    choose_goal,
    find_frontiers,
    is_near,
    survey_ground,
)
from simulation.mapping.narrow_ways import NarrowWays
from simulation.mapping.occupancy import SURE_FREE, SURE_WALL, Floats, OccupancyMap, read_scan
from simulation.mapping.odometry import moved
from simulation.mapping.scan_matching import Trust, match
from vipo_device.protocol.description import Pose

SCAN_M, SCAN_RAD = 0.15, 0.12
"""After so much way or turning a scan is matched and goes into the map."""
LOOK_AHEAD_M = 0.3
NARROW_AHEAD_M = 0.1
"""In narrow places the robot aims at so near a point of its way: it must not cut corners there."""
THERE_M = 0.12
STOP_M = 0.06
"""Nearer than so much beyond its own radius nothing may be ahead of a robot that drives."""
TURN_RAD_S = 0.8
TURN_ONLY_RAD = 0.6
SEEN_SHARE = 0.75
STUCK_S = 12.0
PROGRESS_M = 0.05
MOST_BLOCKED = 4
FRESH_M = 0.02
LEAVE_M = 0.2
BACK_M_S = -0.1
BACK_S = 1.5


@dataclass(frozen=True, slots=True)
class RobotSpec:
    """A robot that makes a map: its radius, its top speed, how far its lidar sees, how far off odometry may be."""

    radius_m: float = 0.12
    speed_m_s: float = 0.3
    range_m: float = 8.0
    odometry_noise: float = 0.05


@dataclass(slots=True)
class _Course:
    """Where the robot is going, and how it gets on."""

    path: list[Point]
    goal: Goal | None
    is_narrow: bool = False
    nearest_m: float = float("inf")
    stalled_s: float = 0.0
    blocked: int = 0


@dataclass(slots=True)
class _Since:
    """What odometry has said since the last scan that was matched."""

    way_m: float = 0.0
    turned_rad: float = 0.0
    spun_rad: float = 0.0


@dataclass
class MapMaker:
    """Explores a floor from `start` on. `anchor` is a corner of some cell, `side_m` the side of cells.

    `is_barred` once the robot has not got out of or through a narrow place behind which there is more to see.
    """

    robot: RobotSpec
    start: Pose
    side_m: float = 0.05
    anchor: Point = (0.0, 0.0)
    state: Literal["exploring", "returning", "done"] = "exploring"
    given_up: list[Point] = field(default_factory=list)
    is_barred: bool = False
    matches: int = 0

    def __post_init__(self) -> None:
        self.pose = self.start
        self.occupancy = OccupancyMap(self.side_m, self.anchor, self.robot.range_m)
        self._since = _Since()
        self._course: _Course | None = None
        self._back_s = 0.0
        self._looks = False

    @property
    def is_done(self) -> bool:
        """True when the robot knows no way to more, and is back where it began, or as near as it could come."""
        return self.state == "done"

    @property
    def is_whole(self) -> bool:
        """True when it is done, and has seen all that it can reach."""
        return self.is_done and not self.is_barred

    def go_on(self) -> None:
        """Explore on with the same map, for the robot stands elsewhere now, or has been given room."""
        self.state, self.is_barred, self._course = "exploring", False, None

    def grid(self) -> Grid:
        """Return the map as it is now."""
        return self.occupancy.grid()

    def move(self, ahead_m: float, turned_rad: float) -> None:
        """Take in what odometry says of the last moment."""
        since = self._since
        since.way_m += abs(ahead_m)
        since.turned_rad += turned_rad
        since.spun_rad += abs(turned_rad)
        self.pose = moved(self.pose, ahead_m, turned_rad)

    def wants_scan(self) -> bool:
        """Tell whether the robot has moved so far that it wants to see anew."""
        since = self._since
        return not self.matches or self._looks or since.way_m >= SCAN_M or since.spun_rad >= SCAN_RAD

    def see(self, ranges: Floats) -> None:
        """Find out where a scan was taken, and put it into the map; one range per beam from -pi on, in metres."""
        sight = read_scan(ranges, self.robot.range_m)
        if self.matches:
            since, noise = self._since, max(self.robot.odometry_noise, 0.01)
            turn = 0.02 + noise * (since.spun_rad + since.way_m / self.robot.radius_m)
            self.pose = match(self.occupancy, sight, self.pose, Trust(0.01 + 2 * noise * since.way_m, turn))
        self.occupancy.add(sight, self.pose)
        self._since, self._looks = _Since(), False
        self.matches += 1
        if self._course is not None and self._course.goal is not None and self._is_seen(self._course.goal):
            self._course = None

    def _is_seen(self, goal: Goal) -> bool:
        """Tell whether most of what was to be seen is known by now."""
        rows, columns = self.occupancy.cells_of(goal.frontier)
        reach = max(1, round(0.15 / self.side_m))
        known = 0
        for row, column in zip(rows.tolist(), columns.tolist(), strict=True):
            window = self.occupancy.odds[
                max(0, row - reach) : row + reach + 1, max(0, column - reach) : column + reach + 1
            ]
            known += bool(np.all((window < SURE_FREE) | (window > SURE_WALL)))
        return known >= SEEN_SHARE * len(rows)

    def drive(self, ranges: Floats, dt_s: float) -> tuple[float, float]:
        """Return how fast to drive (m/s) and to turn (rad/s) in the next `dt_s`, by what the lidar sees now."""
        if self.is_done:
            return 0.0, 0.0
        if self._back_s > 0:
            self._back_s -= dt_s
            return (BACK_M_S, 0.0) if self._room_m(ranges, behind=True) > STOP_M else (0.0, 0.5)
        if self._course is None:
            self._course = self._plan()
        if self._course is None:
            return 0.0, 0.0
        return self._follow(self._course, ranges, dt_s)

    def is_blocked(self, ranges: Floats) -> bool:
        """Tell whether the lidar sees something so near ahead that the robot must not go on."""
        return self._room_m(ranges) <= STOP_M

    def _plan(self) -> _Course | None:
        """Return the way to the next frontier, then home; None when all is over."""
        home, here, radius_m = (self.start.x, self.start.y), (self.pose.x, self.pose.y), self.robot.radius_m
        ground = survey_ground(self.occupancy, radius_m, self.given_up)
        paths = Paths(ground, here)
        if self.state == "exploring":
            course = self._next_course(ground, paths)
            if course is not None:
                return course
        if self.state == "done" or is_near(self.pose, home, THERE_M):
            self.state = "done"
            return None
        self.state = "returning"
        path, is_narrow = paths.path_home(home), False
        if not path:
            path, is_narrow = NarrowWays(self.occupancy, ground, here, radius_m).path_home(home), True
        if not path:
            self.state = "done"
            return None
        return _Course(list(path), None, is_narrow)

    def _next_course(self, ground: Ground, paths: Paths) -> _Course | None:
        """Return the way to the next frontier: a narrow one where no other leads to any."""
        goal = choose_goal(paths, self.robot.radius_m)
        if goal is not None:
            return _Course(list(goal.path), goal)
        if find_frontiers(ground) is None:
            self.is_barred = False  # what was behind a narrow place has been seen from elsewhere
            return None
        if self.is_barred:
            return None
        ways = NarrowWays(self.occupancy, ground, (self.pose.x, self.pose.y), self.robot.radius_m)
        goal = ways.goal()
        if goal is None:
            self.is_barred = not ways.fits
            return None
        return _Course(list(goal.path), goal, is_narrow=True)

    def _follow(self, course: _Course, ranges: Floats, dt_s: float) -> tuple[float, float]:
        ahead_m = NARROW_AHEAD_M if course.is_narrow else LOOK_AHEAD_M
        while len(course.path) > 1 and is_near(self.pose, course.path[0], ahead_m):
            course.path.pop(0)
        left_m = hypot(course.path[0][0] - self.pose.x, course.path[0][1] - self.pose.y)
        if len(course.path) == 1 and left_m < THERE_M:
            self._arrive(course)
            return 0.0, 0.0
        self._watch(course, left_m, dt_s)
        if course.stalled_s > STUCK_S:
            self._give_up(course)
            return 0.0, 0.0
        aim_x, aim_y = course.path[0]
        error = wrapped(atan2(aim_y - self.pose.y, aim_x - self.pose.x) - self.pose.theta)
        turn = max(-TURN_RAD_S, min(TURN_RAD_S, 2.0 * error))
        if abs(error) > TURN_ONLY_RAD:
            return 0.0, turn
        if self._room_m(ranges) <= STOP_M:
            self._meet(course)
            return 0.0, 0.0
        speed = self.robot.speed_m_s * max(0.2, cos(error) ** 2)
        near = max(0.1, self._room_m(ranges) - STOP_M)
        return min(speed, near, max(0.05, left_m if len(course.path) == 1 else speed)), turn

    def _watch(self, course: _Course, left_m: float, dt_s: float) -> None:
        measure = len(course.path) * 0.1 + left_m
        if measure < course.nearest_m - PROGRESS_M:
            course.nearest_m, course.stalled_s = measure, 0.0
        else:
            course.stalled_s += dt_s

    def _room_m(self, ranges: Floats, *, behind: bool = False) -> float:
        """Return how far the robot can go straight on before it touches what the lidar sees now."""
        bearings = np.linspace(-np.pi, np.pi, ranges.size, endpoint=False)
        seen = np.isfinite(ranges)
        x, y = ranges[seen] * np.cos(bearings[seen]), ranges[seen] * np.sin(bearings[seen])
        ahead = -x if behind else x
        radius = self.robot.radius_m
        in_way = (ahead > 0) & (np.abs(y) < radius + 0.02)
        if not in_way.any():
            return self.robot.range_m
        gaps = ahead[in_way] - np.sqrt(np.maximum(0.0, (radius + 0.02) ** 2 - y[in_way] ** 2))
        return float(gaps.min())

    def _meet(self, course: _Course) -> None:
        """Something is in the way: back off a little and plan anew, and in the end give the goal up."""
        self._back_s = BACK_S
        blocked = course.blocked + 1
        if blocked >= MOST_BLOCKED:
            self._give_up(course)
            return
        fresh = self._plan()
        if fresh is not None:
            fresh.blocked = blocked
        self._course = fresh

    def _arrive(self, course: _Course) -> None:
        """Look once more from the end of the way; what is not seen from there is given up."""
        if course.goal is None:
            self.state = "done"
        elif self._since.way_m > FRESH_M:
            self._looks = True
            return
        else:
            self._leave(course.goal)
        self._course = None

    def _give_up(self, course: _Course) -> None:
        if course.goal is None:
            self.state = "done"
        elif course.is_narrow:
            self.is_barred = True
        else:
            self._leave(course.goal)
        self._back_s, self._course = BACK_S, None

    def _leave(self, goal: Goal) -> None:
        """Give up what could not be seen from where it should be seen: the points that are nearest to that."""
        stand = goal.path[-1]
        away = np.hypot(goal.frontier[:, 0] - stand[0], goal.frontier[:, 1] - stand[1])
        near = goal.frontier[away <= away.min() + LEAVE_M]
        spaced: list[Point] = []
        for x, y in near.tolist():
            if all(hypot(x - a, y - b) > LEAVE_M / 2 for a, b in spaced):
                spaced.append((x, y))
        self.given_up.extend(spaced)
